// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/mesh_reader/gltf_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "importers/mesh_reader/gltf_draco.h"
#include "importers/mesh_reader/gltf_morphs.h"
#include "importers/mesh_reader/gltf_nodes.h"
#include "importers/mesh_reader/tinygltf.h"
#include "importers/scene_parts.h"

namespace hairloom {
namespace {

/// The numbers of one primitive, in its own space.
struct Primitive {
    std::size_t vertices = 0;
    std::vector<std::uint32_t> triangles;  ///< three corners each
    std::vector<float> positions, normals, uvs;
    std::vector<std::vector<std::pair<std::uint32_t, float>>> influences;  ///< joint and weight, or empty
};

Mat3f cofactors(const Mat3f& m) {
    Mat3f result;
    result << m.col(1).cross(m.col(2)), m.col(2).cross(m.col(0)), m.col(0).cross(m.col(1));
    return result;
}

/// Triangles of a strip or fan; corners in the order that glTF 2.0 gives them (3.7.2.1).
std::vector<std::uint32_t> trianglesOf(int mode, std::vector<std::uint32_t> indices) {
    if (mode != TINYGLTF_MODE_TRIANGLE_STRIP && mode != TINYGLTF_MODE_TRIANGLE_FAN) {
        indices.resize(indices.size() / 3 * 3);
        return indices;
    }
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = 0; i + 2 < indices.size(); ++i) {
        if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
            triangles.insert(triangles.end(), {indices[i + 1], indices[i + 2], indices[0]});
        else
            triangles.insert(triangles.end(), {indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
    }
    return triangles;
}

class PrimitiveReader {
  public:
    PrimitiveReader(const GltfFile& file, const tinygltf::Primitive& source,
                    const std::vector<double>& weights)
        : file_(file), source_(source), weights_(weights) {}

    Result<Primitive> read() {
        if (isDracoCompressed(source_)) {
            auto decoded = readDraco(file_, source_);
            if (!decoded) return tl::unexpected(decoded.error());
            compressed_ = std::move(*decoded);
        }
        take("POSITION", 3, result_.positions);
        result_.vertices = result_.positions.size() / 3;
        if (result_.positions.empty() && !problem_) return fail("a primitive has no positions");
        take("NORMAL", 3, result_.normals);
        take("TEXCOORD_0", 2, result_.uvs);
        readTriangles();
        readInfluences();
        addMorphTargets();
        if (problem_) return tl::unexpected(*problem_);
        return std::move(result_);
    }

  private:
    /// Keeps the first error; what is not there leaves `into` empty.
    void take(const std::string& name, std::uint32_t components, std::vector<float>& into) {
        if (problem_) return;
        if (const auto found = compressed_.attributes.find(name); found != compressed_.attributes.end()) {
            if (found->second.components == components) into = std::move(found->second.numbers);
        } else if (const auto there = source_.attributes.find(name); there != source_.attributes.end()) {
            take(there->second, name, components, into);
        }
        const bool fits = into.empty() || name == "POSITION" || into.size() == result_.vertices * components;
        if (!fits && !problem_)
            wrong(Error{{},
                        {},
                        fmt::format("{} of {} vertices", name, into.size() / components),
                        fmt::format("expected {}", result_.vertices)});
    }
    void take(int accessor, const std::string& name, std::uint32_t components, std::vector<float>& into) {
        auto numbers = file_.numbers(accessor, components, name.c_str());
        if (!numbers) return wrong(numbers.error());
        into = std::move(*numbers);
    }
    void wrong(Error error) {
        if (!problem_) problem_ = std::move(error);
    }

    void readTriangles() {
        if (problem_) return;
        std::vector<std::uint32_t> indices = std::move(compressed_.indices);
        if (compressed_.vertices == 0 && source_.indices >= 0) {
            auto found = file_.indices(source_.indices, "indices");
            if (!found) return wrong(found.error());
            indices = std::move(*found);
        } else if (compressed_.vertices == 0) {
            indices.resize(result_.vertices);
            for (std::uint32_t i = 0; i < indices.size(); ++i) indices[i] = i;
        }
        const auto beyond =
            std::ranges::find_if(indices, [&](std::uint32_t index) { return index >= result_.vertices; });
        if (beyond != indices.end())
            return wrong(Error{{},
                               {},
                               fmt::format("a face refers to vertex {}", *beyond),
                               fmt::format("there are {} vertices", result_.vertices)});
        result_.triangles = trianglesOf(compressed_.vertices == 0 ? source_.mode : TINYGLTF_MODE_TRIANGLES,
                                        std::move(indices));
    }

    void readInfluences() {
        for (int set = 0; !problem_; ++set) {
            std::vector<float> joints, weights;
            take(fmt::format("JOINTS_{}", set), 4, joints);
            take(fmt::format("WEIGHTS_{}", set), 4, weights);
            if (joints.empty() || weights.empty() || problem_) return;
            result_.influences.resize(result_.vertices);
            for (std::size_t i = 0; i < joints.size(); ++i) {
                if (weights[i] > 0)
                    result_.influences[i / 4].emplace_back(static_cast<std::uint32_t>(joints[i]), weights[i]);
            }
        }
    }

    void addMorphTargets() {
        for (std::size_t target = 0; target < source_.targets.size(); ++target) {
            const float weight = target < weights_.size() ? static_cast<float>(weights_[target]) : 0.0f;
            if (weight == 0) continue;
            addDisplacements(source_.targets[target], "POSITION", weight, result_.positions);
            addDisplacements(source_.targets[target], "NORMAL", weight, result_.normals);
        }
    }
    void addDisplacements(const std::map<std::string, int>& target, const std::string& name, float weight,
                          std::vector<float>& to) {
        const auto found = target.find(name);
        if (found == target.end() || to.empty() || problem_) return;
        std::vector<float> moved;
        take(found->second, "a morph target's " + name, 3, moved);
        if (problem_) return;
        if (moved.size() != to.size())
            return wrong(Error{{},
                               {},
                               fmt::format("a morph target of {} vertices", moved.size() / 3),
                               fmt::format("expected {}", to.size() / 3)});
        for (std::size_t i = 0; i < to.size(); ++i) to[i] += weight * moved[i];
    }

    const GltfFile& file_;
    const tinygltf::Primitive& source_;
    const std::vector<double>& weights_;
    DracoPrimitive compressed_;
    Primitive result_;
    std::optional<Error> problem_;
};

class Converter {
  public:
    explicit Converter(const GltfFile& file) : file_(file), model_(file.model()), morphs_(file, scene_) {}

    Result<RawScene> convert() {
        scene_.metresPerUnit = 1;
        scene_.statesUp = true;
        for (const tinygltf::Mesh& mesh : model_.meshes) {
            for (const tinygltf::Primitive& primitive : mesh.primitives) {
                anyUvs_ = anyUvs_ || primitive.attributes.contains("TEXCOORD_0");
                allNormals_ = allNormals_ && primitive.attributes.contains("NORMAL");
                morphTargets_ += primitive.targets.empty() ? 0 : 1;
            }
        }
        auto nodes = GltfNodes::make(file_, scene_);
        if (!nodes) return tl::unexpected(nodes.error());
        for (const std::uint32_t node : nodes->shown()) {
            if (auto status = addNode(*nodes, node); !status) return tl::unexpected(status.error());
        }
        morphs_.finish();
        if (auto status = nodes->addClips(morphs_); !status) return tl::unexpected(status.error());
        finish();
        return std::move(scene_);
    }

  private:
    /// Materials in the order of their first use; several of one name are one.
    std::uint32_t materialOf(const tinygltf::Primitive& primitive) {
        std::string name = "default";
        if (primitive.material >= 0 &&
            static_cast<std::size_t>(primitive.material) < model_.materials.size()) {
            name = model_.materials[static_cast<std::size_t>(primitive.material)].name;
            if (name.empty()) name = fmt::format("material {}", primitive.material);
        }
        return indexOf(name, materials_, scene_.soup.materialNames);
    }

    Status addNode(GltfNodes& nodes, std::uint32_t number) {
        const tinygltf::Node& node = model_.nodes[number];
        if (node.mesh < 0) return {};
        if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size())
            return fail(fmt::format("a node refers to mesh {}", node.mesh),
                        fmt::format("there are {}", model_.meshes.size()));
        const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
        for (const tinygltf::Primitive& source : mesh.primitives) {
            const bool isFaces = source.mode >= TINYGLTF_MODE_TRIANGLES || isDracoCompressed(source);
            if (!isFaces) {
                ++leftOut_;
                continue;
            }
            auto primitive = PrimitiveReader(file_, source, restWeightsOf(model_, node)).read();
            if (!primitive) return tl::unexpected(primitive.error());
            const Eigen::Affine3f toWorld = nodes.meshToWorld(number);
            morphs_.add(number, source, static_cast<std::uint32_t>(scene_.soup.positions.size()),
                        primitive->vertices, toWorld.linear());
            addTriangles(*primitive, toWorld, indexOf(nodes.nameOf(number), groups_, scene_.soup.groupNames),
                         materialOf(source));
            if (auto status = nodes.addWeights(number, primitive->vertices, std::move(primitive->influences));
                !status)
                return status;
        }
        return {};
    }

    void addTriangles(const Primitive& primitive, const Eigen::Affine3f& toWorld, std::uint32_t group,
                      std::uint32_t material) {
        PolygonSoup& soup = scene_.soup;
        const auto first = static_cast<std::uint32_t>(soup.positions.size());
        for (std::size_t vertex = 0; vertex < primitive.vertices; ++vertex)
            soup.positions.push_back(toWorld * Eigen::Map<const Vec3f>(&primitive.positions[vertex * 3]));
        const bool mirrored = toWorld.linear().determinant() < 0;
        const Mat3f normalMatrix = cofactors(toWorld.linear()) * (mirrored ? -1.0f : 1.0f);
        for (std::size_t face = 0; face + 2 < primitive.triangles.size(); face += 3) {
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const std::uint32_t vertex = primitive.triangles[face + (mirrored ? 2 - corner : corner)];
                soup.corners.push_back(first + vertex);
                if (anyUvs_) soup.uvs.push_back(uvOf(primitive, vertex));
                if (allNormals_) soup.normals.push_back(normalOf(primitive, vertex, normalMatrix));
            }
            soup.offsets.push_back(static_cast<std::uint32_t>(soup.corners.size()));
            soup.faceGroups.push_back(group);
            soup.faceMaterials.push_back(material);
        }
    }

    /// glTF's V goes down, Hairloom's up.
    static Vec2f uvOf(const Primitive& primitive, std::uint32_t vertex) {
        if (primitive.uvs.empty()) return Vec2f::Zero();
        const Vec2f uv(primitive.uvs[vertex * 2], 1.0f - primitive.uvs[vertex * 2 + 1]);
        return uv.allFinite() ? uv : Vec2f::Zero();
    }

    Vec3f normalOf(const Primitive& primitive, std::uint32_t vertex, const Mat3f& normalMatrix) {
        Vec3f normal = Vec3f::Zero();
        if (!primitive.normals.empty())
            normal = normalMatrix * Eigen::Map<const Vec3f>(&primitive.normals[vertex * std::size_t{3}]);
        const float length = normal.norm();
        badNormals_ += !(std::isfinite(length) && length > 0);
        return normal / length;
    }

    void finish() {
        if (leftOut_ != 0)
            scene_.warnings.push_back(
                fmt::format("{} primitives of points and lines were left out", leftOut_));
        if (morphTargets_ != 0 && scene_.morphs.empty())
            scene_.warnings.push_back("morph targets keep the weights of their rest pose");
        if (badNormals_ != 0)
            scene_.warnings.push_back(
                fmt::format("{} normals are unusable, so all are computed from the faces", badNormals_));
        if (badNormals_ != 0 || !allNormals_) scene_.soup.normals.clear();
        if (scene_.bones.empty()) scene_.skin = {};
    }

    const GltfFile& file_;
    const tinygltf::Model& model_;
    RawScene scene_;
    GltfMorphs morphs_;
    std::unordered_map<std::string, std::uint32_t> groups_, materials_;
    bool anyUvs_ = false;
    bool allNormals_ = true;
    std::size_t leftOut_ = 0;
    std::size_t badNormals_ = 0;
    std::size_t morphTargets_ = 0;
};

}  // namespace

Result<RawScene> readGltf(const char* file, std::span<const std::byte> bytes) {
    const auto opened = GltfFile::load(file, bytes);
    if (!opened) return tl::unexpected(opened.error());
    return Converter(*opened).convert();
}

}  // namespace hairloom
