// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entry for the mesh readers of our own, OBJ and PLY, and their repair.

#include <cstdlib>

#include "importers/obj_mesh.h"
#include "importers/ply_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hairloom;
    const std::string text(reinterpret_cast<const char*>(data), size);
    const auto scene = text.starts_with("ply") ? readPlyMesh("fuzzed", std::as_bytes(std::span(data, size)))
                                               : readObjMesh("fuzzed", text);
    if (!scene) return scene.error().problem.empty() ? std::abort(), 0 : 0;
    if (validate(*scene)) static_cast<void>(ScalpMesh::make(scene->soup));
    return 0;
}
