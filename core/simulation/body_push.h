// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair that is drawn stays out of the groom's body (hairloom/body_push.h).

#include <optional>
#include <span>

#include "core/simulation/motion.h"
#include "hairloom/body_push.h"

namespace hairloom {

/// Of hairs at rest, points in the scalp's rest space; none where the groom has no body.
std::optional<runtime::BodyPush> makeBodyPush(const Groom& groom, std::span<const std::uint32_t> offsets,
                                              std::span<const Vec3f> rest_ss);

/// `points_ws` are of the same hairs in the pose. Nothing where the pose does not tell where the body is.
void pushOutOfBody(const runtime::BodyPush& push, const Groom& groom, const HeadPose& pose,
                   std::span<Vec3f> points_ws);

}  // namespace hairloom
