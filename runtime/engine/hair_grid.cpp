// SPDX-License-Identifier: MIT
#include "engine/hair_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/in_parallel.h"

namespace hairloom::runtime {
namespace {

constexpr float kFarCells = 1e5f;
constexpr std::int32_t kBoxMargin = 2;
/// Hair may be so much denser than authored before it is pressed apart: what a cell sees of hair changes by
/// less as its grid goes with the head.
constexpr float kDensitySlack = 0.1f;
constexpr float kHairPressure = 40.0f;  // m²/s², of twice the authored density at full strength
/// Pressure is no potential of all points, since it is held for a frame and read between nodes: without a
/// loss, compressed hair never rests. Hair compressed by so much has all of it.
constexpr float kFirmCompression = 0.05f;
constexpr float kSlowing = 100.0f;  // 1/s, of hair that is compressed so much, towards the head
/// √ of density at most, for the stiffness of a node.
constexpr float kMostDense = 2.0f;
/// acosh of what is left of the error of a pressure, in relax().
constexpr float kRelaxed = 2.0f;
constexpr int kMostRelaxations = 40;
/// Cells that the push on a point may move it by in a frame.
constexpr float kMostPush = 1.0f;
constexpr std::size_t kHairBlocksPerPiece = 4;

/// The rows of R(q).
std::array<Float3, 3> rowsOf(Quat q) {
    const Float3 x = rotate(q, {1.0f, 0.0f, 0.0f}), y = rotate(q, {0.0f, 1.0f, 0.0f}),
                 z = rotate(q, {0.0f, 0.0f, 1.0f});
    return {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
}
Float3 times(const std::array<Float3, 3>& rows, Float3 v) {
    return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
}

/// Visits the numbers of the inner nodes of a slice.
template <class Visit>
void forInner(const HairBox& box, std::size_t z, const Visit& visit) {
    const auto row = static_cast<std::size_t>(box.size[0]), rows = static_cast<std::size_t>(box.size[1]);
    if (z == 0 || z + 1 == static_cast<std::size_t>(box.size[2])) return;
    for (std::size_t y = 1; y + 1 < rows; ++y) {
        for (std::size_t x = 1; x + 1 < row; ++x) visit((z * rows + y) * row + x);
    }
}

}  // namespace

template <class Body>
void HairGrid::forEach(const Host& host, std::size_t count, std::size_t grain, const Body& body) {
    const auto run = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) body(i);
    };
    inParallel(host, count, grain, run);
}

HairBlock HairGrid::blockOf(const RestShape& shape, const State& state, std::size_t index) {
    const Block& block = shape.blocks[index];
    return {block.points,
            block.strands,
            planeSize(block),
            state.planes.data() + block.firstPlane * kStatePlanes,
            state.roots.data() + index * kRootRows * kBlockLanes,
            places_.data() + 3 * block.firstPlane,
            share_.data() + block.firstPlane,
            felt_.data() + kHairPlanes * block.firstPlane};
}

/// From the head's place.
void HairGrid::openFrame(const SimulationSettings& settings) {
    const std::array<Float3, 3> rows = rowsOf(conjugate(head_.rotation));
    for (std::size_t axis = 0; axis < 3; ++axis) frame_.axes[axis] = rows[axis] * (1.0f / cell_);
    frame_.head = head_.at;
    frame_.center = head_.center * (1.0f / cell_);
    frame_.friction = settings.hairHairFriction;
    frame_.stickSpeed = settings.hairHairStickSpeed;
    frame_.cohesion = settings.hairHairCohesion;
}

/// Where the points are in the space of the head; those of sleepers only if asked for.
void HairGrid::locate(const RestShape& shape, const State& state, bool sleepers, const Host& host) {
    const auto& locateBlock = hairKernels().locate;
    forEach(host, shape.blocks.size(), kHairBlocksPerPiece, [&](std::size_t b) {
        if (sleepers || !state.rests[b].asleep) locateBlock(blockOf(shape, state, b), frame_, bounds_[b]);
    });
}

/// Of all hair, with a node around it.
HairBox HairGrid::boxOf() const {
    HairBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        float low = kFarCells, high = -kFarCells;
        for (const HairBounds& block : bounds_) {
            low = std::min(low, block.low[axis]);
            high = std::max(high, block.high[axis]);
        }
        if (!(low <= high)) return {};
        const auto first = static_cast<std::int32_t>(std::floor(std::max(low, -kFarCells))) - 1;
        const auto last = static_cast<std::int32_t>(std::floor(std::min(high, kFarCells))) + 2;
        box.low[axis] = first;
        box.size[axis] = last - first + 1;
    }
    return box;
}

/// One around all hair: nothing that points feel depends on how much larger it is, so that sleepers are not
/// counted anew each time that others move. Where that is too much, as much around the authored hair as can
/// be.
HairBox HairGrid::chooseBox(const HairBox& before) const {
    const HairBox whole = boxOf();
    if (whole.nodes() == 0) return {};
    HairBox wide = whole;
    bool holds = before.nodes() <= kMostHairNodes, isLarge = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        wide.low[axis] -= kBoxMargin;
        wide.size[axis] += 2 * kBoxMargin;
        holds = holds && before.low[axis] <= whole.low[axis] &&
                before.low[axis] + before.size[axis] >= whole.low[axis] + whole.size[axis];
        isLarge = isLarge || before.size[axis] > wide.size[axis] + 2 * kBoxMargin;
    }
    if (holds && !isLarge) return before;
    if (wide.nodes() <= kMostHairNodes) return wide;
    if (whole.nodes() <= kMostHairNodes) return whole;
    HairBox best;
    for (std::int32_t grown = 0;; ++grown) {
        HairBox cut;
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

void HairGrid::update(const RestShape& shape, const State& state, const Floats& nextRoots,
                      const SimulationSettings& settings, const HairGridFrame& given, const Host& host) {
    const std::size_t blocks = shape.blocks.size();
    const float time = given.h * static_cast<float>(given.substeps);
    const Head before = std::exchange(head_, headAt(shape, nextRoots)), now = headAt(shape, state.roots);
    const bool cut = given.isCut || !(length(head_.at - now.at) <= settings.teleportDistance);
    motion_ = {};
    if (cut) {
        head_ = now;
    } else {
        const Quat turn = head_.rotation * conjugate(now.rotation);
        motion_.velocity = (head_.at - now.at) * (1.0f / time);
        motion_.spin = Float3{turn.x, turn.y, turn.z} * ((turn.w < 0.0f ? -2.0f : 2.0f) / time);
    }
    openFrame(settings);
    frame_.rate = state.substep > 0.0f ? 1.0f / state.substep : 0.0f;
    frame_.ahead = cut ? 0.0f : time * frame_.rate;
    frame_.reference = {};
    if (state.substep > 0.0f) {
        // Root of the first lane of the first block: it need not be exact.
        const HairBlock block = blockOf(shape, state, 0);
        const float* const at = block.moving;
        const Float3 moved{at[0] - at[3 * block.pitch], at[block.pitch] - at[4 * block.pitch],
                           at[2 * block.pitch] - at[5 * block.pitch]};
        if (isFinite(moved)) frame_.reference = moved * frame_.rate;
    }
    bool same = work_.sleepersCounted && before == head_;
    for (std::size_t b = 0; same && b < blocks; ++b) same = (counted_[b] != 0) == state.rests[b].asleep;
    locate(shape, state, !same, host);
    const HairBox box = chooseBox(box_);
    same = same && box == box_ && frame_.reference == Float3{};
    frame_.box = box_ = box;
    if (box_.nodes() == 0) {
        std::fill(felt_.begin(), felt_.end(), 0.0f);
        work_.sleepersCounted = false;
        return;
    }
    if (!same) {
        work_.anySleep = false;
        for (std::size_t b = 0; b < blocks; ++b) {
            counted_[b] = state.rests[b].asleep ? 1 : 0;
            work_.anySleep = work_.anySleep || state.rests[b].asleep;
        }
        if (work_.anySleep) {
            sum(shape, state, true, host);
            std::swap(work_.sleepers, work_.slots[0]);
        }
        work_.sleepersCounted = true;
    }
    sum(shape, state, false, host);
    work_.compressed = findCompression(settings, host);
    if (work_.compressed) relax(kHairPressure * settings.hairHairStrength * time * time / (cell_ * cell_));
    setFields(settings, time, host);
    const auto& press = hairKernels().press;
    forEach(host, blocks, kHairBlocksPerPiece, [&](std::size_t b) {
        if (!state.rests[b].asleep) press(blockOf(shape, state, b), frame_, work_.fields.data());
    });
}

/// Into the first slot: the hair that sleeps, or all, with what was counted of sleepers. As many grids as
/// threads run, which are added up.
void HairGrid::sum(const RestShape& shape, const State& state, bool sleepers, const Host& host) {
    const std::size_t blocks = shape.blocks.size(), sums = box_.nodes() * kHairSums;
    const auto& deposit = hairKernels().deposit;
    work_.used = {};
    forEach(host, kSlots, 1, [&](std::size_t piece) {
        const std::size_t begin = blocks * piece / kSlots, end = blocks * (piece + 1) / kSlots;
        if (begin == end) return;
        std::size_t slot = 0;
        while (work_.taken[slot].exchange(true, std::memory_order_acquire)) slot = (slot + 1) % kSlots;
        if (!work_.used[slot]) std::fill_n(work_.slots[slot].begin(), sums, 0.0);
        work_.used[slot] = true;
        for (std::size_t b = begin; b < end; ++b) {
            if (state.rests[b].asleep == sleepers)
                deposit(blockOf(shape, state, b), frame_, work_.slots[slot].data());
        }
        work_.taken[slot].store(false, std::memory_order_release);
    });
    std::array<const double*, kSlots + 1> others{};
    std::size_t count = 0;
    for (std::size_t s = 1; s < kSlots; ++s) {
        if (work_.used[s]) others[count++] = work_.slots[s].data();
    }
    if (!sleepers && work_.anySleep) others[count++] = work_.sleepers.data();
    if (!work_.used[0]) std::fill_n(work_.slots[0].begin(), sums, 0.0);
    if (count == 0) return;
    const auto slices = static_cast<std::size_t>(box_.size[2]), slice = sums / slices;
    forEach(host, slices, 2, [&](std::size_t z) {
        double* const to = work_.slots[0].data();
        for (std::size_t s = 0; s < count; ++s) {
            for (std::size_t i = z * slice; i < (z + 1) * slice; ++i) to[i] += others[s][i];
        }
    });
}

/// How much denser than authored the hair will be: `Work::excess`, pressure by that alone. False where it is
/// nowhere.
bool HairGrid::findCompression(const SimulationSettings& settings, const Host& host) {
    const auto row = static_cast<std::size_t>(box_.size[0]), rows = static_cast<std::size_t>(box_.size[1]),
               slices = static_cast<std::size_t>(box_.size[2]);
    const double* const sums = work_.slots[0].data();
    const float most = kHairPressure * settings.hairHairStrength;
    std::atomic<bool> any = false;
    forEach(host, slices * rows, 2 * rows, [&](std::size_t line) {
        const auto y = static_cast<std::int32_t>(line % rows) + box_.low[1] - restBox_.low[1],
                   z = static_cast<std::int32_t>(line / rows) + box_.low[2] - restBox_.low[2];
        const bool authored = y >= 0 && y < restBox_.size[1] && z >= 0 && z < restBox_.size[2];
        const auto first = static_cast<std::ptrdiff_t>((z * restBox_.size[1] + y) * restBox_.size[0]);
        bool found = false;
        for (std::size_t i = line * row; i < (line + 1) * row; ++i) {
            work_.dense[i] = static_cast<float>(sums[i * kHairSums]) * shareUnit_;
            const auto x = static_cast<std::int32_t>(i - line * row) + box_.low[0] - restBox_.low[0];
            const float allowed = authored && x >= 0 && x < restBox_.size[0]
                                      ? allowed_[static_cast<std::size_t>(first + x)]
                                      : 1.0f;
            work_.excess[i] = most * std::max(work_.dense[i] - allowed * (1.0f + kDensitySlack), 0.0f);
            found = found || work_.excess[i] > 0.0f;
        }
        if (found) any.store(true, std::memory_order_relaxed);
    });
    return any.load(std::memory_order_relaxed);
}

/// Pressure at the end of the frame, implicitly: p − T² P ∇·(ρ ∇p) = bias for the frame's time T, P/ρ as
/// `stiffness` over cells. By Jacobi's iteration with Chebyshev's weights, whose first steps are stable, too:
/// what is left over is softer. Of p √ρ, so that the equation is symmetric and needs one array.
void HairGrid::relax(float stiffness) {
    Floats &dense = work_.dense, &bias = work_.bias, &gain = work_.gain, &pressure = work_.pressure,
           &before = work_.before;
    const auto row = static_cast<std::size_t>(box_.size[0]),
               slice = row * static_cast<std::size_t>(box_.size[1]);
    const std::size_t nodes = box_.nodes();
    for (std::size_t i = 0; i < nodes; ++i) dense[i] = std::min(std::sqrt(dense[i]), kMostDense);
    std::fill_n(gain.begin(), nodes, 0.0f);
    std::fill_n(pressure.begin(), nodes, 0.0f);
    std::fill_n(before.begin(), nodes, 0.0f);
    float most = 0.0f;
    std::fill_n(bias.begin(), nodes, 0.0f);
    for (std::size_t z = 0; z < static_cast<std::size_t>(box_.size[2]); ++z) {
        forInner(box_, z, [&](std::size_t i) {
            const float s = dense[i];
            const float around = dense[i - 1] + dense[i + 1] + dense[i - row] + dense[i + row] +
                                 dense[i - slice] + dense[i + slice];
            const float coupled = stiffness * s * around, inverse = 1.0f / (1.0f + coupled);
            gain[i] = stiffness * s * s * inverse;
            bias[i] = work_.excess[i] * s * inverse;
            most = std::max(most, coupled * inverse);
        });
    }
    const int steps =
        most > 0.0f && most < 1.0f
            ? std::clamp(static_cast<int>(std::ceil(kRelaxed / std::acosh(1.0f / most))), 2, kMostRelaxations)
            : kMostRelaxations;
    float speed = 1.0f;
    const auto& relaxNodes = hairKernels().relax;
    for (int k = 0; k < steps; ++k) {
        if (k == 1) speed = 2.0f / (2.0f - most * most);
        if (k > 1) speed = 4.0f / (4.0f - most * most * speed);
        relaxNodes({bias.data(), gain.data(), pressure.data(), before.data(), slice, nodes - slice, row,
                    slice, speed});
        std::swap(pressure, before);
    }
    for (std::size_t i = 0; i < nodes; ++i)
        pressure[i] = dense[i] > 0.0f ? std::max(pressure[i], 0.0f) / dense[i] : 0.0f;
}

/// What points read.
void HairGrid::setFields(const SimulationSettings& settings, float time, const Host& host) {
    const auto row = static_cast<std::size_t>(box_.size[0]),
               slice = row * static_cast<std::size_t>(box_.size[1]),
               slices = static_cast<std::size_t>(box_.size[2]);
    const double* const sums = work_.slots[0].data();
    const std::array<Float3, 3> outward = rowsOf(head_.rotation);
    const float limit = kMostPush * cell_ / (time * time);
    const float firm = 1.0f / std::max(kHairPressure * settings.hairHairStrength * kFirmCompression, 1e-6f);
    const std::size_t steps[] = {1, row, slice};
    forEach(host, slices, 2, [&](std::size_t z) {
        for (std::size_t i = z * slice; i < (z + 1) * slice; ++i) {
            float* const field = work_.fields.data() + i * kHairFields;
            std::fill_n(field, kHairFields, 0.0f);
            const double* const sum = sums + i * kHairSums;
            if (!(sum[0] > 0.0)) continue;
            field[kFieldDensity] = static_cast<float>(sum[0]) * shareUnit_;
            const double speed = static_cast<double>(kHairVelocityUnit) / sum[0];
            for (std::size_t axis = 0; axis < 3; ++axis)
                field[kFieldVelocity + axis] = static_cast<float>(sum[1 + axis] * speed);
        }
        if (!work_.compressed) return;
        forInner(box_, z, [&](std::size_t i) {
            float* const field = work_.fields.data() + i * kHairFields;
            if (!(field[kFieldDensity] > 0.0f)) return;
            float push[3];
            for (std::size_t axis = 0; axis < 3; ++axis)
                push[axis] =
                    (work_.pressure[i - steps[axis]] - work_.pressure[i + steps[axis]]) * (0.5f / cell_);
            Float3 own = times(outward, {push[0], push[1], push[2]});
            const float size = length(own);
            if (size > limit) own = own * (limit / size);
            const float slows = kSlowing * std::min(work_.pressure[i] * firm, 1.0f);
            const std::size_t y = i % slice / row, x = i % row;
            const Float3 place{static_cast<float>(x) + static_cast<float>(box_.low[0]),
                               static_cast<float>(y) + static_cast<float>(box_.low[1]),
                               static_cast<float>(z) + static_cast<float>(box_.low[2])};
            const Float3 arm = times(outward, place * cell_ - head_.center);
            own = own + (motion_.velocity + cross(motion_.spin, arm)) * slows;
            field[0] = own.x;
            field[1] = own.y;
            field[2] = own.z;
            field[kFieldSlows] = slows;
        });
    });
}

void HairGrid::show(const Block& block, BlockView& view) const {
    const float* const felt = felt_.data() + kHairPlanes * block.firstPlane;
    view.hairPush = {felt, planeSize(block)};
    view.hairRate = felt + 3 * planeSize(block);
}

}  // namespace hairloom::runtime
