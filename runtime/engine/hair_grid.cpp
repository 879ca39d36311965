// SPDX-License-Identifier: MIT
#include "engine/hair_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hairloom::runtime {
namespace {

constexpr int kShareBits = 6;  // of a place in its cell along an axis
constexpr std::int32_t kWhole = 1 << kShareBits;
constexpr float kVelocityUnit = 1.0f / 1024.0f, kMostVelocity = 32.0f;  // m/s
constexpr float kFarCells = 1e5f;
/// Hair may be so much denser than authored before it is pressed apart: what a cell sees of hair changes by
/// less as its grid goes with the head.
constexpr float kDensitySlack = 0.05f;
constexpr float kHairPressure = 40.0f;  // m²/s², of twice the authored density at full strength
/// Of pressure over cell²: how fast the push on a node falls as it moves, of a wave as short as the grid
/// sees.
constexpr float kStiffnessShare = 5.0f;
/// Places in HairGrid::Field.
constexpr std::size_t kFieldStiffness = 3, kFieldVelocity = 4, kFieldDensity = 7;
constexpr std::size_t kHairBlocksPerPiece = 4;

/// The rows of R(q).
std::array<Float3, 3> rowsOf(Quat q) {
    const Float3 x = rotate(q, {1.0f, 0.0f, 0.0f}), y = rotate(q, {0.0f, 1.0f, 0.0f}),
                 z = rotate(q, {0.0f, 0.0f, 1.0f});
    return {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
}

}  // namespace

template <class Body>
void HairGrid::forEach(const Host& host, std::size_t count, std::size_t grain, const Body& body) {
    const auto run = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) body(i);
    };
    // By reference: a std::function that copied the captures would allocate.
    const Host::Body all = std::ref(run);
    host.parallelFor ? host.parallelFor(count, grain, all) : all(0, count);
}

/// Where a block's points are in the space of the head, in cells.
void HairGrid::locate(const RestShape& shape, const State& state, std::size_t index) {
    const Block& block = shape.blocks[index];
    const std::size_t size = planeSize(block);
    const float* const position = state.planes.data() + block.firstPlane * kStatePlanes;
    float* const places = places_.data() + 3 * block.firstPlane;
    const std::array<Float3, 3> rows = rowsOf(conjugate(head_.rotation));
    const float inverse = 1.0f / cell_;
    Float3 root[kBlockLanes];
    for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane)
        root[lane] = hairRootAt(state.roots, index, lane) - head_.at;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Float3 r = rows[axis] * inverse;
        const float center[] = {head_.center.x, head_.center.y, head_.center.z};
        float base[kBlockLanes], low[kBlockLanes], high[kBlockLanes];
        for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
            base[lane] = dot(r, root[lane]) + center[axis] * inverse;
            low[lane] = kFarCells;
            high[lane] = -kFarCells;
        }
        float* const to = places + axis * size;
        for (std::uint32_t p = 0; p < block.points; ++p) {
            const std::size_t at = std::size_t{p} * kBlockLanes;
            for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
                const std::size_t i = at + lane;
                const float x =
                    r.x * position[i] + r.y * position[size + i] + r.z * position[2 * size + i] + base[lane];
                to[i] = x;
                // What is no number is neither.
                low[lane] = x < low[lane] ? x : low[lane];
                high[lane] = x > high[lane] ? x : high[lane];
            }
        }
        bounds_[index].low[axis] = *std::min_element(low, low + kBlockLanes);
        bounds_[index].high[axis] = *std::max_element(high, high + kBlockLanes);
    }
}

/// Of all hair, with a node around it. Where that is too much, as much around the authored hair as can be.
HairGrid::Box HairGrid::boxOf(const std::vector<Bounds>& bounds) const {
    std::array<float, 3> low, high;
    low.fill(kFarCells);
    high.fill(-kFarCells);
    for (const Bounds& block : bounds) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], block.low[axis]);
            high[axis] = std::max(high[axis], block.high[axis]);
        }
    }
    Box whole;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(low[axis] <= high[axis])) return {};
        const auto first = static_cast<std::int32_t>(std::floor(std::max(low[axis], -kFarCells))) - 1;
        const auto last = static_cast<std::int32_t>(std::floor(std::min(high[axis], kFarCells))) + 2;
        whole.low[axis] = first;
        whole.size[axis] = last - first + 1;
    }
    if (restBox_.size[0] == 1 << 20 || whole.nodes() <= kMostHairNodes) return whole;
    Box best;
    for (std::int32_t grown = 0;; ++grown) {
        Box cut;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int32_t first = std::max(whole.low[axis], restBox_.low[axis] - grown);
            const std::int32_t end = std::min(whole.low[axis] + whole.size[axis],
                                              restBox_.low[axis] + restBox_.size[axis] + grown);
            cut.low[axis] = first;
            cut.size[axis] = std::max(end - first, 0);
        }
        if (cut.nodes() > kMostHairNodes || cut == best) return best;
        best = cut;
    }
}

bool HairGrid::findCell(const float* at, std::size_t pitch, Cell& cell) const {
    std::size_t corner[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float from = at[axis * pitch] - static_cast<float>(box_.low[axis]);
        if (!(from >= 0.0f && from < static_cast<float>(box_.size[axis] - 1))) return false;
        corner[axis] = static_cast<std::size_t>(static_cast<std::uint32_t>(from));
        cell.share[axis] = from - static_cast<float>(static_cast<std::uint32_t>(from));
    }
    cell.node = (corner[2] * static_cast<std::size_t>(box_.size[1]) + corner[1]) *
                    static_cast<std::size_t>(box_.size[0]) +
                corner[0];
    return true;
}

void HairGrid::deposit(const RestShape& shape, const State& state, std::size_t index,
                       std::vector<Node>& nodes) const {
    const Block& block = shape.blocks[index];
    const std::size_t size = planeSize(block);
    const float* const moving = state.planes.data() + block.firstPlane * kStatePlanes;
    const float* const places = places_.data() + 3 * block.firstPlane;
    const float rate = state.substep > 0.0f ? 1.0f / state.substep : 0.0f;
    const auto row = static_cast<std::size_t>(box_.size[0]),
               slice = row * static_cast<std::size_t>(box_.size[1]);
    const float reference[] = {motion_.reference.x, motion_.reference.y, motion_.reference.z};
    for (std::uint32_t p = 0; p < block.points; ++p) {
        for (std::uint32_t lane = 0; lane < block.strands; ++lane) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            Cell cell;
            if (!findCell(places + i, size, cell)) continue;
            const Point point = points_[block.firstPlane + i];
            std::int64_t velocity[3];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const float v =
                    (moving[axis * size + i] - moving[(axis + 3) * size + i]) * rate - reference[axis];
                const float within =
                    v > -kMostVelocity ? (v < kMostVelocity ? v : kMostVelocity) : -kMostVelocity;
                velocity[axis] = static_cast<std::int32_t>(within * (1.0f / kVelocityUnit) +
                                                           (within < 0.0f ? -0.5f : 0.5f));
            }
            std::int32_t far[3];
            for (std::size_t axis = 0; axis < 3; ++axis)
                far[axis] = static_cast<std::int32_t>(cell.share[axis] * static_cast<float>(kWhole) + 0.5f);
            for (unsigned corner = 0; corner < 8; ++corner) {
                const std::int32_t weight = ((corner & 1u) ? far[0] : kWhole - far[0]) *
                                            ((corner >> 1 & 1u) ? far[1] : kWhole - far[1]) *
                                            ((corner >> 2) ? far[2] : kWhole - far[2]);
                const std::int64_t mass = std::int64_t{weight} * point.mass;
                Node& node =
                    nodes[cell.node + (corner & 1u) + (corner >> 1 & 1u) * row + (corner >> 2) * slice];
                node.mass += mass;
                node.room += mass * point.room;
                node.x += mass * velocity[0];
                node.y += mass * velocity[1];
                node.z += mass * velocity[2];
            }
        }
    }
}

void HairGrid::update(const RestShape& shape, const State& state, const Floats& nextRoots,
                      const SimulationSettings& settings, float h, std::uint32_t count, const Host& host) {
    const std::size_t blocks = shape.blocks.size();
    const float time = h * static_cast<float>(count);
    const Head before = std::exchange(head_, headAt(shape, state.roots)), next = headAt(shape, nextRoots);
    motion_ = {};
    if (const Float3 way = next.at - head_.at; length(way) <= settings.teleportDistance) {
        const Quat turn = next.rotation * conjugate(head_.rotation);
        motion_.velocity = way * (1.0f / time);
        motion_.spin = Float3{turn.x, turn.y, turn.z} * ((turn.w < 0.0f ? -2.0f : 2.0f) / time);
    }
    if (state.substep > 0.0f) {
        // Root of the first lane of the first block: it need not be exact.
        const Block& block = shape.blocks.front();
        const std::size_t size = planeSize(block);
        const float* const moving = state.planes.data() + block.firstPlane * kStatePlanes;
        const Float3 moved{moving[0] - moving[3 * size], moving[size] - moving[4 * size],
                           moving[2 * size] - moving[5 * size]};
        if (isFinite(moved)) motion_.reference = moved * (1.0f / state.substep);
    }
    bool same = sleepersCounted_ && before == head_;
    for (std::size_t b = 0; same && b < blocks; ++b) same = (counted_[b] != 0) == state.rests[b].asleep;
    forEach(host, blocks, kHairBlocksPerPiece, [&](std::size_t b) {
        if (!same || !state.rests[b].asleep) locate(shape, state, b);
    });
    const Box box = boxOf(bounds_);
    same = same && box == box_ && motion_.reference == Float3{};
    box_ = box;
    if (box_.nodes() == 0) {
        std::fill(felt_.begin(), felt_.end(), 0.0f);
        sleepersCounted_ = false;
        return;
    }
    if (!same) {
        const bool any =
            std::any_of(state.rests.begin(), state.rests.end(), [](const Rest& rest) { return rest.asleep; });
        if (any || anySleep_) std::fill_n(sleepers_.begin(), kMostHairNodes, Node{});
        anySleep_ = any;
        for (std::size_t b = 0; b < blocks; ++b) {
            counted_[b] = state.rests[b].asleep ? 1 : 0;
            if (counted_[b]) deposit(shape, state, b, sleepers_);
        }
        sleepersCounted_ = true;
    }
    sum(state, shape, host);
    resolve(settings, time, host);
    forEach(host, blocks, kHairBlocksPerPiece, [&](std::size_t b) {
        if (!state.rests[b].asleep) press(shape, state, settings, h, b);
    });
}

/// The hair that moves, in as many grids as threads run, which are added up.
void HairGrid::sum(const State& state, const RestShape& shape, const Host& host) {
    const std::size_t blocks = shape.blocks.size(), nodes = box_.nodes();
    used_ = {};
    forEach(host, kSlots, 1, [&](std::size_t piece) {
        const std::size_t begin = blocks * piece / kSlots, end = blocks * (piece + 1) / kSlots;
        if (begin == end) return;
        std::size_t slot = 0;
        while (taken_[slot].exchange(true, std::memory_order_acquire)) slot = (slot + 1) % kSlots;
        if (!used_[slot]) std::fill_n(slots_[slot].begin(), nodes, Node{});
        used_[slot] = true;
        for (std::size_t b = begin; b < end; ++b) {
            if (!state.rests[b].asleep) deposit(shape, state, b, slots_[slot]);
        }
        taken_[slot].store(false, std::memory_order_release);
    });
    // The first grid that was used takes all others.
    std::size_t first = 0;
    while (first < kSlots && !used_[first]) ++first;
    if (first > 0 && first < kSlots) {
        std::swap(slots_[0], slots_[first]);
        std::swap(used_[0], used_[first]);
    }
    const auto slices = static_cast<std::size_t>(box_.size[2]), slice = nodes / slices;
    forEach(host, slices, 2, [&](std::size_t z) {
        for (std::size_t i = z * slice; i < (z + 1) * slice; ++i) {
            Node node = sleepers_[i];
            for (std::size_t s = 0; s < kSlots; ++s) {
                if (!used_[s]) continue;
                const Node& other = slots_[s][i];
                node.mass += other.mass;
                node.room += other.room;
                node.x += other.x;
                node.y += other.y;
                node.z += other.z;
            }
            slots_[0][i] = node;
        }
    });
}

void HairGrid::resolve(const SimulationSettings& settings, float time, const Host& host) {
    const std::vector<Node>& nodes = slots_[0];
    const auto row = static_cast<std::size_t>(box_.size[0]), rows = static_cast<std::size_t>(box_.size[1]),
               slices = static_cast<std::size_t>(box_.size[2]), slice = row * rows;
    const float most = kHairPressure * settings.hairHairStrength;
    forEach(host, slices, 2, [&](std::size_t z) {
        for (std::size_t i = z * slice; i < (z + 1) * slice; ++i) {
            fields_[i].values[kFieldDensity] = static_cast<float>(nodes[i].room) * roomUnit_;
            pressure_[i] = most * std::max(fields_[i].values[kFieldDensity] - (1.0f + kDensitySlack), 0.0f);
        }
    });
    const float limit = 0.5f * cell_ / (time * time), stiffest = kStiffnessShare * most / (cell_ * cell_);
    forEach(host, slices, 2, [&](std::size_t z) {
        for (std::size_t y = 0; y < rows; ++y) {
            for (std::size_t x = 0; x < row; ++x) {
                const std::size_t i = z * slice + y * row + x;
                Field& field = fields_[i];
                const Node& node = nodes[i];
                std::fill_n(field.values, kFieldDensity, 0.0f);
                if (node.mass <= 0) continue;
                const float speed = kVelocityUnit / static_cast<float>(node.mass);
                field.values[kFieldVelocity + 0] = static_cast<float>(node.x) * speed;
                field.values[kFieldVelocity + 1] = static_cast<float>(node.y) * speed;
                field.values[kFieldVelocity + 2] = static_cast<float>(node.z) * speed;
                if (x == 0 || y == 0 || z == 0 || x + 1 == row || y + 1 == rows || z + 1 == slices) continue;
                const std::size_t steps[] = {1, row, slice};
                float greatest = pressure_[i], squared = 0.0f;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const float below = pressure_[i - steps[axis]], above = pressure_[i + steps[axis]];
                    field.values[axis] = (below - above) * (0.5f / cell_);
                    squared += field.values[axis] * field.values[axis];
                    greatest = std::max(greatest, std::max(below, above));
                }
                if (!(greatest > 0.0f)) continue;
                const float size = std::sqrt(squared);
                if (size > limit) {
                    for (std::size_t axis = 0; axis < 3; ++axis) field.values[axis] *= limit / size;
                }
                field.values[kFieldStiffness] = stiffest * std::min(greatest / (0.05f * most), 1.0f);
            }
        }
    });
}

/// Pressure and friction on a block's points, as an acceleration and the rate at which they resist: with both
/// a substep blends the velocity of a point with that around it.
void HairGrid::press(const RestShape& shape, const State& state, const SimulationSettings& settings, float h,
                     std::size_t index) {
    const Block& block = shape.blocks[index];
    const std::size_t size = planeSize(block);
    const float* const moving = state.planes.data() + block.firstPlane * kStatePlanes;
    const float* const places = places_.data() + 3 * block.firstPlane;
    float* const felt = felt_.data() + kHairPlanes * block.firstPlane;
    const float rate = state.substep > 0.0f ? 1.0f / state.substep : 0.0f;
    const auto row = static_cast<std::size_t>(box_.size[0]),
               slice = row * static_cast<std::size_t>(box_.size[1]);
    const std::array<Float3, 3> axes = rowsOf(head_.rotation);
    for (std::uint32_t p = 0; p < block.points; ++p) {
        for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
            const std::size_t i = std::size_t{p} * kBlockLanes + lane;
            float* const to = felt + i;
            Cell cell;
            if (!findCell(places + i, size, cell)) {
                for (std::size_t plane = 0; plane < kHairPlanes; ++plane) to[plane * size] = 0.0f;
                continue;
            }
            float sums[8] = {};
            for (unsigned corner = 0; corner < 8; ++corner) {
                const float weight = ((corner & 1u) ? cell.share[0] : 1.0f - cell.share[0]) *
                                     ((corner >> 1 & 1u) ? cell.share[1] : 1.0f - cell.share[1]) *
                                     ((corner >> 2) ? cell.share[2] : 1.0f - cell.share[2]);
                const float* const values =
                    fields_[cell.node + (corner & 1u) + (corner >> 1 & 1u) * row + (corner >> 2) * slice]
                        .values;
                for (std::size_t k = 0; k < 8; ++k) sums[k] += weight * values[k];
            }
            const Float3 push{dot(axes[0], {sums[0], sums[1], sums[2]}),
                              dot(axes[1], {sums[0], sums[1], sums[2]}),
                              dot(axes[2], {sums[0], sums[1], sums[2]})};
            const Float3 around = Float3{sums[4], sums[5], sums[6]} + motion_.reference;
            const Float3 velocity{(moving[i] - moving[3 * size + i]) * rate,
                                  (moving[size + i] - moving[4 * size + i]) * rate,
                                  (moving[2 * size + i] - moving[5 * size + i]) * rate};
            const Float3 slip = velocity - around;
            const float share = std::min(sums[7], 1.0f);
            const float rubs =
                share * (settings.hairHairCohesion +
                         settings.hairHairFriction / std::max(length(slip), settings.hairHairStickSpeed));
            const Float3 arm = hairRootAt(state.roots, index, lane) - head_.at +
                               Float3{moving[i], moving[size + i], moving[2 * size + i]};
            const Float3 head = motion_.velocity + cross(motion_.spin, arm);
            const float gives = static_cast<float>(points_[block.firstPlane + i].room) * pushUnit_;
            const float resists = gives * sums[3] * h;
            const Float3 pull = push * gives + around * rubs + head * resists;
            to[0] = pull.x;
            to[size] = pull.y;
            to[2 * size] = pull.z;
            to[3 * size] = rubs + resists;
        }
    }
}

void HairGrid::show(const Block& block, BlockView& view) const {
    const float* const felt = felt_.data() + kHairPlanes * block.firstPlane;
    view.hairPush = {felt, planeSize(block)};
    view.hairRate = felt + 3 * planeSize(block);
}

}  // namespace hairloom::runtime
