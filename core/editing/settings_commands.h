// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Commands that give a part of the document another value. They do nothing by themselves: Document::perform()
// carries them out. Each is null where the value is the one that is there, so that a slider that is put back
// leaves no step.

#include <memory>

#include "core/base/result.h"
#include "core/editing/command.h"
#include "core/groom/groom.h"

namespace hairloom::editing {

// `name` is for the history: "Wind speed", "Move sphere".
std::unique_ptr<Command> setMaterial(const Model& model, const HairMaterial& material,
                                     std::string name = "Look");
std::unique_ptr<Command> setPhysics(const Model& model, const runtime::SimulationSettings& settings,
                                    std::string name = "Physics");
std::unique_ptr<Command> setShadows(const Model& model, const ShadowSettings& settings, std::string name);
std::unique_ptr<Command> setInterpolation(const Model& model, const InterpolationSettings& settings,
                                          std::string name = "Follow hairs");
std::unique_ptr<Command> setPlacementSettings(const Model& model, const PlacementSettings& settings,
                                              std::string name = "Placement settings");
std::unique_ptr<Command> setSpheres(const Model& model, std::vector<CollisionSphere> spheres,
                                    std::string name);
/// The skin that hair collides with, baked from the groom's own head; null: none.
std::unique_ptr<Command> setBody(const Model& model, std::shared_ptr<const runtime::BodyField> body,
                                 std::string name);
/// What the painted masks are called, as Groom::maskNames has it. Errors: those of checkMaskNames().
Result<std::unique_ptr<Command>> setMaskNames(const Model& model, std::vector<std::string> names);
/// As many layers as there are or more, for strands name them by index.
std::unique_ptr<Command> setLayers(const Model& model, std::vector<Layer> layers);

/// Cards shaped by hand. Errors: more than kMaxCardEdits or kMaxCardRoots.
Result<std::unique_ptr<Command>> setCardEdits(const Model& model, std::vector<CardEdit> edits,
                                              std::string name);

/// The settings of the poses that there are, in their order. Errors: other names, a value out of its range.
Result<std::unique_ptr<Command>> setPoses(const Model& model, std::vector<GroomPose> poses,
                                          std::string name = "Pose");

/// Errors: what problemsOf() finds, the first one.
Result<std::unique_ptr<Command>> setTimeLine(const Model& model, TimeLine line, std::string name);

/// Of another groom all that the commands above set but the layers: what a preset or a field changes.
std::unique_ptr<Command> setSettings(const Model& model, const Groom& from, std::string name);

/// Another groom altogether: imported hair, the outcome of a script. It says which parts differ, and costs
/// what the two do not share. `record` as Command::record().
std::unique_ptr<Command> replaceGroom(const Model& model, Groom groom, std::string name,
                                      std::string record = {});

/// Roots that came or went have no triangles until somebody wants them, because making them takes longer than
/// a stroke may. Null where the groom has them, or no bound roots.
std::unique_ptr<Command> triangulate(const Model& model);

}  // namespace hairloom::editing
