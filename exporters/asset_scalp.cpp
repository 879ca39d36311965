// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/asset_scalp.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "exporters/character.h"
#include "hairloom/body_bytes.h"

namespace hairloom {
namespace {

constexpr float kShares = 65535.0f;
constexpr std::size_t kMaxBones = asset::kNoBone;
/// More of a skin collider is told as a warning.
constexpr std::size_t kLargeBody = 300'000;

std::uint16_t toShare(float value) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * kShares));
}

template <class Matrix>
std::array<float, 12> rowsOf(const Matrix& matrix) {
    std::array<float, 12> rows{};
    auto at = rows.begin();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) *at++ = matrix(row, column);
    }
    return rows;
}

class Collector {
  public:
    Collector(const Groom& groom, std::span<const std::uint32_t> strands, AssetBuilder& builder)
        : groom_(groom), strands_(strands), builder_(builder) {}

    AssetScalp run() {
        const auto bindings = groom_.rootBindings();
        const bool bound = groom_.scalp && bindings.size() == groom_.strandCount();
        const bool boned = std::ranges::any_of(groom_.spheres, [](const auto& s) { return !s.bone.empty(); });
        if (bound || boned || (groom_.body && !groom_.body->bones.empty())) openCharacter();
        if (bound) addRoots(bindings);
        addSpheres();
        addBody();
        return std::move(result_);
    }

  private:
    void openCharacter() {
        scene_ = characterOf(groom_, result_.findings);
        if (!scene_ || scene_->skeleton.bones().size() <= kMaxBones) return;
        result_.findings.push_back({Severity::Warning,
                                    fmt::format("the head's bones are left out: {} are more than {}",
                                                scene_->skeleton.bones().size(), kMaxBones),
                                    "skin", "bind the head to fewer bones. Roots now move rigidly"});
        scene_.reset();
    }

    /// The asset's number of a bone of the skeleton.
    std::uint16_t boneOf(std::uint32_t index) {
        const auto [found, added] =
            boneNumbers_.emplace(index, static_cast<std::uint16_t>(result_.bones.size()));
        if (!added) return found->second;
        const Bone& bone = scene_->skeleton.bones()[index];
        asset::Bone record{};
        record.name = builder_.text(bone.name);
        record.index = index;
        record.inverseBind = rowsOf(bone.inverseBind.matrix());
        result_.bones.push_back(record);
        return found->second;
    }

    void addRoots(const std::vector<SurfacePoint>& bindings) {
        std::map<std::uint32_t, std::uint32_t> triangles, vertices;
        for (const std::uint32_t strand : strands_) triangles.emplace(bindings[strand].triangle, 0);
        for (auto& [triangle, number] : triangles) {
            for (const std::uint32_t vertex : groom_.scalp->triangles()[triangle])
                vertices.emplace(vertex, 0);
        }
        for (auto& [vertex, number] : vertices) number = addVertex(vertex);
        for (auto& [triangle, number] : triangles) {
            number = static_cast<std::uint32_t>(result_.triangles.size());
            asset::ScalpTriangle record{};
            for (std::size_t corner = 0; corner < 3; ++corner)
                record.vertices[corner] = vertices.at(groom_.scalp->triangles()[triangle][corner]);
            record.source = groom_.scalp->sourceFaces()[triangle];
            result_.triangles.push_back(record);
        }
        for (const std::uint32_t strand : strands_) {
            const SurfacePoint& root = bindings[strand];
            const std::uint16_t b = toShare(root.barycentric.y());
            const auto left = static_cast<std::uint16_t>(65535 - b);
            result_.roots.push_back(
                {triangles.at(root.triangle), b, std::min(toShare(root.barycentric.z()), left)});
        }
    }

    std::uint32_t addVertex(std::uint32_t vertex) {
        asset::ScalpVertex record{};
        const Vec3f& position = groom_.scalp->positions()[vertex];
        record.position = {position.x(), position.y(), position.z()};
        record.source = groom_.scalp->sourceVertices()[vertex];
        if (scene_ && vertex < scene_->skin.vertexCount()) {
            const FourWeights skin = strongestFour(scene_->skin, vertex);
            for (std::size_t i = 0; i < 4; ++i) {
                record.weights[i] = toShare(skin.weights[i]);
                if (record.weights[i] > 0) record.bones[i] = boneOf(skin.bones[i]);
            }
        }
        result_.vertices.push_back(record);
        result_.sources.push_back(vertex);
        return static_cast<std::uint32_t>(result_.vertices.size() - 1);
    }

    void addSpheres() {
        for (const CollisionSphere& sphere : groom_.spheres) {
            asset::Sphere record{};
            record.centre = {sphere.centre.x(), sphere.centre.y(), sphere.centre.z()};
            record.radius = sphere.radius;
            record.name = builder_.text(sphere.name);
            record.joined = static_cast<std::uint32_t>(sphere.joined + 1);
            record.bone = -1;
            if (!sphere.bone.empty()) {
                const auto bone = scene_ ? scene_->skeleton.find(sphere.bone) : std::nullopt;
                if (bone)
                    record.bone = boneOf(*bone);
                else
                    result_.findings.push_back(
                        {Severity::Warning, fmt::format("the asset has no bone '{}'", sphere.bone),
                         fmt::format("sphere '{}'", sphere.name), "it moves with the head"});
            }
            result_.spheres.push_back(record);
        }
    }

    void addBody() {
        if (!groom_.body) return;
        for (const runtime::String& own : groom_.body->bones) {
            const std::string name(own);
            const auto bone = scene_ ? scene_->skeleton.find(name) : std::nullopt;
            if (!bone) {
                result_.findings.push_back(
                    {Severity::Warning,
                     fmt::format(
                         "the skin collider is left out: the head's file has no bone '{}'. Hair meets "
                         "{} spheres",
                         name, groom_.spheres.size()),
                     "body", "fit it again on the character (colliders --fit field)"});
                return;
            }
            boneOf(*bone);
        }
        result_.body = runtime::packBody(*groom_.body);
        const bool isLarge = result_.body.size() > kLargeBody;
        result_.findings.push_back(
            {isLarge ? Severity::Warning : Severity::Info,
             fmt::format("the skin collider takes {:.0f} kB", static_cast<double>(result_.body.size()) / 1e3),
             "body", isLarge ? "fit it with fewer --kilobytes" : ""});
    }

    const Groom& groom_;
    std::span<const std::uint32_t> strands_;
    AssetBuilder& builder_;
    std::optional<ImportedScene> scene_;
    std::map<std::uint32_t, std::uint16_t> boneNumbers_;
    AssetScalp result_;
};

}  // namespace

AssetScalp collectScalp(const Groom& groom, std::span<const std::uint32_t> strands, AssetBuilder& builder) {
    return Collector(groom, strands, builder).run();
}

}  // namespace hairloom
