// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entry for glTF and GLB, as the mesh reader reads them.

#include <cstdlib>
#include <exception>

#include "importers/mesh_reader/gltf_file.h"
#include "importers/mesh_reader/gltf_scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hairloom;
    const auto bytes = std::as_bytes(std::span(data, size));
    if (isFirstGltf(bytes)) return -1;
    try {
        const auto scene = readGltf("/nonexistent/fuzzed.gltf", bytes);
        if (scene) static_cast<void>(validate(*scene));
    } catch (const std::exception&) {  // the program answers these with a message
    }
    return 0;
}
