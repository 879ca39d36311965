// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/software/ribbon_tiles.h"

#include <algorithm>

#include "core/base/parallel.h"

namespace hairloom::software {
namespace {

constexpr std::size_t kPointsAtOnce = 1u << 14u;
constexpr float kFarthest = 1e6f;  // pixels

float3 tangentOf(std::uint32_t packed) {
    const auto part = [](std::uint32_t bits) {
        return static_cast<float>(static_cast<std::int16_t>(bits & 0xffffu)) / 32767.0f;
    };
    const float2 p(part(packed), part(packed >> 16u));
    float3 n(p.x, p.y, 1.0f - abs(p.x) - abs(p.y));
    const float t = saturate(-n.z);
    n.x += n.x >= 0 ? -t : t;
    n.y += n.y >= 0 ? -t : t;
    return normalize(n);
}

/// Positive to the right of the way from a to b, y down.
std::array<float, 3> lineThrough(float2 a, float2 b) {
    const float2 d = b - a;
    const float2 n = float2(-d.y, d.x) * rsqrt(max(dot(d, d), 1e-20f));
    return {n.x, n.y, -dot(n, a)};
}

}  // namespace

RibbonTiles::RibbonTiles(std::span<const RibbonBatch> batches, const RibbonWindow& window)
    : batches_(batches.begin(), batches.end()), window_(window) {
    across_ = (window.columns + kSide - 1) / kSide;
    down_ = (window.rows + kSide - 1) / kSide;
    std::uint32_t items = 0;
    for (const RibbonBatch& batch : batches_) {
        firstItems_.push_back(items);
        items += static_cast<std::uint32_t>(batch.curve.size());
    }
    firstItems_.push_back(items);
    project();
    bin();
}

RibbonTiles::Tile RibbonTiles::tile(std::size_t index) const {
    const int x = static_cast<int>(index) % across_ * kSide;
    const int y = static_cast<int>(index) / across_ * kSide;
    return {window_.left + x, window_.top + y, window_.left + std::min(x + kSide, window_.columns),
            window_.top + std::min(y + kSide, window_.rows)};
}

std::pair<std::uint32_t, std::uint32_t> RibbonTiles::batchAndPoint(std::uint32_t item) const {
    std::uint32_t batch = 0;
    while (item >= firstItems_[batch + 1]) ++batch;
    return {batch, item - firstItems_[batch]};
}

void RibbonTiles::project() {
    projected_.resize(firstItems_.back());
    for (std::size_t b = 0; b < batches_.size(); ++b) {
        const RibbonBatch& batch = batches_[b];
        const shaders::ViewConstants& view = batch.view;
        const auto& m = view.clipFromWorld.m;
        const float3 eye(view.eye_ws.x, view.eye_ws.y, view.eye_ws.z);
        parallelFor(batch.curve.size(), kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const shaders::CurvePoint& p = batch.curve[i];
                Projected& result = projected_[firstItems_[b] + i];
                const float3 centre(p.position_ws.x, p.position_ws.y, p.position_ws.z);
                const float3 toEye = eye - centre * view.eye_ws.w;
                const float3 across = cross(tangentOf(p.tangentXy), toEye);
                const float3 side = across * rsqrt(max(dot(across, across), 1e-20f));
                const float pixelSize = view.pixelSize * (view.eye_ws.w > 0 ? length(toEye) : 1.0f);
                const float radius = max(p.position_ws.w, 0.5f * view.minWidth * pixelSize);
                const auto onto = [&](const float3& at, float& x, float& y) {
                    const auto row = [&](int r) {
                        return m[r] * at.x + m[4 + r] * at.y + m[8 + r] * at.z + m[12 + r];
                    };
                    const float w = row(3);
                    const float safe = max(w, 1e-6f);
                    x = static_cast<float>(window_.left) +
                        (0.5f + 0.5f * row(0) / safe) * static_cast<float>(window_.columns);
                    y = static_cast<float>(window_.top) +
                        (0.5f - 0.5f * row(1) / safe) * static_cast<float>(window_.rows);
                    result.depth = row(2) / safe;
                    return w > 1e-6f;
                };
                const bool second = onto(centre + side * radius, result.x1, result.y1);
                const bool first = onto(centre - side * radius, result.x0, result.y0);
                result.coverage = !first || !second ? -1.0f
                                  : radius > 0      ? p.opacity * p.position_ws.w / radius
                                                    : 0.0f;
            }
        });
    }
}

void RibbonTiles::bin() {
    struct Entry {
        std::uint32_t tile, item;
    };
    const std::size_t all = projected_.size();
    const std::size_t chunks = (all + kPointsAtOnce - 1) / kPointsAtOnce;
    std::vector<std::vector<Entry>> entries(chunks);
    const float reach = window_.reach + 0.5f;
    parallelFor(all, kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
        std::vector<Entry>& found = entries[begin / kPointsAtOnce];
        std::uint32_t batch = batchAndPoint(static_cast<std::uint32_t>(begin)).first;
        for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) {
            while (i >= firstItems_[batch + 1]) ++batch;
            if (i + 1 == firstItems_[batch + 1]) continue;
            const Projected& a = projected_[i];
            const Projected& b = projected_[i + 1];
            if (a.coverage < 0 || b.coverage < 0 || max(a.coverage, b.coverage) <= 0) continue;
            const auto curve = batches_[batch].curve;
            const std::uint32_t point = i - firstItems_[batch];
            if (curve[point].strand != curve[point + 1].strand) continue;
            const float middleX = 0.25f * (a.x0 + a.x1 + b.x0 + b.x1);
            const float middleY = 0.25f * (a.y0 + a.y1 + b.y0 + b.y1);
            if (!(abs(middleX) <= kFarthest && abs(middleY) <= kFarthest)) continue;
            const float lowX =
                min(min(a.x0, a.x1), min(b.x0, b.x1)) - reach - static_cast<float>(window_.left);
            const float lowY =
                min(min(a.y0, a.y1), min(b.y0, b.y1)) - reach - static_cast<float>(window_.top);
            const float highX =
                max(max(a.x0, a.x1), max(b.x0, b.x1)) + reach - static_cast<float>(window_.left);
            const float highY =
                max(max(a.y0, a.y1), max(b.y0, b.y1)) + reach - static_cast<float>(window_.top);
            if (highX < 0 || highY < 0 || lowX >= static_cast<float>(window_.columns) ||
                lowY >= static_cast<float>(window_.rows))
                continue;
            const auto tileOf = [](float at, int count) {
                return std::clamp(static_cast<int>(clamp(at, 0.0f, 1e8f)) / kSide, 0, count - 1);
            };
            for (int y = tileOf(lowY, down_); y <= tileOf(highY, down_); ++y) {
                for (int x = tileOf(lowX, across_); x <= tileOf(highX, across_); ++x)
                    found.push_back({static_cast<std::uint32_t>(y * across_ + x), i});
            }
        }
    });
    starts_.assign(count() + 1, 0);
    for (const auto& chunk : entries) {
        for (const Entry& entry : chunk) ++starts_[entry.tile + 1];
    }
    for (std::size_t i = 0; i < count(); ++i) starts_[i + 1] += starts_[i];
    items_.resize(starts_.back());
    std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
    for (const auto& chunk : entries) {
        for (const Entry& entry : chunk) items_[next[entry.tile]++] = entry.item;
    }
}

std::vector<std::uint64_t> RibbonTiles::nearestFirst(std::size_t index) const {
    std::vector<std::uint64_t> order;
    order.reserve(starts_[index + 1] - starts_[index]);
    for (std::uint32_t k = starts_[index]; k < starts_[index + 1]; ++k) {
        const std::uint32_t item = items_[k];
        const float depth = max(min(projected_[item].depth, projected_[item + 1].depth), 0.0f);
        order.push_back((std::uint64_t{asuint(depth)} << 32u) | item);
    }
    std::ranges::sort(order);
    return order;
}

RibbonPiece RibbonTiles::pieceOf(std::uint32_t item) const {
    const Projected& a = projected_[item];
    const Projected& b = projected_[item + 1];
    RibbonPiece piece;
    const float2 middle(0.25f * (a.x0 + a.x1 + b.x0 + b.x1), 0.25f * (a.y0 + a.y1 + b.y0 + b.y1));
    piece.originX = static_cast<int>(floor(middle.x));
    piece.originY = static_cast<int>(floor(middle.y));
    const float2 origin(static_cast<float>(piece.originX), static_cast<float>(piece.originY));
    const float2 a0 = float2(a.x0, a.y0) - origin;
    const float2 a1 = float2(a.x1, a.y1) - origin;
    const float2 b0 = float2(b.x0, b.y0) - origin;
    const float2 b1 = float2(b.x1, b.y1) - origin;
    piece.begins = lineThrough(a1, a0);
    piece.ends = lineThrough(b0, b1);
    piece.left = lineThrough(a0, b0);
    piece.right = lineThrough(b1, a1);
    piece.depthBegin = a.depth;
    piece.depthEnd = b.depth;
    piece.coverageBegin = a.coverage;
    piece.coverageEnd = b.coverage;
    const float2 start = (a0 + a1) * 0.5f;
    const float2 d = (b0 + b1) * 0.5f - start;
    const float2 minimum = min(min(a0, a1), min(b0, b1));
    const float2 maximum = max(max(a0, a1), max(b0, b1));
    piece.steep = abs(d.y) > abs(d.x);
    const float run = piece.steep ? d.y : d.x;
    piece.slope = abs(run) > 1e-6f ? (piece.steep ? d.x : d.y) / run : 0.0f;
    const float halfWidth = 0.5f * max(length(a1 - a0), length(b1 - b0));
    piece.across = halfWidth * sqrt(1.0f + piece.slope * piece.slope) + window_.reach * abs(piece.slope);
    piece.startU = piece.steep ? start.y : start.x;
    piece.startV = piece.steep ? start.x : start.y;
    piece.lowU = piece.steep ? minimum.y : minimum.x;
    piece.highU = piece.steep ? maximum.y : maximum.x;
    return piece;
}

}  // namespace hairloom::software
