// SPDX-License-Identifier: GPL-3.0-or-later
// hairloom-mesh-reader FORMAT FILE: reads one mesh file with assimp and writes the scene to standard output.
// Assimp crashes, hangs or eats memory on some damaged files; as a process of its own it takes nothing with
// it.

#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#include <windows.h>
#else
#include <sys/resource.h>
#include <unistd.h>
#endif

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>

#include "importers/mesh_format.h"
#include "importers/mesh_reader/assimp_scene.h"
#include "importers/raw_scene_stream.h"

namespace hairloom {
namespace {

/// A crash ends the process without a report or a dialogue.
void prepareForTheWorst() {
#ifdef _WIN32
    SetErrorMode(SEM_FAILCRITICALERRORS | SEM_NOGPFAULTERRORBOX);
    _setmode(_fileno(stdout), _O_BINARY);
#else
    const rlimit noCoreFile{0, 0};
    setrlimit(RLIMIT_CORE, &noCoreFile);
#endif
}

/// On Windows the parent's job object has the limit. Sanitizers reserve terabytes of address space; there the
/// parent's watch over resident memory is the only limit.
void limitMemory() {
#if !defined(_WIN32) && !defined(HAIRLOOM_ADDRESS_SANITIZER) && !defined(__SANITIZE_THREAD__)
    constexpr rlim_t kAddressSpace = rlim_t{3} << 29u;
    const rlimit limit{kAddressSpace, kAddressSpace};
    setrlimit(RLIMIT_AS, &limit);
#endif
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
    return std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() && std::fflush(stdout) == 0;
}

int run(int count, char** arguments) {
    const auto format = count == 3 ? meshFormatNamed(arguments[1]) : std::nullopt;
    if (!format || *format == MeshFormat::Obj || *format == MeshFormat::Ply) {
        std::fputs("usage: hairloom-mesh-reader stl|fbx|gltf|glb FILE > SCENE\n", stderr);
        return 2;
    }
    prepareForTheWorst();
    limitMemory();
    const ByteWriter answer = writeRawScene(readGuarded(arguments[2], *format));
    return writeOut(answer.bytes()) ? 0 : 1;
}

}  // namespace
}  // namespace hairloom

int main(int count, char** arguments) {
    // Freeing what is about to vanish would only cost time, and could crash on a scene that assimp has
    // broken.
    std::_Exit(hairloom::run(count, arguments));
}
