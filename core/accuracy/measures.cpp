// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/measures.h"

#include <limits>

namespace hairloom {
namespace {

constexpr MeasureInfo kMeasures[] = {
    {Measure::distance, "distance", "error against the reference", "mm", true, 1e-4,
     "Root mean square distance of points from the reference, over the whole motion."},
    {Measure::drop, "drop", "sag at rest", "mm", true, 1e-3,
     "Root mean square distance between the authored points and their rest position, with a still head in "
     "still air."},
    {Measure::afterShake, "after_shake", "residual after a shake", "mm", true, 1e-3,
     "Distance between the rest positions before and after the head was shaken for a second."},
    {Measure::depth, "depth", "deepest penetration of head or spheres", "mm", true, 1e-3,
     "Largest depth of a point in the head mesh or in a collision sphere, over the whole motion."},
    {Measure::restSpeed, "rest_speed", "speed at rest", "mm/s", false, 1e-2,
     "Speed of the fastest point after the head has been still for seconds. Above zero, the hair trembles."},
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
