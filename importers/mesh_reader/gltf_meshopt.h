// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Buffer views compressed by EXT_meshopt_compression.

#include <nlohmann/json_fwd.hpp>

#include "core/base/result.h"

namespace tinygltf {
class Model;
}

namespace hairloom {

inline constexpr const char* kMeshopt = "EXT_meshopt_compression";

/// Gives buffers that only stand for what is compressed elsewhere a byte of their own, since they have none
/// in the file. Returns whether there are any.
bool fillFallbackBuffers(nlohmann::json& gltf);

/// Unpacks all compressed buffer views of a loaded file, each into a buffer of its own. Errors: bytes beyond
/// the end of a buffer, sizes that contradict each other or the packed bytes, damage, a filter or mode that
/// there is not.
Status unpackMeshopt(tinygltf::Model& model);

}  // namespace hairloom
