// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Work-precision runs as tables, charts and a page.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/accuracy/measures.h"
#include "core/accuracy/peers.h"
#include "core/accuracy/work_precision.h"
#include "core/charts/plot.h"

namespace hairloom {

/// What a report says of a run besides its numbers.
struct ReportContext {
    std::string groom;        ///< file, as the user named it
    std::string motion;       ///< as named
    std::string commandLine;  ///< may be empty
    std::vector<PeerRun> peers = recordedPeers();
};

/// One line per run after a head line, RFC 4180: each axis by its field's name, then ms_median, ms_q1, ms_q3,
/// ms_all_strands (the median times the share of strands that ran: an estimate), error_mm_rms, error_mm_max,
/// drop_mm, after_shake_mm, head_depth_mm, sphere_depth_mm, rest_speed_mm_s, step_error_mm, points_error_mm,
/// model_error_mm (of runs that have parts), diverged, on_front (0 or 1). Numbers of diverged runs are empty.
std::string workPrecisionCsv(const WorkPrecision& result);

/// Error, or what else runs are judged by, against time, both logarithmic: a colour for each integrator, a
/// shape for each number of points, the front joined and labelled, the rest faint.
Plot workPrecisionPlot(const WorkPrecision& result, const ReportContext& context,
                       Measure measure = Measure::distance);

/// The parts of each error that has them, side by side; nothing where none has.
std::optional<Plot> partsPlot(const WorkPrecision& result);

/// Error against one axis of numbers, a line for each integrator, the other axes held at their largest
/// values. Nothing for an axis of choices, of threads, or of one value.
std::optional<Plot> errorPlot(const WorkPrecision& result, std::size_t axis);

/// "substeps 8, points 16": the values of a run by name.
std::string settingText(const WorkPrecision& result, const WorkPrecisionRun& run);

/// Writes data.csv, work_precision.svg, a drawing for each other measure by its name, error_parts.svg and
/// error_vs_FIELD.svg where there are any, and report.html into the folder, which is made where it is
/// missing. Returns the names of the files in it.
Result<std::vector<std::string>> writeWorkPrecision(const WorkPrecision& result, const ReportContext& context,
                                                    const std::filesystem::path& folder);

}  // namespace hairloom
