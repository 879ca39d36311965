// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/software/mesh_depth.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/parallel.h"
#include "core/software/hlsl.h"

namespace hairloom::software {
namespace {

constexpr float kBesideDepth = -1e-5f;  // of a triangle: neighbours leave no gaps
constexpr std::uint32_t kBand = 32;     // rows that one thread draws

/// In homogeneous coordinates, as shaders/render/triangle_raster.hlsli has them: what reaches behind the eye
/// needs no cutting.
struct DepthTriangle {
    float3 edges[3];  ///< times (x, y, 1): a corner's share divided by w
    float3 depths;
    int left, right, top, bottom;  ///< pixels around it, the last included
};

bool setUp(const DepthWindow& window, const std::array<float4, 3>& clip, DepthTriangle& t) {
    const auto columns = static_cast<float>(window.columns);
    const auto rows = static_cast<float>(window.rows);
    if (max(clip[0].w, max(clip[1].w, clip[2].w)) <= 0) return false;
    float2 low(0.0f, 0.0f);
    float2 high(columns, rows);
    if (min(clip[0].w, min(clip[1].w, clip[2].w)) > 1e-6f) {
        float2 minimum(1e9f);
        float2 maximum(-1e9f);
        for (const float4& c : clip) {
            const float2 at((0.5f + 0.5f * c.x / c.w) * columns, (0.5f - 0.5f * c.y / c.w) * rows);
            minimum = min(minimum, at);
            maximum = max(maximum, at);
        }
        low = max(low, floor(minimum - 0.5f));
        high = min(high, ceil(maximum + 0.5f));
    }
    t.left = static_cast<int>(low.x);
    t.top = static_cast<int>(low.y);
    t.right = static_cast<int>(high.x) - 1;
    t.bottom = static_cast<int>(high.y) - 1;
    if (t.right < t.left || t.bottom < t.top) return false;
    float3 v[3];
    for (int i = 0; i < 3; ++i) {
        const float4& c = clip[static_cast<std::size_t>(i)];
        v[i] = float3(0.5f * (c.w + c.x) * columns, 0.5f * (c.w - c.y) * rows, c.w);
    }
    const float det = dot(v[0], cross(v[1], v[2]));
    if (!(std::fabs(det) >= 1e-20f)) return false;
    t.edges[0] = cross(v[1], v[2]) / det;
    t.edges[1] = cross(v[2], v[0]) / det;
    t.edges[2] = cross(v[0], v[1]) / det;
    t.depths = float3(clip[0].z, clip[1].z, clip[2].z);
    return true;
}

void drawRows(const DepthWindow& window, const DepthTriangle& t, int from, int to) {
    for (int y = std::max(from, t.top); y <= std::min(to, t.bottom); ++y) {
        float* const row =
            window.depths.data() +
            static_cast<std::size_t>(window.top + static_cast<std::uint32_t>(y)) * window.width + window.left;
        for (int x = t.left; x <= t.right; ++x) {
            const float3 at(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 1.0f);
            const float3 shares(dot(t.edges[0], at), dot(t.edges[1], at), dot(t.edges[2], at));
            const float sum = shares.x + shares.y + shares.z;
            if (!(sum > 0) || min(shares.x, min(shares.y, shares.z)) < kBesideDepth * sum) continue;
            const float depth = dot(shares, t.depths);
            if (depth >= 0 && depth <= 1 && depth < row[x]) row[x] = depth;
        }
    }
}

}  // namespace

void drawDepth(const DepthWindow& window, const std::array<float, 16>& clipFromWorld,
               std::span<const float> positions, std::span<const std::uint32_t> indices) {
    const auto& m = clipFromWorld;
    std::vector<DepthTriangle> triangles;
    triangles.reserve(indices.size() / 3);
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        std::array<float4, 3> clip;
        for (std::size_t k = 0; k < 3; ++k) {
            const float* p = positions.data() + std::size_t{3} * indices[i + k];
            const auto row = [&](std::size_t r) {
                return m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r];
            };
            clip[k] = float4(row(0), row(1), row(2), row(3));
        }
        DepthTriangle t;
        if (setUp(window, clip, t)) triangles.push_back(t);
    }
    parallelFor(window.rows, kBand, [&](std::size_t begin, std::size_t end) {
        for (const DepthTriangle& t : triangles)
            drawRows(window, t, static_cast<int>(begin), static_cast<int>(end) - 1);
    });
}

}  // namespace hairloom::software
