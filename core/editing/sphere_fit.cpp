// SPDX-License-Identifier: GPL-3.0-or-later
// Variational sphere-set approximation (Wang et al. 2006) that begins with maximal inscribed balls found by
// shrinking (Ma, Bae and Choi 2012), chosen greedily.

#include "core/editing/sphere_fit.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/parallel.h"
#include "core/editing/root_grid.h"
#include "core/editing/sphere_commands.h"
#include "core/geometry/placement.h"
#include "core/geometry/selection.h"
#include "core/groom/spheres.h"

namespace hairloom::editing {
namespace {

constexpr std::size_t kSamples = 4000;
constexpr double kSamplesPerM2 = 2e7;  // of small regions: one in 0.2 mm
constexpr std::size_t kSeeds = 1000;
constexpr int kRounds = 60;

struct Ball {
    Vec3d centre;
    double radius;
    /// Above 0 outside.
    double distance(const Vec3d& point) const { return (point - centre).norm() - radius; }
};

struct Samples {
    std::vector<Vec3d> points;
    std::vector<Vec3d> normals;
};

std::size_t nearestTo(const std::vector<Vec3d>& points, const Vec3d& place) {
    std::size_t nearest = 0;
    double minimum = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double distance = (points[i] - place).squaredNorm();
        if (distance >= minimum) continue;
        minimum = distance;
        nearest = i;
    }
    return nearest;
}

/// The largest ball that touches the skin at a sample from inside and holds no other sample.
Ball shrink(const Samples& samples, std::size_t at, double largest) {
    constexpr int kSteps = 40;
    constexpr double kTouches = 1e-5;  // metres
    const Vec3d& p = samples.points[at];
    const Vec3d& n = samples.normals[at];
    Ball ball{p - largest * n, largest};
    for (int step = 0; step < kSteps; ++step) {
        const Vec3d& q = samples.points[nearestTo(samples.points, ball.centre)];
        if ((q - ball.centre).norm() >= ball.radius - kTouches) break;
        const double facing = 2 * n.dot(p - q);
        if (!(facing > 0)) break;
        const double radius = (p - q).squaredNorm() / facing;
        if (!(radius < ball.radius)) break;
        ball = {p - radius * n, radius};
    }
    return ball;
}

/// Takes, one after the other, the ball whose surface passes near most samples that no chosen one passes
/// near.
std::vector<Ball> chooseGreedily(const std::vector<Ball>& candidates, const Samples& samples,
                                 std::size_t count) {
    double tolerance = 0.02;  // metres; halves when no ball adds anything
    std::vector<Ball> chosen;
    std::vector<std::uint8_t> covered(samples.points.size(), 0);
    const auto covers = [&](const Ball& ball, std::size_t i) {
        return std::abs(ball.distance(samples.points[i])) <= tolerance;
    };
    const auto mark = [&](const Ball& ball) {
        for (std::size_t i = 0; i < covered.size(); ++i) {
            if (covers(ball, i)) covered[i] = 1;
        }
    };
    constexpr double kFinest = 1e-4;
    while (chosen.size() < count) {
        std::vector<std::size_t> gains(candidates.size(), 0);
        parallelFor(candidates.size(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t b = begin; b < end; ++b) {
                for (std::size_t i = 0; i < covered.size(); ++i)
                    gains[b] += !covered[i] && covers(candidates[b], i) ? 1u : 0u;
            }
        });
        const auto best = std::max_element(gains.begin(), gains.end());
        if (*best == 0 && tolerance > kFinest) {
            tolerance /= 2;
            std::fill(covered.begin(), covered.end(), std::uint8_t{0});
            for (const Ball& ball : chosen) {
                mark(ball);
            }
            continue;
        }
        chosen.push_back(candidates[static_cast<std::size_t>(best - gains.begin())]);
        mark(chosen.back());
    }
    return chosen;
}

/// The ball whose surface is met first from outside, which is the one that the union shows there.
std::size_t outermost(const std::vector<Ball>& balls, const Vec3d& point) {
    std::size_t best = 0;
    for (std::size_t b = 1; b < balls.size(); ++b) {
        if (balls[b].distance(point) < balls[best].distance(point)) best = b;
    }
    return best;
}

/// One Gauss-Newton step of Σ w (|p − c| − r)²; far samples weigh more, so that the worst gap shrinks.
Ball refit(const Ball& ball, const Samples& samples, const std::vector<std::size_t>& owned, double largest) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Identity() * 1e-6;
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    double meanSquare = 1e-12;
    for (const std::size_t i : owned) {
        const double d = ball.distance(samples.points[i]);
        meanSquare += d * d / static_cast<double>(owned.size());
    }
    for (const std::size_t i : owned) {
        const Vec3d away = samples.points[i] - ball.centre;
        const double length = away.norm();
        if (!(length > 1e-9)) continue;
        const double residual = length - ball.radius;
        const double weight = 1 + residual * residual / meanSquare;
        Eigen::Vector4d gradient;
        gradient << -away / length, -1;
        normal += weight * gradient * gradient.transpose();
        right -= weight * residual * gradient;
    }
    const Eigen::Vector4d step = normal.ldlt().solve(right);
    Ball moved{ball.centre + step.head<3>(), std::clamp(ball.radius + step[3], 1e-3, largest)};
    return moved.centre.allFinite() && std::isfinite(moved.radius) ? moved : ball;
}

/// Whether the ball lies behind its samples: one before a hollow, behind an ear, say, fits it as closely from
/// outside, and pushes hair away.
bool liesInside(const Ball& ball, const Samples& samples, const std::vector<std::size_t>& owned) {
    constexpr double kFacing = 0.3;  // mean cosine between the skin's normal and the ball's
    double sum = 0;
    for (const std::size_t i : owned)
        sum += samples.normals[i].dot((samples.points[i] - ball.centre).normalized());
    return sum > kFacing * static_cast<double>(owned.size());
}

struct Quality {
    double worst = 0;    ///< metres, distance of a sample from the union's surface
    std::size_t at = 0;  ///< the sample that lies outermost
    double mean4 = 0;    ///< mean of fourth powers: what the rounds bring down
};

Quality qualityOf(const std::vector<Ball>& balls, const Samples& samples) {
    Quality quality;
    double outermostGap = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < samples.points.size(); ++i) {
        const double d = balls[outermost(balls, samples.points[i])].distance(samples.points[i]);
        quality.worst = std::max(quality.worst, std::abs(d));
        quality.mean4 += d * d * d * d;
        if (d > outermostGap) {
            outermostGap = d;
            quality.at = i;
        }
    }
    return quality;
}

/// Assigns samples to balls and fits each ball to its own, over and over; the best round counts. A ball with
/// too few samples begins anew where the gap is widest.
std::vector<Ball> refine(std::vector<Ball> balls, const Samples& samples, double largest) {
    constexpr std::size_t kFewest = 8;
    std::vector<Ball> best = balls;
    double minimum = qualityOf(balls, samples).mean4;
    for (int round = 0; round < kRounds; ++round) {
        std::vector<std::vector<std::size_t>> owned(balls.size());
        for (std::size_t i = 0; i < samples.points.size(); ++i)
            owned[outermost(balls, samples.points[i])].push_back(i);
        const std::size_t widest = qualityOf(balls, samples).at;
        bool isReseeded = false;
        for (std::size_t b = 0; b < balls.size(); ++b) {
            if (owned[b].size() >= kFewest) {
                const Ball fitted = refit(balls[b], samples, owned[b], largest);
                if (liesInside(fitted, samples, owned[b])) balls[b] = fitted;
            } else if (!isReseeded) {
                balls[b] = shrink(samples, widest, largest);
                isReseeded = true;
            }
        }
        const double now = qualityOf(balls, samples).mean4;
        if (now >= minimum) continue;
        minimum = now;
        best = balls;
    }
    return best;
}

FaceSet facesOf(const ScalpMesh& mesh, const FaceSet& region) {
    if (!region.empty()) return region;
    FaceSet all(mesh.triangleCount());
    std::iota(all.begin(), all.end(), 0u);
    return all;
}

Result<Samples> sample(const ScalpMesh& mesh, const SphereFitOptions& options) {
    const FaceSet faces = facesOf(mesh, options.region);
    PlacementRequest request;
    request.count = static_cast<std::size_t>(
        std::clamp(kSamplesPerM2 * selectionArea(mesh, faces), 1.0, static_cast<double>(kSamples)));
    request.seed = options.seed;
    const auto placed = placeRandom(mesh, faces, request);
    if (!placed) return tl::unexpected(placed.error());
    Samples samples;
    for (const SurfacePoint& point : placed->roots) {
        samples.points.push_back(mesh.pointAt(point.triangle, point.barycentric).cast<double>());
        samples.normals.push_back(mesh.normalAt(point.triangle, point.barycentric).cast<double>());
    }
    return samples;
}

}  // namespace

Result<SphereFit> fitSpheres(const ScalpMesh& mesh, const SphereFitOptions& options) {
    if (options.count < 1 || options.count > kMaxSpheres)
        return fail(fmt::format("{} spheres", options.count), fmt::format("1 to {}", kMaxSpheres));
    const bool isFree = options.largestRadius == 0;
    if (!isFree && !(options.largestRadius >= kSmallestSphere && options.largestRadius <= kLargestSphere))
        return fail(fmt::format("a largest radius of {} m", options.largestRadius), "0.001 to 10 m");
    const auto samples = sample(mesh, options);
    if (!samples) return tl::unexpected(samples.error());
    const auto largest = static_cast<double>(isFree ? largestSphereIn(mesh.bounds()) : options.largestRadius);
    std::vector<Ball> candidates(std::min(kSeeds, samples->points.size()));
    parallelFor(candidates.size(), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) candidates[i] = shrink(*samples, i, largest);
    });
    std::vector<CollisionSphere> spheres;
    for (const Ball& ball : refine(chooseGreedily(candidates, *samples, options.count), *samples, largest)) {
        spheres.push_back({fmt::format("Fit {}", spheres.size() + 1),
                           ball.centre.cast<float>(),
                           static_cast<float>(ball.radius),
                           {},
                           -1});
    }
    return measureSpheres(mesh, options.region, std::move(spheres));
}

float largestSphereIn(const Box3f& bounds) {
    // The skin that is to be covered may be a patch, behind which a larger ball leaves the body on the other
    // side.
    constexpr float kOfAnyHead = 0.2f;
    return std::clamp(bounds.sizes().minCoeff() / 2, kOfAnyHead, kLargestSphere);
}

std::vector<std::uint8_t> verticesOf(const ScalpMesh& mesh, const FaceSet& region) {
    std::vector<std::uint8_t> isIn(mesh.vertexCount(), 0);
    for (const std::uint32_t face : facesOf(mesh, region)) {
        for (const std::uint32_t v : mesh.triangles()[face]) isIn[v] = 1;
    }
    return isIn;
}

SphereFit measureSpheres(const ScalpMesh& mesh, const FaceSet& region, std::vector<CollisionSphere> spheres) {
    SphereFit fit;
    fit.spheres = std::move(spheres);
    const std::vector<std::uint8_t> isIn = verticesOf(mesh, region);
    const ColliderDistance distance(fit.spheres);
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t v = 0; v < isIn.size(); ++v) {
        if (!isIn[v]) continue;
        const Vec3f& point = mesh.positions()[v];
        const float nearest = distance(point);
        ++count;
        sum += static_cast<double>(std::max(0.0f, nearest));
        fit.worstBulge = std::max(fit.worstBulge, -nearest);
        if (nearest <= fit.worstGap) continue;
        fit.worstGap = nearest;
        fit.worstGapAt_ss = point;
    }
    fit.meanGap = count > 0 ? static_cast<float>(sum / static_cast<double>(count)) : 0;
    return fit;
}

FaceSet facesNearHair(const Groom& groom, float distance) {
    FaceSet faces;
    if (!groom.scalp) return faces;
    RootGrid grid(distance);
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        for (const Vec3f& point : groom.strand(s)) grid.add(static_cast<std::uint32_t>(s), point);
    }
    for (std::uint32_t face = 0; face < groom.scalp->triangleCount(); ++face) {
        if (grid.anyWithin(groom.scalp->pointAt(face, Vec3f::Constant(1.0f / 3)), distance))
            faces.push_back(face);
    }
    return faces;
}

}  // namespace hairloom::editing
