// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/streaks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/base/cell_stream.h"
#include "core/base/parallel.h"
#include "core/base/random.h"

namespace hairloom {
namespace {

using Cell = std::array<std::int64_t, 3>;

struct Seed {
    Vec3d place = Vec3d::Zero();  ///< in widths
    bool streak = false;
};

/// The point of a cube of the lattice, and whether its cell is a streak.
Seed seedOf(const HairMaterial& material, const Cell& cube) {
    Random random(material.streakSeed, streamOf(cube));
    Seed seed;
    for (int c = 0; c < 3; ++c) {
        seed.place[c] = static_cast<double>(cube[static_cast<std::size_t>(c)]) + random.uniformDouble();
    }
    seed.streak = random.uniformDouble() < static_cast<double>(material.streakShare);
    return seed;
}

float weightAt(const HairMaterial& material, const Vec3f& root_ss) {
    const Vec3d p = root_ss.cast<double>() / static_cast<double>(material.streakWidth);
    // Distances to the nearest streak and to the nearest cell that is none: their difference is twice the
    // distance to the border between them (Worley 1996).
    double streak = std::numeric_limits<double>::max();
    double plain = streak;
    const auto floorOf = [](double x) { return static_cast<std::int64_t>(std::floor(x)); };
    for (std::int64_t z = -2; z <= 2; ++z) {
        for (std::int64_t y = -2; y <= 2; ++y) {
            for (std::int64_t x = -2; x <= 2; ++x) {
                const Seed seed =
                    seedOf(material, {floorOf(p.x()) + x, floorOf(p.y()) + y, floorOf(p.z()) + z});
                double& nearest = seed.streak ? streak : plain;
                nearest = std::min(nearest, (seed.place - p).norm());
            }
        }
    }
    const double inside = 0.5 * (plain - streak);
    const double soft = 0.5 * static_cast<double>(material.streakSoftness);
    if (soft < 1e-6) return inside >= 0 ? 1.0f : 0.0f;
    return static_cast<float>(std::clamp(0.5 + inside / soft, 0.0, 1.0));
}

}  // namespace

std::vector<float> streakWeights(const HairMaterial& material, std::span<const Vec3f> roots_ss) {
    if (!(material.streakShare > 0)) return {};
    constexpr std::size_t kPiece = 64;
    std::vector<float> weights(roots_ss.size());
    parallelFor(roots_ss.size(), kPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) weights[i] = weightAt(material, roots_ss[i]);
    });
    return weights;
}

}  // namespace hairloom
