// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Primvars of meshes of USD.

#include <optional>
#include <string>
#include <string_view>

#include "importers/corner_values.h"
#include "importers/usd_values.h"

namespace hairloom {

/// Nothing where the mesh has no such attribute, with `components` numbers a value. `problem` says why what
/// is there cannot be used.
std::optional<CornerValues> readPrimvar(const UsdPrim& mesh, std::string_view name, std::uint32_t components,
                                        double time, const MeshCounts& counts, std::string& problem);

/// The name of the mesh's texture coordinates: "primvars:st", else the first that is meant as such; empty
/// where there are none.
std::string uvNameOf(const UsdPrim& mesh);

}  // namespace hairloom
