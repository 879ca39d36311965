// SPDX-License-Identifier: GPL-3.0-or-later
// hairloom-mesh-reader FORMAT FILE: reads one mesh file with assimp, or tinygltf where it is glTF, and writes
// the scene to standard output. These crash, hang or eat memory on some damaged files; as a process of its
// own it takes nothing with it.

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
#include <filesystem>
#include <new>
#include <span>
#include <string>
#include <string_view>

#include "core/base/file.h"
#include "importers/confinement.h"
#include "importers/mesh_format.h"
#include "importers/mesh_reader/assimp_scene.h"
#include "importers/mesh_reader/gltf_file.h"
#include "importers/mesh_reader/gltf_scene.h"
#include "importers/mesh_reader/limited_folder.h"
#include "importers/raw_scene_stream.h"

namespace hairloom {
namespace {

constexpr std::uint64_t kLargestFile = std::uint64_t{1} << 30u;

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
        if (format != MeshFormat::Gltf && format != MeshFormat::Glb) return readWithAssimp(file, format);
        const auto bytes = readFile(file, kLargestFile);
        if (!bytes) return tl::unexpected(bytes.error());
        return isFirstGltf(*bytes) ? readWithAssimp(file, format) : readGltf(file, *bytes);
    } catch (const std::bad_alloc&) {
        return fail("needs more memory than a mesh may take (1.5 GiB)", "the file is damaged or too large");
    } catch (const std::exception& exception) {
        return fail(fmt::format("cannot be read: {}", exception.what()));
    }
}

/// After this only the file's folder can be read, and nothing written but the answer.
void confine(const char* file) {
    confineProcess(std::filesystem::path(LimitedFolder(file).path()));
}

bool writeOut(std::span<const std::byte> bytes) {
    return std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() && std::fflush(stdout) == 0;
}

/// Lines "NAME VALUE": what the kernel could take from the process, and what it then could not do.
int trySecurity(const char* folder, const char* outside) {
    const Confinement confinement = confineProcess(folder);
    std::string lines = fmt::format("seccomp {}\nlandlock {}\nlandlock_version {}\n", confinement.systemCalls,
                                    confinement.files, confinement.landlockVersion);
    for (const ConfinementTrial& trial : tryToEscape(folder, outside))
        lines += fmt::format("refuses_{} {}\n", trial.what, trial.isRefused);
    return writeOut(std::as_bytes(std::span(lines))) ? 0 : 1;
}

int run(int count, char** arguments) {
    if (count == 4 && std::string_view(arguments[1]) == "--security")
        return trySecurity(arguments[2], arguments[3]);
    const auto format = count == 3 ? meshFormatNamed(arguments[1]) : std::nullopt;
    if (!format || *format == MeshFormat::Obj || *format == MeshFormat::Ply) {
        std::fputs(
            "usage: hairloom-mesh-reader stl|fbx|gltf|glb FILE > SCENE\n"
            "       hairloom-mesh-reader --security FOLDER FILE_OUTSIDE\n",
            stderr);
        return 2;
    }
    prepareForTheWorst();
    limitMemory();
    confine(arguments[2]);
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
