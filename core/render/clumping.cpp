// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/clumping.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/render/scene.h"

namespace hairloom::render {
namespace {

constexpr std::size_t kWidthCount = Clumping::kWidths.size();
constexpr std::uint32_t kRays = 48;     // a beam
constexpr std::size_t kDirections = 8;  // a power of two
constexpr std::size_t kPoints = 192;    // of the hair, in all directions
constexpr std::size_t kParts = 16;      // of the strands, that are looked at side by side
const float kGoldenAngle = kPi * (3 - std::sqrt(5.0f));
constexpr std::size_t kMaxVisits = 2'000'000;  // of segments; more hair is seen from fewer sides

/// A point of the hair and what lies between it and a light far away.
struct Beams {
    Vec3f place;  // across the light, and towards it
    std::size_t group = 0, strand = 0;
    std::array<std::array<std::uint32_t, kRays>, kWidthCount> crossed{};
};

struct Frame {
    Vec3f right, up, towards;

    Vec3f seen(const Vec3f& p) const { return {p.dot(right), p.dot(up), p.dot(towards)}; }
};

/// Evenly around a sphere (the golden angle).
Frame frameOf(std::size_t i) {
    const float z = 1 - (2 * static_cast<float>(i) + 1) / static_cast<float>(kDirections);
    const float angle = static_cast<float>(i) * kGoldenAngle;
    const float radius = std::sqrt(1 - z * z);
    Frame frame;
    frame.towards = {radius * std::cos(angle), z, radius * std::sin(angle)};
    frame.right = frame.towards.unitOrthogonal();
    frame.up = frame.towards.cross(frame.right);
    return frame;
}

/// Places in a disc of diameter 1, evenly (Vogel 1979).
std::array<Vec2f, kRays> raysOfBeam() {
    std::array<Vec2f, kRays> rays;
    for (std::uint32_t i = 0; i < kRays; ++i) {
        const float radius = 0.5f * std::sqrt((static_cast<float>(i) + 0.5f) / static_cast<float>(kRays));
        const float angle = static_cast<float>(i) * kGoldenAngle;
        rays[i] = {radius * std::cos(angle), radius * std::sin(angle)};
    }
    return rays;
}

/// Places along the hair at random, in the order of the first coordinate.
std::vector<Beams> chooseBeams(std::span<const RenderStrands> strands, const Frame& frame, std::size_t count,
                               Random& random) {
    std::size_t points = 0;
    for (const RenderStrands& group : strands) points += group.positions_ws.size();
    std::vector<Beams> beams;
    for (std::size_t i = 0; i < count; ++i) {
        std::size_t at = random.below(static_cast<std::uint32_t>(points));
        const float part = random.uniform();
        Beams one;
        while (at >= strands[one.group].positions_ws.size()) at -= strands[one.group++].positions_ws.size();
        const RenderStrands& group = strands[one.group];
        const auto after = std::ranges::upper_bound(group.offsets, static_cast<std::uint32_t>(at));
        one.strand = static_cast<std::size_t>(after - group.offsets.begin()) - 1;
        if (at + 1 == group.offsets[one.strand + 1] && at > group.offsets[one.strand]) --at;
        const Vec3f& a = group.positions_ws[at];
        const bool ends = at + 1 == group.offsets[one.strand + 1];
        one.place = frame.seen(ends ? a : a + part * (group.positions_ws[at + 1] - a));
        beams.push_back(one);
    }
    std::ranges::sort(beams, {}, [](const Beams& b) { return b.place.x(); });
    return beams;
}

/// Counts for each ray of a point's beams whether a segment is in its way.
void cross(Beams& beams, const Vec3f& a, const Vec3f& b, float radius, const std::array<Vec2f, kRays>& rays) {
    const Vec3f from = a - beams.place;
    const Vec3f way = b - a;
    const Vec2f across = way.head<2>();
    const float length = across.squaredNorm();
    const float nearest = length > 0 ? std::clamp(-from.head<2>().dot(across) / length, 0.0f, 1.0f) : 0.0f;
    const float distance = (from.head<2>() + nearest * across).norm();
    for (std::size_t w = 0; w < kWidthCount; ++w) {
        if (distance > 0.5f * Clumping::kWidths[w] + radius) return;  // nor does it reach narrower ones
        for (std::uint32_t r = 0; r < kRays; ++r) {
            const Vec2f to = Clumping::kWidths[w] * rays[r] - from.head<2>();
            const float t = length > 0 ? to.dot(across) / length : 0.0f;
            // Half open, so that a ray crosses a strand once where two segments meet.
            if (t < 0 || t >= 1 || (to - t * across).squaredNorm() > radius * radius) continue;
            if (from.z() + t * way.z() > radius) ++beams.crossed[w][r];
        }
    }
}

/// What a part of all strands, one of kParts, has in the way of `beams`.
void look(std::span<const RenderStrands> strands, std::size_t part, const Frame& frame,
          std::vector<Beams>& beams) {
    constexpr float kReach = 0.5f * Clumping::kWidths.front();
    static const std::array<Vec2f, kRays> rays = raysOfBeam();
    for (std::size_t g = 0; g < strands.size(); ++g) {
        const RenderStrands& group = strands[g];
        const std::size_t count = group.offsets.empty() ? 0 : group.offsets.size() - 1;
        for (std::size_t s = count * part / kParts; s < count * (part + 1) / kParts; ++s) {
            const std::uint32_t first = group.offsets[s], last = group.offsets[s + 1];
            const StrandShading* material = shadingOf(group, s);
            if (last - first < 2 || material == nullptr) continue;
            Vec3f a = frame.seen(group.positions_ws[first]);
            for (std::uint32_t p = first + 1; p < last; ++p) {
                const Vec3f b = frame.seen(group.positions_ws[p]);
                const float radius = radiusAt(group, *material, first, last, p - 1);
                const float reach = kReach + radius;
                const float begin = std::min(a.x(), b.x()) - reach, end = std::max(a.x(), b.x()) + reach;
                auto it =
                    std::ranges::lower_bound(beams, begin, {}, [](const Beams& o) { return o.place.x(); });
                for (; it != beams.end() && it->place.x() <= end; ++it) {
                    const bool own = it->group == g && it->strand == s;
                    const float y = it->place.y(), z = it->place.z();
                    if (own || y < std::min(a.y(), b.y()) - reach || y > std::max(a.y(), b.y()) + reach ||
                        z > std::max(a.z(), b.z()))
                        continue;
                    cross(*it, a, b, radius, rays);
                }
                a = b;
            }
        }
    }
}

void addTo(std::span<Beams> sum, std::span<const Beams> more) {
    for (std::size_t i = 0; i < sum.size(); ++i) {
        for (std::size_t w = 0; w < kWidthCount; ++w) {
            for (std::uint32_t r = 0; r < kRays; ++r) sum[i].crossed[w][r] += more[i].crossed[w][r];
        }
    }
}

/// The c at which the mean of exp(−c n) over all beams is what they let through.
float solve(std::span<const Beams> beams, std::size_t width) {
    std::vector<double> crossed;
    double through = 0, all = 0;
    for (const Beams& one : beams) {
        double sum = 0, free = 0;
        for (const std::uint32_t count : one.crossed[width]) {
            sum += count;
            free += count == 0 ? 1 : 0;
        }
        crossed.push_back(sum / kRays);
        through += free / kRays;
        all += sum / kRays;
    }
    if (all <= 0) return 1;
    double least = 0.1, most = 4;
    for (int i = 0; i < 40; ++i) {
        const double c = 0.5 * (least + most);
        double passed = 0;
        for (const double n : crossed) passed += std::exp(-c * n);
        (passed > through ? least : most) = c;
    }
    return static_cast<float>(least);
}

}  // namespace

float Clumping::of(float width) const {
    const float at = std::log2(kWidths.front() / std::max(width, 1e-9f));
    const float held = std::clamp(at, 0.0f, static_cast<float>(kWidthCount - 1));
    const auto i = std::min(static_cast<std::size_t>(held), kWidthCount - 2);
    const float part = held - static_cast<float>(i);
    return (1 - part) * values[i] + part * values[i + 1];
}

Clumping measureClumping(std::span<const RenderStrands> strands) {
    std::size_t points = 0;
    for (const RenderStrands& group : strands) points += group.positions_ws.size();
    if (points == 0) return {};
    std::size_t directions = kDirections;
    while (directions > 1 && directions * points > kMaxVisits) directions /= 2;
    std::vector<Frame> frames;
    std::vector<std::vector<Beams>> seen;
    for (std::size_t i = 0; i < kDirections; i += kDirections / directions) {
        frames.push_back(frameOf(i));
        Random random(i);
        seen.insert(seen.end(), kParts, chooseBeams(strands, frames.back(), kPoints / directions, random));
    }
    parallelFor(seen.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) look(strands, i % kParts, frames[i / kParts], seen[i]);
    });
    std::vector<Beams> beams;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (i % kParts == 0) {
            beams.insert(beams.end(), seen[i].begin(), seen[i].end());
        } else {
            addTo(std::span(beams).last(seen[i].size()), seen[i]);
        }
    }
    Clumping result;
    for (std::size_t w = 0; w < kWidthCount; ++w) result.values[w] = solve(beams, w);
    return result;
}

}  // namespace hairloom::render
