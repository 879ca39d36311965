// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/base/parallel.h"
#include "core/groom/point_dye.h"
#include "core/groom/point_width.h"
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

/// Of a strand's points, at a share of its length in points.
float valueAt(std::span<const float> values, float share) {
    const float place = share * static_cast<float>(values.size() - 1);
    const std::size_t before = std::min(static_cast<std::size_t>(place), values.size() - 2);
    const float t = place - static_cast<float>(before);
    return values[before] + t * (values[before + 1] - values[before]);
}

}  // namespace

runtime::FollowView followView(const FollowBindings& bindings, std::span<const std::uint32_t> guideOffsets) {
    runtime::FollowView view;
    view.guideOffsets = guideOffsets;
    view.rootPlanes_ss = viewAs<runtime::RootPlane>(bindings.rootFrames);
    view.pointsPerHair = bindings.pointsPerHair;
    view.radii = bindings.radii;
    view.wisps = bindings.wisps;
    view.guides = bindings.guides;
    view.weights = viewAs<runtime::Float3>(bindings.weights);
    view.rootWeights = viewAs<runtime::Float3>(bindings.rootWeights);
    view.wispOffsets = viewAs<std::array<float, 2>>(bindings.wispOffsets);
    view.blends = bindings.blends;
    view.rootShifts = viewAs<runtime::Float3>(bindings.rootShifts);
    return view;
}

Status evaluateFollowHairs(const FollowBindings& bindings, const GuideState& state,
                           std::span<Vec3f> positions) {
    assert(positions.size() == bindings.hairCount() * bindings.pointsPerHair);
    assert(state.positions.size() == bindings.guideCount() * bindings.pointsPerHair);
    std::vector<std::uint32_t> offsets(bindings.guideCount() + 1);
    for (std::size_t guide = 0; guide < offsets.size(); ++guide) {
        offsets[guide] = static_cast<std::uint32_t>(guide * bindings.pointsPerHair);
    }
    auto made = runtime::FollowHairs::make(followView(bindings, offsets));
    if (!made.hairs) return tl::unexpected(errorOfWords(made.error));
    runtime::GuideMotion guides;
    guides.positions_ws = viewAs<runtime::Float3>(state.positions);
    guides.velocities_ws = viewAs<runtime::Float3>(state.velocities);
    guides.rootRotations_ws = viewAs<runtime::Quat>(state.rotations);
    runtime::Host host;
    host.parallelFor = parallelFor;
    made.hairs->evaluate(guides, {reinterpret_cast<runtime::Float3*>(positions.data()), positions.size()},
                         host);
    return {};
}

std::vector<float> followHairValues(const Groom& groom, const FollowBindings& bindings,
                                    std::span<const float> values) {
    assert(values.size() == groom.pointCount());
    const std::size_t perHair = bindings.pointsPerHair;
    std::vector<float> guides(bindings.guideCount() * perHair);
    for (std::size_t guide = 0; guide < bindings.guideCount(); ++guide) {
        const std::size_t first = groom.offsets[bindings.guideStrands[guide]];
        const std::size_t count = groom.offsets[bindings.guideStrands[guide] + 1] - first;
        for (std::size_t i = 0; i < perHair; ++i) {
            const float share = static_cast<float>(i) / static_cast<float>(perHair - 1);
            guides[guide * perHair + i] = valueAt(values.subspan(first, count), share);
        }
    }
    constexpr std::size_t kGrain = 256;
    std::vector<float> result(bindings.hairCount() * perHair);
    parallelFor(bindings.hairCount(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t hair = begin; hair < end; ++hair) {
            for (std::size_t i = 0; i < perHair; ++i) {
                float sum = 0;
                for (std::size_t k = 0; k < 3; ++k) {
                    const float weight = bindings.rootWeights[hair][static_cast<int>(k)];
                    sum += weight * guides[bindings.guides[hair][k] * perHair + i];
                }
                result[hair * perHair + i] = sum;
            }
        }
    });
    return result;
}

std::vector<float> followHairRootValues(const FollowBindings& bindings, std::span<const float> ofStrands) {
    if (ofStrands.empty()) return {};
    std::vector<float> values(bindings.hairCount());
    for (std::size_t hair = 0; hair < values.size(); ++hair) {
        std::array<float, 3> around{};
        for (std::size_t k = 0; k < 3; ++k) {
            around[k] = ofStrands[bindings.guideStrands[bindings.guides[hair][k]]];
            values[hair] += bindings.rootWeights[hair][static_cast<int>(k)] * around[k];
        }
        // NaN is a strand without a value, and has no mean.
        if (std::isnan(values[hair])) continue;
        // Weights sum up to 1 but for rounding, and limits are limits.
        const auto [least, most] = std::ranges::minmax(around);
        values[hair] = std::clamp(values[hair], least, most);
    }
    return values;
}

Result<Groom> bakeFollowHairs(const Groom& groom, const FollowBindings& bindings) {
    const std::size_t hairs = bindings.hairCount();
    const auto guides = guidePositions(groom, bindings);
    std::vector<Vec3f> positions(hairs * bindings.pointsPerHair);
    if (auto status = evaluateFollowHairs(bindings, {guides, {}, {}}, positions); !status) {
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
    if (const auto changes = widthChanges(groom); !changes.empty())
        baked.pointAttributes.set(attribute::kWidthChange, followHairValues(groom, bindings, changes));
    if (const auto painted = groom.pointAttributes.view<float>(attribute::kPointDye); !painted.empty()) {
        auto dyes = followHairValues(groom, bindings, painted);
        for (float& dye : dyes) dye = std::clamp(dye, 0.0f, 1.0f);
        baked.pointAttributes.set(attribute::kPointDye, std::move(dyes));
    }
    for (const std::string_view name : {attribute::kDye, attribute::kMelanin, attribute::kStiffness}) {
        auto values = followHairRootValues(bindings, groom.strandAttributes.view<float>(name));
        if (!values.empty()) baked.strandAttributes.set(name, std::move(values));
    }
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
