// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/strand_frames.h"

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/base/smooth_step.h"
#include "core/geometry/curve.h"

namespace hairloom {
namespace {

/// Unit tangents; where points coincide, that of the one before.
std::vector<Vec3f> tangentsOf(std::span<const Vec3f> points) {
    std::vector<Vec3f> tangents(points.size());
    Vec3f last = unitOr(points.back() - points.front(), -Vec3f::UnitY());
    for (std::size_t i = 0; i < points.size(); ++i) {
        last = unitOr(points[std::min(i + 1, points.size() - 1)] - points[i == 0 ? 0 : i - 1], last);
        tangents[i] = last;
    }
    return tangents;
}

}  // namespace

std::vector<StrandFrame> strandFrames(std::span<const Vec3f> points, const Vec3f& outward) {
    const std::vector<Vec3f> tangents = tangentsOf(points);
    std::size_t clearest = 0;
    float sine = 0;
    for (std::size_t i = 0; i < tangents.size(); ++i) {
        const float own = tangents[i].cross(outward).norm();
        if (own <= sine) continue;
        sine = own;
        clearest = i;
    }
    constexpr float kUnclear = 1e-3f;
    std::vector<StrandFrame> frames(points.size());
    const auto set = [&](std::size_t i, const Vec3f& lateral) {
        const Vec3f& along = tangents[i];
        const Vec3f across = unitOr(lateral - along * along.dot(lateral), along.unitOrthogonal());
        frames[i] = {across, across.cross(along), along};
    };
    set(clearest, sine > kUnclear ? Vec3f(tangents[clearest].cross(outward))
                                  : Vec3f(tangents[clearest].unitOrthogonal()));
    for (std::size_t i = clearest + 1; i < points.size(); ++i)
        set(i, shortestArc(tangents[i - 1], tangents[i]) * frames[i - 1].lateral);
    for (std::size_t i = clearest; i > 0; --i)
        set(i - 1, shortestArc(tangents[i], tangents[i - 1]) * frames[i].lateral);
    return frames;
}

Vec3f waveAt(std::uint64_t stream, float x) {
    const float cell = std::floor(x);
    const auto corner = [&](float whole) {
        Random random(stream, static_cast<std::uint64_t>(whole));
        const float a = random.uniform(-1, 1);
        const float b = random.uniform(-1, 1);
        return Vec3f(a, b, random.uniform(-1, 1));
    };
    const float smooth = smoothStep(x - cell);
    return corner(cell) * (1 - smooth) + corner(cell + 1) * smooth;
}

}  // namespace hairloom
