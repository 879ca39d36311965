// SPDX-License-Identifier: GPL-3.0-or-later
#include <cassert>

#include "core/base/parallel.h"
#include "core/groom/strand_subset.h"
#include "core/interpolation/follow_hairs.h"

namespace hairloom {
namespace {

/// The engine's view of an array whose elements are laid out alike.
template <class To, class From>
std::span<const To> viewAs(std::span<const From> values) {
    static_assert(sizeof(To) == sizeof(From) && alignof(To) <= alignof(From));
    return {reinterpret_cast<const To*>(values.data()), values.size()};
}

template <class To, class From>
std::span<const To> viewAs(const std::vector<From>& values) {
    return viewAs<To>(std::span(values));
}

}  // namespace

runtime::FollowView followView(const FollowBindings& bindings, std::span<const std::uint32_t> guideOffsets) {
    runtime::FollowView view;
    view.guideOffsets = guideOffsets;
    view.rootPlanes_ss = viewAs<runtime::RootPlane>(bindings.rootFrames);
    view.pointsPerHair = bindings.pointsPerHair;
    view.radii = bindings.radii;
    view.guides = bindings.guides;
    view.weights = viewAs<runtime::Float3>(bindings.weights);
    view.rootWeights = viewAs<runtime::Float3>(bindings.rootWeights);
    view.wispOffsets = viewAs<std::array<float, 2>>(bindings.wispOffsets);
    view.blends = bindings.blends;
    view.rootShifts = viewAs<runtime::Float3>(bindings.rootShifts);
    return view;
}

Status evaluateFollowHairs(const FollowBindings& bindings, const GuideState& state, const WispMotion& motion,
                           std::span<Vec3f> positions) {
    assert(positions.size() == bindings.hairCount() * bindings.pointsPerHair);
    assert(state.positions.size() == bindings.guideCount() * bindings.pointsPerHair);
    std::vector<std::uint32_t> offsets(bindings.guideCount() + 1);
    for (std::size_t guide = 0; guide < offsets.size(); ++guide) {
        offsets[guide] = static_cast<std::uint32_t>(guide * bindings.pointsPerHair);
    }
    auto made = runtime::FollowHairs::make(followView(bindings, offsets));
    if (!made.hairs) return fail(made.error);
    runtime::GuideMotion guides;
    guides.positions_ws = viewAs<runtime::Float3>(state.positions);
    guides.velocities_ws = viewAs<runtime::Float3>(state.velocities);
    guides.rootRotations_ws = viewAs<runtime::Quat>(state.rotations);
    guides.wispSpread = motion.spread;
    runtime::Host host;
    host.parallelFor = parallelFor;
    made.hairs->evaluate(guides, {reinterpret_cast<runtime::Float3*>(positions.data()), positions.size()},
                         host);
    return {};
}

Result<Groom> bakeFollowHairs(const Groom& groom, const FollowBindings& bindings) {
    const std::size_t hairs = bindings.hairCount();
    const auto guides = guidePositions(groom, bindings);
    std::vector<Vec3f> positions(hairs * bindings.pointsPerHair);
    if (auto status = evaluateFollowHairs(bindings, {guides, {}, {}}, {}, positions); !status) {
        return tl::unexpected(status.error());
    }
    std::vector<std::uint32_t> offsets(hairs + 1);
    for (std::size_t hair = 0; hair <= hairs; ++hair) {
        offsets[hair] = static_cast<std::uint32_t>(hair * bindings.pointsPerHair);
    }
    Groom baked = makeGroom(std::move(offsets), std::move(positions));
    baked.material = groom.material;
    baked.scalp = groom.scalp;
    baked.scalpSelection = groom.scalpSelection;
    baked.scalpExpression = groom.scalpExpression;
    baked.characterFile = groom.characterFile;
    if (!bindings.roots.empty()) baked.setRootBindings(bindings.roots);
    baked.layers = groom.layers;
    if (groom.layers.size() > 1) {
        const std::vector<std::uint32_t> ofStrands = layersOfStrands(groom);
        std::vector<std::uint32_t> layers(hairs);
        for (std::size_t hair = 0; hair < hairs; ++hair)
            layers[hair] = ofStrands[bindings.guideStrands[bindings.guides[hair][0]]];
        baked.strandAttributes.set(attribute::kLayer, std::move(layers));
    }
    return baked;
}

}  // namespace hairloom
