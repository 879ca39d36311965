// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <system_error>

#include "core/base/stop_scope.h"
#include "core/base/utf8.h"
#include "core/base/write_rules.h"
#include "importers/child_process.h"
#include "importers/foreign_reader.h"
#include "importers/length_unit.h"
#include "importers/mesh_format.h"
#include "importers/mesh_reader_program.h"
#include "importers/raw_scene.h"
#include "importers/raw_scene_stream.h"
#include "importers/reader_limits.h"
#include "importers/scene_parts.h"

namespace hairloom {
namespace {

constexpr std::uint64_t kLargestFile = std::uint64_t{1} << 30u;

std::string expectedFormats() {
    return fmt::format("expected a mesh in {} format", labelsOf(meshFormats()));
}

/// Where a reader says no more than what is wrong.
constexpr const char* kReadableMesh = "expected a whole file that can be read: export it again";

struct FileHead {
    std::vector<std::byte> bytes;
    std::uint64_t fileSize;
};

Result<FileHead> readHead(const std::filesystem::path& path) {
    const std::string file = path.string();
    std::error_code code;
    const auto status = std::filesystem::status(path, code);
    if (!std::filesystem::exists(status)) return failIn(file, {}, "no such file", "expected a mesh file");
    if (!std::filesystem::is_regular_file(status))
        return failIn(file, {}, "is not a regular file", "expected a mesh file");
    FileHead head;
    head.fileSize = std::filesystem::file_size(path, code);
    if (code)
        return failIn(file, {}, fmt::format("cannot be read: {}", code.message()),
                      "expected a readable file");
    if (head.fileSize == 0) return failIn(file, {}, "is empty", expectedFormats());
    if (head.fileSize > kLargestFile) {
        return failIn(file, {}, fmt::format("is {} bytes long", head.fileSize),
                      fmt::format("expected at most {}", kLargestFile));
    }
    head.bytes.resize(static_cast<std::size_t>(std::min<std::uint64_t>(head.fileSize, kMeshFormatHead)));
    std::ifstream stream(path, std::ios::binary);
    stream.read(reinterpret_cast<char*>(head.bytes.data()), static_cast<std::streamsize>(head.bytes.size()));
    if (!stream) return failIn(file, {}, "cannot be read", "expected a readable file");
    return head;
}

bool startsWithUtf16Mark(const std::vector<std::byte>& bytes) {
    if (bytes.size() < 2) return false;
    const auto first = std::to_integer<int>(bytes[0]), second = std::to_integer<int>(bytes[1]);
    return (first == 0xff && second == 0xfe) || (first == 0xfe && second == 0xff);
}

Result<RawScene> readRaw(const std::filesystem::path& path, MeshFormat format, std::uint64_t fileBytes) {
    const bool isOurs = format == MeshFormat::Obj || format == MeshFormat::Ply || format == MeshFormat::Usd ||
                        format == MeshFormat::Alembic;
    const auto answer = readInChild(std::string(name(format)), path, {},
                                    isOurs ? limitsOfFile(fileBytes) : meshLimits(fileBytes));
    if (!answer) return tl::unexpected(answer.error());
    std::string lacking;
    auto scene = readRawScene(path.string(), *answer, lacking);
    sayWhatTheGuardLacks(lacking);
    return scene;
}

void cleanNames(RawScene& scene) {
    const auto clean = [](std::string& name) { name = cleanUtf8(name); };
    std::ranges::for_each(scene.soup.groupNames, clean);
    std::ranges::for_each(scene.soup.materialNames, clean);
    std::ranges::for_each(scene.warnings, clean);
    for (Bone& bone : scene.bones) clean(bone.name);
    for (Clip& clip : scene.clips) clean(clip.name);
    for (MorphTarget& target : scene.morphs) clean(target.name);
}

/// Decides the unit, says so where a user should know, and turns all lengths into metres.
float convertToMetres(RawScene& scene, const MeshImportOptions& options) {
    const bool stated = scene.metresPerUnit > 0 && std::isfinite(scene.metresPerUnit);
    const bool assumed = !stated && !options.metresPerUnit && scene.assumedMetresPerUnit > 0;
    const float metresPerUnit = stated    ? scene.metresPerUnit
                                : assumed ? scene.assumedMetresPerUnit
                                          : options.metresPerUnit.value_or(1.0f);
    if (assumed)
        scene.warnings.push_back(
            fmt::format("the file states no unit; its format takes {} m then", metresPerUnit));
    if (stated && options.metresPerUnit && std::abs(*options.metresPerUnit / metresPerUnit - 1) > 1e-4f) {
        scene.warnings.push_back(
            fmt::format("the file states its unit, {} m, so the requested unit is not used", metresPerUnit));
    }
    scaleLengths(scene, metresPerUnit);
    return metresPerUnit;
}

double largestExtent(const PolygonSoup& soup) {
    Box3f bounds;
    for (const std::uint32_t corner : soup.corners) bounds.extend(soup.positions[corner]);
    return bounds.isEmpty() ? 0.0 : bounds.sizes().cast<double>().maxCoeff();
}

/// Weights of the mesh's vertices from those of the file's.
SkinWeights followVertices(const SkinWeights& skin, std::span<const std::uint32_t> sourceVertices) {
    SkinWeights followed;
    if (skin.vertexCount() == 0) return followed;
    followed.bones.reserve(sourceVertices.size());
    followed.weights.reserve(sourceVertices.size());
    for (const std::uint32_t source : sourceVertices) {
        followed.bones.push_back(skin.bones[source]);
        followed.weights.push_back(skin.weights[source]);
    }
    return followed;
}

Result<ImportedScene> finishScene(RawScene raw, MeshFormat format, const MeshImportOptions& options) {
    if (auto status = validate(raw); !status) return tl::unexpected(status.error());
    cleanNames(raw);
    ImportedScene scene;
    scene.statesUnit = raw.metresPerUnit > 0 && std::isfinite(raw.metresPerUnit);
    scene.statesUp = raw.statesUp;
    scene.metresPerUnit = convertToMetres(raw, options);
    if (auto status = validate(raw); !status) return tl::unexpected(status.error());
    const double metres = largestExtent(raw.soup);
    if (auto strange = implausibleSize(metres / scene.metresPerUnit, scene.metresPerUnit)) {
        raw.warnings.push_back(std::move(*strange));
    }
    if (auto status = checkStop(); !status) return tl::unexpected(status.error());
    auto mesh = ScalpMesh::make(raw.soup);
    if (!mesh) return tl::unexpected(mesh.error());
    if (auto status = checkStop(); !status) return tl::unexpected(status.error());
    auto skeleton = Skeleton::make(std::move(raw.bones));
    if (!skeleton) return tl::unexpected(skeleton.error());
    scene.mesh = std::move(*mesh);
    scene.skeleton = std::move(*skeleton);
    scene.clips = std::move(raw.clips);
    scene.skin = followVertices(raw.skin, scene.mesh.sourceVertices());
    scene.morphs = morphsOf(raw.morphs, scene.mesh.sourceVertices(), kMostCached);
    const auto isLost = [&](std::size_t t) {
        return scene.morphs[t].vertices.empty() && !raw.morphs[t].vertices.empty();
    };
    std::size_t lost = 0;
    for (std::size_t t = 0; t < scene.morphs.size(); ++t) lost += isLost(t) ? 1 : 0;
    if (lost > 0)
        raw.warnings.push_back(
            fmt::format("{} morph targets move no vertex of the repaired mesh, or all targets "
                        "more than {} of them: they stay at rest",
                        lost, kMostCached));
    scene.warnings = std::move(raw.warnings);
    scene.format = name(format);
    return scene;
}

}  // namespace

std::filesystem::path meshReaderProgram() {
    if (const char* named = std::getenv("HAIRLOOM_MESH_READER"); named && *named) return named;
    return programFolder() / "hairloom-mesh-reader";
}

Result<ImportedScene> importScene(const std::filesystem::path& path, const MeshImportOptions& options) {
    assert(!options.metresPerUnit || *options.metresPerUnit > 0);
    const std::string file = path.string();
    noteInput(path);
    const auto head = readHead(path);
    if (!head) return tl::unexpected(head.error());
    if (startsWithUtf16Mark(head->bytes)) return failIn(file, {}, "is UTF-16 text", "expected UTF-8");
    const auto format = meshFormatOf(head->bytes, head->fileSize);
    if (!format) return failIn(file, {}, "is not in a supported mesh format", expectedFormats());
    auto raw = readRaw(path, *format, head->fileSize);
    if (!raw) return tl::unexpected(expecting(inFile(raw.error(), file), kReadableMesh));
    auto scene = finishScene(std::move(*raw), *format, options);
    if (!scene) return tl::unexpected(expecting(inFile(scene.error(), file), kReadableMesh));
    return scene;
}

}  // namespace hairloom
