// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From a skinned mesh to the signed distances that hair collides with.

#include <memory>

#include "core/animation/actor.h"
#include "core/base/result.h"
#include "core/geometry/scalp_mesh.h"
#include "core/groom/groom.h"
#include "hairloom/body_field.h"

namespace hairloom {

struct BakeBodyOptions {
    /// Metres between distances near the skin: the finest of which a field fits into `mostBytes`, but no
    /// finer.
    float finest = 0.002f;
    std::size_t mostBytes = 300'000;
    /// Where hair comes in the mesh's rest space, as reachOfHair() tells; empty: anywhere.
    Box3f where;
};

/// Around all places that hair can reach at rest, with 2 cm beyond.
Box3f reachOfHair(const Groom& groom);

/// How far the baked skin is from the mesh, at its vertices and in the middle of its triangles, but for those
/// that lie inside.
struct BodyFit {
    float worstGap = 0;    ///< metres that the mesh lies outside the field
    float meanGap = 0;     ///< metres, of all places, 0 where it does not
    float worstBulge = 0;  ///< metres that the field lies outside the mesh
    Vec3f worstGapAt_ss = Vec3f::Zero();
};

struct BakedBody {
    std::shared_ptr<const runtime::BodyField> field;
    BodyFit fit;
    float cell = 0;                  ///< metres between distances near the skin
    std::vector<std::string> notes;  ///< what people should know: coarser than asked for, bones left out …
};

/// Sign by winding number and size by the nearest point (geometry/mesh_solid.h), in the mesh's rest space;
/// each place goes with the bones of the nearest skin. Without a skin the body moves as a whole. The same
/// bits for any number of threads. Errors: a mesh that encloses nothing, weights that do not fit it, more
/// than 255 bones, a body that does not fit even in cells of 5 cm (with the size that it would have).
/// `boneNames` has the name of each bone that `skin` speaks of, or none at all.
Result<BakedBody> bakeBody(const ScalpMesh& mesh, const SkinWeights& skin,
                           std::span<const std::string> boneNames = {}, const BakeBodyOptions& options = {});

/// How far a field is from a mesh in its rest space, 0 throughout where the mesh encloses nothing.
BodyFit measureBody(const ScalpMesh& mesh, const runtime::BodyField& field);

/// Of the groom's scalp where its hair reaches, moved by the skin of `actor` where there is one. Errors: no
/// scalp, a character of another mesh, those above.
Result<BakedBody> bakeBodyOf(const Groom& groom, const Actor* actor, const BakeBodyOptions& options = {});

}  // namespace hairloom
