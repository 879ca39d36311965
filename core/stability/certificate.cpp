// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/stability/certificate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>

#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/cost/scene_run.h"
#include "core/geometry/curve.h"

namespace hairloom {
namespace {

constexpr StormStrength kMildest{0.001, 0.1, 1, 0.1};
constexpr StormStrength kStrongest{0.1, 300, 180, 300};
constexpr int kStormFrames = 40;
constexpr int kRestFrames = 300, kLongRestFrames = 900;
constexpr float kFrame = 1.0f / 60.0f;
constexpr double kFast = 0.5, kCalm = 0.005;  // m/s
constexpr double kMaxStretch = 0.01;

constexpr std::array kParts{&StormStrength::step, &StormStrength::rootSpeed, &StormStrength::turn,
                            &StormStrength::wind};

struct StormEnd {
    StormStrength strength;
    std::string failure;    ///< empty where it held
    bool calm = false;      ///< after kRestFrames
    bool calmLate = false;  ///< after kLongRestFrames
};

Vec3f direction(Random& random) {
    const float z = random.uniform(-1, 1), around = random.uniform(0, 2 * std::numbers::pi_v<float>);
    const float across = std::sqrt(1 - z * z);
    return {across * std::cos(around), across * std::sin(around), z};
}

/// Evenly over orders of magnitude; a quarter of the storms lack one thing or another.
StormStrength drawStrength(Random& random) {
    StormStrength strength;
    for (double StormStrength::*const part : kParts) {
        const double share = random.uniformDouble();
        const bool lacks = random.below(4) == 0;
        strength.*part = kMildest.*part * std::pow(kStrongest.*part / kMildest.*part, share);
        if (lacks) strength.*part = part == &StormStrength::step ? static_cast<double>(kFrame) : 0;
    }
    return strength;
}

Random randomOf(std::uint32_t storm) {
    return Random(0x570a4, storm);
}
StormStrength strengthOf(std::uint32_t storm) {
    Random random = randomOf(storm);
    return drawStrength(random);
}

/// What gravity and the storm can have left of motion after the rest, m/s.
double leftOfMotion(const Groom& groom, double rootSpeed, double restSeconds) {
    float longest = 0;
    for (std::size_t s = 0; s < groom.strandCount(); ++s)
        longest = std::max(longest, polylineLength(groom.strand(s)));
    const double gravity = static_cast<double>(
        Vec3f(groom.simulation.gravity.x, groom.simulation.gravity.y, groom.simulation.gravity.z).norm());
    const double tau = static_cast<double>(groom.simulation.dampingTime);
    const double swing = rootSpeed + std::sqrt(4 * gravity * static_cast<double>(longest));
    return tau > 0 ? swing * std::exp(-restSeconds / tau) : swing;
}

Result<StormEnd> runStorm(const Groom& groom, std::uint32_t number, std::uint32_t strands) {
    Random random = randomOf(number);
    StormEnd end;
    end.strength = drawStrength(random);
    const SceneHair hair = sampleStrands(groom, strands, number);
    const Vec3f centre = hair.groom.bounds().center();
    HeadPose pose;
    pose.wind_ws = Vec3f::Zero();
    auto simulation = Simulation::make(hair.groom, pose);
    if (!simulation) return tl::unexpected(simulation.error());
    const auto amount = [](double value) { return static_cast<float>(value); };
    for (int frame = 0; frame < kStormFrames; ++frame) {
        const float dt = amount(end.strength.step);
        pose.origin_ws += (direction(random) * (amount(end.strength.rootSpeed) * dt)).cast<double>();
        const float angle = amount(end.strength.turn) * std::numbers::pi_v<float> / 180.0f;
        const Quatf turn(Eigen::AngleAxisf(angle, direction(random)));
        pose.head_ws.linear() = (turn * Quatf(pose.head_ws.linear())).normalized().toRotationMatrix();
        pose.head_ws.translation() = centre - pose.head_ws.linear() * centre;
        pose.wind_ws = direction(random) * amount(end.strength.wind);
        simulation->step(dt, pose);
    }
    pose.wind_ws = Vec3f::Zero();
    int rested = 0;
    const auto restUntil = [&](int frames) {
        for (; rested < frames; ++rested) simulation->step(kFrame, pose);
        return simulation->stats();
    };
    SimulationStats stats = restUntil(kRestFrames);
    const auto speedOf = [](const SimulationStats& now) { return now.fastestMmPerSecond / 1000; };
    end.calm = speedOf(stats) < kCalm;
    // Hair that a shoulder has caught may slip off it late, as real hair does.
    if (!end.calm && stats.nanCount == 0) stats = restUntil(kLongRestFrames);
    const double speed = speedOf(stats), restSeconds = rested * static_cast<double>(kFrame);
    end.calmLate = speed < kCalm;
    const bool held = groom.simulation.strandModel == runtime::StrandModel::rods ||
                      groom.simulation.lengthMethod == runtime::LengthMethod::constraint;
    if (stats.nanCount > 0) {
        end.failure = fmt::format("{} points are not finite", stats.nanCount);
    } else if (stats.restoredStrands > 0) {
        end.failure = fmt::format("{} strands were reset to rest", stats.restoredStrands);
    } else if (held && !(stats.maxStretch <= kMaxStretch)) {
        end.failure = fmt::format("a segment stretched by {:.2g} %", 100 * stats.maxStretch);
    } else if (!(speed <= kFast + leftOfMotion(hair.groom, end.strength.rootSpeed, restSeconds))) {
        end.failure = fmt::format("{:.2g} m/s after {:.0f} s of rest", speed, restSeconds);
    }
    return end;
}

bool isWithin(const StormStrength& strength, const StormStrength& box) {
    return std::ranges::all_of(
        kParts, [&](double StormStrength::*const part) { return strength.*part <= box.*part; });
}

}  // namespace

StormStrength boxWithout(std::span<const FailedStorm> failed) {
    StormStrength box = kStrongest;
    while (true) {
        double dearest = -1;
        double StormStrength::*cut = nullptr;
        double at = 0;
        for (const FailedStorm& storm : failed) {
            if (!isWithin(storm.strength, box)) continue;
            for (double StormStrength::*const part : kParts) {
                const double share = box.*part > 0 ? storm.strength.*part / (box.*part) : 0;
                if (share > dearest) {
                    dearest = share;
                    cut = part;
                    at = storm.strength.*part;
                }
            }
        }
        if (cut == nullptr) return box;
        if (dearest <= 0) return {};  // it fails in a calm
        box.*cut = std::nextafter(at, 0.0);
    }
}

Result<StormTally> runStorms(const Groom& groom, const CertificateOptions& options) {
    assert(options.storms >= 1 && options.strands >= 1);
    if (groom.strandCount() == 0) return fail("the groom has no strands", "expected strands to simulate");
    std::vector<std::optional<Result<StormEnd>>> ends(options.storms);
    std::atomic<std::size_t> done{0};
    std::atomic<bool> cancelled{false};
    parallelFor(ends.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t storm = begin; storm < end && !cancelled; ++storm) {
            if (options.cancelled && options.cancelled()) cancelled = true;
            const auto number = options.first + static_cast<std::uint32_t>(storm);
            ends[storm] = runStorm(groom, number, options.strands);
            if (options.progress) options.progress(++done, ends.size());
        }
    });
    if (cancelled) return fail("certifying was cancelled", "expected it to run to its end");
    StormTally tally;
    tally.first = options.first;
    tally.storms = options.storms;
    for (std::uint32_t storm = 0; storm < options.storms; ++storm) {
        const Result<StormEnd>& end = *ends[storm];
        if (!end) return tl::unexpected(end.error());
        if (!end->failure.empty())
            tally.failed.push_back({options.first + storm, end->strength, end->failure});
        tally.calm += end->calm ? 1 : 0;
        tally.calmLate += end->calmLate ? 1 : 0;
    }
    return tally;
}

Result<Certificate> certificateOf(std::vector<StormTally> tallies) {
    if (tallies.empty()) return fail("there are no storms", "expected at least one tally");
    std::ranges::sort(tallies, {}, &StormTally::first);
    Certificate certificate;
    for (StormTally& tally : tallies) {
        if (tally.first != certificate.storms || tally.storms == 0)
            return fail(fmt::format("storms {} to {} are {}", std::min(tally.first, certificate.storms),
                                    std::max(tally.first, certificate.storms),
                                    tally.first < certificate.storms ? "in two tallies" : "in no tally"),
                        "expected each storm once, from 0 on");
        certificate.storms += tally.storms;
        certificate.calm += tally.calm;
        certificate.calmLate += tally.calmLate;
        std::ranges::move(tally.failed, std::back_inserter(certificate.failed));
    }
    const StormStrength box = boxWithout(certificate.failed);
    for (std::uint32_t storm = 0; storm < certificate.storms; ++storm)
        certificate.within += isWithin(strengthOf(storm), box) ? 1 : 0;
    if (certificate.within == 0) return certificate;  // nothing tells that it holds
    for (double StormStrength::*const part : kParts)
        certificate.limits.*part = box.*part / (1 + kStormMargin);
    return certificate;
}

Result<Certificate> certify(const Groom& groom, CertificateOptions options) {
    options.first = 0;
    auto tally = runStorms(groom, options);
    if (!tally) return tl::unexpected(tally.error());
    return certificateOf({std::move(*tally)});
}

std::string inWords(const StormStrength& limits) {
    return fmt::format(
        "frames of {:.3g} ms, a head that moves at {:.3g} m/s and turns by {:.3g}° a frame, and wind of "
        "{:.3g} "
        "m/s",
        1000 * limits.step, limits.rootSpeed, limits.turn, limits.wind);
}

std::string inWords(const Certificate& certificate) {
    const StormStrength& limits = certificate.limits;
    const auto& failed = certificate.failed;
    const std::string first =
        failed.empty() ? "" : fmt::format(", storm {} first: {}", failed.front().number, failed.front().what);
    if (!(limits.step > 0))
        return fmt::format("Does not withstand any tested storm: {} of {} random storms failed{}.",
                           failed.size(), certificate.storms, first);
    return fmt::format(
        "Withstands {}, all at once and each with a margin of {:.0f} %. {} of {} random storms were within "
        "these limits and none of them failed. Beyond them, {} failed{}.",
        inWords(limits), 100 * kStormMargin, certificate.within, certificate.storms, failed.size(), first);
}

}  // namespace hairloom
