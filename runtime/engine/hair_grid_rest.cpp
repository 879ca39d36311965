// SPDX-License-Identifier: MIT
// What the grid of hair-hair collision knows of the authored hair.
#include <algorithm>
#include <cmath>

#include "engine/hair_grid.h"

namespace hairloom::runtime {
namespace {

/// Sums stay whole in a double, with any velocity: 2⁵¹ over kMostHairVelocity over kHairVelocityUnit.
constexpr double kMostHairSum = static_cast<double>(std::uint64_t{1} << 51) *
                                static_cast<double>(kHairVelocityUnit) /
                                static_cast<double>(kMostHairVelocity);
constexpr double kMostHairUnits = 1 << 20;  // of a full node
/// Single hairs are no volume: none keeps less than this share of the mean density.
constexpr double kLeastHairDensity = 0.3;
constexpr std::size_t kSampledRoots = 64;

}  // namespace

HairGrid::Work& HairGrid::Work::operator=(const Work& other) {
    if (this != &other) take(other.nodes());
    return *this;
}

void HairGrid::Work::take(std::size_t nodes) {
    for (Sums& slot : slots) slot = Sums(nodes * kHairSums);
    sleepers = Sums(nodes * kHairSums);
    for (Floats* const each : {&dense, &excess, &bias, &gain, &pressure, &before}) *each = Floats(nodes);
    fields = Floats(nodes * kHairFields);
    sleepersCounted = anySleep = compressed = false;
}

std::size_t HairGrid::Work::bytes() const {
    const std::size_t sums = (kSlots + 1) * sleepers.size(), floats = 6 * dense.size() + fields.size();
    return sums * sizeof(double) + floats * sizeof(float);
}

void HairGrid::take(const RestShape& shape, const SimulationSettings& settings, const Host& host) {
    if (!settings.hairHair || settings.strandModel != StrandModel::rods || shape.planeFloats == 0) {
        *this = HairGrid();
        return;
    }
    share_ = zeroFloats(shape.planeFloats, host);
    places_ = zeroFloats(3 * shape.planeFloats, host);
    felt_ = zeroFloats(kHairPlanes * shape.planeFloats, host);
    bounds_.assign(shape.blocks.size(), {});
    counted_.assign(shape.blocks.size(), 0);
    // A cell holds several strands at their roots, and no segment reaches over the next one.
    Float3 low{1e30f, 1e30f, 1e30f}, high = low * -1.0f;
    for (const RootFrame& root : shape.restRoots) {
        low = {std::min(low.x, root.position.x), std::min(low.y, root.position.y),
               std::min(low.z, root.position.z)};
        high = {std::max(high.x, root.position.x), std::max(high.y, root.position.y),
                std::max(high.z, root.position.z)};
    }
    const Float3 e = high - low;
    const float spacing =
        std::sqrt((e.x * e.y + e.y * e.z + e.z * e.x) / static_cast<float>(shape.restRoots.size()));
    double lengths = 0.0;
    std::size_t segments = 0;
    for (const Block& block : shape.blocks) {
        const float* const length =
            shape.planes.data() + block.firstPlane * kRestPlanes + 3 * planeSize(block);
        for (std::uint32_t p = 0; p + 1 < block.points; ++p) {
            for (std::uint32_t lane = 0; lane < block.strands; ++lane)
                lengths += static_cast<double>(length[std::size_t{p} * kBlockLanes + lane]);
        }
        segments += std::size_t{block.points - 1} * block.strands;
    }
    const auto segment =
        static_cast<float>(lengths / static_cast<double>(std::max(segments, std::size_t{1})));
    cell_ = settings.hairHairCell > 0.0f
                ? std::max(settings.hairHairCell, 0.001f)
                : std::clamp(std::max(2.0f * spacing, 1.5f * segment), 0.005f, 0.05f);
    count(shape, lengths, host);
}

/// The authored hair, in the space of the head at rest.
void HairGrid::count(const RestShape& shape, double lengths, const Host& host) {
    State rest;
    rest.planes = zeroFloats(shape.planeFloats * kStatePlanes, host);
    rest.roots.assign(shape.blocks.size() * kRootRows * kBlockLanes, 0.0f);
    rest.rests.assign(shape.blocks.size(), {});
    // Of all hair, so that no sum leaves 51 bits.
    const double unit =
        std::max(lengths, 1e-9) / std::min(kMostHairSum, 256.0 * static_cast<double>(shape.offsets.back()));
    for (std::size_t b = 0; b < shape.blocks.size(); ++b) {
        const Block& block = shape.blocks[b];
        for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
            const RootFrame& root = shape.restRoots[block.strandOfLane[lane]];
            const float values[kRootRows] = {root.position.x, root.position.y, root.position.z,
                                             root.rotation.x, root.rotation.y, root.rotation.z,
                                             root.rotation.w};
            for (std::size_t r = 0; r < kRootRows; ++r)
                rest.roots[(b * kRootRows + r) * kBlockLanes + lane] = values[r];
        }
        placeAtRest(shape, rest, b, kAllLanes);
        const float* const length =
            shape.planes.data() + block.firstPlane * kRestPlanes + 3 * planeSize(block);
        for (std::uint32_t p = 0; p < block.points; ++p) {
            for (std::uint32_t lane = 0; lane < kBlockLanes; ++lane) {
                const std::size_t i = std::size_t{p} * kBlockLanes + lane;
                const float metres = (p > 0 ? 0.5f * length[i - kBlockLanes] : 0.0f) +
                                     (p + 1 < block.points ? 0.5f * length[i] : 0.0f);
                share_[block.firstPlane + i] = metres;
            }
        }
    }
    work_.take(kMostHairNodes);
    head_ = headAt(shape, rest.roots);
    frame_ = {};
    for (;; cell_ *= 1.25f) {
        openFrame({});
        locate(shape, rest, true, host);
        restBox_ = boxOf();
        if (restBox_.nodes() <= kMostRestHairNodes) break;
    }
    frame_.box = box_ = restBox_;
    scaleShares(1.0 / unit);
    sum(shape, rest, false, host);
    keepDensity(shape);
    sum(shape, rest, false, host);
    allowed_.resize(box_.nodes());
    for (std::size_t i = 0; i < allowed_.size(); ++i)
        allowed_[i] = std::max(static_cast<float>(work_.slots[0][i * kHairSums]) * shareUnit_, 1.0f);
}

void HairGrid::scaleShares(double scale) {
    for (float& share : share_) share = static_cast<float>(static_cast<double>(share) * scale);
}

/// Makes each point's length of hair its share of the density that it keeps, which is authored where it is.
void HairGrid::keepDensity(const RestShape& shape) {
    const double* const sums = work_.slots[0].data();
    double squares = 0.0, masses = 0.0;
    for (std::size_t i = 0; i < box_.nodes(); ++i) {
        const double mass = sums[i * kHairSums];
        squares += mass * mass;
        masses += mass;
    }
    const double mean = squares / std::max(masses, 1.0), least = std::max(kLeastHairDensity * mean, 1.0);
    double all = 0.0;
    for (const Block& block : shape.blocks) {
        const float* const places = places_.data() + 3 * block.firstPlane;
        for (std::size_t i = 0; i < std::size_t{block.points} * kBlockLanes; ++i) {
            double target = 0.0;
            bool inside = true;
            std::size_t corner[3] = {};
            double part[3] = {};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const float from = places[axis * planeSize(block) + i] - static_cast<float>(box_.low[axis]);
                inside = inside && from >= 0.0f && from < static_cast<float>(box_.size[axis] - 1);
                if (!inside) break;
                corner[axis] = static_cast<std::size_t>(from);
                part[axis] = static_cast<double>(from) - std::floor(static_cast<double>(from));
            }
            const auto row = static_cast<std::size_t>(box_.size[0]),
                       slice = row * static_cast<std::size_t>(box_.size[1]);
            for (std::size_t c = 0; inside && c < 8; ++c) {
                const std::size_t node =
                    (corner[0] + (c & 1)) + (corner[1] + (c >> 1 & 1)) * row + (corner[2] + (c >> 2)) * slice;
                target += sums[node * kHairSums] * ((c & 1) ? part[0] : 1.0 - part[0]) *
                          ((c >> 1 & 1) ? part[1] : 1.0 - part[1]) * ((c >> 2) ? part[2] : 1.0 - part[2]);
            }
            float& share = share_[block.firstPlane + i];
            share = static_cast<float>(static_cast<double>(share) / std::max(target, least));
            all += static_cast<double>(share);
        }
    }
    const double units = std::min(kMostHairUnits, std::floor(kMostHairSum / std::max(all, 1.0)));
    shareUnit_ = static_cast<float>(1.0 / units);
    scaleShares(units);
}

/// The mean turn and place of some of the roots.
HairGrid::Head HairGrid::headAt(const RestShape& shape, const Floats& roots) const {
    Head head{{0.0f, 0.0f, 0.0f, 0.0f}, {}, {}};
    const std::size_t step = std::max(shape.blocks.size() / kSampledRoots, std::size_t{1});
    float sampled = 0.0f;
    Quat first;
    for (std::size_t b = 0; b < shape.blocks.size(); b += step) {
        const RootFrame& rest = shape.restRoots[shape.blocks[b].strandOfLane[0]];
        const float* const row = roots.data() + b * kRootRows * kBlockLanes;
        Quat turn =
            Quat{row[3 * kBlockLanes], row[4 * kBlockLanes], row[5 * kBlockLanes], row[6 * kBlockLanes]} *
            conjugate(rest.rotation);
        if (sampled == 0.0f) first = turn;
        const float sign =
            turn.x * first.x + turn.y * first.y + turn.z * first.z + turn.w * first.w < 0.0f ? -1.0f : 1.0f;
        head.rotation = {head.rotation.x + sign * turn.x, head.rotation.y + sign * turn.y,
                         head.rotation.z + sign * turn.z, head.rotation.w + sign * turn.w};
        head.at = head.at + hairRootAt(roots, b, 0);
        head.center = head.center + rest.position;
        sampled += 1.0f;
    }
    if (!normalize(head.rotation)) head.rotation = {};
    head.at = head.at * (1.0f / sampled);
    head.center = head.center * (1.0f / sampled);
    return head;
}

std::size_t HairGrid::bytes() const {
    const std::size_t floats = share_.size() + allowed_.size() + places_.size() + felt_.size();
    return work_.bytes() + floats * sizeof(float) + bounds_.size() * sizeof(HairBounds) + counted_.size();
}

}  // namespace hairloom::runtime
