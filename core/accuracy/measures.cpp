// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/measures.h"

#include <limits>

namespace hairloom {
namespace {

constexpr MeasureInfo kMeasures[] = {
    {Measure::distance, "distance", "off from the reference", "mm", true, 1e-4,
     "Root mean square distance of points from where the reference has them, over the whole motion."},
    {Measure::drop, "drop", "drop at rest", "mm", true, 1e-3,
     "How far points come to rest from where they are authored, root mean square, on a head that stands "
     "still in still air."},
    {Measure::afterShake, "after_shake", "left over after a shake", "mm", true, 1e-3,
     "How far points come to rest from where they rested before the head was shaken for a second."},
    {Measure::depth, "depth", "deepest in head or spheres", "mm", true, 1e-3,
     "How deep a point is in the head's mesh or in a collision sphere, at the worst moment of the motion."},
    {Measure::restSpeed, "rest_speed", "speed at rest", "mm/s", false, 1e-2,
     "How fast the fastest point still is where the head has stood still for seconds: hair that trembles."},
};

}  // namespace

std::span<const MeasureInfo> measures() {
    return kMeasures;
}

const MeasureInfo& infoOf(Measure measure) {
    return kMeasures[static_cast<std::size_t>(measure)];
}

double valueOf(const WorkPrecisionRun& run, Measure measure) {
    switch (measure) {
        case Measure::distance:
            return run.error.rmsMm;
        case Measure::drop:
            return run.other.dropMm;
        case Measure::afterShake:
            return run.other.returnMm;
        case Measure::depth:
            return run.other.depthMm();
        case Measure::restSpeed:
            return 1e3 * run.other.restSpeed;
    }
    return std::numeric_limits<double>::quiet_NaN();
}

std::vector<bool> frontBy(const WorkPrecision& measured, Measure measure) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    std::vector<std::pair<double, double>> pairs;
    for (const WorkPrecisionRun& run : measured.runs) {
        const bool out = run.diverged || run.trembling > 0;
        pairs.emplace_back(out ? kNever : run.milliseconds.median, out ? kNever : valueOf(run, measure));
    }
    return paretoFront(pairs);
}

}  // namespace hairloom
