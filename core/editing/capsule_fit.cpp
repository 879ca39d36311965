// SPDX-License-Identifier: GPL-3.0-or-later
// Capsules between the spheres of a fit, chosen greedily among all pairs.

#include <algorithm>
#include <limits>

#include "core/base/parallel.h"
#include "core/editing/sphere_fit.h"
#include "core/groom/spheres.h"
#include "core/operations/skin.h"
#include "hairloom/capsules.h"

namespace hairloom::editing {
namespace {

constexpr std::size_t kMostSamples = 4000;

/// Vertices of the region, evenly thinned out.
std::vector<Vec3f> samplesOf(const ScalpMesh& mesh, const FaceSet& region) {
    const std::vector<std::uint8_t> isIn = verticesOf(mesh, region);
    std::vector<Vec3f> points;
    for (std::size_t v = 0; v < isIn.size(); ++v) {
        if (isIn[v]) points.push_back(mesh.positions()[v]);
    }
    const std::size_t stride = points.size() / kMostSamples + 1;
    std::vector<Vec3f> samples;
    for (std::size_t i = 0; i < points.size(); i += stride) samples.push_back(points[i]);
    return samples;
}

struct Pair {
    std::size_t first, second;
    std::vector<float> distances;  ///< of the samples from the capsule
};

/// Whether the capsule stands out of the skin by no more than `deepest` metres, or than its ends do: one
/// across a hollow, from chin to chest, holds no vertex.
bool liesInSkin(const runtime::Sphere& from, const runtime::Sphere& to, const SkinQuery& skin,
                float deepest) {
    const auto standsOut = [&](const runtime::Sphere& sphere) {
        return skin.distanceAt(Vec3f(sphere.center_ws.x, sphere.center_ws.y, sphere.center_ws.z)).distance +
               sphere.radius;
    };
    const float most = std::max({deepest, standsOut(from), standsOut(to)});
    constexpr int kSteps = 16;
    for (int k = 1; k < kSteps; ++k) {
        if (standsOut(runtime::sphereOfCapsule(from, to, static_cast<float>(k) / kSteps)) > most)
            return false;
    }
    return true;
}

/// Distances of the samples, or none where skin lies too deep in the capsule.
std::vector<float> distancesFrom(const CollisionSphere& first, const CollisionSphere& second,
                                 const std::vector<Vec3f>& samples, const SkinQuery& skin, float deepest) {
    std::vector<float> distances;
    const runtime::Sphere from = toSphere(first.centre, first.radius),
                          to = toSphere(second.centre, second.radius);
    if (!liesInSkin(from, to, skin, deepest)) return {};
    for (const Vec3f& sample : samples) {
        const runtime::Float3 place{sample.x(), sample.y(), sample.z()};
        const runtime::Sphere nearest = runtime::nearestOfCapsule(from, to, place);
        distances.push_back(runtime::length(place - nearest.center_ws) - nearest.radius);
        if (distances.back() < -deepest) return {};
    }
    return distances;
}

/// Sum of fourth powers of what stays outside, so that the widest gaps count most.
double outside(const std::vector<float>& now, const std::vector<float>* with) {
    double sum = 0;
    for (std::size_t i = 0; i < now.size(); ++i) {
        const auto gap = static_cast<double>(std::max(with ? std::min(now[i], (*with)[i]) : now[i], 0.0f));
        sum += gap * gap * gap * gap;
    }
    return sum;
}

}  // namespace

void joinSpheres(const ScalpMesh& mesh, const FaceSet& region, float error,
                 std::vector<CollisionSphere>& spheres) {
    const std::vector<Vec3f> samples = samplesOf(mesh, region);
    const Skin skin(std::make_shared<const ScalpMesh>(mesh));
    const ColliderDistance distance(spheres);
    std::vector<float> now;
    for (const Vec3f& sample : samples) now.push_back(distance(sample));
    if (now.empty()) return;
    const float deepest = std::max(error, -*std::ranges::min_element(now));
    std::vector<Pair> pairs;
    for (std::size_t a = 0; a < spheres.size(); ++a) {
        for (std::size_t b = a + 1; b < spheres.size(); ++b) {
            if (spheres[a].bone == spheres[b].bone) pairs.push_back({a, b, {}});
        }
    }
    parallelFor(pairs.size(), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            pairs[p].distances =
                distancesFrom(spheres[pairs[p].first], spheres[pairs[p].second], samples, skin, deepest);
    });
    std::erase_if(pairs, [](const Pair& pair) { return pair.distances.empty(); });
    constexpr double kWorthIt = 1e-3;  // of what lies outside
    for (double before = outside(now, nullptr); before > 0 && !pairs.empty();) {
        std::vector<double> left(pairs.size());
        parallelFor(pairs.size(), 8, [&](std::size_t begin, std::size_t end) {
            for (std::size_t p = begin; p < end; ++p) left[p] = outside(now, &pairs[p].distances);
        });
        const auto best = static_cast<std::size_t>(std::ranges::min_element(left) - left.begin());
        if (left[best] > (1 - kWorthIt) * before) return;
        Pair pair = std::move(pairs[best]);
        pairs.erase(pairs.begin() + static_cast<std::ptrdiff_t>(best));
        // Each sphere is joined to one other; others may be joined to it.
        if (spheres[pair.first].joined >= 0) std::swap(pair.first, pair.second);
        if (spheres[pair.first].joined >= 0) continue;
        spheres[pair.first].joined = static_cast<std::int32_t>(pair.second);
        for (std::size_t i = 0; i < now.size(); ++i) now[i] = std::min(now[i], pair.distances[i]);
        before = left[best];
    }
}

}  // namespace hairloom::editing
