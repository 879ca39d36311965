// SPDX-License-Identifier: MIT
// Whether the records of an asset fit each other.
#include <algorithm>
#include <cmath>

#include "hairloom/asset.h"
#include "src/asset_error.h"

namespace hairloom::runtime {

using namespace asset;

namespace {

using Problem = std::optional<AssetError>;

bool allFinite(std::span<const float> values) {
    return std::all_of(std::begin(values), std::end(values),
                       [](float value) { return std::isfinite(value); });
}

bool inside(Text place, std::span<const char> text) {
    return place.at <= text.size() && place.bytes <= text.size() - place.at;
}

/// Most points of an asset, so that counts fit 32 bits with room to spare.
constexpr std::uint64_t kMaxAssetPoints = 1u << 30u;
constexpr std::uint32_t kMaxHairsPerGuide = 4096;

}  // namespace

Problem Asset::checkContent() const {
    for (const auto& check :
         {&Asset::checkStrands, &Asset::checkScalp, &Asset::checkFollowHairs, &Asset::checkSettings}) {
        if (Problem problem = (this->*check)()) return problem;
    }
    return std::nullopt;
}

Problem Asset::checkStrands() const {
    std::uint64_t points = 0, residualBytes = 0;
    for (std::size_t s = 0; s < strands.size(); ++s) {
        const Strand& strand = strands[s];
        const auto wrong = [&](const std::string& words) {
            return damaged(placeOf(&strand), "strand " + number(s) + " " + words);
        };
        if (strand.points < 2 || strand.points > kMaxPoints)
            return wrong("has " + number(strand.points) + " points; expected 2 to " + number(kMaxPoints));
        if (strand.gridBits < kMinGridBits || strand.gridBits > kMaxGridBits)
            return wrong("has a grid of " + number(strand.gridBits) + " bits; expected 15 to 24");
        if (strand.residualBytes != 4 && strand.residualBytes != 6 && strand.residualBytes != 12)
            return wrong("has residuals of " + number(strand.residualBytes) + " bytes; expected 4, 6 or 12");
        residualBytes += std::uint64_t{strand.points - 2u} * strand.residualBytes;
        points += strand.points;
    }
    if (points != header().points || points > kMaxAssetPoints)
        return damaged(
            56, number(header().points) + " points in the header, " + number(points) + " in the strands");
    if (residualBytes != residuals.size())
        return damaged(placeOf(residuals.data()),
                       number(residuals.size()) + " bytes of residuals; expected " + number(residualBytes));
    if (!radii.empty() && radii.size() != points)
        return damaged(placeOf(radii.data()),
                       number(radii.size()) + " radii of " + number(points) + " points");
    if (!allFinite(header().boundsMin) || !allFinite(header().boundsMax))
        return damaged(32, "bounds that are not finite");
    return std::nullopt;
}

Problem Asset::checkScalp() const {
    for (const Bone& bone : bones) {
        if (!inside(bone.name, texts) || !allFinite(bone.inverseBind))
            return damaged(placeOf(&bone), "a bone without name or matrix");
    }
    for (const ScalpVertex& vertex : scalpVertices) {
        bool known = allFinite(vertex.position);
        for (std::size_t i = 0; i < 4; ++i)
            known = known && (vertex.weights[i] == 0 || vertex.bones[i] < bones.size());
        if (!known)
            return damaged(placeOf(&vertex), "a vertex of the scalp that is not finite or hangs on no bone");
    }
    for (const ScalpTriangle& triangle : scalpTriangles) {
        for (const std::uint32_t vertex : triangle.vertices) {
            if (vertex >= scalpVertices.size())
                return damaged(placeOf(&triangle), "a triangle of the scalp with vertex " + number(vertex) +
                                                       " of " + number(scalpVertices.size()));
        }
    }
    if (!roots.empty() && roots.size() != strands.size())
        return damaged(placeOf(roots.data()),
                       number(roots.size()) + " roots of " + number(strands.size()) + " strands");
    for (const Root& root : roots) {
        if (root.triangle >= scalpTriangles.size())
            return damaged(placeOf(&root), "a root in triangle " + number(root.triangle) + " of " +
                                               number(scalpTriangles.size()));
    }
    for (const asset::Sphere& sphere : spheres) {
        const bool boned =
            sphere.bone >= -1 && (sphere.bone < 0 || static_cast<std::size_t>(sphere.bone) < bones.size());
        if (!boned || !inside(sphere.name, texts) || !allFinite(sphere.centre) || !(sphere.radius > 0) ||
            !std::isfinite(sphere.radius))
            return damaged(placeOf(&sphere), "a sphere without name, place or bone");
    }
    return std::nullopt;
}

Problem Asset::checkFollowHairs() const {
    if (recipe.empty()) return std::nullopt;
    const Recipe& r = recipe[0];
    const auto wrong = [&](const std::string& words) {
        return damaged(placeOf(&r), "follow hairs " + words);
    };
    if (recipe.size() != 1) return wrong("by " + number(recipe.size()) + " recipes; expected one");
    if (r.hairsPerGuide > kMaxHairsPerGuide || r.pointsPerHair < 2 || r.pointsPerHair > kMaxPoints)
        return wrong("of " + number(r.pointsPerHair) + " points, " + number(r.hairsPerGuide) +
                     " of each guide");
    const float numbers[] = {r.radiusRoot, r.radiusTip, r.blend, r.shiftStep};
    if (!allFinite(numbers) || r.radiusRoot < 0 || r.radiusTip < 0 || r.blend < 0 || r.blend > 1 ||
        r.shiftStep < 0)
        return wrong("with a radius, blend or step out of range");
    const float limits[] = {r.beginAngle, r.endAngle, r.beginSpread, r.endSpread};
    if (!allFinite(limits) || !(r.endAngle > r.beginAngle) || !(r.endSpread > r.beginSpread))
        return wrong("with a parting that ends before it begins");
    for (const Guide& guide : guides) {
        if (guide.strand >= strands.size() || !allFinite(guide.normal) || !allFinite(guide.axis))
            return damaged(placeOf(&guide), "a guide that is no strand or has no frame");
    }
    for (const GuideTriangle& triangle : guideTriangles) {
        const bool known = std::all_of(std::begin(triangle.guides), std::end(triangle.guides),
                                       [&](std::uint32_t g) { return g < guides.size(); });
        if (!known || !(triangle.area >= 0) || !std::isfinite(triangle.area))
            return damaged(placeOf(&triangle), "a triangle of guides that there are not, or without area");
    }
    const std::uint64_t hairs = std::uint64_t{r.hairsPerGuide} * guides.size();
    if (hairs * r.pointsPerHair > kMaxAssetPoints)
        return wrong("of " + number(hairs) + " hairs; that is too many");
    if (!rootShifts.empty() && rootShifts.size() != hairs)
        return damaged(placeOf(rootShifts.data()),
                       number(rootShifts.size()) + " root shifts of " + number(hairs) + " hairs");
    for (const FarRootShift& shift : farRootShifts) {
        if (shift.hair >= hairs)
            return damaged(placeOf(&shift),
                           "a root shift of hair " + number(shift.hair) + " of " + number(hairs));
    }
    return std::nullopt;
}

Problem Asset::checkSettings() const {
    for (const Setting& setting : settings) {
        const auto wrong = [&](const std::string& words) {
            return damaged(placeOf(&setting), "a setting " + words);
        };
        if (!inside({setting.name, setting.nameBytes}, texts)) return wrong("without name");
        if (setting.firstValue > values.size() || setting.count > values.size() - setting.firstValue)
            return wrong("whose values are not in the file");
        for (const double value : valuesOf(setting)) {
            if (!std::isfinite(value)) return wrong("that is not finite");
        }
        if (setting.kind > ValueKind::ramp) return wrong("of a kind that there is not");
        const bool pair = setting.kind == ValueKind::choice || setting.kind == ValueKind::seed;
        if (pair && setting.count != 2) return wrong("of " + number(setting.count) + " values; expected 2");
        if (pair) {
            for (const double value : valuesOf(setting)) {
                if (!(value >= 0) || value > 4294967295.0) return wrong("with a value out of range");
            }
        }
        if (setting.kind == ValueKind::choice) {
            const auto place = valuesOf(setting);
            if (!inside({static_cast<std::uint32_t>(place[0]), static_cast<std::uint32_t>(place[1])}, texts))
                return wrong("without choice");
        }
        if (setting.kind == ValueKind::ramp && (setting.count % 2 != 0 || setting.count > 2 * Ramp::kMaxKeys))
            return wrong("with a ramp of " + number(setting.count) + " numbers");
    }
    return std::nullopt;
}

}  // namespace hairloom::runtime
