// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/live/groom_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"
#include "core/geometry/curve.h"
#include "core/geometry/selection.h"
#include "core/groom/file/fields.h"
#include "core/groom/move_strands.h"
#include "core/groom/point_dye.h"
#include "core/groom/point_width.h"
#include "core/interpolation/follow_hairs.h"
#include "core/live/hair_look.h"
#include "core/live/head_tint.h"
#include "core/live/root_rotations.h"
#include "core/simulation/body_push.h"
#include "core/simulation/simulation.h"

namespace hairloom {
namespace {

/// The same strands are in streaks, white and dyed, as strands and not the material say.
bool hasSameWeights(const HairMaterial& a, const HairMaterial& b) {
    return a.streakShare == b.streakShare && a.streakWidth == b.streakWidth &&
           a.streakSoftness == b.streakSoftness && a.streakSeed == b.streakSeed &&
           a.dyeStrength == b.dyeStrength && a.greyShare == b.greyShare && a.greySeed == b.greySeed &&
           a.dyeRegrowth == b.dyeRegrowth;
}

/// For a dye that has grown out, which most brushes leave where it is on the strand.
bool hasSameLength(std::span<const Vec3f> before, std::span<const Vec3f> now) {
    constexpr float kShare = 0.01f;
    const float length = polylineLength(before);
    return std::abs(polylineLength(now) - length) <= kShare * length;
}

bool sameFollowHairs(const InterpolationSettings& a, const InterpolationSettings& b) {
    return std::ranges::all_of(fieldsOf(InterpolationSettings()),
                               [&](const Field<InterpolationSettings>& field) {
                                   for (std::uint32_t c = 0; c < field.components(); ++c) {
                                       if (field.get(a, c) != field.get(b, c)) return false;
                                   }
                                   return true;
                               });
}

}  // namespace

bool drawSameHairs(const Groom& a, const Groom& b) {
    const auto sameLayer = [](const Layer& x, const Layer& y) {
        return x.visible == y.visible && x.density == y.density;
    };
    constexpr std::array kDeciding{attribute::kLayer, attribute::kGuide, attribute::kHidden,
                                   attribute::kStrandId};
    const bool sameStrands = std::ranges::all_of(kDeciding, [&](std::string_view name) {
        return a.strandAttributes.version(name) == b.strandAttributes.version(name);
    });
    return a.offsets.version() == b.offsets.version() && sameStrands && a.scalp == b.scalp &&
           sameFollowHairs(a.interpolation, b.interpolation) &&
           std::ranges::equal(a.layers, b.layers, sameLayer);
}

Result<GroomScene> GroomScene::make(const Groom& groom, const ViewFile& view,
                                    const std::vector<std::string>& hiddenGroups) {
    GroomScene scene;
    scene.rest_ = scene.posed_ = groom;
    scene.materials_ = strandMaterials(groom, view);
    // The view's radius goes before the points' own.
    if (view.rootRadius || view.tipScale) {
        scene.rest_.pointAttributes.erase(attribute::kRadius);
        scene.posed_.pointAttributes.erase(attribute::kRadius);
    }
    scene.matte_ = view.headAlbedo.has_value();
    if (!groom.scalp && !hiddenGroups.empty())
        return fail("there is no head to hide groups of",
                    "expected a head, which `create` and `import --mesh` set");
    if (groom.scalp) {
        const auto hidden = facesOfGroups(*groom.scalp, hiddenGroups);
        if (!hidden) return tl::unexpected(hidden.error());
        // A view's albedo is that of the whole head.
        const Vec3f skin = view.headAlbedo.value_or(render::RenderMesh().albedo);
        if (!scene.matte_) scene.tint_ = headTint(groom);
        scene.vertexAlbedo_ = scene.matte_ ? std::vector<Vec3f>(groom.scalp->vertexCount(), skin)
                                           : tinted(skin, groom.material.rootColour, scene.tint_);
        for (const std::uint32_t face : invertSelection(*groom.scalp, *hidden)) {
            const Triangle& triangle = groom.scalp->triangles()[face];
            scene.indices_.insert(scene.indices_.end(), triangle.begin(), triangle.end());
        }
    }
    if (groom.interpolation.followPerGuide == 0 || groom.strandCount() == 0) {
        scene.push_ = makeBodyPush(groom, groom.offsets.view(), groom.positions());
        scene.materials_.ofStrands = materialsOfStrands(groom);
        if (scene.materials_.hasLook()) scene.weights_ = weightsOfStrands(groom);
        scene.takeWidths();
        scene.clumping_ = render::measureClumping(scene.scene().strands);
        return scene;
    }

    auto bindings = bindFollowHairs(groom, groom.interpolation);
    if (!bindings) return tl::unexpected(bindings.error());
    for (std::size_t hair = 0; hair <= bindings->hairCount(); ++hair) {
        scene.hairOffsets_.push_back(static_cast<std::uint32_t>(hair * bindings->pointsPerHair));
    }
    scene.follow_.emplace(groom, *bindings);
    auto made = runtime::FollowHairs::make(scene.follow_->view());
    if (!made.hairs) return tl::unexpected(errorOfWords(made.error));
    scene.followHairs_ = std::move(made.hairs);
    scene.bindings_ = std::move(*bindings);
    scene.materials_.ofStrands = materialsOfFollowHairs(groom, *scene.bindings_);
    if (scene.materials_.hasLook()) {
        auto weights = weightsOfFollowHairs(groom, *scene.bindings_);
        if (!weights) return tl::unexpected(weights.error());
        scene.weights_ = std::move(*weights);
    }
    scene.makeFollowHairs({}, {});
    scene.takeWidths();
    scene.push_ = makeBodyPush(groom, scene.hairOffsets_, scene.hairPositions_ws_);
    scene.clumping_ = render::measureClumping(scene.scene().strands);
    return scene;
}

void GroomScene::pose(std::span<const Vec3f> positions_ws, std::span<const Vec3f> velocities_ws,
                      const HeadPose& pose) {
    posed_ = posedGroom(rest_, positions_ws, pose);
    if (bindings_) return makeFollowHairs(velocities_ws, pose);
    if (!push_) return;
    std::vector<Vec3f> drawn(positions_ws.begin(), positions_ws.end());
    pushOutOfBody(*push_, rest_, pose, drawn);
    posed_.pointAttributes.set(attribute::kPosition, std::move(drawn));
}

bool GroomScene::moveStrands(std::span<const std::uint32_t> strands, std::span<const Vec3f> points_ws) {
    std::size_t first = 0;
    for (const std::uint32_t strand : strands) {
        const std::span<const Vec3f> before = rest_.strand(strand);
        const auto now = points_ws.subspan(first, before.size());
        if (bindings_ && now[0] != before[0]) return false;
        if (!weights_.lengths.empty() && !hasSameLength(before, now)) return false;
        first += before.size();
    }
    hairloom::moveStrands(posed_, strands, points_ws);
    if (!bindings_) return true;
    bindingOld_ = true;
    makeFollowHairs({}, {});
    return true;
}

bool GroomScene::setMaterials(const Groom& groom, const ViewFile& view) {
    const HairMaterial &authored = groom.material, &before = rest_.material;
    if (!hasSameWeights(authored, before)) return false;
    const bool sameOwners =
        std::ranges::equal(groom.layers, rest_.layers, [](const Layer& a, const Layer& b) {
            return a.material.has_value() == b.material.has_value() &&
                   (!a.material || hasSameWeights(*a.material, *b.material));
        });
    if (!sameOwners) return false;
    if (authored.rootColour != before.rootColour && !tint_.empty())
        vertexAlbedo_ = tinted(render::RenderMesh().albedo, authored.rootColour, tint_);
    rest_.material = authored;
    rest_.layers = groom.layers;
    StrandMaterials now = strandMaterials(rest_, view);
    now.ofStrands = std::move(materials_.ofStrands);
    materials_ = std::move(now);
    makeRadii();
    return true;
}

bool GroomScene::setDye(const Groom& groom) {
    if (weights_.pointDyes.empty() || !groom.pointAttributes.has(attribute::kPointDye)) return false;
    rest_.pointAttributes.set(attribute::kPointDye,
                              groom.pointAttributes.all().find(attribute::kPointDye)->second);
    weights_.pointDyes = bindings_ ? pointDyesOfFollowHairs(rest_, *bindings_) : pointDyes(rest_);
    return true;
}

bool GroomScene::setWidths(const Groom& groom) {
    if (widthChanges_.empty() || !groom.pointAttributes.has(attribute::kWidthChange)) return false;
    rest_.pointAttributes.set(attribute::kWidthChange,
                              groom.pointAttributes.all().find(attribute::kWidthChange)->second);
    takeWidths();
    return hasPaintedWidths();
}

void GroomScene::takeWidths() {
    const auto changes = widthChanges(rest_);
    widthChanges_ = changes.empty() ? std::vector<float>()
                    : bindings_     ? followHairValues(rest_, *bindings_, changes)
                                    : std::vector<float>(changes.begin(), changes.end());
    makeRadii();
}

void GroomScene::makeRadii() {
    radii_.clear();
    if (widthChanges_.empty() || posed_.strandCount() == 0) return;
    radii_ = paintedRadii(scene().strands.front(), widthChanges_);
}

void GroomScene::makeFollowHairs(std::span<const Vec3f> velocities_ws, const HeadPose& pose) {
    const auto asEngine = [](std::span<const Vec3f> values) {
        static_assert(sizeof(Vec3f) == sizeof(runtime::Float3));
        return std::span(reinterpret_cast<const runtime::Float3*>(values.data()), values.size());
    };
    static_assert(sizeof(Quatf) == sizeof(runtime::Quat));
    const std::vector<Quatf> rotations = rootRotations(rest_, posed_, pose);
    hairPositions_ws_.resize(follow_->hairCount() * follow_->pointsPerHair());
    runtime::GuideMotion guides;
    guides.positions_ws = asEngine(posed_.positions());
    guides.velocities_ws = asEngine(velocities_ws);
    guides.rootRotations_ws = {reinterpret_cast<const runtime::Quat*>(rotations.data()), rotations.size()};
    runtime::Host host;
    host.parallelFor = parallelFor;
    followHairs_->evaluate(
        guides, {reinterpret_cast<runtime::Float3*>(hairPositions_ws_.data()), hairPositions_ws_.size()},
        host);
    if (push_) pushOutOfBody(*push_, rest_, pose, hairPositions_ws_);
}

render::RenderScene GroomScene::scene() const {
    render::RenderScene scene;
    if (!indices_.empty()) {
        render::RenderMesh mesh;
        mesh.positions_ws = posed_.scalp->positions();
        mesh.normals_ws = posed_.scalp->normals();
        mesh.indices = indices_;
        mesh.vertexAlbedo = vertexAlbedo_;
        mesh.matte = matte_;
        scene.meshes.push_back(mesh);
    }
    if (posed_.strandCount() == 0) return scene;
    scene.clumping = clumping_;
    render::RenderStrands strands;
    strands.material = materials_.material;
    strands.others = materials_.others;
    strands.materials = materials_.ofStrands;
    if (hairOffsets_.empty()) {
        strands.offsets = posed_.offsets.view();
        strands.positions_ws = posed_.positions();
        strands.radii = posed_.pointAttributes.view<float>(attribute::kRadius);
        strands.colours = posed_.strandAttributes.view<Vec3f>(attribute::kStrandColour);
    } else {
        strands.offsets = hairOffsets_;
        strands.positions_ws = hairPositions_ws_;
    }
    if (!radii_.empty()) strands.radii = radii_, strands.radiiOfAll = true;
    strands.streaks = weights_.streaks;
    strands.dyes = weights_.dyes;
    strands.pointDyes = weights_.pointDyes;
    strands.pigments = weights_.pigments;
    strands.lengths = weights_.lengths;
    scene.strands.push_back(strands);
    return scene;
}

Box3f GroomScene::subject() const {
    render::RenderScene hair = scene();
    hair.meshes.clear();
    Box3f box = render::boundsOf(hair);
    Box3f all = box;
    for (const std::uint32_t vertex : indices_) all.extend(posed_.scalp->positions()[vertex]);
    if (box.isEmpty() || !posed_.scalp) return all;
    for (const std::uint32_t triangle : posed_.scalpSelection) {
        for (const std::uint32_t vertex : posed_.scalp->triangles()[triangle]) {
            box.extend(posed_.scalp->positions()[vertex]);
        }
    }
    // Short hair covers the upper half of a head; a picture of it shows the face too.
    constexpr float kHeadHeight = 0.27f;
    box.min().y() = std::min(box.min().y(), box.max().y() - kHeadHeight);
    return box.intersection(all);
}

}  // namespace hairloom
