// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a recorded frame says of a groom, as vectors: points, the scalp's vertices, sphere centres and poses
// of the body's bones.

#include <cstdint>
#include <span>
#include <vector>

#include "core/simulation/frame_record.h"

namespace hairloom {

inline constexpr std::uint64_t kVectorsPerBone = 4;
inline constexpr std::uint64_t kMostBones = 255;

struct FrameCounts {
    std::uint64_t points = 0;
    std::uint64_t vertices = 0;  ///< of the scalp; 0 where there is none
    std::uint64_t spheres = 0;
    std::uint64_t bones = 0;  ///< of the body, 1 where it moves as a whole
};
FrameCounts frameCounts(const Groom& groom);
/// Errors, at `place` in `file`: a record of another number of points, vertices or spheres.
Status checkCounts(const FrameCounts& counts, const Groom& groom, const std::string& file, Byte place);

/// Of a groom, without its hair.
class FrameVectors {
  public:
    explicit FrameVectors(const Groom& groom);

    /// Appends vertices and spheres, with what the pose leaves to the rigid motion of the head written out.
    void appendHead(std::vector<Vec3f>& values, const HeadPose& pose) const;
    /// Appends kVectorsPerBone of each bone: the columns of its matrix, from the body at rest to the world.
    /// All 0 where the pose does not say where the body is.
    void appendBody(std::vector<Vec3f>& values, const HeadPose& pose) const;

  private:
    std::vector<Vec3f> scalpRest_, sphereRest_;
    Groom bodyOnly_;
    std::uint64_t bones_;
};

/// A frame of points, then what appendHead() and appendBody() wrote for `counts`. Where the groom's body has
/// other bones, that has no pose: the record is from before it was fitted.
RecordedFrame frameFrom(std::span<const Vec3f> values, const FrameCounts& counts, const Groom& groom);

}  // namespace hairloom
