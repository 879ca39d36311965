// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "benchmarks/contact_rows.h"
#include "core/stability/contact_scenes.h"
#include "core/stability/stability.h"

namespace hairloom::benchmarks {
namespace {

/// Share of the angle of friction at which the point of slideOnAPlane() lets go: it slides by a centimetre in
/// a second where a body does that at 1.007 of it.
double lettingGo(std::uint32_t substeps) {
    double holds = 0.8, slides = 1.2;
    for (int i = 0; i < 12; ++i) {
        const double middle = 0.5 * (holds + slides);
        (slideOnAPlane(middle, substeps).slid < 0.01 ? holds : slides) = middle;
    }
    return 0.5 * (holds + slides);
}

double percentOff(double value, double due) {
    return 100 * std::abs(value / due - 1);
}

}  // namespace

std::size_t contactStepsOfRods(bool quick) {
    return quick ? 5 : 7;
}

std::vector<ContactRow> contactsOfRods(bool quick, const std::function<void()>& next) {
    std::vector<ContactRow> rows;
    next();
    const FallOnASphere fall;
    double before = 0.009;  // so that the first mark is 3 mm
    for (const std::uint32_t substeps : {2u, 8u, 32u, 128u}) {
        if (quick && substeps > 8) break;
        const double error = fall.error(substeps);
        rows.push_back(
            {fmt::format("strand falls on a sphere, off a chain in closed equations, {} substeps", substeps),
             1e3 * error, "mm", 1e3 * before / 3, "not found yet"});
        before = error;
    }
    next();
    for (const std::uint32_t substeps : {2u, 16u}) {
        rows.push_back(
            {fmt::format("tilt at which a point lets go, off the angle of friction, {} substeps", substeps),
             percentOff(lettingGo(substeps), 1.007), "%", 5, "friction takes the force of the last substep"});
        rows.push_back({fmt::format("slides 5 % below that angle in a second, {} substeps", substeps),
                        1e3 * slideOnAPlane(0.95, substeps).slid, "mm", 1,
                        "the first substep finds no force to hold by"});
        for (const double over : {1.1, 1.5}) {
            const Slide slide = slideOnAPlane(over, substeps);
            rows.push_back(
                {fmt::format("way {:.0f} % above it in a second, {} substeps", 100 * (over - 1), substeps),
                 percentOff(slide.slid, slide.due), "%", 5,
                 "what pulls is a tenth of what holds: 1 % of friction is 10 % of the way"});
        }
    }
    next();
    for (const std::uint32_t substeps : {2u, 8u}) {
        for (const float friction : {0.2f, 0.5f, 0.8f}) {
            const Capstan found = strandOverABar(friction, substeps);
            rows.push_back({fmt::format("tension over a bar (capstan), friction {}, {:.0f}°, {} substeps",
                                        friction, found.wrap * 180 / std::acos(-1.0), substeps),
                            percentOff(found.ratio, found.due), "%", 5,
                            "friction takes the force of the last substep"});
        }
    }
    next();
    for (const float restitution : {0.2f, 0.5f, 1.0f}) {
        if (quick && restitution > 0.2f) break;
        const Bounce bounce = bounceOnASphere(restitution);
        rows.push_back({fmt::format("restitution {}, speed after 15 s", restitution), 1e3 * bounce.speed,
                        "mm/s", 5, "what bounces back whole loses nothing to the sphere"});
        rows.push_back({fmt::format("restitution {}, energy that it gains without damping", restitution),
                        1e3 * bounce.gained, "mJ", 0.1, "rounding"});
    }
    next();
    rows.push_back({"gravity that changes by 10 % a frame, strands whose speed is taken",
                    static_cast<double>(guardedWhereGravityChanges()), "", 0, "the guard of energy"});
    if (quick) return rows;
    next();
    const StabilityResult none = runHardCase(hardCases()[26], kRods);
    rows.push_back({"stiffness 0 to 1 along a strand (hard case 27), thresholds that it misses",
                    static_cast<double>(std::ranges::count_if(
                        none.thresholds, [](const StabilityThreshold& one) { return !one.met(); })),
                    "", 0, none.closest().what});
    next();
    for (const std::uint32_t seed : {351u, 950u, 3806u})
        rows.push_back({fmt::format("storm {} of hard case 26, speed after 15 s", seed),
                        1e3 * speedAfterStorm(seed), "mm/s", 5, "it swings between spheres"});
    return rows;
}

}  // namespace hairloom::benchmarks
