// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "core/geometry/curve.h"
#include "core/groom/findings.h"
#include "core/groom/point_dye.h"
#include "core/groom/point_width.h"
#include "core/groom/white_strands.h"
#include "hairloom/strands.h"

namespace hairloom {
namespace {

constexpr float kShortestSegment = 1e-7f;   ///< metres; shorter ones have no usable direction
constexpr float kSmallestHair = 0.002f;     ///< metres of a groom's diagonal, below any groom worn on a head
constexpr float kLargestHair = 10.0f;       ///< metres of a groom's diagonal
constexpr float kLargestRadius = 0.005f;    ///< metres
constexpr float kBarycentricSlack = 1e-4f;  ///< of the sum from 1
constexpr float kRootDistance = 0.001f;     ///< metres between a root and its place on the scalp

/// The domain element that holds a not finite value, for each attribute.
void findNotFinite(const AttributeSet& attributes, std::string_view domain, std::vector<Finding>& findings) {
    for (const auto& [name, data] : attributes.all()) {
        Places places;
        std::visit(
            [&]<class T>(const CowArray<T>& array) {
                for (std::size_t i = 0; i < array.size(); ++i) {
                    if constexpr (std::is_same_v<T, float>) {
                        if (!std::isfinite(array[i])) places.other(domain, i);
                    } else if constexpr (!std::is_integral_v<T>) {
                        if (!array[i].allFinite()) places.other(domain, i);
                    }
                }
            },
            data);
        places.report(findings, Severity::Error, fmt::format("{} is not finite", name),
                      "delete these strands or fix the values");
    }
}

void findSegments(const Groom& groom, std::vector<Finding>& findings) {
    Places places;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const auto points = groom.strand(s);
        for (std::size_t p = 1; p < points.size(); ++p) {
            if ((points[p] - points[p - 1]).norm() < kShortestSegment) places.point(s, p);
        }
    }
    places.report(findings, Severity::Error, "a segment has no length", "resample the strand or delete it");
}

void findRadii(const Groom& groom, std::vector<Finding>& findings) {
    const auto radii = groom.pointAttributes.view<float>(attribute::kRadius);
    Places negative;
    for (std::size_t p = 0; p < radii.size(); ++p) {
        if (radii[p] < 0) negative.other("point", p);
    }
    negative.report(findings, Severity::Error, "a radius is negative", "set the radius to 0 or more");
    for (Finding& finding : findThickHair(groom)) findings.push_back(std::move(finding));
    Places wrong;
    const auto changes = groom.pointAttributes.view<float>(attribute::kWidthChange);
    for (std::size_t p = 0; p < changes.size(); ++p) {
        if (!(changes[p] >= -1 && changes[p] <= kMaxWidthChange)) wrong.other("point", p);
    }
    wrong.report(findings, Severity::Error,
                 fmt::format("the painted width is not from -1 to {}", kMaxWidthChange),
                 "paint the width again");
}

void findSize(const Groom& groom, std::vector<Finding>& findings) {
    if (groom.pointCount() == 0) return;
    const float diagonal = groom.bounds().diagonal().norm();
    if (diagonal >= kSmallestHair && diagonal <= kLargestHair) return;
    findings.push_back({Severity::Warning,
                        fmt::format("the hair measures {} m from corner to corner", diagonal), "bounds",
                        diagonal > kLargestHair ? "import it in a smaller unit, such as cm or mm"
                                                : "import it in a larger unit, such as m"});
}

void findFlags(const Groom& groom, std::vector<Finding>& findings) {
    for (const std::string_view name :
         {attribute::kGuide, attribute::kFrozen, attribute::kSelected, attribute::kHidden}) {
        const auto flags = groom.strandAttributes.view<std::uint8_t>(name);
        Places places;
        for (std::size_t s = 0; s < flags.size(); ++s) {
            if (flags[s] > 1) places.strand(s);
        }
        places.report(findings, Severity::Warning, fmt::format("{} is neither 0 nor 1", name),
                      "set it to 0 or 1");
    }
}

void findIds(const Groom& groom, std::vector<Finding>& findings) {
    const auto ids = groom.strandAttributes.view<std::uint32_t>(attribute::kStrandId);
    std::vector<std::uint32_t> sorted(ids.begin(), ids.end());
    std::sort(sorted.begin(), sorted.end());
    Places places;
    for (std::size_t i = 1; i < sorted.size(); ++i) {
        if (sorted[i] == sorted[i - 1]) places.other("id", sorted[i]);
    }
    places.report(findings, Severity::Error, "two strands have the same id", "number the strands again");
}

void findDensities(const Groom& groom, std::vector<Finding>& findings) {
    Places places;
    for (std::size_t v = 0; v < groom.scalpDensity.size(); ++v) {
        if (!(groom.scalpDensity[v] >= 0 && groom.scalpDensity[v] <= 1)) places.other("vertex", v);
    }
    places.report(findings, Severity::Error, "the density of roots is not from 0 to 1",
                  "paint the density again");
}

void findDye(const Groom& groom, std::vector<Finding>& findings) {
    const auto mask = groom.strandAttributes.view<float>(attribute::kDye);
    Places places;
    for (std::size_t s = 0; s < mask.size(); ++s) {
        if (!(mask[s] >= 0 && mask[s] <= 1)) places.strand(s);
    }
    const auto points = groom.pointAttributes.view<float>(attribute::kPointDye);
    const auto isShare = [](float value) { return value >= 0 && value <= 1; };
    for (std::size_t s = 0; s < groom.strandCount() && !points.empty(); ++s) {
        const std::size_t count = groom.offsets[s + 1] - groom.offsets[s];
        if (!std::ranges::all_of(points.subspan(groom.offsets[s], count), isShare)) places.strand(s);
    }
    places.report(findings, Severity::Error, "the dye mask is not from 0 to 1", "dye the strands again");
}

void findMelanin(const Groom& groom, std::vector<Finding>& findings) {
    const auto melanin = groom.strandAttributes.view<float>(attribute::kMelanin);
    Places places;
    for (std::size_t s = 0; s < melanin.size(); ++s) {
        if (!(melanin[s] >= 0 && melanin[s] <= kMostMelanin)) places.strand(s);
    }
    places.report(findings, Severity::Error, "the melanin of strands is not from 0 to 8",
                  "set the melanin again");
}

void findStiffness(const Groom& groom, std::vector<Finding>& findings) {
    const auto stiffness = groom.strandAttributes.view<float>(attribute::kStiffness);
    Places places;
    for (std::size_t s = 0; s < stiffness.size(); ++s) {
        if (!(stiffness[s] >= 0 && stiffness[s] <= runtime::kMostStiffness)) places.strand(s);
    }
    places.report(findings, Severity::Error,
                  fmt::format("the stiffness of strands is not from 0 to {}", runtime::kMostStiffness),
                  "set the stiffness again");
}

void findTriangleBindings(const Groom& groom, std::span<const SurfacePoint> roots,
                          std::vector<Finding>& findings) {
    std::vector<std::uint8_t> selected(groom.scalp->triangleCount(), groom.scalpSelection.empty() ? 1 : 0);
    for (const std::uint32_t triangle : groom.scalpSelection) selected[triangle] = 1;
    Places outside;
    Places barycentric;
    Places away;
    for (std::size_t s = 0; s < roots.size(); ++s) {
        const auto& [triangle, weights] = roots[s];
        if (!selected[triangle]) outside.strand(s);
        const bool good = weights.minCoeff() >= 0 && std::abs(weights.sum() - 1.0f) <= kBarycentricSlack;
        if (!good) {
            barycentric.strand(s);
        } else if ((groom.scalp->pointAt(triangle, weights) - groom.strand(s)[0]).norm() > kRootDistance) {
            away.strand(s);
        }
    }
    outside.report(findings, Severity::Warning, "a strand has its root outside the scalp selection",
                   "grow the selection or bind the strands to the scalp again");
    barycentric.report(findings, Severity::Error, "root barycentrics are negative or do not add up to 1",
                       "bind the strands to the scalp again");
    away.report(findings, Severity::Warning,
                fmt::format("a root is more than {} m away from its binding", kRootDistance),
                "bind the strands to the scalp again");
}

}  // namespace

void findGeometry(const Groom& groom, std::vector<Finding>& findings) {
    if (groom.strandCount() == 0) {
        findings.push_back({Severity::Info, "there are no strands", "groom", "import or grow some"});
    }
    const std::size_t before = findings.size();
    findNotFinite(groom.pointAttributes, "point", findings);
    findNotFinite(groom.strandAttributes, "strand", findings);
    if (!hasErrors({findings.begin() + static_cast<std::ptrdiff_t>(before), findings.end()})) {
        findSegments(groom, findings);
        findSize(groom, findings);
    }
    findRadii(groom, findings);
    findFlags(groom, findings);
    findIds(groom, findings);
    findDensities(groom, findings);
    findDye(groom, findings);
    findMelanin(groom, findings);
    findStiffness(groom, findings);
}

void findBinding(const Groom& groom, std::vector<Finding>& findings) {
    if (!groom.scalp || groom.strandCount() == 0) return;
    const auto roots = groom.rootBindings();
    if (roots.empty()) {
        findings.push_back({Severity::Warning, "the strands are not bound to the scalp", "strands",
                            "bind them, or they stay in place when the head moves"});
        return;
    }
    findTriangleBindings(groom, roots, findings);
}

std::vector<Finding> findThickHair(const Groom& groom) {
    const auto radii = groom.pointAttributes.view<float>(attribute::kRadius);
    Places thick;
    for (std::size_t p = 0; p < radii.size(); ++p) {
        if (radii[p] > kLargestRadius) thick.other("point", p);
    }
    std::vector<Finding> findings;
    thick.report(findings, Severity::Warning, fmt::format("a radius is above {} m", kLargestRadius),
                 "check the unit of the file that the strands came from; a hair has 25e-6 to 60e-6 m");
    return findings;
}

}  // namespace hairloom
