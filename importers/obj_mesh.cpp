// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/obj_mesh.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string_view>
#include <unordered_map>

#include "importers/obj_text.h"

namespace hairloom {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

/// Names in the order of their first use.
class NameTable {
  public:
    std::uint32_t index(std::string_view name) {
        const auto [entry, added] =
            indices_.try_emplace(std::string(name), static_cast<std::uint32_t>(names.size()));
        if (added) names.emplace_back(name);
        return entry->second;
    }
    std::vector<std::string> names;

  private:
    std::unordered_map<std::string, std::uint32_t> indices_;
};

class ObjReader {
  public:
    explicit ObjReader(const std::filesystem::path& path) : path_(path), file_(path.string()) {}

    Result<RawScene> read(const std::string& text) {
        ObjLines lines(text);
        while (lines.next()) {
            line_ = lines.number();
            if (auto status = readLine(lines.keyword(), lines.rest()); !status)
                return tl::unexpected(status.error());
        }
        if (auto status = checkIndices(); !status) return tl::unexpected(status.error());
        finish();
        return std::move(scene_);
    }

  private:
    Status readLine(std::string_view keyword, std::string_view rest) {
        if (keyword == "v") return readPosition(rest);
        if (keyword == "vt") return readUv(rest);
        if (keyword == "vn") return readNormal(rest);
        if (keyword == "f") return readFace(rest);
        if (keyword == "g" || keyword == "o") {
            group_ = rest.empty() ? std::string_view("default") : rest;
        } else if (keyword == "usemtl") {
            material_ = rest.empty() ? std::string_view("default") : rest;
            usesMaterials_ = true;
        } else if (keyword == "mtllib") {
            lookForLibrary(rest);
        }
        return {};
    }

    Status malformed(std::string_view found, std::string expected) const {
        return failIn(file_, Line{line_}, fmt::format("found '{}'", shortened(found)), std::move(expected));
    }

    /// The first `count` numbers of a line; at least `needed` must be there, missing ones are 0.
    Result<Vec3f> readNumbers(std::string_view rest, int needed, int count, const char* expected) {
        Vec3f numbers = Vec3f::Zero();
        std::string_view tail = rest;
        for (int index = 0; index < count; ++index) {
            const std::string_view word = takeWord(tail);
            if (word.empty() && index >= needed) break;
            const auto number = parseNumber(word);
            if (!number) return tl::unexpected(malformed(rest, expected).error());
            numbers[index] = static_cast<float>(*number);
        }
        return numbers;
    }

    Status readPosition(std::string_view rest) {
        const auto position = readNumbers(rest, 3, 3, "expected a vertex with three coordinates");
        if (!position) return tl::unexpected(position.error());
        if (!position->allFinite()) return malformed(rest, "expected finite coordinates");
        scene_.soup.positions.push_back(*position);
        return {};
    }

    Status readUv(std::string_view rest) {
        const auto uv = readNumbers(rest, 1, 2, "expected a texture coordinate");
        if (!uv) return tl::unexpected(uv.error());
        uvs_.push_back(uv->head<2>());
        return {};
    }

    Status readNormal(std::string_view rest) {
        const auto normal = readNumbers(rest, 3, 3, "expected a normal with three coordinates");
        if (!normal) return tl::unexpected(normal.error());
        normals_.push_back(*normal);
        return {};
    }

    Status readFace(std::string_view rest) {
        const std::size_t begin = scene_.soup.corners.size();
        std::string_view tail = rest;
        for (std::string_view word = takeWord(tail); !word.empty(); word = takeWord(tail)) {
            if (!readCorner(word)) {
                return malformed(
                    word, "expected a corner as VERTEX, VERTEX/UV, VERTEX//NORMAL or VERTEX/UV/NORMAL");
            }
        }
        if (scene_.soup.corners.size() > kNone) return malformed(rest, "expected fewer than 2^32 corners");
        if (scene_.soup.corners.size() - begin < 3) {
            ++tooFewCorners_;
            scene_.soup.corners.resize(begin);
            cornerUvs_.resize(begin);
            cornerNormals_.resize(begin);
            return {};
        }
        scene_.soup.offsets.push_back(static_cast<std::uint32_t>(scene_.soup.corners.size()));
        scene_.soup.faceGroups.push_back(groups_.index(group_));
        scene_.soup.faceMaterials.push_back(materials_.index(material_));
        faceLines_.push_back(line_);
        return {};
    }

    bool readCorner(std::string_view word) {
        const std::size_t slash = word.find('/');
        const auto vertex = parseIndex(word.substr(0, slash), scene_.soup.positions.size());
        std::optional<std::uint32_t> uv = kNone, normal = kNone;
        if (slash != word.npos) {
            const std::string_view after = word.substr(slash + 1);
            const std::size_t second = after.find('/');
            if (!after.substr(0, second).empty()) uv = parseIndex(after.substr(0, second), uvs_.size());
            if (second != after.npos && second + 1 < after.size()) {
                normal = parseIndex(after.substr(second + 1), normals_.size());
            }
        }
        if (!vertex || !uv || !normal) return false;
        scene_.soup.corners.push_back(*vertex);
        cornerUvs_.push_back(*uv);
        cornerNormals_.push_back(*normal);
        return true;
    }

    /// Counted from 1, or backwards from what has been read so far. Whether a forward index names something
    /// is only known at the end of the file.
    static std::optional<std::uint32_t> parseIndex(std::string_view word, std::size_t soFar) {
        const std::optional<std::int64_t> named = parseWhole(word);
        if (!named) return std::nullopt;
        const std::int64_t index = *named < 0 ? *named + static_cast<std::int64_t>(soFar) + 1 : *named;
        if (index <= 0 || index >= kNone) return std::nullopt;
        return static_cast<std::uint32_t>(index - 1);
    }

    void lookForLibrary(std::string_view name) {
        std::error_code code;
        if (name.empty() || std::filesystem::exists(path_.parent_path() / std::filesystem::path(name), code))
            return;
        scene_.warnings.push_back(fmt::format(
            "the material file '{}' was not found, so materials have only their names", shortened(name)));
    }

    Status checkIndices() const {
        const PolygonSoup& soup = scene_.soup;
        for (std::size_t face = 0; face + 1 < soup.offsets.size(); ++face) {
            for (std::uint32_t corner = soup.offsets[face]; corner < soup.offsets[face + 1]; ++corner) {
                if (soup.corners[corner] < soup.positions.size()) continue;
                return failIn(
                    file_, Line{faceLines_[face]},
                    fmt::format("a face refers to vertex {}", std::uint64_t{soup.corners[corner]} + 1),
                    fmt::format("the file has {} vertices", soup.positions.size()));
            }
        }
        return {};
    }

    void finish() {
        PolygonSoup& soup = scene_.soup;
        soup.groupNames = std::move(groups_.names);
        soup.materialNames = std::move(materials_.names);
        if (!usesMaterials_) {
            soup.faceMaterials.clear();
            soup.materialNames.clear();
        }
        if (tooFewCorners_ != 0) {
            scene_.warnings.push_back(
                fmt::format("{} faces with fewer than three corners were left out", tooFewCorners_));
        }
        attachUvs();
        attachNormals();
    }

    void attachUvs() {
        std::size_t missing = 0;
        std::vector<Vec2f> uvs;
        uvs.reserve(cornerUvs_.size());
        for (const std::uint32_t index : cornerUvs_) {
            const bool usable = index < uvs_.size() && uvs_[index].allFinite();
            missing += !usable;
            uvs.push_back(usable ? uvs_[index] : Vec2f::Zero());
        }
        if (missing == uvs.size()) return;
        if (missing != 0) {
            scene_.warnings.push_back(fmt::format(
                "{} of {} corners have no usable texture coordinate and get (0, 0)", missing, uvs.size()));
        }
        scene_.soup.uvs = std::move(uvs);
    }

    void attachNormals() {
        std::vector<Vec3f> normals;
        normals.reserve(cornerNormals_.size());
        for (const std::uint32_t index : cornerNormals_) {
            if (index >= normals_.size() || !normals_[index].allFinite()) break;
            normals.push_back(normals_[index]);
        }
        if (normals.size() == cornerNormals_.size()) scene_.soup.normals = std::move(normals);
    }

    std::filesystem::path path_;
    std::string file_;
    std::uint64_t line_ = 0;
    RawScene scene_;
    std::vector<Vec2f> uvs_;
    std::vector<Vec3f> normals_;
    std::vector<std::uint32_t> cornerUvs_, cornerNormals_;
    std::vector<std::uint64_t> faceLines_;
    NameTable groups_, materials_;
    std::string group_ = "default";
    std::string material_ = "default";
    bool usesMaterials_ = false;
    std::size_t tooFewCorners_ = 0;
};

}  // namespace

Result<RawScene> readObjMesh(const std::filesystem::path& path, const std::string& text) {
    return ObjReader(path).read(text);
}

}  // namespace hairloom
