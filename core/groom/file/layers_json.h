// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Layers as JSON: one form for project files and scripts.

#include "core/groom/file/json_reader.h"
#include "core/groom/groom.h"

namespace hairloom {

/// Density and material stand where they are not what files without them mean.
nlohmann::ordered_json toJson(const std::vector<Layer>& layers);

/// The reader's "layers": objects of "name", "visible", "locked", and perhaps "density" and "material", of
/// which members that are absent are the groom's default.
std::vector<Layer> readLayers(JsonReader& reader);

}  // namespace hairloom
