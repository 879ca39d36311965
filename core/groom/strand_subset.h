// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/groom/groom.h"

namespace hairloom {

/// These strands, ascending, with their attributes, and all else that a groom has; the triangulation, which
/// is of all roots, goes.
Groom strandsOf(const Groom& groom, std::span<const std::uint32_t> strands);

/// The same of some points of each strand, in any order: strand s of the result has
/// points[offsets[s] … offsets[s + 1]) of the groom's. At least two each.
Groom strandsOf(const Groom& groom, std::span<const std::uint32_t> strands,
                std::vector<std::uint32_t> offsets, std::span<const std::uint32_t> points);

/// The layer of each strand; the first where the groom says none.
std::vector<std::uint32_t> layersOfStrands(const Groom& groom);

/// Strands of that layer, ascending.
std::vector<std::uint32_t> strandsOfLayer(const Groom& groom, std::uint32_t layer);

/// Strands of the layers of these names, ascending. Errors: a name that no layer has, listing those there
/// are.
Result<std::vector<std::uint32_t>> strandsOfLayers(const Groom& groom, std::span<const std::string> names);

}  // namespace hairloom
