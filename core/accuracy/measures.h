// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The numbers that runs are judged by, each a vertical axis of diagrams.

#include <span>

#include "core/accuracy/work_precision.h"

namespace hairloom {

enum class Measure { distance, drop, afterShake, depth, restSpeed };

struct MeasureInfo {
    Measure measure;
    const char* name;     ///< of files: "after_shake"
    const char* label;    ///< "left over after a shake"
    const char* unit;     ///< "mm", "mm/s"
    bool length;          ///< in mm, which a picture shows as pixels
    double floor;         ///< in the unit; what is less is drawn there
    const char* meaning;  ///< one sentence for people
};
/// All, distance first.
std::span<const MeasureInfo> measures();
const MeasureInfo& infoOf(Measure measure);

/// In the measure's unit; of a run that has not diverged.
double valueOf(const WorkPrecisionRun& run, Measure measure);

/// For each run whether no other that neither diverges nor trembles has both less time and less of it.
std::vector<bool> frontBy(const WorkPrecision& measured, Measure measure);

}  // namespace hairloom
