// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/shadow_truth.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/render/passes.h"

namespace hairloom::render {
namespace {

/// Metres in front of a fibre in which hair does not count, as the shading has it.
double biasOf(const RenderStrands& strands, std::uint32_t point) {
    return static_cast<double>(strands.radii[point]);
}

/// Unit, of the strand at one of its points.
shaders::float4 directionAt(const RenderStrands& strands, std::uint32_t point) {
    const auto after = std::ranges::upper_bound(strands.offsets, point);
    const std::uint32_t a = point > *(after - 1) ? point - 1 : point,
                        b = point + 1 < *after ? point + 1 : point;
    return toShader(Vec3f(strands.positions_ws[b] - strands.positions_ws[a]).normalized(), 0);
}

/// Length of the part of a segment that lies inside a disc around the origin.
double insideDisc(const Vec2d& a, const Vec2d& b, double radius) {
    const Vec2d d = b - a;
    const double qa = d.squaredNorm(), qb = 2 * a.dot(d), qc = a.squaredNorm() - radius * radius;
    if (qa <= 0) return 0;
    const double discriminant = qb * qb - 4 * qa * qc;
    if (discriminant <= 0) return 0;
    const double root = std::sqrt(discriminant);
    const double t0 = std::clamp((-qb - root) / (2 * qa), 0.0, 1.0);
    const double t1 = std::clamp((-qb + root) / (2 * qa), 0.0, 1.0);
    return (t1 - t0) * std::sqrt(qa);
}

/// Marches a beam from a point towards the light through all strands.
class Beam {
  public:
    Beam(const RenderStrands& strands, const Vec3d& toLight)
        : strands_(strands),
          toLight_(toLight.normalized()),
          right_(
              (std::abs(toLight_.x()) < 0.9 ? Vec3d::UnitX() : Vec3d::UnitY()).cross(toLight_).normalized()),
          up_(toLight_.cross(right_)) {}

    double fibresBefore(const Vec3d& p, double bias) const {
        double area = 0;
        for (std::size_t s = 0; s + 1 < strands_.offsets.size(); ++s) {
            for (std::uint32_t k = strands_.offsets[s]; k + 1 < strands_.offsets[s + 1]; ++k) {
                area += shadeOf(strands_.positions_ws[k].cast<double>() - p,
                                strands_.positions_ws[k + 1].cast<double>() - p, bias) *
                        2 * static_cast<double>(strands_.radii[k]);
            }
        }
        return area / (static_cast<double>(kPi) * kShadowFootprint * kShadowFootprint);
    }

  private:
    /// Length of a segment in front of the point and within the beam, seen from the light.
    double shadeOf(Vec3d a, Vec3d b, double bias) const {
        const double da = a.dot(toLight_) - bias, db = b.dot(toLight_) - bias;
        if (da <= 0 && db <= 0) return 0;
        if (da < 0) a += (b - a) * (-da / (db - da));
        if (db < 0) b += (a - b) * (-db / (da - db));
        return insideDisc({a.dot(right_), a.dot(up_)}, {b.dot(right_), b.dot(up_)}, kShadowFootprint);
    }

    const RenderStrands& strands_;
    Vec3d toLight_, right_, up_;
};

/// Whether a ray meets a triangle in front of its origin (Möller and Trumbore 1997).
bool meets(const Vec3d& origin, const Vec3d& direction, const std::array<Vec3d, 3>& corners) {
    const Vec3d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
    const Vec3d p = direction.cross(ac);
    const double determinant = ab.dot(p);
    if (std::abs(determinant) < 1e-18) return false;
    const Vec3d to = origin - corners[0];
    const double u = to.dot(p) / determinant;
    const Vec3d q = to.cross(ab);
    const double v = direction.dot(q) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 && ac.dot(q) / determinant > 0;
}

bool isVisible(const RenderMesh& mesh, const Vec3d& from, const Vec3d& toLight) {
    for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
        std::array<Vec3d, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
            corners[k] = mesh.positions_ws[mesh.indices[t + k]].cast<double>();
        if (meets(from, toLight, corners)) return false;
    }
    return true;
}

double rootMeanSquare(double sum, std::size_t count) {
    return std::sqrt(sum / static_cast<double>(count));
}

}  // namespace

ShadowCases countFibres(const RenderScene& scene, std::size_t count, std::uint64_t seed) {
    const RenderStrands& strands = scene.strands.front();
    const Beam beam(strands, scene.lights.front().toLight_ws.cast<double>());
    ShadowCases result;
    Random random(seed);
    for (std::size_t i = 0; i < count; ++i) {
        const auto at = random.below(static_cast<std::uint32_t>(strands.positions_ws.size()));
        result.cases.push_back({toShader(strands.positions_ws[at], static_cast<float>(biasOf(strands, at))),
                                directionAt(strands, at)});
    }
    result.counted.resize(count);
    parallelFor(count, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const shaders::float4& p = result.cases[i].position_ws;
            result.counted[i] =
                beam.fibresBefore(Vec3f(p.x, p.y, p.z).cast<double>(), static_cast<double>(p.w));
        }
    });
    return result;
}

Result<double> shadowError(gpu::Device& device, const RenderScene& scene, const ShadowCases& cases,
                           RenderOptions options, const std::optional<DeepLayers>& layers) {
    options.subdivisions = 1;
    const auto results = probeLight(device, scene, options, cases.cases, layers);
    if (!results) return tl::unexpected(results.error());
    double sum = 0;
    for (std::size_t i = 0; i < cases.counted.size(); ++i) {
        const double found = static_cast<double>((*results)[i].onHair.w);
        const double error = std::exp(-0.5 * found) - std::exp(-0.5 * cases.counted[i]);
        sum += error * error;
    }
    return rootMeanSquare(sum, cases.counted.size());
}

HeadCases castRays(const RenderScene& scene, std::size_t count, std::uint64_t seed) {
    const RenderStrands& strands = scene.strands.front();
    const std::span<const Vec3f> points = strands.positions_ws;
    const Vec3d toLight = scene.lights.front().toLight_ws.cast<double>().normalized();
    HeadCases result;
    Random random(seed);
    for (std::size_t i = 0; i < count; ++i) {
        const auto at = random.below(static_cast<std::uint32_t>(points.size()));
        result.cases.push_back({toShader(points[at], static_cast<float>(biasOf(strands, at))), {0, 1, 0, 0}});
    }
    result.visible.resize(count);
    parallelFor(count, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const shaders::float4& p = result.cases[i].position_ws;
            const Vec3d from = Vec3f(p.x, p.y, p.z).cast<double>();
            result.visible[i] = isVisible(scene.meshes.front(), from, toLight) ? 1 : 0;
        }
    });
    return result;
}

Result<double> headShadowError(gpu::Device& device, const RenderScene& scene, const HeadCases& cases,
                               float absorption, std::uint32_t resolution) {
    RenderOptions options;
    options.shadows = Shadows::absorption;
    options.headAbsorption = absorption;
    options.shadowResolution = resolution;
    options.subdivisions = 1;
    const auto results = probeLight(device, scene, options, cases.cases);
    if (!results) return tl::unexpected(results.error());
    double sum = 0;
    for (std::size_t i = 0; i < cases.visible.size(); ++i) {
        const double error = static_cast<double>((*results)[i].onSkin.w) - cases.visible[i];
        sum += error * error;
    }
    return rootMeanSquare(sum, cases.visible.size());
}

}  // namespace hairloom::render
