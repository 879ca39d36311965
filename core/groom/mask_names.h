// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What people call the painted masks of operators.

#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/groom/file/json_reader.h"
#include "core/groom/groom.h"

namespace hairloom {

/// The name that it was given, else "Mask 1". `number` counts from 1, to kPaintedMasks.
std::string maskName(const Groom& groom, std::uint32_t number);
/// The number of the mask with that name, or of "mask 1", or of "1", in capitals or not. Error: there is
/// none, listing those there are.
Result<std::uint32_t> findMask(const Groom& groom, std::string_view name);

/// Names as Groom::maskNames has them, after that of one mask changed. Spaces around a name go; an empty one
/// takes the mask's name away. Errors: those of checkMaskNames().
Result<std::vector<std::string>> maskNamesWith(const std::vector<std::string>& names, std::uint32_t number,
                                               std::string_view name);
/// Errors: more than kPaintedMasks names; one of more than kLongestMaskName bytes, with control characters,
/// or that reads as a number or as the name of a mask that has none; two that are the same but for capitals.
Status checkMaskNames(const std::vector<std::string>& names);

/// {"1": "Fringe"}: those that have one.
nlohmann::ordered_json maskNamesToJson(const std::vector<std::string>& names);
/// The members of such an object replace the names of their masks. What is wrong is a complaint of the
/// reader.
void readMaskNames(JsonReader reader, std::vector<std::string>& names);

}  // namespace hairloom
