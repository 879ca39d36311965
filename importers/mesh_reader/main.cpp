// SPDX-License-Identifier: GPL-3.0-or-later
// hairloom-mesh-reader FORMAT FILE: reads one mesh file with assimp and writes the scene to standard output.
// Assimp crashes, hangs or eats memory on some damaged files; as a process of its own it takes nothing with
// it.

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <new>
#include <string_view>

#include "importers/mesh_format.h"
#include "importers/mesh_reader/assimp_scene.h"
#include "importers/raw_scene_stream.h"

namespace hairloom {
namespace {

/// Sanitizers reserve terabytes of address space; there the parent's watch over resident memory is the only
/// limit.
void limitMemory() {
#if !defined(HAIRLOOM_ADDRESS_SANITIZER) && !defined(__SANITIZE_THREAD__)
    constexpr rlim_t kAddressSpace = rlim_t{3} << 29u;
    const rlimit limit{kAddressSpace, kAddressSpace};
    setrlimit(RLIMIT_AS, &limit);
#endif
    const rlimit noCoreFile{0, 0};
    setrlimit(RLIMIT_CORE, &noCoreFile);
}

Result<RawScene> readGuarded(const char* file, MeshFormat format) {
    try {
        return readWithAssimp(file, format);
    } catch (const std::bad_alloc&) {
        return fail("needs more memory than a mesh may take (1.5 GiB)", "the file is damaged or too large");
    } catch (const std::exception& exception) {
        return fail(fmt::format("cannot be read: {}", exception.what()));
    }
}

bool writeOut(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = write(STDOUT_FILENO, bytes.data(), bytes.size());
        if (written <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return true;
}

int run(int count, char** arguments) {
    const auto format = count == 3 ? meshFormatNamed(arguments[1]) : std::nullopt;
    if (!format || *format == MeshFormat::Obj || *format == MeshFormat::Ply) {
        std::fputs("usage: hairloom-mesh-reader stl|fbx|gltf|glb FILE > SCENE\n", stderr);
        return 2;
    }
    limitMemory();
    const ByteWriter answer = writeRawScene(readGuarded(arguments[2], *format));
    return writeOut(answer.bytes()) ? 0 : 1;
}

}  // namespace
}  // namespace hairloom

int main(int count, char** arguments) {
    // Freeing what is about to vanish would only cost time, and could crash on a scene that assimp has
    // broken.
    _exit(hairloom::run(count, arguments));
}
