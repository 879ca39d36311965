// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entry for the mesh readers of our own and their repair.

#include <cstdlib>

#include "importers/alembic_mesh.h"
#include "importers/file_format.h"
#include "importers/obj_mesh.h"
#include "importers/ply_mesh.h"
#include "importers/usd_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hairloom;
    const auto bytes = std::as_bytes(std::span(data, size));
    const std::string text(reinterpret_cast<const char*>(data), size);
    const auto scene = startsLikeUsd(bytes)       ? readUsdMesh("fuzzed", {bytes.begin(), bytes.end()}, {})
                       : startsLikeAlembic(bytes) ? readAlembicMesh("fuzzed", bytes)
                       : text.starts_with("ply")  ? readPlyMesh("fuzzed", bytes)
                                                  : readObjMesh("fuzzed", text);
    if (!scene) return scene.error().problem.empty() ? std::abort(), 0 : 0;
    if (validate(*scene)) static_cast<void>(ScalpMesh::make(scene->soup));
    return 0;
}
