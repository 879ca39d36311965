// SPDX-License-Identifier: MIT
#include "engine/state.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <span>

#include "engine/in_parallel.h"

namespace hairloom::runtime {
namespace {

constexpr std::size_t kStrandsPerPiece = 256;

/// The most lanes of a vector or block that a part of `count` strands can fill.
std::size_t unitOf(std::size_t count) {
    for (const std::size_t lanes : {kBlockLanes, kWidestVector, kWidestVector / 2}) {
        if (count > lanes) return lanes;
    }
    return kWidestVector / 4;
}

/// Orders strands so that those of a block lie close, and those of each of its vectors closer still: what
/// acts on a few strands at one place then stops few vectors. Halves them across the longest side of their
/// box, again and again.
void orderByPosition(std::span<std::uint32_t> strands, std::span<const Float3> positions) {
    const std::size_t unit = unitOf(strands.size());
    if (strands.size() <= unit) {
        std::sort(strands.begin(), strands.end());
        return;
    }
    Float3 low = positions[strands[0]], high = low;
    for (const std::uint32_t s : strands) {
        const Float3 p = positions[s];
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Float3 size = high - low;
    const auto longest = size.x >= size.y && size.x >= size.z ? &Float3::x
                         : size.y >= size.z                   ? &Float3::y
                                                              : &Float3::z;
    const std::size_t half = std::max((strands.size() + unit) / (2 * unit), std::size_t{1}) * unit;
    std::nth_element(strands.begin(), strands.begin() + static_cast<std::ptrdiff_t>(half), strands.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                         const float atA = positions[a].*longest, atB = positions[b].*longest;
                         return atA != atB ? atA < atB : a < b;
                     });
    orderByPosition(strands.first(half), positions);
    orderByPosition(strands.subspan(half), positions);
}

/// Segments that turn by less, in radians, count as straight.
constexpr float kStraightTurn = 1e-4f;

/// Whether the strand bends at rest.
bool bends(std::span<const Float3> points) {
    Float3 before{};
    for (std::size_t p = 1; p < points.size(); ++p) {
        const Float3 segment = points[p] - points[p - 1];
        const float size = length(segment);
        if (!(size > 1e-9f)) continue;
        const Float3 direction = segment * (1.0f / size);
        if (length(before) > 0.5f && length(direction - before) > kStraightTurn) return true;
        before = direction;
    }
    return false;
}

/// In blocks of equal point counts; straight strands and others apart, so that each block pays for what it
/// needs.
Vector<Block> groupStrands(const StrandsView& strands, const Host& host, bool& straight) {
    const std::size_t count = strands.offsets.size() - 1;
    const auto pointsOf = [&](std::uint32_t s) { return strands.offsets[s + 1] - strands.offsets[s]; };
    Vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    Vector<std::uint32_t> kind(count);  // twice the points, and one more where the strand bends
    inParallel(host, count, kStrandsPerPiece, [&](std::size_t begin, std::size_t end) {
        for (auto s = static_cast<std::uint32_t>(begin); s < end; ++s) {
            const bool curved = bends(strands.restPositions_ss.subspan(strands.offsets[s], pointsOf(s)));
            kind[s] = 2 * pointsOf(s) + (curved ? 1 : 0);
        }
    });
    straight = std::none_of(kind.begin(), kind.end(), [](std::uint32_t k) { return k % 2 == 1; });
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return kind[a] != kind[b] ? kind[a] < kind[b] : a < b;
    });
    // Where strands touch things, rather than where they grow.
    Vector<Float3> positions(count);
    for (std::uint32_t s = 0; s < count; ++s)
        positions[s] = strands.restPositions_ss[strands.offsets[s] + pointsOf(s) / 4];
    for (std::size_t first = 0, end = 0; first < count; first = end) {
        while (end < count && kind[order[end]] == kind[order[first]]) ++end;
        orderByPosition(std::span(order).subspan(first, end - first), positions);
    }
    Vector<Block> blocks;
    std::size_t plane = 0;
    for (std::size_t i = 0; i < count;) {
        Block block{pointsOf(order[i]), 0, plane, {}};
        const std::uint32_t sort = kind[order[i]];
        while (i < count && block.strands < kBlockLanes && kind[order[i]] == sort) {
            block.strandOfLane[block.strands++] = order[i++];
        }
        std::fill(block.strandOfLane + block.strands, block.strandOfLane + kBlockLanes, order[i - 1]);
        plane += planeSize(block);
        blocks.push_back(block);
    }
    return blocks;
}

/// Least mass of a point as a share of the strand's mean.
constexpr double kMinMass = 1e-6;

void fillInverseMasses(const StrandsView& strands, std::uint32_t strand, const Block& block,
                       std::uint32_t lane, float* inverseMasses) {
    const std::uint32_t first = strands.offsets[strand];
    const auto half = [&](std::uint32_t p) {
        return p + 1 < block.points
                   ? 0.5 * static_cast<double>(length(strands.restPositions_ss[first + p + 1] -
                                                      strands.restPositions_ss[first + p]))
                   : 0.0;
    };
    const auto massOf = [&](std::uint32_t p) {
        if (!strands.masses.empty()) return static_cast<double>(strands.masses[first + p]);
        return half(p) + (p > 0 ? half(p - 1) : 0.0);
    };
    double total = 0.0;
    for (std::uint32_t p = 0; p < block.points; ++p) total += massOf(p);
    const double mean = total / block.points;
    for (std::uint32_t p = 0; p < block.points; ++p) {
        // Between segments without length a point still weighs something.
        const double relative = mean > 0.0 ? std::max(massOf(p) / mean, kMinMass) : 1.0;
        inverseMasses[std::size_t{p} * kBlockLanes + lane] = static_cast<float>(1.0 / relative);
    }
}

/// Metres of the longest strand.
float fillRestPlanes(const StrandsView& strands, const Block& block, RestShape& shape) {
    float longest = 0.0f;
    const std::size_t size = planeSize(block);
    float* const planes = shape.planes.data() + block.firstPlane * kRestPlanes;
    for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
        const std::uint32_t strand = block.strandOfLane[lane];
        const Float3* points = strands.restPositions_ss.data() + strands.offsets[strand];
        const Quat toRoot = conjugate(shape.restRoots[strand].rotation);
        fillInverseMasses(strands, strand, block, lane, planes + 5 * size);
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
        longest = std::max(longest, total);
    }
    return longest;
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
           (planes.size() + stiffness.size()) * sizeof(float) + restRoots.size() * sizeof(RootFrame);
}

Floats zeroFloats(std::size_t count, const Host& host) {
    constexpr std::size_t kPiece = std::size_t{1} << 20;
    if (!host.parallelFor || count <= kPiece) return Floats(count, 0.0f);
    Floats values(count);
    host.parallelFor(count, kPiece, [&](std::size_t begin, std::size_t end) {
        std::memset(values.data() + begin, 0, (end - begin) * sizeof(float));
    });
    return values;
}

std::shared_ptr<const RestShape> makeRestShape(const StrandsView& strands, const Host& host) {
    auto shape = makeShared<RestShape>();
    const std::size_t count = strands.offsets.size() - 1;
    shape->offsets.assign(strands.offsets.begin(), strands.offsets.end());
    shape->restRoots.resize(count);
    for (std::size_t s = 0; s < count; ++s) {
        Quat rotation;
        if (!strands.rootRotations_ss.empty()) rotation = strands.rootRotations_ss[s];
        normalize(rotation);
        shape->restRoots[s] = {strands.restPositions_ss[strands.offsets[s]], rotation};
    }
    if (std::any_of(strands.stiffness.begin(), strands.stiffness.end(), [](float s) { return s != 1.0f; }))
        shape->stiffness.assign(strands.stiffness.begin(), strands.stiffness.end());
    if (count == 0) return shape;
    shape->blocks = groupStrands(strands, host, shape->straight);
    shape->planeFloats = shape->blocks.back().firstPlane + planeSize(shape->blocks.back());
    shape->planes = zeroFloats(shape->planeFloats * kRestPlanes, host);
    Vector<float> longest(shape->blocks.size());
    inParallel(host, longest.size(), kStrandsPerPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b)
            longest[b] = fillRestPlanes(strands, shape->blocks[b], *shape);
    });
    shape->longestStrand = *std::max_element(longest.begin(), longest.end());
    for (const Block& block : shape->blocks)
        shape->longestPointCount = std::max(shape->longestPointCount, block.points);
    return shape;
}

std::uint64_t State::hash() const {
    std::uint64_t hash = 0xcbf29ce484222325ull;
    hash = mix(hash, planes.data(), planes.size() * sizeof(float));
    for (const Floats& values : own) hash = mix(hash, values.data(), values.size() * sizeof(float));
    return mix(hash, roots.data(), roots.size() * sizeof(float));
}

void fillView(const RestShape& shape, State& state, std::size_t index, std::uint32_t clampedPoints,
              BlockView& view) {
    const Block& block = shape.blocks[index];
    const std::size_t size = planeSize(block);
    const float* rest = shape.planes.data() + block.firstPlane * kRestPlanes;
    float* moving = state.planes.data() + block.firstPlane * kStatePlanes;
    view.lanes = (block.strands + kWidestVector - 1) / kWidestVector * kWidestVector;
    view.points = block.points;
    view.firstFree = clampedPoints;
    view.pitch = size;
    view.position = {moving, size};
    view.previous = {moving + 3 * size, size};
    view.rest = {rest, size};
    view.length = rest + 3 * size;
    view.inverseLength = rest + 4 * size;
    view.inverseMass = rest + 5 * size;
}

void placeAtRest(const RestShape& shape, State& state, std::size_t index, LaneRange lanes) {
    const Block& block = shape.blocks[index];
    const std::size_t size = planeSize(block);
    const float* rest = shape.planes.data() + block.firstPlane * kRestPlanes;
    float* moving = state.planes.data() + block.firstPlane * kStatePlanes;
    const float* roots = state.roots.data() + index * kRootRows * kBlockLanes;
    Float3 at[kBlockLanes] = {};
    for (std::uint32_t p = 0; p < block.points; ++p) {
        for (std::uint32_t lane = lanes.begin; lane < lanes.end; ++lane) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            const float values[] = {at[lane].x, at[lane].y, at[lane].z, at[lane].x, at[lane].y, at[lane].z};
            for (std::size_t plane = 0; plane < kStatePlanes; ++plane)
                moving[plane * size + i] = values[plane];
            const auto row = [&](std::size_t r) { return roots[r * kBlockLanes + lane]; };
            const Quat rotation{row(3), row(4), row(5), row(6)};
            at[lane] = at[lane] + rotate(rotation, Float3{rest[i], rest[size + i], rest[2 * size + i]});
        }
    }
}

}  // namespace hairloom::runtime
