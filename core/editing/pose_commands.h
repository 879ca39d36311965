// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Commands that give the document poses, or take them away. setPoses() changes their settings.

#include <memory>
#include <span>
#include <string>

#include "core/editing/command.h"

namespace hairloom::editing {

/// One more pose, or another shape of the pose of that name: `positions_ss` of all points, metres, in the
/// scalp's rest space. Null where that is its shape. Errors: as hairloom::putPose().
Result<std::unique_ptr<Command>> putPose(const Model& model, const std::string& name,
                                         std::span<const Vec3f> positions_ss);
/// The same of the shape that the strands have now.
Result<std::unique_ptr<Command>> poseOfShape(const Model& model, const std::string& name);
/// The shape of a groom of the same strands. Errors: as hairloom::putPoseOf().
Result<std::unique_ptr<Command>> putPoseOf(const Model& model, const std::string& name, const Groom& other);
/// Errors: as hairloom::swapPose().
Result<std::unique_ptr<Command>> swapPose(const Model& model, const std::string& name);
/// With its shape; its keys stay, for a pose of that name. Error: there is none.
Result<std::unique_ptr<Command>> removePose(const Model& model, const std::string& name);
/// With its keys. Null where the names are the same. Errors: there is none, a name that is none or is taken.
Result<std::unique_ptr<Command>> renamePose(const Model& model, const std::string& from,
                                            const std::string& to);

}  // namespace hairloom::editing
