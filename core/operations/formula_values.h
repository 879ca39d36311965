// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Formulas on the strands of a groom: what their names stand for there.

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/groom/file/json_reader.h"
#include "core/operations/formula.h"
#include "core/operations/painted_maps.h"

namespace hairloom {

/// The maps that a formula names.
std::vector<MaskMap> mapsOf(const Formula& formula);

/// Multiplies each point's share by the formula there, held to 0 … 1. `positions` has a place for each point
/// of the groom. Errors: no number; u or v where there are no UVs; density where hair is bound to no scalp.
Status multiplyByFormula(const Groom& groom, const Formula& formula, std::span<const Vec3f> positions,
                         std::vector<float>& shares);

/// The formula at these strands, which have two points or more; entries of others are 0. A map along the
/// strand is read at the root. Errors: as above, and t, which no value of a whole strand has.
Result<std::vector<float>> formulaOfStrands(const Groom& groom, const Formula& formula,
                                            std::span<const std::uint32_t> strands);

/// Formulas of an operation's settings, by the names of their fields.
using SettingFormulas = std::map<std::string, std::string, std::less<>>;
/// The member "formulas", empty where it is absent. Complaints are the reader's: a field that takes none, a
/// formula that does not read or names t.
SettingFormulas readFormulas(JsonReader& reader, std::span<const char* const> fields);
/// A formula as a setting may have it, with the errors that readFormulas() complains of.
Result<Formula> readSettingFormula(std::string_view text);

/// Differs where what the formulas read of the groom beside its strands differs.
std::string formulaState(const Groom& groom, const SettingFormulas& formulas);
std::vector<MaskMap> mapsOf(const SettingFormulas& formulas);

}  // namespace hairloom
