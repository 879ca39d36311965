// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How strongly an operation acts where: by a painted map and along the strand. One mechanism for all that
// move points: what they did is kept by the mask's share.

#include <functional>
#include <string>
#include <vector>

#include "core/groom/file/json_reader.h"

namespace hairloom {

/// What is painted.
enum class MaskMap : std::uint32_t { none, density, dye, mask1, mask2, mask3, mask4 };
inline constexpr std::uint32_t kPaintedMasks = 4;

/// "mask.1": float per strand in [0, 1]; 0 where nothing was painted. `number` counts from 1.
std::string maskAttribute(std::uint32_t number);

/// The map's share times the ramp's. fieldsOf() describes the members.
struct Mask {
    MaskMap map = MaskMap::none;
    bool invert = false;
    runtime::Ramp ramp;  ///< over the share of the strand's length

    /// Acts everywhere with full strength.
    bool isWhole() const { return map == MaskMap::none && ramp == runtime::Ramp(); }
};
std::span<const Field<Mask>> fieldsOf(const Mask&);
/// The member "mask", whole where it is absent.
Mask readMask(JsonReader& reader);
/// The fields for lists and the reference page.
const std::vector<FieldRow>& scriptMaskFields();

/// One share for each point, 0 … 1, on strands that have these positions.
std::vector<float> maskShares(const Groom& groom, const Mask& mask, std::span<const Vec3f> positions);
/// Differs where what is painted on a map differs.
std::string mapState(const Groom& groom, MaskMap map);

/// The same for all points, or one for each.
struct BlendShares {
    float all = 1;
    std::span<const float> ofPoints{};
    float at(std::size_t point) const { return ofPoints.empty() ? all : all * ofPoints[point]; }
};
/// A share of the way from one shape of the groom's strands to another; segments get a length between those
/// that they have in both. A strand keeps its bits up to the first point that has a share.
std::vector<Vec3f> blendShapes(const Groom& groom, std::span<const Vec3f> from, std::span<const Vec3f> to,
                               const BlendShares& shares);

/// Runs an edit of the groom's points and keeps the mask's share of it. Returns the number of strands that
/// changed. Errors: those of the edit; a map of the scalp where hair is bound to none.
Result<std::size_t> runMasked(Groom& groom, const Mask& mask,
                              const std::function<Result<std::size_t>(Groom&)>& edit);

}  // namespace hairloom
