// SPDX-License-Identifier: MIT
#include "engine/slots.h"

#include <algorithm>

namespace hairloom::runtime {

namespace {

/// Calls visit(block, point, index of lane 0 in a plane of that block, index of its slot in a plane of the
/// slots) for each row of kBlockLanes strands.
template <class Visit>
void forEachRow(const RestShape& shape, const Slots& slots, const Visit& visit) {
    for (std::size_t n = 0; n < slots.blocks.size(); ++n) {
        const std::size_t block = slots.blocks[n];
        for (std::uint32_t p = 0; p < shape.blocks[block].points; ++p) {
            const std::size_t first = n * kBlockLanes;
            visit(block, p, std::size_t{p} * kBlockLanes,
                  slots.together ? first * slots.points + p : std::size_t{p} * slots.count + first);
        }
    }
}

}  // namespace

Vector<float> planesOfSlots(const RestShape& shape, const Slots& slots, const Floats& planes,
                            std::size_t count) {
    const std::size_t plane = slots.planeSize(), stride = slots.laneStride();
    Vector<float> values(plane * count, 0.0f);
    forEachRow(shape, slots, [&](std::size_t block, std::uint32_t, std::size_t inBlock, std::size_t inSlots) {
        const float* const first = planes.data() + shape.blocks[block].firstPlane * count;
        for (std::size_t k = 0; k < count; ++k) {
            const float* const row = first + k * planeSize(shape.blocks[block]) + inBlock;
            float* const to = values.data() + k * plane + inSlots;
            for (std::size_t lane = 0; lane < kBlockLanes; ++lane) to[lane * stride] = row[lane];
        }
    });
    return values;
}

void planesOfBlocks(const RestShape& shape, const Slots& slots, std::span<const float> values, Floats& planes,
                    std::size_t count) {
    const std::size_t plane = slots.planeSize(), stride = slots.laneStride();
    forEachRow(shape, slots, [&](std::size_t block, std::uint32_t, std::size_t inBlock, std::size_t inSlots) {
        float* const first = planes.data() + shape.blocks[block].firstPlane * count;
        for (std::size_t k = 0; k < count; ++k) {
            float* const row = first + k * planeSize(shape.blocks[block]) + inBlock;
            const float* const from = values.data() + k * plane + inSlots;
            for (std::size_t lane = 0; lane < kBlockLanes; ++lane) row[lane] = from[lane * stride];
        }
    });
}

void rowsToBlocks(const Slots& slots, std::span<const float> values, std::size_t rows, float* blocks) {
    for (std::size_t n = 0; n < slots.blocks.size(); ++n) {
        for (std::size_t r = 0; r < rows; ++r)
            std::copy_n(values.data() + r * slots.count + n * kBlockLanes, kBlockLanes,
                        blocks + (slots.blocks[n] * rows + r) * kBlockLanes);
    }
}

Vector<float> rowsOfSlots(const Slots& slots, const float* blocks, std::size_t rows) {
    Vector<float> values(rows * slots.count);
    for (std::size_t n = 0; n < slots.blocks.size(); ++n) {
        for (std::size_t r = 0; r < rows; ++r)
            std::copy_n(blocks + (slots.blocks[n] * rows + r) * kBlockLanes, kBlockLanes,
                        values.data() + r * slots.count + n * kBlockLanes);
    }
    return values;
}

Vector<float> restsOfSlots(const Slots& slots, std::span<const Rest> rests) {
    Vector<float> values;
    values.reserve(slots.blocks.size() * kRestFloats);
    for (const std::uint32_t block : slots.blocks) {
        const Rest& rest = rests[block];
        for (const float number :
             {rest.time, rest.asleep ? 1.0f : 0.0f, rest.stayed, rest.stayed > 0.0f ? 0.0f : 1.0f})
            values.push_back(number);
    }
    for (const std::uint32_t block : slots.blocks)
        values.insert(values.end(), rests[block].anchors.begin(), rests[block].anchors.end());
    return values;
}

void restsToBlocks(const Slots& slots, std::span<const float> values, std::span<Rest> rests) {
    const float* number = values.data();
    const float* anchors = number + slots.blocks.size() * HAIRLOOM_REST_NUMBERS;
    for (const std::uint32_t block : slots.blocks) {
        Rest& rest = rests[block];
        rest = {number[0], number[1] != 0.0f, number[2]};
        std::copy_n(anchors, rest.anchors.size(), rest.anchors.begin());
        number += HAIRLOOM_REST_NUMBERS;
        anchors += rest.anchors.size();
    }
}

Vector<shaders::float4> quadsOfSlots(const RestShape& shape, const Slots& slots, const Floats& planes,
                                     std::size_t count, std::span<const std::size_t> which) {
    Vector<shaders::float4> values(slots.planeSize());
    forEachRow(shape, slots, [&](std::size_t block, std::uint32_t, std::size_t inBlock, std::size_t inSlots) {
        const std::size_t size = planeSize(shape.blocks[block]);
        const float* const first = planes.data() + shape.blocks[block].firstPlane * count + inBlock;
        for (std::size_t lane = 0; lane < kBlockLanes; ++lane) {
            std::array<float, 4> parts{};
            for (std::size_t k = 0; k < which.size(); ++k) parts[k] = first[which[k] * size + lane];
            values[inSlots + lane * slots.laneStride()] = {parts[0], parts[1], parts[2], parts[3]};
        }
    });
    return values;
}

RestSlots restOfSlots(const RestShape& shape, const Slots& slots) {
    // Rest planes: x, y, z, length, inverse length, inverse mass.
    constexpr std::array<std::size_t, 4> kVectors{0, 1, 2, 3};
    constexpr std::array<std::size_t, 2> kLengthAndMass{3, 5};
    RestSlots made;
    made.rest = quadsOfSlots(shape, slots, shape.planes, kRestPlanes, kVectors);
    for (const shaders::float4& quad : quadsOfSlots(shape, slots, shape.planes, kRestPlanes, kLengthAndMass))
        made.segments.push_back({quad.x, quad.y});
    for (const std::uint32_t b : slots.blocks) {
        const Block& block = shape.blocks[b];
        made.blocks.push_back({block.points, block.strands});
        for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane)
            made.firstPoints.push_back(lane < block.strands ? shape.offsets[block.strandOfLane[lane]] : ~0u);
    }
    return made;
}

void putRootsOfSlots(const RestShape& shape, const Slots& slots, std::span<const RootFrame> roots,
                     const Vector<bool>& moved, std::span<shaders::float4> rows) {
    for (std::size_t n = 0; n < slots.blocks.size(); ++n) {
        for (std::size_t lane = 0; lane < kBlockLanes; ++lane) {
            const std::uint32_t strand = shape.blocks[slots.blocks[n]].strandOfLane[lane];
            const RootFrame& root = roots[strand];
            const std::size_t slot = n * kBlockLanes + lane;
            rows[2 * slot] = {root.position.x, root.position.y, root.position.z,
                              !moved.empty() && moved[strand] ? 1.0f : 0.0f};
            rows[2 * slot + 1] = {root.rotation.x, root.rotation.y, root.rotation.z, root.rotation.w};
        }
    }
}

}  // namespace hairloom::runtime
