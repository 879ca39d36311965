// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/record_comparison.h"

#include <algorithm>
#include <cmath>

#include "cli/documents.h"
#include "core/simulation/frame_record.h"

namespace hairloom::cli {

Status RecordComparison::add(const Groom& groom, std::uint64_t frame, std::span<const Vec3f> positions_ws) {
    const auto recorded = readFrame(path_, groom, frame);
    if (!recorded) return tl::unexpected(recorded.error());
    for (std::size_t p = 0; p < positions_ws.size(); ++p) {
        const double squared = (positions_ws[p] - recorded->positions_ws[p]).cast<double>().squaredNorm();
        sum_ += squared;
        largest_ = std::max(largest_, squared);
    }
    count_ += positions_ws.size();
    return {};
}

double RecordComparison::meanMm() const {
    return 1e3 * std::sqrt(sum_ / static_cast<double>(count_));
}

double RecordComparison::maxMm() const {
    return 1e3 * std::sqrt(largest_);
}

void RecordComparison::report(Report& report) const {
    report["error_mm"] = finiteOrNull(meanMm());
    report["error_mm_max"] = finiteOrNull(maxMm());
}

}  // namespace hairloom::cli
