// SPDX-License-Identifier: MIT
// What the grid of hair against hair knows of the authored hair.
#include <algorithm>
#include <cmath>

#include "engine/hair_grid.h"

namespace hairloom::runtime {
namespace {

constexpr double kMostHairMass = 1 << 28;  // of all points: no sum leaves 62 bits
constexpr double kMostHairRoom = 32767.0;
/// Single hairs are no volume: none keeps less than this share of the mean density.
constexpr double kLeastHairDensity = 0.3;
constexpr std::size_t kSampledRoots = 64;

}  // namespace

HairGrid& HairGrid::operator=(const HairGrid& other) {
    if (this == &other) return *this;
    cell_ = other.cell_;
    massUnit_ = other.massUnit_;
    roomUnit_ = other.roomUnit_;
    pushUnit_ = other.pushUnit_;
    restBox_ = other.restBox_;
    box_ = other.box_;
    head_ = other.head_;
    motion_ = other.motion_;
    points_ = other.points_;
    places_ = other.places_;
    felt_ = other.felt_;
    bounds_ = other.bounds_;
    slots_ = other.slots_;
    used_ = {};
    sleepers_ = other.sleepers_;
    counted_ = other.counted_;
    sleepersCounted_ = false;
    pressure_ = other.pressure_;
    fields_ = other.fields_;
    return *this;
}

void HairGrid::take(const RestShape& shape, const SimulationSettings& settings, const Host& host) {
    if (!settings.hairHair || settings.strandModel != StrandModel::rods || shape.planeFloats == 0) {
        *this = HairGrid();
        return;
    }
    points_.assign(shape.planeFloats, {});
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
    const double units = std::min(256.0 * static_cast<double>(shape.offsets.back()), kMostHairMass / 256.0);
    massUnit_ = std::max(lengths, 1e-9) / units;
    count(shape, host);
}

/// The authored hair, in the space of the head at rest.
void HairGrid::count(const RestShape& shape, const Host& host) {
    State rest;
    rest.planes = zeroFloats(shape.planeFloats * kStatePlanes, host);
    rest.roots.assign(shape.blocks.size() * kRootRows * kBlockLanes, 0.0f);
    rest.rests.assign(shape.blocks.size(), {});
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
                const double units = static_cast<double>(metres) / massUnit_;
                points_[block.firstPlane + i].mass =
                    static_cast<std::uint16_t>(std::clamp(units + 0.5, 1.0, 65535.0));
            }
        }
    }
    head_ = headAt(shape, rest.roots);
    for (;; cell_ *= 1.25f) {
        for (std::size_t b = 0; b < shape.blocks.size(); ++b) locate(shape, rest, b);
        restBox_ = {{}, {1 << 20, 1 << 20, 1 << 20}};
        restBox_ = boxOf(bounds_);
        if (restBox_.nodes() <= kMostRestHairNodes) break;
    }
    box_ = restBox_;
    std::vector<Node> nodes(box_.nodes(), Node{});
    for (std::size_t b = 0; b < shape.blocks.size(); ++b) deposit(shape, rest, b, nodes);
    double squares = 0.0, masses = 0.0;
    for (const Node& node : nodes) {
        const auto mass = static_cast<double>(node.mass);
        squares += mass * mass;
        masses += mass;
    }
    const double mean = squares / std::max(masses, 1.0), least = std::max(kLeastHairDensity * mean, 1.0);
    roomUnit_ = static_cast<float>(1.0 / (least * kMostHairRoom));
    pushUnit_ = static_cast<float>(mean / (least * kMostHairRoom));
    for (const Block& block : shape.blocks) {
        const float* const places = places_.data() + 3 * block.firstPlane;
        for (std::size_t i = 0; i < std::size_t{block.points} * kBlockLanes; ++i) {
            // The most of its corners: so no node at rest is denser than those around it keep.
            double target = least;
            Cell cell;
            if (findCell(places + i, planeSize(block), cell)) {
                const auto row = static_cast<std::size_t>(box_.size[0]),
                           slice = row * static_cast<std::size_t>(box_.size[1]);
                for (unsigned corner = 0; corner < 8; ++corner) {
                    const std::size_t node =
                        cell.node + (corner & 1u) + (corner >> 1 & 1u) * row + (corner >> 2) * slice;
                    target = std::max(target, static_cast<double>(nodes[node].mass));
                }
            }
            points_[block.firstPlane + i].room =
                static_cast<std::uint16_t>(std::max(std::floor(kMostHairRoom * least / target), 1.0));
        }
    }
    sleepersCounted_ = false;
    for (std::vector<Node>& slot : slots_) slot.resize(kMostHairNodes);
    sleepers_.resize(kMostHairNodes);
    pressure_.resize(kMostHairNodes);
    fields_.resize(kMostHairNodes);
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
    std::size_t nodes = sleepers_.size();
    for (const std::vector<Node>& slot : slots_) nodes += slot.size();
    return nodes * sizeof(Node) + pressure_.size() * sizeof(float) + fields_.size() * sizeof(Field) +
           points_.size() * sizeof(Point) + (places_.size() + felt_.size()) * sizeof(float) +
           bounds_.size() * sizeof(Bounds) + counted_.size();
}

}  // namespace hairloom::runtime
