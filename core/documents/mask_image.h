// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What people paint in other programs as a mask of strands or of the scalp.

#include <string>
#include <vector>

#include "core/groom/groom.h"
#include "core/render/image.h"

namespace hairloom {

/// A PNG whose luminance is a share, as it was painted and not made linear; what is transparent counts less.
/// (0, 0) is its lower left corner, and it repeats.
class MaskImage {
  public:
    /// Errors: as readPicture(), which names the file.
    static Result<MaskImage> read(const std::string& path);
    /// 0 … 1.
    float at(const Vec2f& uv) const;

  private:
    render::LinearImage image_;
};

/// One value for each strand, at its root UV. Errors: strands without root UVs, or one that is not finite.
Result<std::vector<float>> valuesAtRoots(const MaskImage& image, const Groom& groom);
/// One value for each vertex, the mean of those that its corners have. Errors: a mesh without UVs.
Result<std::vector<float>> valuesAtVertices(const MaskImage& image, const ScalpMesh& mesh);

}  // namespace hairloom
