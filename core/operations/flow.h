// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/operations/strand_edit.h"

namespace hairloom {

/// Ranges stand in fieldsOf(). Directions add up: away from the crown, away from the parting, along the
/// sweep.
struct FlowSettings {
    Vec3f crown = Vec3f(0, 0, 0);  ///< metres; hair flows away from this point of the head
    float whorlDegrees = 0;        ///< turn of the flow near the crown
    float parting = 0;             ///< 0 … 1; share of the flow that leads away from the parting plane
    Vec3f partingPoint = Vec3f::Zero();  ///< metres; the middle of the parting
    Vec3f partingNormal =
        Vec3f(1, 0, 0);           ///< of the parting plane; each strand flows to the side of its root
    float partingReach = 0.15f;   ///< metres from the middle at which the parting's share has fallen to 1/e
    Vec3f sweep = Vec3f::Zero();  ///< direction that is added; its length is its weight
    float gravity = 0.5f;         ///< 0 … 1; share of straight down at the tip
    float fall = 0.8f;            ///< 0 … 1; share of straight down where the skin is steep
    float liftRoot = 0.012f;      ///< metres over the skin that hair near its root rises to
    float liftTip = 0.006f;       ///< metres over the skin at the tip
    float rise = 0.03f;           ///< metres of hair over which it rises
    float bend = 0.012f;          ///< metres of hair over which it turns into the flow; larger is rounder
    float variation = 0.5f;       ///< 0 … 1; random share by which the lift of a strand may be lower
    float clearance = 0.0015f;    ///< metres kept from the skin
    std::uint64_t seed = 1;
};
std::span<const Field<FlowSettings>> fieldsOf(const FlowSettings&);

/// Combs by a field: each strand is laid anew from its root along the scalp and falls free where the head
/// curves away beneath it. Lengths are kept. Returns the number of strands touched. Error: no scalp.
Result<std::size_t> flow(Groom& groom, const FlowSettings& settings, const Region& region = {});

}  // namespace hairloom
