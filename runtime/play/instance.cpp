// SPDX-License-Identifier: MIT
#include "play/instance.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/body_table.h"
#include "engine/moving_body.h"
#include "engine/state.h"
#include "engine/strand_model.h"
#include "follow/follow_kernels.h"
#include "hairloom/body_spheres.h"
#include "hairloom/capsules.h"
#include "play/frame_values.h"

namespace hairloom::runtime {
namespace {

/// `usual` where the asset has none, or one out of range.
float numberWithin(const Asset& asset, std::string_view name, double min, double max, double usual) {
    const double value = asset.numberOf(name, usual);
    return static_cast<float>(value >= min && value <= max ? value : usual);
}

/// Radii at root and tip that a group of settings says, or `usual`.
std::array<float, 2> radiiOf(const Asset& asset, const String& group, std::array<float, 2> usual) {
    const double root{usual[0]}, tip{usual[1]};
    const float radius = numberWithin(asset, group + ".rootRadius", 5e-6, 0.05, root);
    return {radius, radius * numberWithin(asset, group + ".tipScale", 0, 1, tip / root)};
}

std::size_t bytesOf(const Engine& engine) {
    std::size_t bytes = engine.baseBytes();
    for (std::uint32_t effect = 0; effect < kEffectCount; ++effect)
        bytes += engine.effectBytes(static_cast<Effect>(effect));
    return bytes + bytesOfPoses(engine);
}

}  // namespace

Instance::Result Instance::make(const Asset& asset, bool wantsHairs, bool wantsLevels, Host host) {
    Asset::Strands strands = asset.strandsAtRest();
    Engine::Result made = Engine::make(
        {strands.offsets, strands.positions_ss, {}, {}, asset.strandStiffness()}, asset.simulation(), host);
    if (!made.engine) return {std::nullopt, std::move(made.error)};
    Instance instance(std::move(*made.engine), RootPoses(asset, strands), std::move(host));
    instance.asset_ = numberOf(asset);
    instance.gpuHairs_ = static_cast<std::uint32_t>(asset.hairCount());
    if (instance.gpuHairs_ > 0) instance.gpuPoints_ = asset.recipe[0].pointsPerHair;
    instance.gpuWisps_ = asset.wispMotion();
    const Map<std::uint32_t, std::size_t> strandsOf = strandsByPoints(asset);
    instance.gpuBlocks_ = gpuBlocksOf(strandsOf);
    instance.gpuLongest_ = strandsOf.empty() ? 0 : strandsOf.rbegin()->first;
    const Float3 low = asset.boundsMin_ss(), high = asset.boundsMax_ss();
    instance.pivot_ = {0, 0.5f * (low.y + high.y), 0.5f * (low.z + high.z)};
    instance.roots_.resize(asset.strands.size());
    instance.turns_.resize(asset.strands.size());
    instance.restSpheres_.assign(asset.spheres.begin(), asset.spheres.end());
    instance.spheres_.resize(asset.spheres.size());
    for (const asset::Sphere& sphere : asset.spheres) {
        if (sphere.joined > 0)
            instance.restCapsules_.push_back(
                {static_cast<std::uint32_t>(&sphere - asset.spheres.data()), sphere.joined - 1});
    }
    instance.last_.bones.reserve(12 * asset.bones.size());
    instance.positions_.resize(strands.positions_ss.size());
    for (const std::uint16_t radius : asset.radii)
        instance.radii_.own.push_back(static_cast<float>(radius) * asset::kRadiusStep);
    const std::array<float, 2> usual = radiiOf(asset, "material", {4e-5f, 1.6e-5f});
    instance.radii_.root = usual[0];
    instance.radii_.tip = usual[1];
    // Levels choose among hairs that a GPU makes, too.
    if ((wantsHairs || wantsLevels) && asset.hairCount() > 0) {
        instance.hairGroups_.push_back(0);
        for (std::size_t guide = 0; guide < asset.guides.size(); ++guide)
            instance.hairGroups_.push_back(instance.hairGroups_.back() + asset.hairsOf(guide));
    }
    if (wantsHairs && asset.hairCount() > 0) {
        FollowHairs::Result hairs = asset.followHairs(strands, instance.host_);
        if (!hairs.hairs) return {std::nullopt, std::move(hairs.error)};
        instance.hairs_ = std::move(hairs.hairs);
        if (hasMaterials(asset)) {
            for (const asset::Guide& guide : asset.guides) {
                const std::uint32_t layer = asset.layerOf(guide.strand);
                const bool own = asset.layers[layer].ownMaterial != 0;
                instance.radii_.ofHairs.push_back(own ? radiiOf(asset, layerGroup(layer), usual) : usual);
            }
        }
        instance.velocities_.resize(instance.positions_.size());
    }
    instance.poses_.followHead(kIdentity34, instance.roots_);
    instance.engine_.reset(instance.roots_);
    instance.offsets_ = strands.offsets;
    if (BodyFieldRead body = asset.readBody(); body.field) {
        instance.bodyBones_ = asset.bonesOf(*body.field);
        instance.body_ = makeShared<const BodyField>(std::move(*body.field));
        instance.bodyPose_.resize(std::max<std::size_t>(instance.bodyBones_.size(), 1));
        instance.engine_.setBody(instance.body_);
        Vector<Sphere> spheres_ss;
        for (const asset::Sphere& sphere : asset.spheres)
            spheres_ss.push_back({{sphere.centre[0], sphere.centre[1], sphere.centre[2]}, sphere.radius});
        instance.skinSpheres_ = spheresOfSkin(*instance.body_, spheres_ss, instance.restCapsules_);
        instance.engine_.setSkinSpheres(instance.skinSpheres_);
    }
    if (wantsLevels) instance.makeLevels(asset, strands);
    if (std::string problem = instance.makePoses(asset, strands); !problem.empty())
        return {std::nullopt, std::move(problem)};
    return {std::move(instance), {}};
}

/// Of its strands: clips of assets with others are refused.
std::uint64_t Instance::numberOf(const Asset& asset) {
    return std::uint64_t{asset::checksum(std::as_bytes(asset.strands))} << 32u |
           asset::checksum(asset.residuals);
}

Outcome Instance::reset(const hl_frame& frame) {
    FrameInput input;
    if (Outcome refused = place(withoutInner(frame), input)) return refused;
    leaveGpu();
    played_ = playedWaits_ = false;
    engine_.reset(roots_);
    takeTurns();
    asleep_ = false;
    if (levels_) resetLevel();
    takeOrigin(frame);
    ++changes_;
    for (Shown& shown : shown_) shown.state = 0;
    return std::nullopt;
}

/// One that is no place stays where it was.
void Instance::takeOrigin(const hl_frame& frame) {
    const auto finite = [](double axis) { return std::isfinite(axis); };
    if (std::all_of(frame.origin, frame.origin + 3, finite)) std::copy_n(frame.origin, 3, origin_.begin());
}

/// Roots that are no numbers stay where they were, and so does what is turned with them.
void Instance::takeTurns() {
    for (std::size_t s = 0; s < roots_.size(); ++s) {
        Quat rotation = roots_[s].rotation;
        if (isFinite(roots_[s].position) && normalize(rotation)) turns_[s] = roots_[s].rotation;
    }
}

Outcome Instance::checkStep(const hl_frame& frame) {
    // Speeds of a shorter step are no numbers any more.
    if (frame.dt >= 1e-6f && std::isfinite(frame.dt)) return std::nullopt;
    return Refusal{HL_BAD_VALUE, "dt is " + std::to_string(frame.dt) + "; expected 0, or 0.000001 s or more"};
}

Outcome Instance::step(const hl_frame& frame) {
    if (frame.dt == 0) return std::nullopt;
    if (Outcome refused = checkStep(frame)) return refused;
    if (Outcome refused = checkInner(frame)) return refused;
    // Nothing wakes it: a step would leave every bit as it is.
    if (asleep_ && asBefore(frame) && innerAsBefore(frame)) return std::nullopt;
    settlePlayed();
    FrameInput input;
    if (Outcome refused = place(frame, input)) return refused;
    played_ = false;
    leaveGpu();
    takeTurns();
    // A game's own spheres are what it says.
    const auto ofSkin = frame.spheres ? std::span<const std::uint8_t>() : std::span(skinSpheres_);
    if (Engine* const engine = engineOfLevel()) engine->setSkinSpheres(ofSkin);
    input.poseAmounts = hairPoses_.amounts;
    if (levels_)
        stepLevel(input);
    else
        engine_.step(input);
    remember(frame);
    takeOrigin(frame);
    ++changes_;
    const Engine* const engine = engineOfLevel();
    asleep_ = !(levels_ && levels_->fading) && (!engine || engine->asleep() == engine->strandCount());
    return std::nullopt;
}

bool Instance::asBefore(const hl_frame& frame) const {
    const auto same = [](const float* given, const auto& known) {
        return std::memcmp(given, known.data(), known.size() * sizeof(float)) == 0;
    };
    return last_.known && !frame.roots && !frame.scalp && !frame.spheres && frame.dt == last_.dt &&
           std::equal(last_.origin.begin(), last_.origin.end(), frame.origin) &&
           same(frame.head ? frame.head : kIdentity34.data(), last_.head) &&
           (frame.wind != nullptr) == last_.hasWind && (!frame.wind || same(frame.wind, last_.wind)) &&
           (frame.bones ? frame.bone_count : 0) * 12 == last_.bones.size() &&
           (!frame.bones || same(frame.bones, last_.bones));
}

void Instance::remember(const hl_frame& frame) {
    last_.known = !frame.roots && !frame.scalp && !frame.spheres;
    if (!last_.known) return;
    last_.dt = frame.dt;
    std::copy_n(frame.origin, 3, last_.origin.begin());
    last_.head = frame.head ? matrixAt(frame.head, 0) : kIdentity34;
    last_.hasWind = frame.wind != nullptr;
    if (frame.wind) std::copy_n(frame.wind, 3, last_.wind.begin());
    last_.bones.assign(frame.bones, frame.bones ? frame.bones + 12 * frame.bone_count : frame.bones);
}

Outcome Instance::set(std::string_view name, std::span<const double> values) {
    const auto* field = findField<SimulationSettings>(name);
    const auto refuse = [&](const std::string& why) {
        return Refusal{HL_BAD_VALUE, "setting '" + std::string(name) + "' " + why};
    };
    if (!field) return refuse("does not exist");
    if (field->kind == FieldKind::Ramp) return refuse("is a curve");
    if (values.size() != field->components())
        return wrongSize("values of '" + std::string(name) + "'", values.size(), field->components());
    SimulationSettings settings = engine_.settings();
    for (std::uint32_t c = 0; c < values.size(); ++c) {
        if (!setFieldValue(settings, *field, values[c], c))
            return refuse("is " + std::to_string(values[c]) + "; expected " + std::to_string(field->min) +
                          " to " + std::to_string(field->max));
    }
    if (settings == engine_.settings()) return std::nullopt;
    // In copies of what changes: where memory ends in the middle, all is as it was.
    Engine finest(engine_);
    Vector<Engine> coarser;
    if (levels_) coarser = levels_->engines;
    if (playedWaits_) finest.place(roots_, positions_, velocities_, origin_);
    if (const std::string why = finest.setSettings(settings); !why.empty()) return Refusal{HL_BAD_VALUE, why};
    if (levels_) setSettingsOfLevels(settings, coarser);
    engine_ = std::move(finest);
    if (levels_) levels_->engines = std::move(coarser);
    leaveGpu();
    playedWaits_ = asleep_ = hairPoses_.isStanding = hairPoses_.isReserved = false;
    return std::nullopt;
}

Outcome Instance::choose(std::string_view name, std::string_view choice) {
    const auto refuse = [&](const std::string& why) {
        return Refusal{HL_BAD_VALUE, "setting '" + std::string(name) + "' " + why};
    };
    const auto* const field = findField<SimulationSettings>(name);
    if (!field) return refuse("does not exist");
    if (field->kind != FieldKind::Choice) return refuse("is no choice");
    std::string known;
    for (std::size_t c = 0; c < field->choices.size(); ++c) {
        const double number = static_cast<double>(c);
        if (field->choices[c] == choice) return set(name, {&number, 1});
        known += (known.empty() ? "" : ", ") + std::string(field->choices[c]);
    }
    return refuse("is '" + std::string(choice) + "'; expected one of " + known);
}

Outcome Instance::readOffsets(std::span<std::uint32_t> offsets) const {
    if (offsets.size() != offsets_.size()) return wrongSize("offsets", offsets.size(), offsets_.size());
    std::copy(offsets_.begin(), offsets_.end(), offsets.begin());
    return std::nullopt;
}

hl_instance_info Instance::describe() const {
    hl_instance_info info{};
    info.guides = static_cast<std::uint32_t>(roots_.size());
    info.guide_points = static_cast<std::uint32_t>(positions_.size());
    info.hairs = hairsRead();
    info.points_per_hair = hairs_ ? hairs_->pointsPerHair() : 0;
    const Engine* const engine = engineOfLevel();
    const StepReport report = engine && !played_ ? engine->lastStep() : StepReport{};
    // At a coarser level the guides that are not simulated sleep when the others do.
    info.asleep = asleep_ ? info.guides : engine && !played_ ? engine->asleep() : 0;
    info.restored = report.restoredStrands;
    info.left_roots = report.rejectedRoots;
    info.left_spheres = report.rejectedSpheres;
    info.bytes = sizeof(Instance) + bytesOf(engine_) + poses_.bytes() + (hairs_ ? hairs_->bytes() : 0) +
                 ownBytes(roots_.size(), positions_.size(), hairs_ || !levels_ ? velocities_.size() : 0) +
                 hairGroups_.size() * sizeof(std::uint32_t) + radii_.ofHairs.size() * 2 * sizeof(float) +
                 radii_.own.size() * sizeof(float) + restSpheres_.size() * sizeof(asset::Sphere) +
                 restCapsules_.size() * sizeof(Capsule) + (body_ ? body_->bytes() : 0) +
                 spheres_.size() * sizeof(Sphere) + skinSpheres_.size() + bytesOfLevels() +
                 (shown_[0].positions.size() + shown_[1].positions.size()) * sizeof(Float3) +
                 allStrands_.size() * sizeof(std::uint32_t) + rootsBefore_.size() * sizeof(Float3) +
                 (clip_ ? clip_->bytes() : 0) + inner_.bytes() + hairPoses_.amounts.size() * sizeof(float) +
                 (hairPoses_.all.size() + hairPoses_.simulated.size()) * sizeof(Float3);
    return info;
}

void Instance::setClock(const std::function<std::uint64_t()>& nanoseconds) {
    engine_.setClock(nanoseconds);
    if (!levels_) return;
    for (Engine& engine : levels_->engines) engine.setClock(nanoseconds);
}

hl_effect Instance::describeEffect(std::uint32_t number) const {
    hl_effect effect{};
    const bool strands = number == kEffectCount;
    effect.name = strands ? "strands" : kEffects[number].name;
    const Engine* const engine = engineOfLevel();
    std::string why;
    if (!engine || asleep_ || played_) {
        why = std::string(effect.name) + (asleep_   ? ": off, all strands at rest"
                                          : played_ ? ": off, a clip plays"
                                                    : ": off, hair is rigid");
    } else {
        effect.on = strands || engine->plan().on(static_cast<Effect>(number));
        why = strands ? "strands: on, of every strand" : engine->plan().why(static_cast<Effect>(number));
        const StepReport& report = engine->lastStep();
        for (std::uint32_t stage = 0; stage < kStageCount; ++stage) {
            const auto of = kStages[stage].effect;
            if (strands ? !of : of == static_cast<Effect>(number))
                effect.milliseconds += static_cast<float>(report.stageMilliseconds[stage]);
        }
    }
    why.resize(std::min(why.size(), sizeof effect.why - 1));
    std::memcpy(effect.why, why.c_str(), why.size() + 1);
    return effect;
}

}  // namespace hairloom::runtime
