// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Primitives compressed by KHR_draco_mesh_compression.

#include <map>
#include <string>
#include <vector>

#include "importers/mesh_reader/gltf_file.h"

namespace tinygltf {
struct Primitive;
}

namespace hairloom {

/// What a compressed primitive holds.
struct DracoPrimitive {
    std::size_t vertices = 0;
    std::vector<std::uint32_t> indices;  ///< of triangles
    struct Attribute {
        std::uint32_t components = 0;
        std::vector<float> numbers;
    };
    std::map<std::string, Attribute> attributes;  ///< "POSITION", "NORMAL" …
};

bool isDracoCompressed(const tinygltf::Primitive& primitive);

/// Errors: draco's, bytes beyond the end of a buffer; a build without draco.
Result<DracoPrimitive> readDraco(const GltfFile& file, const tinygltf::Primitive& primitive);

}  // namespace hairloom
