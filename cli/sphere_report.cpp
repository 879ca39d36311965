// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sphere_report.h"

namespace hairloom::cli {

void addFit(Report& report, const editing::SphereFit& fit) {
    constexpr double kMm = 1000;
    report["worst_gap_mm"] = kMm * static_cast<double>(fit.worstGap);
    report["mean_gap_mm"] = kMm * static_cast<double>(fit.meanGap);
    report["worst_bulge_mm"] = kMm * static_cast<double>(fit.worstBulge);
}

}  // namespace hairloom::cli
