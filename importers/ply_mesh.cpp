// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/ply_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "importers/ply_rows.h"

namespace hairloom {
namespace {

class PlyReader {
  public:
    PlyReader(const std::string& file, std::span<const std::byte> bytes, const PlyHeader& header)
        : numbers_(file, bytes, header), header_(header) {}

    Result<RawScene> read() {
        for (const PlyElement& element : header_.elements) {
            if (auto status = readElement(element); !status) return tl::unexpected(status.error());
        }
        finish();
        return std::move(scene_);
    }

  private:
    Status readElement(const PlyElement& element) {
        if (element.properties.empty()) return {};
        if (auto status = numbers_.checkCount(element); !status) return status;
        const bool isVertex = element.name == "vertex", isFace = element.name == "face";
        if (isVertex) {
            if (auto status = findVertexProperties(element); !status) return status;
        }
        if (isFace) {
            if (auto status = findFaceProperties(element); !status) return status;
        }
        PlyRow row;
        for (std::uint64_t index = 0; index < element.count; ++index) {
            if (auto status = numbers_.row(element, row); !status) return status;
            if (isVertex) addVertex(row);
            if (!isFace) continue;
            if (auto status = addFace(row); !status) return status;
        }
        return {};
    }

    Status findVertexProperties(const PlyElement& element) {
        position_ = {element.find({"x"}), element.find({"y"}), element.find({"z"})};
        normal_ = {element.find({"nx"}), element.find({"ny"}), element.find({"nz"})};
        uv_ = {element.find({"u", "s", "texture_u"}), element.find({"v", "t", "texture_v"})};
        if (!position_[0] || !position_[1] || !position_[2])
            return numbers_.wrong("vertices without x, y and z");
        hasNormals_ = normal_[0] && normal_[1] && normal_[2];
        hasUvs_ = uv_[0] && uv_[1];
        return {};
    }

    Status findFaceProperties(const PlyElement& element) {
        indices_ = element.find({"vertex_indices", "vertex_index"});
        if (!indices_ || !element.properties[*indices_].listSize) {
            return numbers_.wrong("faces without vertex indices",
                                  "expected 'property list TYPE TYPE vertex_indices'");
        }
        wedgeUvs_ = element.find({"texcoord"});
        if (wedgeUvs_ && !element.properties[*wedgeUvs_].listSize) wedgeUvs_.reset();
        return {};
    }

    void addVertex(const PlyRow& row) {
        const auto at = [&](const std::optional<std::size_t>& index) {
            return static_cast<float>(row.values[*index]);
        };
        scene_.soup.positions.emplace_back(at(position_[0]), at(position_[1]), at(position_[2]));
        if (hasNormals_) normals_.emplace_back(at(normal_[0]), at(normal_[1]), at(normal_[2]));
        if (hasUvs_) uvs_.emplace_back(at(uv_[0]), at(uv_[1]));
    }

    Status addFace(const PlyRow& row) {
        PolygonSoup& soup = scene_.soup;
        const std::vector<double>& indices = row.lists[*indices_];
        if (indices.size() < 3) {
            ++tooFewCorners_;
            return {};
        }
        for (const double index : indices) {
            if (!(index >= 0) || index > 4294967294.0 || index != std::floor(index)) {
                return numbers_.wrong(fmt::format("a face refers to vertex {}", index),
                                      "expected an index from 0");
            }
            soup.corners.push_back(static_cast<std::uint32_t>(index));
        }
        soup.offsets.push_back(static_cast<std::uint32_t>(soup.corners.size()));
        if (!wedgeUvs_) return {};
        const std::vector<double>& uvs = row.lists[*wedgeUvs_];
        for (std::size_t corner = 0; corner < indices.size(); ++corner) {
            const bool given = uvs.size() == 2 * indices.size();
            cornerUvs_.push_back(
                given ? Vec2f(static_cast<float>(uvs[2 * corner]), static_cast<float>(uvs[2 * corner + 1]))
                      : Vec2f::Zero());
        }
        return {};
    }

    void finish() {
        PolygonSoup& soup = scene_.soup;
        soup.groupNames = {"default"};
        soup.faceGroups.assign(soup.offsets.size() - 1, 0);
        if (tooFewCorners_ != 0) {
            scene_.warnings.push_back(
                fmt::format("{} faces with fewer than three corners were left out", tooFewCorners_));
        }
        const auto exists = [&](std::uint32_t corner) { return corner < soup.positions.size(); };
        if (!std::ranges::all_of(soup.corners, exists)) return;
        if (cornerUvs_.size() == soup.corners.size()) {
            soup.uvs = std::move(cornerUvs_);
        } else if (uvs_.size() == soup.positions.size()) {
            for (const std::uint32_t corner : soup.corners) soup.uvs.push_back(uvs_[corner]);
        }
        for (Vec2f& uv : soup.uvs) {
            if (!uv.allFinite()) uv.setZero();
        }
        const auto usable = [](const Vec3f& normal) {
            return normal.allFinite() && normal.squaredNorm() > 0;
        };
        if (normals_.size() != soup.positions.size() || !std::ranges::all_of(normals_, usable)) return;
        for (const std::uint32_t corner : soup.corners) soup.normals.push_back(normals_[corner].normalized());
    }

    PlyRows numbers_;
    const PlyHeader& header_;
    RawScene scene_;
    std::array<std::optional<std::size_t>, 3> position_, normal_;
    std::array<std::optional<std::size_t>, 2> uv_;
    std::optional<std::size_t> indices_, wedgeUvs_;
    bool hasNormals_ = false, hasUvs_ = false;
    std::vector<Vec3f> normals_;
    std::vector<Vec2f> uvs_, cornerUvs_;
    std::size_t tooFewCorners_ = 0;
};

}  // namespace

Result<RawScene> readPlyMesh(const std::string& file, std::span<const std::byte> bytes) {
    const auto header = readPlyHeader(file, bytes);
    if (!header) return tl::unexpected(header.error());
    return PlyReader(file, bytes, *header).read();
}

}  // namespace hairloom
