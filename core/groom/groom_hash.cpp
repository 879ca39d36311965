// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/groom_hash.h"

#include <bit>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/hash.h"
#include "core/groom/file/card_edits_json.h"
#include "core/groom/file/fields.h"
#include "core/groom/file/poses_json.h"
#include "core/groom/file/time_line_json.h"
#include "hairloom/body_field.h"

namespace hairloom {
namespace {

/// Gathers a hash over the parts of a groom; lengths are included, so that values cannot move between parts.
class Hasher {
  public:
    template <class T>
    void array(std::span<const T> values) {
        number(values.size());
        state_ = hashOf(values, state_);
    }
    void number(std::uint64_t value) { state_ = hashOf(std::span<const std::uint64_t>(&value, 1), state_); }
    void real(double value) { number(std::bit_cast<std::uint64_t>(value)); }
    void text(std::string_view value) { array(std::span<const char>(value)); }
    void texts(const std::vector<std::string>& values) {
        number(values.size());
        for (const std::string& value : values) text(value);
    }
    void vector(const Vec3f& value) { array(std::span<const float>(value.data(), 3)); }
    std::uint64_t result() const { return state_; }

  private:
    std::uint64_t state_ = 0;
};

void hashAttributes(Hasher& hasher, const AttributeSet& attributes) {
    hasher.number(attributes.all().size());
    for (const auto& [name, data] : attributes.all()) {
        hasher.text(name);
        hasher.text(typeName(data));
        std::visit([&](const auto& array) { hasher.array(array.view()); }, data);
    }
}

template <class S>
void hashFields(Hasher& hasher, const S& settings) {
    for (const Field<S>& field : fieldsOf(settings)) {
        if (field.kind == FieldKind::Seed) {
            hasher.number(runtime::member<std::uint64_t>(settings, field));
            continue;
        }
        if (field.kind == FieldKind::Ramp)
            hasher.array(runtime::member<runtime::Ramp>(settings, field).inUse());
        for (std::uint32_t c = 0; c < field.components(); ++c) hasher.real(field.get(settings, c));
    }
}

void hashSettings(Hasher& hasher, const Groom& groom) {
    hasher.number(groom.layers.size());
    for (const Layer& layer : groom.layers) {
        hasher.text(layer.name);
        hasher.number((layer.visible ? 1u : 0u) | (layer.locked ? 2u : 0u) | (layer.material ? 4u : 0u));
        hasher.real(static_cast<double>(layer.density));
        if (layer.material) hashFields(hasher, *layer.material);
    }
    hasher.number(groom.operators.size());
    for (const Operator& one : groom.operators) {
        hasher.text(one.op);
        // In order of name: the order in which a file has them says nothing.
        hasher.text(nlohmann::json::parse(one.settings).dump());
        hasher.number(one.enabled ? 1 : 0);
        hasher.real(static_cast<double>(one.weight));
        hasher.number(one.number);
    }
    hasher.texts(groom.groupNames);
    // None hashes as before masks had names.
    if (!groom.maskNames.empty()) hasher.texts(groom.maskNames);
    hasher.number(groom.spheres.size());
    for (const CollisionSphere& sphere : groom.spheres) {
        hasher.text(sphere.name);
        hasher.vector(sphere.centre);
        hasher.real(static_cast<double>(sphere.radius));
        hasher.text(sphere.bone);
        // None hashes as before there were capsules.
        if (sphere.joined >= 0) hasher.number(static_cast<std::uint64_t>(sphere.joined));
    }
    hasher.number(groom.cardEdits.size());
    if (groom.body) hasher.array(std::span<const std::uint8_t>(groom.body->toBytes()));
    for (const CardEdit& edit : groom.cardEdits) hasher.text(toJson(edit).dump());
    if (!groom.poses.empty()) hasher.text(toJson(groom.poses).dump());
    if (groom.timeLine) hasher.text(toJson(*groom.timeLine).dump());
    hashFields(hasher, groom.material);
    hashFields(hasher, groom.shadows);
    hashFields(hasher, groom.interpolation);
    hashFields(hasher, groom.placement);
    hashFields(hasher, groom.simulation);
    hasher.text(groom.scalpExpression);
    // Where it lies is no part of what it is.
    hasher.text(std::filesystem::path(groom.characterFile).filename().string());
    hasher.real(static_cast<double>(groom.characterMetresPerUnit));
}

void hashStrands(Hasher& hasher, const Groom& groom) {
    hasher.array(groom.offsets.view());
    hashAttributes(hasher, groom.strandAttributes);
    hashAttributes(hasher, groom.pointAttributes);
    hasher.array(std::span<const std::uint32_t>(groom.scalpSelection));
    hasher.array(std::span<const float>(groom.scalpDensity));
    hasher.array(std::span<const Triangle>(groom.triangulation.triangles));
    hasher.array(std::span<const RootTriangulation::Coincident>(groom.triangulation.coincident));
    hasher.array(std::span<const std::uint32_t>(groom.triangulation.alone));
}

void hashScalp(Hasher& hasher, const ScalpMesh* scalp) {
    hasher.number(scalp ? 1 : 0);
    if (!scalp) return;
    hasher.array(scalp->positions());
    hasher.array(scalp->normals());
    hasher.array(scalp->triangles());
    hasher.array(scalp->cornerUvs());
    hasher.array(scalp->sourceFaces());
    hasher.array(scalp->sourceVertices());
    hasher.array(scalp->triangleGroups());
    hasher.array(scalp->triangleMaterials());
    hasher.texts(scalp->groupNames());
    hasher.texts(scalp->materialNames());
    for (const MeshRepair& repair : scalp->repairs()) {
        hasher.text(repair.what);
        hasher.number(repair.count);
    }
}

}  // namespace

std::uint64_t contentHash(const Groom& groom) {
    Hasher hasher;
    hashStrands(hasher, groom);
    hashSettings(hasher, groom);
    hashScalp(hasher, groom.scalp.get());
    return hasher.result();
}

}  // namespace hairloom
