// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How strongly an operation acts where: by a painted map and along the strand. One mechanism for all that
// move points: what they did is kept by the mask's share.

#include <functional>
#include <string>
#include <vector>

#include "core/groom/file/json_reader.h"
#include "core/operations/painted_maps.h"

namespace hairloom {

/// The map's share times the ramp's and the formula's. fieldsOf() describes the members but the formula.
struct Mask {
    MaskMap map = MaskMap::none;
    bool invert = false;
    runtime::Ramp ramp;   ///< over the share of the strand's length
    std::string formula;  ///< of core/operations/formula.h, held to 0 … 1; empty: 1

    /// Acts everywhere with full strength.
    bool isWhole() const { return map == MaskMap::none && ramp == runtime::Ramp() && formula.empty(); }
};
std::span<const Field<Mask>> fieldsOf(const Mask&);
/// The member "mask", whole where it is absent. A formula that does not read is a complaint of the reader.
Mask readMask(JsonReader& reader);
nlohmann::ordered_json toJson(const Mask& mask);
/// The fields for lists and the reference page.
const std::vector<FieldRow>& scriptMaskFields();

/// One share for each point, 0 … 1, on strands that have these positions. Error: a formula that gives no
/// number, or asks for UVs that there are none of.
Result<std::vector<float>> maskShares(const Groom& groom, const Mask& mask, std::span<const Vec3f> positions);
/// Whether it reads what is painted: that map, or any.
bool readsMap(const Mask& mask, MaskMap map);
bool readsMaps(const Mask& mask);
/// Differs where what it reads of the groom differs.
std::string mapState(const Groom& groom, const Mask& mask);

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
