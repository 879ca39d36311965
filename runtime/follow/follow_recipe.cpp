// SPDX-License-Identifier: MIT
#include "hairloom/follow_recipe.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/in_parallel.h"
#include "hairloom/random.h"

namespace hairloom::runtime {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;
constexpr float kPi = 3.14159265358979323846f;
constexpr std::size_t kGuidesPerPiece = 16;

/// The triangles around each guide, with the running sum of their areas for drawing by area.
struct Fans {
    Vector<std::uint32_t> offsets;  // per guide, into the others
    Vector<std::uint32_t> triangles;
    Vector<float> areas;  // running sum within the fan

    explicit Fans(const FollowRecipe& recipe) : offsets(recipe.ids.size() + 1, 0) {
        for (const auto& triangle : recipe.triangles) {
            for (const std::uint32_t corner : triangle) ++offsets[corner + 1];
        }
        std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
        triangles.resize(offsets.back());
        areas.resize(offsets.back());
        Vector<std::uint32_t> next(offsets.begin(), offsets.end() - 1);
        for (std::uint32_t index = 0; index < recipe.triangles.size(); ++index) {
            for (const std::uint32_t corner : recipe.triangles[index]) {
                const std::uint32_t place = next[corner]++;
                triangles[place] = index;
                areas[place] = (place > offsets[corner] ? areas[place - 1] : 0.0f) + recipe.areas[index];
            }
        }
    }

    std::uint32_t draw(std::uint32_t guide, float uniform) const {
        const auto begin = areas.begin() + offsets[guide];
        const auto end = areas.begin() + offsets[guide + 1];
        if (begin == end) return kNone;
        const auto found = std::upper_bound(begin, end, uniform * *(end - 1));
        return triangles[static_cast<std::size_t>(std::min(found, end - 1) - areas.begin())];
    }
};

/// Uniform over the part of the triangle where the first corner has the largest weight: the three parts are
/// equally large, and exchanging weights maps one onto another.
Float3 drawOwnThird(Random& random) {
    float u = random.uniform();
    float v = random.uniform();
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    const float first = 1 - u - v;
    if (first >= u && first >= v) return {first, u, v};
    return u >= v ? Float3{u, first, v} : Float3{v, u, first};
}

std::array<float, 2> drawInDisc(Random& random) {
    const float radius = std::sqrt(random.uniform());
    const float angle = 0.0f + 2.0f * kPi * random.uniform();
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

float fade(float value, float begin, float end) {
    const float t = std::clamp((value - begin) / (end - begin), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/// How much farther apart two guides are at places of theirs than at their roots, in lengths up to there.
float spread(const FollowRecipe& recipe, std::span<const Float3> places_ss, float share, std::uint32_t a,
             std::uint32_t b) {
    const float apart = length(places_ss[a] - places_ss[b]) - length(recipe.roots_ss[a] - recipe.roots_ss[b]);
    const float mean = 0.5f * share * (recipe.lengths[a] + recipe.lengths[b]);
    return mean > 0 ? apart / mean : 0.0f;
}

/// 0 for guides that lie together, 1 for guides on two sides of a parting, which may come together again
/// below, and for those of two layers.
float divergence(const FollowRecipe& recipe, std::uint32_t a, std::uint32_t b) {
    if (!recipe.layers.empty() && recipe.layers[a] != recipe.layers[b]) return 1;
    const Float3 chordA = recipe.tips_ss[a] - recipe.roots_ss[a];
    const Float3 chordB = recipe.tips_ss[b] - recipe.roots_ss[b];
    const float angle = std::atan2(length(cross(chordA, chordB)), dot(chordA, chordB)) * (180.0f / kPi);
    float widest = spread(recipe, recipe.tips_ss, 1, a, b);
    if (!recipe.quarters_ss.empty())
        widest = std::max(widest, spread(recipe, recipe.quarters_ss, FollowRecipe::kQuarter, a, b));
    const PartingLimits& limits = recipe.parting;
    return std::max(fade(angle, limits.beginAngleDegrees, limits.endAngleDegrees),
                    fade(widest, limits.beginSpread, limits.endSpread));
}

/// Gives the share of guides that diverge from the first to the first.
Float3 keepPartings(const FollowRecipe& recipe, const std::array<std::uint32_t, 3>& guides, Float3 weights) {
    const float second = weights.y * divergence(recipe, guides[0], guides[1]);
    weights.y -= second;
    weights.x += second;
    const float third = weights.z * divergence(recipe, guides[0], guides[2]);
    weights.z -= third;
    weights.x += third;
    return weights;
}

void drawHair(const FollowRecipe& recipe, const Fans& fans, std::uint32_t guide, std::uint32_t number,
              std::size_t hair, DrawnHairs& hairs) {
    Random random(recipe.seed, (std::uint64_t{recipe.ids[guide]} << 16u) | number);
    hairs.wispOffsets[hair] = drawInDisc(random);
    const std::uint32_t chosen = fans.draw(guide, random.uniform());
    const Float3 barycentric = drawOwnThird(random);
    hairs.guides[hair] = {guide, guide, guide};
    hairs.weights[hair] = hairs.rootWeights[hair] = {1, 0, 0};
    hairs.blends[hair] = 0;
    if (recipe.drawGuides && number == 0) {
        hairs.wispOffsets[hair] = {0.0f, 0.0f};
        return;
    }
    if (chosen == kNone) return;
    std::array<std::uint32_t, 3> corners = recipe.triangles[chosen];
    std::rotate(corners.begin(), std::find(corners.begin(), corners.end(), guide), corners.end());
    hairs.guides[hair] = corners;
    hairs.rootWeights[hair] = barycentric;
    hairs.weights[hair] = keepPartings(recipe, corners, barycentric);
    hairs.blends[hair] = recipe.blend;
}

}  // namespace

DrawnHairs drawFollowHairs(const FollowRecipe& recipe, const Host& host) {
    const std::size_t guides = recipe.ids.size();
    Vector<std::size_t> firstHairs(guides + 1);
    for (std::size_t guide = 0; guide < guides; ++guide)
        firstHairs[guide + 1] = firstHairs[guide] + recipe.hairs[guide];
    const std::size_t count = firstHairs.back();
    DrawnHairs hairs;
    hairs.guides.resize(count);
    hairs.weights.resize(count);
    hairs.rootWeights.resize(count);
    hairs.wispOffsets.resize(count);
    hairs.blends.resize(count);
    if (count == 0) return hairs;
    const Fans fans(recipe);
    const auto draw = [&](std::size_t begin, std::size_t end) {
        for (std::size_t guide = begin; guide < end; ++guide) {
            for (std::uint32_t number = 0; number < recipe.hairs[guide]; ++number)
                drawHair(recipe, fans, static_cast<std::uint32_t>(guide), number, firstHairs[guide] + number,
                         hairs);
        }
    };
    inParallel(host, guides, kGuidesPerPiece, draw);
    return hairs;
}

Float3 shiftDirection(std::span<const RootPlane> planes_ss, const std::array<std::uint32_t, 3>& guides,
                      Float3 rootWeights) {
    const RootPlane& own = planes_ss[guides[0]];
    const Float3 mean = own.normal * rootWeights.x + planes_ss[guides[1]].normal * rootWeights.y +
                        planes_ss[guides[2]].normal * rootWeights.z;
    const float size = length(mean);
    if (!(size > 0.1f)) return {0, 0, 1};
    const Float3 unit = mean * (1 / size);
    return {dot(unit, own.x), dot(unit, own.y), dot(unit, own.normal)};
}

float polylineLength(std::span<const Float3> points) {
    float sum = 0;
    for (std::size_t i = 1; i < points.size(); ++i) sum += length(points[i] - points[i - 1]);
    return sum;
}

Float3 pointAtShare(std::span<const Float3> points, float share) {
    float left = share * polylineLength(points);
    for (std::size_t i = 1; i < points.size(); ++i) {
        const Float3 segment = points[i] - points[i - 1];
        const float size = length(segment);
        if (left < size) return points[i - 1] + segment * (left / size);
        left -= size;
    }
    return points.back();
}

Vector<float> wispRadii(float root, float tip, std::uint32_t points) {
    Vector<float> radii(points);
    for (std::uint32_t i = 0; i < points; ++i)
        radii[i] = root + static_cast<float>(i) / static_cast<float>(points - 1) * (tip - root);
    return radii;
}

}  // namespace hairloom::runtime
