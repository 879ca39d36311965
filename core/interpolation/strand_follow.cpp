// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/interpolation/strand_follow.h"

namespace hairloom {
namespace {

template <class To, class From>
std::span<const To> viewAs(const std::vector<From>& values) {
    static_assert(sizeof(To) == sizeof(From) && alignof(To) <= alignof(From));
    return {reinterpret_cast<const To*>(values.data()), values.size()};
}

}  // namespace

StrandFollow::StrandFollow(const Groom& groom, const FollowBindings& bindings)
    : pointsPerHair_(bindings.pointsPerHair),
      offsets_(groom.offsets.view().begin(), groom.offsets.view().end()),
      rest_(groom.positions().begin(), groom.positions().end()),
      rootFrames_(groom.strandCount(), Mat3f::Identity()),
      radii_(bindings.radii),
      wisps_(bindings.wisps),
      guides_(bindings.guides),
      weights_(bindings.weights),
      rootWeights_(bindings.rootWeights),
      rootShifts_(bindings.rootShifts),
      wispOffsets_(bindings.wispOffsets),
      blends_(bindings.blends) {
    for (std::size_t g = 0; g < bindings.guideCount(); ++g)
        rootFrames_[bindings.guideStrands[g]] = bindings.rootFrames[g];
    for (auto& guides : guides_) {
        for (std::uint32_t& guide : guides) guide = bindings.guideStrands[guide];
    }
}

runtime::FollowView StrandFollow::view() const {
    runtime::FollowView view;
    view.guideOffsets = offsets_;
    view.guideRestPositions_ss = viewAs<runtime::Float3>(rest_);
    view.rootPlanes_ss = viewAs<runtime::RootPlane>(rootFrames_);
    view.pointsPerHair = pointsPerHair_;
    view.radii = radii_;
    view.wisps = wisps_;
    view.guides = guides_;
    view.weights = viewAs<runtime::Float3>(weights_);
    view.rootWeights = viewAs<runtime::Float3>(rootWeights_);
    view.wispOffsets = viewAs<std::array<float, 2>>(wispOffsets_);
    view.blends = blends_;
    view.rootShifts = viewAs<runtime::Float3>(rootShifts_);
    return view;
}

}  // namespace hairloom
