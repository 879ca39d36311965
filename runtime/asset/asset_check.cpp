// SPDX-License-Identifier: MIT
// Whether the records of an asset fit each other.
#include <algorithm>
#include <cmath>

#include "asset/asset_error.h"
#include "asset/asset_points.h"
#include "engine/checks.h"
#include "hairloom/asset.h"

namespace hairloom::runtime {

using namespace asset;

namespace {

using Problem = std::optional<AssetError>;

/// Whether all are numbers of which none is beyond ±1e6.
bool allWithin(std::span<const float> values) {
    return std::all_of(std::begin(values), std::end(values),
                       [](float value) { return std::abs(value) <= kFarthest; });
}

/// Whether two directions are of unit length and perpendicular.
bool isFrame(Float3 a, Float3 b) {
    constexpr float kSlack = 1e-3f;
    return std::abs(dot(a, a) - 1) <= kSlack && std::abs(dot(b, b) - 1) <= kSlack &&
           std::abs(dot(a, b)) <= kSlack;
}

bool inside(Text place, std::span<const char> text) {
    return place.at <= text.size() && place.bytes <= text.size() - place.at;
}

/// Most points of an asset, so that counts fit 32 bits with room to spare.
constexpr std::uint64_t kMaxAssetPoints = 1u << 30u;
constexpr std::uint32_t kMaxHairsPerGuide = 4096;
constexpr float kLargestArea = 1e12f;

}  // namespace

Problem Asset::checkContent() const {
    for (const auto& check :
         {&Asset::checkStrands, &Asset::checkPoints, &Asset::checkScalp, &Asset::checkFollowHairs,
          &Asset::checkLayers, &Asset::checkSettings, &Asset::checkAttributes, &Asset::checkLevels,
          &Asset::checkBody, &Asset::checkClip, &Asset::checkMaterials, &Asset::checkPoses}) {
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
    return std::nullopt;
}

Problem Asset::checkPoints() const {
    const std::array<float, 3>&low = header().boundsMin, &high = header().boundsMax;
    if (!allWithin(low) || !allWithin(high)) return damaged(32, "bounds that are no numbers within 1e6 m");
    const std::byte* residual = residuals.data();
    for (std::size_t s = 0; s < strands.size(); ++s) {
        const Strand& strand = strands[s];
        AssetGrid least{}, most{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto cell = [&](float metres) { return std::ldexp(double{metres}, strand.gridBits); };
            least[axis] = static_cast<std::int64_t>(std::floor(cell(low[axis])));
            most[axis] = static_cast<std::int64_t>(std::ceil(cell(high[axis])));
        }
        bool inside = true;
        forPoints(strand, residual, [&](const AssetGrid& at) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                inside = inside && at[axis] >= least[axis] && at[axis] <= most[axis];
        });
        if (!inside) return damaged(placeOf(&strand), "strand " + number(s) + " leaves the file's bounds");
    }
    return std::nullopt;
}

Problem Asset::checkScalp() const {
    for (const Bone& bone : bones) {
        if (!inside(bone.name, texts) || !allWithin(bone.inverseBind))
            return damaged(placeOf(&bone), "a bone without name or matrix");
    }
    for (const ScalpVertex& vertex : scalpVertices) {
        bool known = allWithin(vertex.position);
        for (std::size_t i = 0; i < 4; ++i)
            known = known && (vertex.weights[i] == 0 || vertex.bones[i] < bones.size());
        if (!known)
            return damaged(placeOf(&vertex),
                           "a vertex of the scalp without place within 1e6 m, or that hangs on no bone");
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
        if (std::uint32_t{root.b} + root.c > 65535u)
            return damaged(placeOf(&root), "a root beside its triangle");
    }
    std::size_t capsules = 0;
    for (const asset::Sphere& sphere : spheres) {
        if (sphere.joined > 0 && ++capsules > kMaxCapsules)
            return damaged(placeOf(&sphere), "more than " + number(kMaxCapsules) + " capsules");
        if (sphere.joined > spheres.size() || &spheres[0] + sphere.joined == &sphere + 1)
            return damaged(placeOf(&sphere), "a capsule with sphere " + number(sphere.joined - 1) + " of " +
                                                 number(spheres.size()) + ", or to itself");
        const bool boned =
            sphere.bone >= -1 && (sphere.bone < 0 || static_cast<std::size_t>(sphere.bone) < bones.size());
        if (!boned || !inside(sphere.name, texts) || !allWithin(sphere.centre) || !(sphere.radius > 0) ||
            sphere.radius > kFarthest)
            return damaged(placeOf(&sphere), "a sphere without name, place or bone");
    }
    return std::nullopt;
}

Problem Asset::checkBody() const {
    if (body().empty()) return std::nullopt;
    const BodyFieldRead read = readBody();
    if (!read.field) return damaged(placeOf(body().data()), "the skin collider: " + read.error);
    if (bonesOf(*read.field).size() != read.field->bones.size())
        return damaged(placeOf(body().data()), "a skin collider on a bone that the file does not have");
    return std::nullopt;
}

Problem Asset::checkLayers() const {
    for (const Layer& layer : layers) {
        if (!inside(layer.name, texts) || !(layer.density >= 0 && layer.density <= kFarthest) ||
            layer.ownMaterial > 1)
            return damaged(placeOf(&layer), "a layer without name or density");
    }
    if (!strandLayers.empty() && strandLayers.size() != strands.size())
        return damaged(placeOf(strandLayers.data()),
                       number(strandLayers.size()) + " layers of " + number(strands.size()) + " strands");
    for (const std::uint16_t& layer : strandLayers) {
        if (layer >= layers.size())
            return damaged(placeOf(&layer),
                           "a strand on layer " + number(layer) + " of " + number(layers.size()));
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
    for (const float value : {r.radiusRoot, r.radiusTip, r.blend, r.shiftStep}) {
        if (!(value >= 0 && value <= 1)) return wrong("with a radius, blend or step that is not from 0 to 1");
    }
    const float limits[] = {r.beginAngle, r.endAngle, r.beginSpread, r.endSpread};
    if (!allWithin(limits) || !(r.endAngle > r.beginAngle) || !(r.endSpread > r.beginSpread))
        return wrong("with a parting that ends before it begins");
    for (const Guide& guide : guides) {
        const std::array<float, 3>&n = guide.normal, &a = guide.axis;
        if (guide.strand >= strands.size() || !isFrame({n[0], n[1], n[2]}, {a[0], a[1], a[2]}))
            return damaged(placeOf(&guide), "a guide that is no strand or has no frame");
    }
    for (const GuideTriangle& triangle : guideTriangles) {
        const bool known = std::all_of(std::begin(triangle.guides), std::end(triangle.guides),
                                       [&](std::uint32_t g) { return g < guides.size(); });
        if (!known || !(triangle.area >= 0 && triangle.area <= kLargestArea))
            return damaged(placeOf(&triangle), "a triangle of guides that there are not, or without area");
    }
    if (!guideHairs.empty() && guideHairs.size() != guides.size())
        return damaged(placeOf(guideHairs.data()), number(guideHairs.size()) + " numbers of hairs for " +
                                                       number(guides.size()) + " guides");
    std::uint64_t hairs = 0;
    for (std::size_t guide = 0; guide < guides.size(); ++guide) {
        if (hairsOf(guide) > r.hairsPerGuide)
            return damaged(placeOf(&guideHairs[guide]), "more hairs of a guide than any has");
        hairs += hairsOf(guide);
    }
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

Problem Asset::checkAttributes() const {
    const std::size_t room = attributeValues().size();
    for (const Attribute& attribute : attributes()) {
        const auto wrong = [&](const std::string& words) {
            return damaged(placeOf(&attribute), "an attribute " + words);
        };
        if (!inside(attribute.name, texts)) return wrong("without name");
        if (attribute.type > AttributeType::float32 || attribute.components < 1 || attribute.components > 4)
            return wrong("of a type that there is not");
        if (attribute.firstByte % 4 != 0 || attribute.firstByte > room ||
            bytesOf(attribute) * strands.size() > room - attribute.firstByte)
            return wrong("whose values are not in the file");
        if (minor() < kMinorOfStiffness || nameOf(attribute) != kStiffnessName) continue;
        if (attribute.type != AttributeType::float32 || attribute.components != 1)
            return wrong("'stiffness' that is not one float32 of each strand");
        const float* const factors = reinterpret_cast<const float*>(valuesOf(attribute).data());
        for (std::size_t s = 0; s < strands.size(); ++s) {
            if (!(factors[s] >= 0 && factors[s] <= kMostStiffness))
                return damaged(placeOf(factors + s), "a stiffness of strand " + number(s) + " that is " +
                                                         std::to_string(factors[s]) + "; expected 0 to " +
                                                         number(static_cast<std::size_t>(kMostStiffness)));
        }
    }
    return std::nullopt;
}

Problem Asset::checkLevels() const {
    for (const auto errors : {levelErrors(), seenErrors()}) {
        if (errors.empty()) continue;
        if (errors.size() != kLevels)
            return damaged(placeOf(errors.data()),
                           number(errors.size()) + " levels of detail; expected " + number(kLevels));
        for (const MeasuredLevel& error : errors) {
            for (const float value : {error.still, error.head, error.wind}) {
                if (!(value >= 0 && value <= kFarthest))
                    return damaged(placeOf(&error), "a level of detail whose error is no length");
            }
        }
    }
    return std::nullopt;
}

}  // namespace hairloom::runtime
