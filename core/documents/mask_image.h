// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What people paint in other programs as a mask of strands or of the scalp.

#include <cstdint>
#include <optional>
#include <span>
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
    /// As it was painted, 0xrrggbb; nothing where it is more transparent than not.
    std::optional<std::uint32_t> colourAt(const Vec2f& uv) const;
    /// Colours that fill at least 0.2 % of the image, from the highest number down. Black and what is
    /// transparent are no colour. Error: less than nine tenths of the image are of such colours, as in a
    /// photograph.
    Result<std::vector<std::uint32_t>> flatColours() const;

  private:
    std::optional<std::uint32_t> colourOf(std::size_t pixel) const;
    std::size_t pixelAt(const Vec2f& uv) const;

    render::LinearImage image_;
};

/// One value for each strand, at its root UV. Errors: strands without root UVs, or one that is not finite.
Result<std::vector<float>> valuesAtRoots(const MaskImage& image, const Groom& groom);
/// What is painted in one colour.
struct ColourRegion {
    std::string name;  ///< "red", or "#c04010"
    std::uint32_t rgb = 0;
    std::vector<float> shares;  ///< one for each strand, 1 inside
    std::size_t strands = 0;    ///< inside
};
std::string colourName(std::uint32_t rgb);
/// A region for each colour of the image; roots between colours, as at soft edges, belong to the nearest,
/// which may be black, and then to none. Errors: those of flatColours() and valuesAtRoots(), and an image
/// without regions.
Result<std::vector<ColourRegion>> regionsAtRoots(const MaskImage& image, const Groom& groom);
/// Names for the masks that the regions fill, one for each: that of its colour, where the mask has none or
/// that of another colour; empty where somebody called it otherwise.
std::vector<std::string> namesOfRegions(const Groom& groom, std::span<const std::uint32_t> masks,
                                        std::span<const ColourRegion> regions);
/// One value for each vertex, the mean of those that its corners have. Errors: a mesh without UVs.
Result<std::vector<float>> valuesAtVertices(const MaskImage& image, const ScalpMesh& mesh);

}  // namespace hairloom
