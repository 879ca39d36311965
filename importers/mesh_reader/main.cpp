// SPDX-License-Identifier: GPL-3.0-or-later
// hairloom-mesh-reader FORMAT FILE: reads one mesh file with assimp, or tinygltf where it is glTF, and writes
// the scene to standard output. These crash, hang or eat memory on some damaged files; as a process of its
// own it takes nothing with it.

#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#include <windows.h>
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
constexpr std::uint64_t kAddressSpace = std::uint64_t{3} << 29u;  // 1.5 GiB
constexpr std::string_view kAllowUnconfined = "--allow-unconfined";

/// A crash ends the process without a report or a dialogue.
void prepareForTheWorst() {
#ifdef _WIN32
    SetErrorMode(SEM_FAILCRITICALERRORS | SEM_NOGPFAULTERRORBOX);
    _setmode(_fileno(stdout), _O_BINARY);
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

/// The scene, read where only the file's folder can be read, and nothing written but the answer. What this
/// system lacks to make it so is the first warning.
Result<RawScene> readConfined(const char* file, MeshFormat format, bool allowUnconfined) {
    std::error_code code;
    // Links that lead to the file lie in folders that are gone in a moment.
    const std::string target = std::filesystem::weakly_canonical(file, code).string();
    const Confinement confinement = confineProcess(LimitedFolder(file).path(), kAddressSpace);
    const std::string failed = confinement.namesOf(LayerState::Failed);
    if (!failed.empty() && !allowUnconfined) {
        return fail("is not read, since the process that reads it could not be confined: " + failed,
                    "mend that, or read it all the same with --allow-unconfined");
    }
    auto scene = readGuarded(code ? file : target.c_str(), format);
    const std::string missing = confinement.namesOf(LayerState::Missing);
    if (scene && !(missing + failed).empty()) {
        const std::string names = missing + (missing.empty() || failed.empty() ? "" : ", ") + failed;
        scene->warnings.insert(scene->warnings.begin(), std::string(kGuardWarning) + names);
    }
    return scene;
}

bool writeOut(std::span<const std::byte> bytes) {
    return std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() && std::fflush(stdout) == 0;
}

/// Lines "NAME VALUE": what the kernel could take from the process, and what it then could not do.
int trySecurity(const char* folder, const char* outside, const char* process) {
    const Confinement confinement = confineProcess(folder, kAddressSpace);
    std::string lines =
        fmt::format("seccomp {}\nlandlock {}\nlandlock_version {}\n", confinement.isSet("system_calls"),
                    confinement.isSet("files"), confinement.landlockVersion);
    for (const ConfinementLayer& layer : confinement.layers)
        lines += fmt::format("layer_{} {}\n", layer.name, layerStateName(layer.state));
    const ConfinementBait bait{folder, outside, std::strtoll(process, nullptr, 10), kAddressSpace};
    for (const ConfinementTrial& trial : tryToEscape(bait))
        lines += fmt::format("refuses_{} {}\n", trial.what, trial.isRefused);
    return writeOut(std::as_bytes(std::span(lines))) ? 0 : 1;
}

int run(int count, char** arguments) {
    if (count == 5 && std::string_view(arguments[1]) == "--security")
        return trySecurity(arguments[2], arguments[3], arguments[4]);
    const bool allowUnconfined = count == 4 && arguments[3] == kAllowUnconfined;
    const auto format = count == 3 || allowUnconfined ? meshFormatNamed(arguments[1]) : std::nullopt;
    if (!format || *format == MeshFormat::Obj || *format == MeshFormat::Ply) {
        std::fputs(
            "usage: hairloom-mesh-reader stl|fbx|gltf|glb FILE [--allow-unconfined] > SCENE\n"
            "       hairloom-mesh-reader --security FOLDER FILE_OUTSIDE PROCESS\n",
            stderr);
        return 2;
    }
    prepareForTheWorst();
    const ByteWriter answer = writeRawScene(readConfined(arguments[2], *format, allowUnconfined));
    return writeOut(answer.bytes()) ? 0 : 1;
}

}  // namespace
}  // namespace hairloom

int main(int count, char** arguments) {
    // Freeing what is about to vanish would only cost time, and could crash on a scene that assimp has
    // broken.
    std::_Exit(hairloom::run(count, arguments));
}
