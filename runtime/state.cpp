// SPDX-License-Identifier: MIT
#include "runtime/state.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace hairloom::runtime {
namespace {

/// Bits of 10-bit x, two apart.
std::uint32_t spread(std::uint32_t x) {
    x = (x | (x << 16)) & 0x030000ffu;
    x = (x | (x << 8)) & 0x0300f00fu;
    x = (x | (x << 4)) & 0x030c30c3u;
    return (x | (x << 2)) & 0x09249249u;
}

/// Place along a Morton curve through the roots' box: strands that follow each other lie close.
std::vector<std::uint32_t> mortonCodes(const StrandsView& strands) {
    const std::size_t count = strands.offsets.size() - 1;
    Float3 low = strands.restPositions_ss[0], high = low;
    for (std::size_t s = 0; s < count; ++s) {
        const Float3 p = strands.restPositions_ss[strands.offsets[s]];
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const float size = std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-20f});
    const auto cell = [&](float offset) {
        return std::min(static_cast<std::uint32_t>(offset / size * 1023.0f), 1023u);
    };
    std::vector<std::uint32_t> codes(count);
    for (std::size_t s = 0; s < count; ++s) {
        const Float3 p = strands.restPositions_ss[strands.offsets[s]] - low;
        codes[s] = spread(cell(p.x)) | (spread(cell(p.y)) << 1) | (spread(cell(p.z)) << 2);
    }
    return codes;
}

std::vector<Block> groupStrands(const StrandsView& strands) {
    const std::size_t count = strands.offsets.size() - 1;
    const auto pointsOf = [&](std::uint32_t s) { return strands.offsets[s + 1] - strands.offsets[s]; };
    const std::vector<std::uint32_t> codes = mortonCodes(strands);
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        if (pointsOf(a) != pointsOf(b)) return pointsOf(a) < pointsOf(b);
        return codes[a] != codes[b] ? codes[a] < codes[b] : a < b;
    });
    std::vector<Block> blocks;
    std::size_t plane = 0;
    for (std::size_t i = 0; i < count;) {
        Block block{pointsOf(order[i]), 0, plane, {}};
        while (i < count && block.strands < kBlockLanes && pointsOf(order[i]) == block.points) {
            block.strandOfLane[block.strands++] = order[i++];
        }
        std::fill(block.strandOfLane + block.strands, block.strandOfLane + kBlockLanes, order[i - 1]);
        plane += planeSize(block);
        blocks.push_back(block);
    }
    return blocks;
}

void fillRestPlanes(const StrandsView& strands, const Block& block, RestShape& shape) {
    const std::size_t size = planeSize(block);
    float* const planes = shape.planes.data() + block.firstPlane * kRestPlanes;
    for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
        const std::uint32_t strand = block.strandOfLane[lane];
        const Float3* points = strands.restPositions_ss.data() + strands.offsets[strand];
        const Quat toRoot = conjugate(shape.restRoots[strand].rotation);
        float total = 0.0f;
        for (std::uint32_t s = 0; s + 1 < block.points; ++s) {
            const Float3 segment = rotate(toRoot, points[s + 1] - points[s]);
            const float l = length(segment);
            const std::size_t i = std::size_t{s} * kBlockLanes + lane;
            planes[i] = segment.x;
            planes[size + i] = segment.y;
            planes[2 * size + i] = segment.z;
            planes[3 * size + i] = l;
            planes[4 * size + i] = l > 1e-9f ? 1.0f / l : 0.0f;
            total += l;
        }
        shape.longestStrand = std::max(shape.longestStrand, total);
    }
    shape.longestPointCount = std::max(shape.longestPointCount, block.points);
}

std::uint64_t mix(std::uint64_t hash, const void* data, std::size_t bytes) {
    const auto* at = static_cast<const unsigned char*>(data);
    for (; bytes > 0;) {
        const std::size_t part = std::min<std::size_t>(bytes, 8);
        std::uint64_t word = 0;
        std::memcpy(&word, at, part);
        hash = (hash ^ word) * 0x9e3779b97f4a7c15ull;
        hash ^= hash >> 32;
        at += part;
        bytes -= part;
    }
    return hash;
}

}  // namespace

std::size_t RestShape::bytes() const {
    return offsets.size() * sizeof(offsets[0]) + blocks.size() * sizeof(Block) +
           planes.size() * sizeof(float) + restRoots.size() * sizeof(RootFrame);
}

std::shared_ptr<const RestShape> makeRestShape(const StrandsView& strands) {
    auto shape = std::make_shared<RestShape>();
    const std::size_t count = strands.offsets.size() - 1;
    shape->offsets.assign(strands.offsets.begin(), strands.offsets.end());
    shape->restRoots.resize(count);
    for (std::size_t s = 0; s < count; ++s) {
        Quat rotation;
        if (!strands.rootRotations_ss.empty()) rotation = strands.rootRotations_ss[s];
        normalize(rotation);
        shape->restRoots[s] = {strands.restPositions_ss[strands.offsets[s]], rotation};
    }
    if (count == 0) return shape;
    shape->blocks = groupStrands(strands);
    shape->planeFloats = shape->blocks.back().firstPlane + planeSize(shape->blocks.back());
    shape->planes.assign(shape->planeFloats * kRestPlanes, 0.0f);
    for (const Block& block : shape->blocks) fillRestPlanes(strands, block, *shape);
    return shape;
}

std::uint64_t State::hash() const {
    std::uint64_t hash = 0xcbf29ce484222325ull;
    hash = mix(hash, planes.data(), planes.size() * sizeof(float));
    return mix(hash, roots.data(), roots.size() * sizeof(float));
}

BlockView viewOf(const RestShape& shape, State& state, std::size_t index, std::uint32_t clampedPoints) {
    const Block& block = shape.blocks[index];
    const std::size_t size = planeSize(block);
    const float* rest = shape.planes.data() + block.firstPlane * kRestPlanes;
    float* moving = state.planes.data() + block.firstPlane * kStatePlanes;
    const float* pull = state.pull.empty() ? nullptr : state.pull.data() + block.firstPlane * kPullPlanes;
    return {block.points,
            clampedPoints,
            {moving, moving + size, moving + 2 * size},
            {moving + 3 * size, moving + 4 * size, moving + 5 * size},
            {rest, rest + size, rest + 2 * size},
            rest + 3 * size,
            rest + 4 * size,
            pull,
            pull == nullptr ? nullptr : pull + size};
}

void placeAtRest(const RestShape& shape, State& state, std::size_t index) {
    const Block& block = shape.blocks[index];
    const BlockView view = viewOf(shape, state, index, 1);
    const float* roots = state.roots.data() + index * kRootRows * kBlockLanes;
    for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
        const auto row = [&](std::size_t r) { return roots[r * kBlockLanes + lane]; };
        const Quat rotation{row(3), row(4), row(5), row(6)};
        Float3 at{};
        for (std::uint32_t p = 0; p < block.points; ++p) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            view.position.x[i] = view.previous.x[i] = at.x;
            view.position.y[i] = view.previous.y[i] = at.y;
            view.position.z[i] = view.previous.z[i] = at.z;
            at = at + rotate(rotation, Float3{view.rest.x[i], view.rest.y[i], view.rest.z[i]});
        }
    }
}

void fillPull(const RestShape& shape, const SimulationSettings& settings, float h, std::size_t index,
              State& state) {
    constexpr float kFrequency = 100.0f;  // rad/s
    constexpr float kSegment = 0.01f;     // metres
    const Block& block = shape.blocks[index];
    constexpr float kDamping = 2.0f;  // ζ: twice critical
    float* const pull = state.pull.data() + block.firstPlane * kPullPlanes;
    float* const settle = pull + planeSize(block);
    const float* lengths = shape.planes.data() + block.firstPlane * kRestPlanes + 3 * planeSize(block);
    for (std::uint32_t s = 0; s + 1 < block.points; ++s) {
        const float along = static_cast<float>(s) / static_cast<float>(block.points - 1);
        const float stiffness =
            settings.angularStiffness * (1.0f + (settings.angularTipShare - 1.0f) * along);
        const float compliance = std::max(1.0f - stiffness, 1e-9f);
        const float share = kFrequency * h * kSegment;
        for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
            const std::size_t i = std::size_t{s} * kBlockLanes + lane;
            const float ratio = share / std::max(lengths[i], 1e-9f);
            const float x = std::min(ratio * std::sqrt(stiffness / compliance), 1e9f);
            const float both = x * x + 2.0f * kDamping * x;
            pull[i] = both / (1.0f + both);
            settle[i] = 2.0f * kDamping / (x + 2.0f * kDamping);
        }
    }
}

}  // namespace hairloom::runtime
