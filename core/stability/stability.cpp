// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/stability/stability.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/stability/hard_cases.h"

namespace hairloom {
namespace {

using namespace hardcases;

// clang-format off
constexpr HardCase kCases[] = {
    {1, "zero-length segment", "shape", "a zero-length segment at the root, in the middle, at the tip, then shaken", segmentWithoutLength},
    {2, "coincident neighbours", "shape", "four points at one place, 10 µm apart, all points at one place, then shaken", coincidentNeighbours},
    {3, "folded back", "shape", "a rest shape that turns by 180° once, and at every point, then shaken", foldedBack},
    {4, "point at a sphere's centre", "spheres", "a sphere of 2 cm appears with a point at its centre, which has 0.5 s to leave it", pointAtCentre},
    {5, "overlapping spheres", "spheres", "two, then five overlapping spheres appear around one point, which has 0.5 s to leave them", overlappingSpheres},
    {6, "10 turns a second", "motion", "the head turns at 10 rev/s for 2,000 substeps, then stops at once", turningHead},
    {7, "teleport", "motion", "a cut by 10 m and half a turn in motion, and back", teleport},
    {8, "frame times", "motion", "frames of 1, 33, 250 and 1,000 ms, then alternating, on a swaying head", frameTimes},
    {9, "stiffness x 10^6", "stiffness", "a million times the default stiffness, then shaken", stiffnessTimesMillion},
    {10, "mass ratio 10^4", "shape", "masses from 1 to 10,000 along a strand, in either direction, then shaken", massRatio},
    {11, "reversing storm", "stiffness", "100 m/s, reversing each frame, for 2,000 substeps, then still", reversingStorm},
    {12, "tiny segments", "shape", "31 segments of 0.1 mm, then shaken", tinySegments},
    {13, "long strand", "shape", "1.5 m in 31 segments, then shaken", longStrand},
    {14, "small curls", "shape", "curls of 2 mm radius, 12 points per turn, then shaken", smallCurls},
    {15, "one segment", "shape", "strands of two points, one or both clamped, then shaken", oneSegment},
    {16, "root through a sphere", "spheres", "the roots cross a sphere of 5 cm at 0.5 m/s", rootThroughSphere},
    {17, "free swing", "energy", "no gravity, air or damping, straight hair, 60 s after a push", freeSwing},
    {18, "a million substeps at rest", "energy", "once asleep, once kept awake", longRest},
    {19, "non-finite input", "input", "wind, time, roots and spheres of NaN and infinity, and a strand that does break", windThatIsNoNumber},
    {20, "denormal speeds", "input", "gravity of 1e-36 m/s² and wind of 1e-38 m/s, then gravity as usual", denormalSpeeds},
    {21, "scale 0.001 and 1,000", "shape", "hair of 0.18 mm and of 180 m, then shaken", smallAndLarge},
    {22, "shrinking sphere", "spheres", "a sphere of 4 cm shrinks to nothing in 2 s", shrinkingSphere},
    {23, "negative radius", "spheres", "a sphere of -5 cm is left out and changes nothing", negativeRadius},
    {24, "changes in mid-run", "motion", "integrator, substeps and number of segments change every few frames", changesInMidRun},
    {25, "6, 8, 9 and 11 at once", "motion", "turning at 10 rev/s in a reversing storm, stiffness x 10^6, frames of 1 to 1,000 ms", everythingAtOnce},
    {26, "random storms", "motion", "jumps of metres, any rotation, frames of 1 ms to 1 s, gusts to 300 m/s and spheres at once, on hair of 2 to 200 points, straight and curled, then still", randomStorms},
    {27, "stiffness 0", "stiffness", "no stiffness at all, then none at the tip and none at the root, straight and curled; shaken, then on a sphere", noStiffness},
    {28, "vice", "spheres", "two spheres of 5 cm close on hanging hair until they touch", viceOfSpheres},
    {29, "bounce", "spheres", "level hair falls on a sphere with a restitution of 0.2, 0.5 and 1", bouncingStrand},
    {30, "sphere of 1 km", "spheres", "level hair falls on a sphere of 1 km", sphereOfAKilometre},
};
// clang-format on

/// Share of its threshold; what is no number or may not happen at all is beyond every share.
double share(const StabilityThreshold& m) {
    if (m.met()) return m.threshold > 0.0 ? m.worst / m.threshold : 0.0;
    return m.threshold > 0.0 && std::isfinite(m.worst) ? m.worst / m.threshold
                                                       : std::numeric_limits<double>::infinity();
}

}  // namespace

const StabilityThreshold& StabilityResult::closest() const {
    return *std::ranges::max_element(thresholds, {}, share);
}

std::span<const HardCase> hardCases() {
    return kCases;
}

StabilityResult runHardCase(const HardCase& hardCase, const StabilityMethod& method,
                            const StabilityOptions& options) {
    HardCaseRun caseRun(method, options);
    hardCase.run(caseRun);
    StabilityResult result = caseRun.result();
    result.number = hardCase.number;
    result.name = hardCase.name;
    result.family = hardCase.family;
    return result;
}

std::vector<StabilityResult> runHardCases(std::span<const StabilityMethod> methods,
                                          const StabilityOptions& options,
                                          const std::function<void(std::size_t)>& progress) {
    std::vector<StabilityResult> results(hardCases().size() * methods.size());
    std::atomic<std::size_t> done{0};
    // A device is used from one thread.
    const std::size_t piece = options.engines ? results.size() : 1;
    parallelFor(results.size(), std::max<std::size_t>(piece, 1), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            results[i] = runHardCase(hardCases()[i / methods.size()], methods[i % methods.size()], options);
            const std::size_t count = ++done;
            if (progress) progress(count);
        }
    });
    return results;
}

std::string StabilityMethod::name() const {
    return rods() ? "rods" : nameOf(integrator);
}

std::vector<StabilityMethod> allStabilityMethods() {
    std::vector<StabilityMethod> all{kRods};
    for (const runtime::Integrator integrator : allIntegrators()) all.push_back(springsWith(integrator));
    return all;
}

std::vector<runtime::Integrator> allIntegrators() {
    std::vector<runtime::Integrator> all;
    const std::size_t count = runtime::integratorNames().size();
    for (std::size_t i = 0; i < count; ++i) all.push_back(static_cast<runtime::Integrator>(i));
    return all;
}

}  // namespace hairloom
