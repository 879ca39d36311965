// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// fieldsOf() describes the members. Directions add up: away from the crown, away from the parting, along the
/// sweep.
struct FlowSettings {
    Vec3f crown = Vec3f::Zero();  ///< zero: crownOfHead()
    float whorlDegrees = 0;
    float parting = 0;
    Vec3f partingPoint = Vec3f::Zero();  ///< zero: topOfHead()
    Vec3f partingNormal = Vec3f(1, 0, 0);
    float partingReach = 0.15f;
    Vec3f sweep = Vec3f::Zero();
    float gravity = 0.5f;
    float fall = 0.8f;
    float liftRoot = 0.006f;
    float liftTip = 0.016f;
    float rise = 0.03f;
    float bend = 0.012f;
    float variation = 0.5f;
    float clearance = 0.0015f;
    std::uint64_t seed = 1;
};
std::span<const Field<FlowSettings>> fieldsOf(const FlowSettings&);

/// Combs by a field: each strand is laid anew from its root along the scalp and falls free where the head
/// curves away beneath it. Lengths are kept. Returns the number of strands touched. Error: no scalp.
Result<std::size_t> flow(Groom& groom, const FlowSettings& settings, const Region& region = {});

}  // namespace hairloom
