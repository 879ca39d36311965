// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Commands over collision spheres. Indices are those of Groom::spheres and exist. Null where nothing would
// change; Document::perform() carries them out.

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/editing/command.h"
#include "core/editing/view.h"
#include "core/geometry/scalp_mesh.h"

namespace hairloom::editing {

inline constexpr float kSmallestSphere = 0.001f;  ///< metres, radius
inline constexpr float kLargestSphere = 10.0f;

/// A sphere under a place of the head, so that it touches the skin there from inside. `radius` in metres is
/// held to the bounds above.
std::unique_ptr<Command> placeSphere(const Model& model, const SurfacePoint& place, float radius,
                                     std::string bone = {});
std::unique_ptr<Command> moveSphere(const Model& model, std::size_t index, const Vec3f& centre_ss);
std::unique_ptr<Command> resizeSphere(const Model& model, std::size_t index, float radius);
/// An empty bone fixes it to the head as a whole.
std::unique_ptr<Command> attachSphere(const Model& model, std::size_t index, std::string bone);
std::unique_ptr<Command> renameSphere(const Model& model, std::size_t index, std::string name);
std::unique_ptr<Command> removeSphere(const Model& model, std::size_t index);
/// Makes a tapered capsule with sphere `other`; −1 or itself makes none any more.
std::unique_ptr<Command> joinSphere(const Model& model, std::size_t index, std::int32_t other);
/// Adds the mirror image in the plane, and that of the sphere that it is joined to, unless that lies on the
/// plane; a name or bone that ends in a side ("_L", ".l", "Left" …) gets the other.
std::unique_ptr<Command> mirrorSphere(const Model& model, std::size_t index,
                                      const Vec3f& planePoint = Vec3f::Zero(),
                                      const Vec3f& planeNormal = Vec3f::UnitX());
/// "arm_L" → "arm_R", "LeftArm" → "RightArm"; others as they are.
std::string otherSide(const std::string& name);

/// The sphere under the cursor, nearest first.
std::optional<std::size_t> pickSphere(std::span<const CollisionSphere> spheres, const View& view,
                                      const Vec2f& px);

}  // namespace hairloom::editing
