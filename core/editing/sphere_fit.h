// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Collision spheres for a head, a neck and shoulders, found rather than placed.

#include <cstdint>
#include <vector>

#include "core/groom/groom.h"

namespace hairloom::editing {

inline constexpr std::uint32_t kMaxSpheres = 64;  ///< of one fit

struct SphereFitOptions {
    std::uint32_t count = 12;  ///< spheres, 1 … kMaxSpheres
    FaceSet region;            ///< ascending; the skin that is to be covered. Empty: all of the mesh
    float largestRadius = 0;   ///< metres; 0: as fits the mesh, largestSphereIn()
    std::uint64_t seed = 1;
};

struct SphereFit {
    std::vector<CollisionSphere> spheres;  ///< without bones
    float worstGap = 0;    ///< metres; deepest that skin of the region lies outside all spheres
    float meanGap = 0;     ///< metres; of the skin outside, by vertex
    float worstBulge = 0;  ///< metres; deepest that skin lies in a sphere, which holds hair off it
    Vec3f worstGapAt_ss = Vec3f::Zero();
};

/// Spheres whose union lies as close to the skin as so many can: chosen among the largest that fit inside,
/// then moved and resized by least squares. Errors: an empty mesh, options out of range.
Result<SphereFit> fitSpheres(const ScalpMesh& mesh, const SphereFitOptions& options);

/// The radius up to which spheres of a fit are sought: half of what the mesh measures where it is thinnest,
/// or 0.2 m where that is more.
float largestSphereIn(const Box3f& bounds);

/// Joins spheres of one bone in tapered capsules, one after the other, where that covers most of the region
/// (all skin where it is empty) that lies outside. No capsule holds hair farther off the skin than `error`
/// metres, or than the spheres do already.
void joinSpheres(const ScalpMesh& mesh, const FaceSet& region, float error,
                 std::vector<CollisionSphere>& spheres);

/// 1 for each vertex of the region (all faces where it is empty), 0 for others.
std::vector<std::uint8_t> verticesOf(const ScalpMesh& mesh, const FaceSet& region);

/// How well spheres, and capsules between them, cover the vertices of a region (all where it is empty).
SphereFit measureSpheres(const ScalpMesh& mesh, const FaceSet& region, std::vector<CollisionSphere> spheres);

/// Faces whose middle is within `distance` metres of hair: where spheres matter.
FaceSet facesNearHair(const Groom& groom, float distance);

}  // namespace hairloom::editing
