// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/stability/hard_case_run.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hairloom/stable.h"

namespace hairloom {
namespace {

using runtime::Float3;

constexpr double kRestSpeed = 0.005;     // m/s
constexpr double kNoEnergy = 1e-9;       // joules a point of 1 kg: below is rounding
constexpr double kMaxPenetration = 0.5;  // mm
constexpr std::uint32_t kMaxSubsteps = 64;
constexpr std::uint32_t kRodSubsteps = 2;
constexpr const char* kLengthsAfterBending =
    "lengths are fixed after bending has moved the points, and the two undo part of each other's work. Only "
    "position Verlet includes the tension of the lengths in bending";
/// What an integrator claims lies this far inside of its stable region: about ten steps to the period of the
/// fastest wave, where waves no longer resonate with the step (docs/stability.md).
constexpr double kMargin = 0.3;

/// Fewest substeps, from kSpringSubsteps on, within the integrator's stable region; kMaxSubsteps where none
/// are.
std::uint32_t substepsFor(const StrandSet& strands, runtime::SimulationSettings settings, float frame) {
    settings.substeps = runtime::kSpringSubsteps;
    while (settings.substeps < kMaxSubsteps &&
           runtime::stableRegion(strands.view(), settings, frame).factor > kMargin)
        ++settings.substeps;
    return settings.substeps;
}

}  // namespace

void HardCaseRun::start(StrandSet strands, runtime::SimulationSettings settings, float longestFrame) {
    strands_ = std::move(strands);
    settings.strandModel = method_.model;
    settings.integrator = method_.integrator;
    settings.substeps = method_.rods() ? kRodSubsteps : substepsFor(strands_, settings, longestFrame);
    const runtime::StableAdvice advice = runtime::adviseStability(strands_.view(), settings, longestFrame);
    // Whether hair comes to rest is what the cases measure.
    if (limit_.empty() && !advice.region.stable()) limit_ = advice.words;
    engine_ = another(settings);
    roots_ = strands_.roots();
    engine_->reset(roots_);
}

std::unique_ptr<HardCaseEngine> HardCaseRun::another(const runtime::SimulationSettings& settings) {
    HardCaseEngineResult made = options_.engines ? options_.engines(strands_.view(), settings)
                                                 : makeCpuHardCaseEngine(strands_.view(), settings);
    if (made.engine == nullptr) {
        expect("refused: " + made.error, "", 1.0, 0.0);
        strands_ = {};
        made = makeCpuHardCaseEngine({}, {});
    }
    return std::move(made.engine);
}

void HardCaseRun::change(const runtime::SimulationSettings& settings) {
    if (const std::string error = engine_->setSettings(settings); !error.empty())
        expect("refused: " + error, "", 1.0, 0.0);
}

void HardCaseRun::frame(float dt) {
    if (over()) return;
    time_ += static_cast<double>(dt);
    engine_->step({dt, time_, roots_, spheres_});
    substeps_ += substepsIn(settings(), dt);
    inspect();
}

void HardCaseRun::frames(int count, float dt) {
    for (int i = 0; i < count; ++i) frame(dt);
}

void HardCaseRun::shakeRoots() {
    for (int f = 1; f <= 60; ++f) {
        const float t = static_cast<float>(f) / 60.0f;
        moveRoots({0.03f * std::sin(4.0f * std::numbers::pi_v<float> * t), 0.0f, 0.0f});
        frame();
    }
}

void HardCaseRun::settle(double maximum) {
    sourceEnds();
    double moving = 0.0;
    const int frameCount = static_cast<int>(std::lround(1.2 * maximum / static_cast<double>(kFrame)));
    for (int f = 1; f <= frameCount && !over(); ++f) {
        frame();
        // Not "> kRestSpeed": what is no number does not rest.
        if (!(greatestSpeed() <= kRestSpeed)) moving = f * static_cast<double>(kFrame);
    }
    raise("time to rest", "s", over() ? std::nan("") : moving, maximum, holdsRest());
}

void HardCaseRun::inspect() {
    const runtime::Measurements m = engine_->measure();
    if (const std::string problem = engine_->problem(); !problem.empty()) expect(problem, "", 1.0, 0.0);
    const bool held = settings().lengthMethod == runtime::LengthMethod::constraint;
    const double stretch = held ? 0.01 : 0.48;
    const double broken =
        static_cast<double>(m.nanCount) + static_cast<double>(engine_->lastStep().restoredStrands);
    expect("points or strands lost", "", broken, 0.0);
    expect("stretch", "%", 100.0 * m.maxStretch, 100.0 * stretch);
    if (watchingSpheres_) expect("penetration", "mm", 1000.0 * m.maxPenetration, kMaxPenetration);
    const bool sound = broken == 0.0 && m.maxStretch <= stretch && std::isfinite(m.kineticEnergy);
    if (!sound && !failedAt_) failedAt_ = substeps_;
    const double energy = m.kineticEnergy / std::max<double>(engine_->pointCount(), 1.0);
    if (!sourceEnded_) {
        maxEnergy_ = std::max(maxEnergy_, energy);
    } else {
        raise("kinetic energy over its peak with a source", "",
              energy > kNoEnergy ? energy / std::max(maxEnergy_, kNoEnergy) : 0.0, 1.0, holdsRest());
    }
}

void HardCaseRun::expect(const std::string& what, const std::string& unit, double worst, double threshold) {
    raise(what, unit, worst, threshold, true);
}

void HardCaseRun::expectEnergy(const std::string& what, const std::string& unit, double worst,
                               double threshold) {
    raise(what, unit, worst, threshold, holdsRest());
}

bool HardCaseRun::holdsRest() const {
    return method_.rods() || method_.integrator == runtime::Integrator::verlet ||
           settings().lengthMethod != runtime::LengthMethod::constraint;
}

void HardCaseRun::raise(const std::string& what, const std::string& unit, double value, double threshold,
                        bool claimed) {
    const auto found = std::ranges::find(thresholds_, what, &StabilityThreshold::what);
    if (found == thresholds_.end()) {
        thresholds_.push_back({what, unit, value, threshold, claimed});
    } else if (!(value <= found->worst)) {
        if (!std::isnan(found->worst)) found->worst = value;
    }
}

std::vector<Float3> HardCaseRun::positions() const {
    std::vector<Float3> result(engine_->pointCount());
    engine_->readPositions(result);
    return result;
}

double HardCaseRun::greatestSpeed() const {
    std::vector<Float3> velocities(engine_->pointCount());
    engine_->readVelocities(velocities);
    double maximum = 0.0;
    for (const Float3& v : velocities) {
        const double speed = static_cast<double>(length(v));
        if (!(speed <= maximum)) maximum = speed;
    }
    return maximum;
}

StabilityResult HardCaseRun::result() const {
    StabilityResult result;
    result.integrator = method_.name();
    result.substeps = engine_ ? settings().substeps : 0;
    result.claimed = limit_.empty();
    result.thresholds = thresholds_;
    result.pass =
        !thresholds_.empty() && std::ranges::all_of(thresholds_, &StabilityThreshold::met) && !over();
    result.limit = limit_;
    const auto kept = [](const StabilityThreshold& m) { return m.met() || !m.claimed; };
    if (result.claimed && !result.pass && std::ranges::all_of(thresholds_, kept)) {
        result.claimed = false;
        result.limit = kLengthsAfterBending;
    }
    result.failedAt = failedAt_;
    return result;
}

}  // namespace hairloom
