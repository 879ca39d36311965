// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entry for what assimp reads; FUZZED_FORMAT is one of MeshFormat. The library falls over damaged
// files, which is why a process of its own reads them: ./dev fuzz lists what it finds here and goes on.

#include <exception>

#include "importers/mesh_reader/assimp_scene.h"
#include "tests/fuzz/file_of_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hairloom;
    const FileOfBytes file(data, size);
    try {
        const auto scene = readWithAssimp(file.path().c_str(), MeshFormat::FUZZED_FORMAT);
        if (scene) static_cast<void>(validate(*scene));
    } catch (const std::exception&) {  // the program answers these with a message
    }
    return 0;
}
