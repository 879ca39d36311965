// SPDX-License-Identifier: GPL-3.0-or-later
// hairloom-mesh-reader KIND FILE: reads one foreign file, a mesh, strands or a picture, and writes what it
// has to standard output. The libraries that read some of these crash, hang or eat memory on damaged files;
// as a process of its own it takes nothing with it.

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
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/file.h"
#include "importers/alembic_mesh.h"
#include "importers/confinement.h"
#include "importers/mesh_format.h"
#include "importers/mesh_reader/assimp_scene.h"
#include "importers/mesh_reader/gltf_file.h"
#include "importers/mesh_reader/gltf_scene.h"
#include "importers/mesh_reader/limited_folder.h"
#include "importers/mesh_reader/picture_file.h"
#include "importers/obj_mesh.h"
#include "importers/picture_stream.h"
#include "importers/ply_mesh.h"
#include "importers/raw_scene_stream.h"
#include "importers/raw_strands_stream.h"
#include "importers/reader_limits.h"
#include "importers/strand_file.h"
#include "importers/usd_mesh.h"

namespace hairloom {
namespace {

constexpr std::uint64_t kLargestFile = std::uint64_t{1} << 30u;
constexpr std::uint64_t kLargestStrandFile = std::uint64_t{4} << 30u;

/// What the command line asks for.
struct Request {
    std::string kind;  ///< "strands", "picture", or the name of a MeshFormat
    std::string file;
    std::string name;  ///< what errors call it
    std::uint64_t memoryBytes = kMeshMemory;
    bool allowUnconfined = false;
    StrandImportOptions strands;
    std::vector<PictureKind> pictures;
    CompanionPaths companions;  ///< that do not lie beside the file
    std::string lacking;        ///< layers of confinement, once it is confined
};

/// A crash ends the process without a report or a dialogue.
void prepareForTheWorst() {
#ifdef _WIN32
    SetErrorMode(SEM_FAILCRITICALERRORS | SEM_NOGPFAULTERRORBOX);
    _setmode(_fileno(stdout), _O_BINARY);
#endif
}

Result<RawScene> readMesh(const Request& request) {
    const MeshFormat format = *meshFormatNamed(request.kind);
    const std::string& file = request.file;
    if (format == MeshFormat::Obj) {
        const auto text = readTextFile(file, kLargestFile);
        return text ? readObjMesh(file, *text) : tl::unexpected(text.error());
    }
    if (format == MeshFormat::Stl || format == MeshFormat::Fbx) return readWithAssimp(file.c_str(), format);
    auto bytes = readFile(file, kLargestFile);
    if (!bytes) return tl::unexpected(bytes.error());
    if (format == MeshFormat::Ply) return readPlyMesh(file, *bytes);
    if (format == MeshFormat::Alembic) return readAlembicMesh(file, *bytes);
    if (format == MeshFormat::Usd)
        return readUsdMesh(file, std::move(*bytes), std::filesystem::path(file).parent_path());
    return isFirstGltf(*bytes) ? readWithAssimp(file.c_str(), format) : readGltf(file.c_str(), *bytes);
}

Result<render::LinearImage> readPictureFile(const Request& request) {
    const auto bytes = readFile(request.file, kMaxPictureFile);
    if (!bytes) return tl::unexpected(bytes.error());
    return decodePicture(request.file, *bytes, request.pictures);
}

Result<RawStrands> readStrands(const Request& request, const Companions& companions) {
    auto bytes = readFile(request.file, kLargestStrandFile);
    if (!bytes) return tl::unexpected(bytes.error());
    return readStrandFile(request.file, std::move(*bytes), request.strands, companions);
}

/// What `read` gives, where only the file's folder can be read, and nothing written but the answer.
template <class Content, class Read>
Result<Content> readConfined(Request& request, const Read& read) {
    std::error_code code;
    // Links that lead to the file lie in folders that are gone in a moment.
    const auto target = std::filesystem::weakly_canonical(request.file, code);
    if (!code) request.file = target.string();
    request.strands.folder = std::filesystem::path(request.file).parent_path();
    const Confinement confinement = confineProcess(LimitedFolder(request.file).path(), request.memoryBytes);
    const std::string failed = confinement.namesOf(LayerState::Failed);
    if (!failed.empty() && !request.allowUnconfined) {
        return fail("is not read, since the process that reads it could not be confined: " + failed,
                    "fix that, or read it anyway with --allow-unconfined");
    }
    const std::string missing = confinement.namesOf(LayerState::Missing);
    request.lacking = missing + (missing.empty() || failed.empty() ? "" : ", ") + failed;
    try {
        auto content = read();
        if (content || content.error().file != request.file) return content;
        // The parent knows it by the name that it was given.
        Error error = content.error();
        error.file.clear();
        return tl::unexpected(error);
    } catch (const std::bad_alloc&) {
        return fail(fmt::format("needs more memory than may be taken to read it ({} MiB)",
                                request.memoryBytes >> 20u),
                    "the file is damaged or too large");
    } catch (const std::exception& exception) {
        return fail(fmt::format("cannot be read: {}", exception.what()), "the file is damaged");
    }
}

bool writeOut(std::span<const std::byte> bytes) {
    return std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() && std::fflush(stdout) == 0;
}

/// Lines "NAME VALUE": what the kernel could take from the process, and what it then could not do.
int trySecurity(const char* folder, const char* outside, const char* process) {
    const Confinement confinement = confineProcess(folder, kMeshMemory);
    std::string lines =
        fmt::format("seccomp {}\nlandlock {}\nlandlock_version {}\n", confinement.isSet("system_calls"),
                    confinement.isSet("files"), confinement.landlockVersion);
    for (const ConfinementLayer& layer : confinement.layers)
        lines += fmt::format("layer_{} {}\n", layer.name, layerStateName(layer.state));
    const ConfinementBait bait{folder, outside, std::strtoll(process, nullptr, 10), kMeshMemory};
    for (const ConfinementTrial& trial : tryToEscape(bait))
        lines += fmt::format("refuses_{} {}\n", trial.what, trial.isRefused);
    return writeOut(std::as_bytes(std::span(lines))) ? 0 : 1;
}

/// Nothing where the words are none of this program's.
std::optional<Request> requestOf(std::span<char*> words) {
    if (words.size() < 2) return std::nullopt;
    Request request;
    request.kind = words[0];
    request.file = words[1];
    if (request.kind != "strands" && request.kind != "picture" && !meshFormatNamed(request.kind))
        return std::nullopt;
    for (const std::string_view word : words.subspan(2)) {
        const auto kind = pictureKindNamed(word);
        if (word == "--allow-unconfined") {
            request.allowUnconfined = true;
        } else if (word.starts_with("--name=")) {
            request.name = word.substr(word.find('=') + 1);
        } else if (word.starts_with("--companion=")) {
            const auto first = word.find('=') + 1, second = word.find('=', first);
            if (second == std::string::npos) return std::nullopt;
            request.companions[std::string(word.substr(first, second - first))] = word.substr(second + 1);
        } else if (word.starts_with("--memory=")) {
            request.memoryBytes = std::strtoull(word.data() + word.find('=') + 1, nullptr, 10);
        } else if (kind && request.kind == "picture") {
            request.pictures.push_back(*kind);
        } else if (request.kind != "strands" || !takeWord(word, request.strands)) {
            return std::nullopt;
        }
    }
    return request;
}

/// Reads, and writes the answer; false where nobody takes it.
bool answer(Request request) {
    bool isWritten = true;
    const auto sink = [&](std::span<const std::byte> bytes) {
        isWritten = isWritten && std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size();
    };
    if (request.kind == "picture") {
        const auto picture =
            readConfined<render::LinearImage>(request, [&] { return readPictureFile(request); });
        writePicture(picture, request.lacking, sink);
    } else if (request.kind == "strands") {
        // What lies beside a link to a file may not lie in the file's folder.
        const Companions companions = readCompanions(
            request.file, request.name.empty() ? request.file : request.name, request.companions);
        const auto strands =
            readConfined<RawStrands>(request, [&] { return readStrands(request, companions); });
        writeRawStrands(strands, request.lacking, sink);
    } else {
        const auto scene = readConfined<RawScene>(request, [&] { return readMesh(request); });
        writeRawScene(scene, request.lacking, sink);
    }
    return isWritten && std::fflush(stdout) == 0;
}

int run(int count, char** arguments) {
    if (count == 5 && std::string_view(arguments[1]) == "--security")
        return trySecurity(arguments[2], arguments[3], arguments[4]);
    auto request = requestOf(std::span(arguments, static_cast<std::size_t>(count)).subspan(1));
    if (!request) {
        std::fputs(
            "usage: hairloom-mesh-reader obj|ply|stl|fbx|gltf|glb|usd|abc|strands|picture FILE [OPTION…] > "
            "ANSWER\n"
            "       hairloom-mesh-reader --security FOLDER FILE_OUTSIDE PROCESS\n",
            stderr);
        return 2;
    }
    prepareForTheWorst();
    return answer(std::move(*request)) ? 0 : 1;
}

}  // namespace
}  // namespace hairloom

int main(int count, char** arguments) {
    hairloom::endWithParent();
    // Freeing what is about to vanish would only cost time, and could crash on a scene that assimp has
    // broken.
    std::_Exit(hairloom::run(count, arguments));
}
