// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The document: strands on a scalp, with everything an artist authored. Copying is cheap (arrays are shared
// until written), so undo, jobs and snapshots hold whole grooms.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/root_triangulation.h"
#include "core/geometry/scalp_mesh.h"
#include "core/groom/attributes.h"
#include "core/groom/card_edits.h"
#include "core/groom/groom_pose.h"
#include "core/groom/material.h"
#include "core/groom/operator_stack.h"
#include "core/groom/shadow_settings.h"
#include "hairloom/settings.h"

namespace hairloom {

struct TimeLine;
namespace runtime {
struct BodyField;
}

/// A sphere that strands collide with, fixed to a bone.
struct CollisionSphere {
    std::string name;
    Vec3f centre = Vec3f::Zero();  ///< metres, in the scalp's rest space
    float radius = 0.1f;           ///< metres, > 0
    std::string bone;              ///< bone it moves with; empty: with the scalp as a rigid whole
    /// Number of another sphere of the groom, with which it makes a tapered capsule; −1: it stays a sphere.
    std::int32_t joined = -1;
};

/// Strands that are shown, locked, coloured and edited together.
struct Layer {
    std::string name = "Hair";
    bool visible = true;
    bool locked = false;
    float density = 1;                     ///< 0 … kMaxLayerDensity, times followPerGuide for its guides
    std::optional<HairMaterial> material;  ///< in place of the groom's, and of what points say of thickness
};
inline constexpr float kMaxLayerDensity = 4;

inline constexpr std::size_t kLongestMaskName = 64;  ///< bytes

/// How follow hairs come from guides (thesis §4.2). fieldsOf() describes the members.
struct InterpolationSettings {
    std::uint32_t followPerGuide = 0;
    float wispRadiusRoot = 0.002f;
    float wispRadiusTip = 0.004f;
    float wispSpread = 0.15f;
    float wispSpreadLimit = 10;
    float blend = 0.5f;
    bool drawGuides = false;
    std::uint64_t seed = 1;
};

enum class PlacementMethod : std::uint32_t {
    random,       ///< anywhere, by area
    poissonDisk,  ///< at even distances, by dart throwing
};

/// How roots are placed on the scalp selection and what grows from them. fieldsOf() describes the members.
struct PlacementSettings {
    PlacementMethod placement = PlacementMethod::poissonDisk;
    std::uint32_t count = 3000;
    float densityPerCm2 = 0;
    float length = 0.15f;
    std::uint32_t points = 16;
    std::uint64_t seed = 1;
};

struct Groom {
    /// Strand s owns points [offsets[s], offsets[s + 1]), root first. Size: strands + 1, first 0, ascending.
    CowArray<std::uint32_t> offsets{std::vector<std::uint32_t>{0}};
    AttributeSet strandAttributes;
    AttributeSet pointAttributes;

    /// What makes the positions out of attribute::kBasePosition, which is there where there are operators.
    std::vector<Operator> operators;

    std::vector<Layer> layers{Layer{}};
    std::vector<std::string> groupNames;
    /// Of painted masks, from mask 1 on, at most kPaintedMasks. Those that are empty or missing have none.
    std::vector<std::string> maskNames;
    std::vector<CollisionSphere> spheres;
    /// What rods collide with beside spheres: the skin of `scalp`, baked (hairloom/body_field.h), with the
    /// names of the bones that move it; null: none. Shared and immutable. Goes with its scalp.
    std::shared_ptr<const runtime::BodyField> body;
    HairMaterial material;
    ShadowSettings shadows;
    runtime::SimulationSettings simulation;
    InterpolationSettings interpolation;
    PlacementSettings placement;
    std::vector<CardEdit> cardEdits;  ///< of levels of detail
    /// Their shapes are point attributes, poseAttribute().
    std::vector<GroomPose> poses;
    /// What moves and changes when (core/groom/time_line.h); null: nothing. Shared and immutable.
    std::shared_ptr<const TimeLine> timeLine;

    /// The mesh that strands are rooted on; null for hair that came without one. Shared and immutable.
    std::shared_ptr<const ScalpMesh> scalp;
    FaceSet scalpSelection;           ///< triangles of `scalp` that may carry hair
    std::vector<float> scalpDensity;  ///< per vertex of `scalp`, 0 … 1, of roots; empty: 1 everywhere
    std::string scalpExpression;      ///< how the selection was made, for people; may be empty
    RootTriangulation triangulation;  ///< over the strands' roots; empty until made
    std::string characterFile;        ///< file that the scalp came from (mesh, skeleton, clips); may be empty
    float characterMetresPerUnit = 0;  ///< metres in one unit of that file; 0 as the file states

    std::size_t strandCount() const { return offsets.empty() ? 0 : offsets.size() - 1; }
    std::size_t pointCount() const { return offsets.empty() ? 0 : offsets[offsets.size() - 1]; }

    std::span<const Vec3f> positions() const { return pointAttributes.view<Vec3f>(attribute::kPosition); }
    std::span<const Vec3f> strand(std::size_t index) const {
        return positions().subspan(offsets[index], offsets[index + 1] - offsets[index]);
    }

    /// What the strands of a layer look like.
    const HairMaterial& materialOf(std::size_t layer) const {
        const bool own = layer < layers.size() && layers[layer].material;
        return own ? *layers[layer].material : material;
    }

    /// Strands whose guide flag is set; all of them where there are no flags.
    std::size_t guideCount() const;
    Box3f bounds() const;

    /// Per strand, where the root binding attributes are; empty for unbound hair.
    std::vector<SurfacePoint> rootBindings() const;
    void setRootBindings(std::span<const SurfacePoint> roots);
};

/// A groom of these strands with position and offsets and nothing else. `offsets` as in Groom.
Groom makeGroom(std::vector<std::uint32_t> offsets, std::vector<Vec3f> positions);

/// Whether a point attribute belongs to the operators: their base shape, or the strokes of a sculpt.
bool isOperatorAttribute(std::string_view name);
/// Leaves the positions as they are; operators, their base shape and their strokes go.
void dropOperators(Groom& groom);

/// Straight strands along the interpolated scalp normals (thesis §4.1), bound to the scalp, each with
/// `points` ≥ 2 points over `length` metres, with ids, root UVs, radius tapered as the material says, and the
/// Delaunay triangulation of the roots, which lists those that make no triangle as alone. Errors: no scalp,
/// an empty selection, a root beside it, a length or number of points out of range.
Result<Groom> growStraight(std::shared_ptr<const ScalpMesh> scalp, FaceSet selection,
                           std::span<const SurfacePoint> roots, float length, std::uint32_t points);

/// Binds each root to the nearest point of the selection (which becomes all of the scalp where it is empty),
/// replaces scalp and selection of the groom, empties the triangulation (and the density map of another
/// scalp), and returns the distance of each root to its binding, metres. `scalp` has triangles; strands have
/// points.
std::vector<float> bindToScalp(Groom& groom, std::shared_ptr<const ScalpMesh> scalp, FaceSet selection);

}  // namespace hairloom
