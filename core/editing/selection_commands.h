// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Commands over strands and faces that somebody chose: select, hide, freeze, delete; the scalp. Null where
// nothing would change; Document::perform() carries them out.

#include <memory>
#include <span>
#include <string>

#include "core/editing/command.h"

namespace hairloom::editing {

enum class Choice { Replace, Add, Remove, Toggle };

/// `strands`, `faces`: ascending.
std::unique_ptr<Command> selectStrands(const Model& model, std::span<const std::uint32_t> strands,
                                       Choice choice);
/// Strands of a group of Groom::groupNames.
std::vector<std::uint32_t> strandsOfGroup(const Groom& groom, std::uint32_t group);
/// Strands with the attribute (selected, hidden, frozen) set.
std::vector<std::uint32_t> strandsWithFlag(const Groom& groom, std::string_view attribute);
std::vector<std::uint32_t> allStrands(const Groom& groom);

std::unique_ptr<Command> hideStrands(const Model& model, std::span<const std::uint32_t> strands);
/// Shows all.
std::unique_ptr<Command> showStrands(const Model& model);
std::unique_ptr<Command> freezeStrands(const Model& model, std::span<const std::uint32_t> strands,
                                       bool frozen);
std::unique_ptr<Command> deleteStrands(const Model& model, std::span<const std::uint32_t> strands);

/// `expression`: how the selection was made, as Groom::scalpExpression; may be empty.
std::unique_ptr<Command> selectScalp(const Model& model, const FaceSet& faces, Choice choice,
                                     std::string expression = {});
/// One value in [0, 1] for each vertex of the head.
std::unique_ptr<Command> setDensity(const Model& model, std::span<const float> density);
/// One value in [0, 1] for each strand: mask `number` of operators, from 1 to kPaintedMasks.
std::unique_ptr<Command> setMask(const Model& model, std::uint32_t number, std::span<const float> values);
/// One value in [0, kMostMelanin] for each strand; empty: strands have the melanin of their material.
std::unique_ptr<Command> setMelanin(const Model& model, std::span<const float> values);
/// One value in [0, runtime::kMostStiffness] for each strand; empty: strands have that of the settings.
std::unique_ptr<Command> setStiffness(const Model& model, std::span<const float> values);

}  // namespace hairloom::editing
