// SPDX-License-Identifier: MIT
// Poses of an instance: other shapes of its hair, which it follows by amounts that the game sets.

#include <algorithm>

#include "engine/poses.h"
#include "play/instance.h"

namespace hairloom::runtime {
namespace {

/// The pose of a level's guides, which have fewer points.
Asset::PoseArrays sampled(const Asset::PoseArrays& pose, std::span<const std::uint32_t> offsets,
                          const Level& level) {
    Asset::PoseArrays fewer;
    for (std::size_t s = 0; s < level.guides.size(); ++s) {
        const std::size_t first = offsets[level.guides[s]], count = offsets[level.guides[s] + 1] - first;
        const std::size_t points = level.offsets[s + 1] - level.offsets[s];
        const auto positions = std::span(pose.positions_ss).subspan(first, count);
        for (std::size_t p = 0; p < points; ++p) fewer.positions_ss.push_back(sampleAt(positions, p, points));
        if (pose.weights.empty()) continue;
        const auto weights = std::span(pose.weights).subspan(first, count);
        for (std::size_t p = 0; p < points; ++p) fewer.weights.push_back(sampleAt(weights, p, points));
    }
    return fewer;
}

std::string givePoses(std::span<const Asset::PoseArrays> poses, Engine& engine) {
    Vector<PoseView> views;
    for (const Asset::PoseArrays& pose : poses) views.push_back({pose.positions_ss, pose.weights});
    return engine.setPoses(views);
}

bool isAnyAbove0(std::span<const float> amounts) {
    return std::any_of(amounts.begin(), amounts.end(), [](float amount) { return amount > 0; });
}

}  // namespace

/// With the authored amounts. Empty, or why there are none.
std::string Instance::makePoses(const Asset& asset, const Asset::Strands& strands) {
    if (asset.poses().empty()) return {};
    Vector<Asset::PoseArrays> poses;
    for (std::size_t k = 0; k < asset.poses().size(); ++k) poses.push_back(asset.poseArrays(k, strands));
    if (std::string problem = givePoses(poses, engine_); !problem.empty()) return problem;
    for (std::size_t i = 0; levels_ && i < levels_->engines.size(); ++i) {
        Vector<Asset::PoseArrays> fewer;
        for (const Asset::PoseArrays& pose : poses)
            fewer.push_back(sampled(pose, offsets_, levels_->set->coarser[i]));
        if (std::string problem = givePoses(fewer, levels_->engines[i]); !problem.empty()) return problem;
    }
    for (const asset::Pose& pose : asset.poses()) hairPoses_.amounts.push_back(pose.amount);
    if (levels_) {
        hairPoses_.all.resize(positions_.size());
        hairPoses_.simulated.resize(levels_->simulated.size());
    }
    giveAmounts(hairPoses_.amounts, engine_, levels_ ? std::span(levels_->engines) : std::span<Engine>());
    return {};
}

void Instance::giveAmounts(std::span<const float> amounts, Engine& finest, std::span<Engine> coarser) {
    finest.setPoseAmounts(amounts);
    for (Engine& engine : coarser) engine.setPoseAmounts(amounts);
}

Outcome Instance::checkPose(std::uint32_t pose) const {
    if (pose < hairPoses_.amounts.size()) return std::nullopt;
    return Refusal{HL_BAD_VALUE,
                   "pose " + std::to_string(pose) + " of " + std::to_string(hairPoses_.amounts.size())};
}

Outcome Instance::setPose(std::uint32_t pose, float amount) {
    if (Outcome refused = checkPose(pose)) return refused;
    if (!(amount >= 0 && amount <= 1))
        return Refusal{HL_BAD_VALUE, "a pose's amount is " + std::to_string(amount) + "; expected 0 to 1"};
    Vector<float>& amounts = hairPoses_.amounts;
    if (amounts[pose] == amount) return std::nullopt;
    std::array<float, kMaxPoses> next{};
    std::copy(amounts.begin(), amounts.end(), next.begin());
    next[pose] = amount;
    takeAmounts(std::span<const float>(next).first(amounts.size()));
    return std::nullopt;
}

/// Engines take amounts with their steps, but for memory, which comes and goes with the first and the last.
void Instance::takeAmounts(std::span<const float> amounts) {
    const bool on = isAnyAbove0(amounts);
    if (on != isPosed()) {
        if (on && !hairPoses_.isReserved) {
            // In copies of what changes: where memory ends in the middle, all is as it was.
            Engine finest(engine_);
            Vector<Engine> coarser;
            if (levels_) coarser = levels_->engines;
            giveAmounts(amounts, finest, coarser);
            engine_ = std::move(finest);
            if (levels_) levels_->engines = std::move(coarser);
        } else {
            giveAmounts(amounts, engine_, levels_ ? std::span(levels_->engines) : std::span<Engine>());
        }
    }
    std::copy(amounts.begin(), amounts.end(), hairPoses_.amounts.begin());
    hairPoses_.isStanding = asleep_ = last_.known = false;
    // What is not simulated stands there at once.
    if (level() != HL_LEVEL_FINEST) ++changes_;
}

bool Instance::isPosed() const {
    return isAnyAbove0(hairPoses_.amounts);
}

/// Of the level. Hair that it does not simulate stands there at once.
Standing Instance::standing() {
    if (!isPosed() || engine_.settings().strandModel != StrandModel::rods) return {levels_->set->rest, {}};
    const Engine* const engine = engineOfLevel();
    const auto simulated = std::span<Float3>(hairPoses_.simulated).first(engine ? engine->pointCount() : 0);
    if (!hairPoses_.isStanding) {
        const std::uint32_t clamped = engine_.settings().clampedPoints;
        standInPoses(*engine_.restShape(), *engine_.poses(), hairPoses_.amounts, clamped, hairPoses_.all);
        if (engine)
            standInPoses(*engine->restShape(), *engine->poses(), hairPoses_.amounts, clamped, simulated);
    }
    hairPoses_.isStanding = true;
    return {hairPoses_.all, simulated};
}

std::size_t bytesOfPoses(const Engine& engine) {
    const auto poses = engine.poses();
    return poses ? sizeof(PoseSet) + poses->planes.size() * sizeof(float) : 0;
}

}  // namespace hairloom::runtime
