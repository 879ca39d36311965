// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/geometry/placement_area.h"

namespace hairloom {
namespace {

constexpr double kMaxPerCm2 = 10'000;
constexpr double kMaxRoots = 5e6;
constexpr double kCm2PerM2 = 1e4;

/// Picks faces in proportion to their weight in constant expected time (the cutpoint method, Chen and Asau
/// 1974).
class FacePicker {
  public:
    explicit FacePicker(const std::vector<double>& weights)
        : cumulated_(weights.size()), first_(weights.size()) {
        double sum = 0;
        for (std::size_t i = 0; i < weights.size(); ++i) cumulated_[i] = sum += weights[i];
        std::size_t face = 0;
        for (std::size_t i = 0; i < first_.size(); ++i) {
            const double bound = sum * static_cast<double>(i) / static_cast<double>(first_.size());
            while (cumulated_[face] <= bound && face + 1 < cumulated_.size()) ++face;
            first_[i] = static_cast<std::uint32_t>(face);
        }
    }
    /// `u` in [0, 1)
    std::size_t pick(double u) const {
        const double bound = u * cumulated_.back();
        std::size_t face = first_[static_cast<std::size_t>(u * static_cast<double>(first_.size()))];
        while (cumulated_[face] <= bound && face + 1 < cumulated_.size()) ++face;
        return face;
    }

  private:
    std::vector<double> cumulated_;
    std::vector<std::uint32_t> first_;
};

Vec3f uniformBarycentric(Random& random) {
    float a = random.uniform(), b = random.uniform();
    if (a + b > 1) {
        a = 1 - a;
        b = 1 - b;
    }
    return {std::max(0.0f, 1 - a - b), a, b};
}

/// Points of a face in proportion to a density that is linear over it.
Vec3f pointByDensity(Random& random, const Vec3f& densities) {
    const float maximum = densities.maxCoeff();
    Vec3f point = uniformBarycentric(random);
    while (random.uniform() * maximum >= point.dot(densities)) point = uniformBarycentric(random);
    return point;
}

}  // namespace

Status checkPlacement(const ScalpMesh& mesh, const FaceSet& faces, std::span<const float> mask) {
    if (faces.empty()) return fail("no face of the scalp is selected", "at least one face");
    if (!mask.empty() && mask.size() != mesh.vertexCount())
        return fail(fmt::format("the density mask has {} values", mask.size()),
                    fmt::format("one for each of the {} vertices", mesh.vertexCount()));
    for (std::size_t v = 0; v < mask.size(); ++v)
        if (!(mask[v] >= 0 && mask[v] <= 1))
            return fail(fmt::format("the density mask is {} at vertex {}", mask[v], v),
                        "a value from 0 to 1");
    if (!(maskedArea(mesh, faces, mask) > 0))
        return fail("the density mask is 0 on the whole selection", "a positive value somewhere");
    return {};
}

double relativeRadius(double minRootDistance, std::size_t roots, double squareMetres) {
    if (roots < 2 || !(squareMetres > 0)) return 0;
    return minRootDistance / std::sqrt(2 / std::sqrt(3.0) * squareMetres / static_cast<double>(roots));
}

double maskedArea(const ScalpMesh& mesh, const FaceSet& faces, std::span<const float> mask) {
    double area = 0;
    for (const std::uint32_t face : faces)
        area += static_cast<double>(mesh.triangleArea(face)) *
                cornerDensities(mesh, mask, face).cast<double>().mean();
    return area;
}

Result<std::size_t> requestedCount(const PlacementRequest& request, double maskedSquareMetres) {
    const double cm2 = maskedSquareMetres * kCm2PerM2;
    const double maximum = std::min(kMaxRoots, kMaxPerCm2 * cm2);
    const bool byDensity = request.densityPerCm2 != 0;
    const double wanted =
        byDensity ? std::round(request.densityPerCm2 * cm2) : static_cast<double>(request.count);
    if (byDensity && !(request.densityPerCm2 > 0 && std::isfinite(request.densityPerCm2)))
        return fail(fmt::format("a density of {} roots per cm²", request.densityPerCm2), "a positive number");
    if (wanted < 1)
        return fail("the request is for no root", byDensity ? fmt::format("at least {:.3g} per cm²", 1 / cm2)
                                                            : std::string("a count of at least 1"));
    if (wanted > maximum)
        return fail(fmt::format("{:.0f} roots on {:.4g} cm² are {:.4g} per cm²", wanted, cm2, wanted / cm2),
                    fmt::format("at most {:.4g} per cm²", maximum / cm2));
    return static_cast<std::size_t>(wanted);
}

Result<Placement> placeRandom(const ScalpMesh& mesh, const FaceSet& faces, const PlacementRequest& request) {
    if (Status status = checkPlacement(mesh, faces, request.mask); !status)
        return tl::unexpected(status.error());
    const Result<std::size_t> count = requestedCount(request, maskedArea(mesh, faces, request.mask));
    if (!count) return tl::unexpected(count.error());
    std::vector<double> weights;
    weights.reserve(faces.size());
    for (const std::uint32_t face : faces)
        weights.push_back(static_cast<double>(mesh.triangleArea(face)) *
                          cornerDensities(mesh, request.mask, face).cast<double>().mean());
    const FacePicker picker(weights);
    Random random(request.seed);
    Placement placement;
    placement.roots.resize(*count);
    for (SurfacePoint& root : placement.roots) {
        root.triangle = faces[picker.pick(random.uniformDouble())];
        root.barycentric = request.mask.empty()
                               ? uniformBarycentric(random)
                               : pointByDensity(random, cornerDensities(mesh, request.mask, root.triangle));
    }
    return placement;
}

float minimumRootDistance(const ScalpMesh& mesh, std::span<const SurfacePoint> roots) {
    std::vector<Vec3f> points;
    points.reserve(roots.size());
    for (const SurfacePoint& root : roots) points.push_back(mesh.pointAt(root.triangle, root.barycentric));
    std::sort(points.begin(), points.end(), [](const Vec3f& a, const Vec3f& b) { return a.x() < b.x(); });
    float nearest = std::numeric_limits<float>::infinity();  // squared
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = i + 1; j < points.size(); ++j) {
            const float dx = points[j].x() - points[i].x();
            if (dx * dx >= nearest) break;
            nearest = std::min(nearest, (points[j] - points[i]).squaredNorm());
        }
    return std::sqrt(nearest);
}

}  // namespace hairloom
