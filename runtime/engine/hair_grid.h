// SPDX-License-Identifier: MIT
#pragma once
// Hair-hair collision: how dense the hair is and how it moves, on a grid that goes with the head, and what
// each point feels of it in a frame (docs/engine.md, "Hair-hair collision"). After Petrovic, Henne, Anderson
// 2005, "Volumetric methods for simulation and rendering of hair"; the density that hair keeps is the
// authored one.

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "engine/hair_kernel.h"
#include "engine/state.h"
#include "hairloom/memory.h"

namespace hairloom::runtime {

/// Of each point: push x, y, z and rate (BlockView::hairPush, hairRate).
inline constexpr std::size_t kHairPlanes = 4;

/// Nodes at most, at rest and in motion.
inline constexpr std::size_t kMostRestHairNodes = 1u << 14, kMostHairNodes = 1u << 15;

/// A root of State::roots.
inline Float3 hairRootAt(const Floats& rows, std::size_t block, std::uint32_t lane) {
    const float* const at = rows.data() + block * kRootRows * kBlockLanes + lane;
    return {at[0], at[kBlockLanes], at[2 * kBlockLanes]};
}

/// The substeps that a grid is for.
struct HairGridFrame {
    float h;  ///< seconds of each
    std::uint32_t substeps;
    bool isCut = false;  ///< the head jumps
};

/// What it knows follows from the rest shape, the settings and the state of each frame: copies and snapshots
/// go on with the same bits. Sums are of whole numbers: their order does not matter.
class HairGrid {
  public:
    /// Takes all its memory, and counts the authored hair; none where the settings do not ask for it.
    void take(const RestShape& shape, const SimulationSettings& settings, const Host& host);
    bool isOn() const { return !share_.empty(); }
    /// Metres: as authored or chosen, larger where the authored hair would take more than 2¹⁴ cells.
    float cell() const { return cell_; }

    /// What points of blocks that move feel in a frame; roots as State::roots, at its end. Points that are no
    /// numbers, or far outside of all hair, feel nothing.
    void update(const RestShape& shape, const State& state, const Floats& nextRoots,
                const SimulationSettings& settings, const HairGridFrame& given, const Host& host);
    /// Sleepers have moved, or are others.
    void forget() { work_.sleepersCounted = false; }
    void show(const Block& block, BlockView& view) const;
    std::size_t bytes() const;

  private:
    static constexpr std::size_t kSlots = 8;
    using Sums = std::vector<double, CacheLineAllocator<double>>;
    /// Where the head is: from the rest space to the world.
    struct Head {
        Quat rotation;
        Float3 at, center;  ///< world, rest
        friend bool operator==(const Head&, const Head&) = default;
    };
    struct Motion {
        Float3 velocity, spin;  ///< m/s, 1/s
    };

    /// What each frame fills anew: a copy has as much of it, with nothing in it.
    struct Work {
        Work() = default;
        Work(const Work& other) { take(other.nodes()); }
        Work& operator=(const Work& other);
        /// Not touched before it is used.
        void take(std::size_t nodes);
        std::size_t nodes() const { return fields.size() / kHairFields; }
        std::size_t bytes() const;

        std::array<Sums, kSlots> slots;
        std::array<std::atomic<bool>, kSlots> taken{};
        std::array<bool, kSlots> used{};
        Sums sleepers;  ///< of the blocks of `counted_`
        bool sleepersCounted = false;
        bool anySleep = false;
        bool compressed = false;
        /// Of each node: density and then its √, pressure by it alone, and the equation of the pressure
        /// (relax()).
        Floats dense, excess, bias, gain, pressure, before;
        Floats fields;  ///< kHairFields of each node
    };

    template <class Body>
    static void forEach(const Host& host, std::size_t count, std::size_t grain, const Body& body);
    void count(const RestShape& shape, double lengths, const Host& host);
    void scaleShares(double scale);
    void keepDensity(const RestShape& shape);
    Head headAt(const RestShape& shape, const Floats& roots) const;
    HairBlock blockOf(const RestShape& shape, const State& state, std::size_t index);
    void openFrame(const SimulationSettings& settings);
    void locate(const RestShape& shape, const State& state, bool sleepers, const Host& host);
    HairBox boxOf() const;
    HairBox chooseBox(const HairBox& before) const;
    void sum(const RestShape& shape, const State& state, bool sleepers, const Host& host);
    bool findCompression(const SimulationSettings& settings, const Host& host);
    void relax(float stiffness);
    void setFields(const SimulationSettings& settings, float time, const Host& host);

    float cell_ = 0.0f;
    float shareUnit_ = 1.0f;  ///< of a node's sum: 1 where it is as dense as authored
    HairBox restBox_, box_;
    Head head_;
    Motion motion_;
    HairFrame frame_;
    Floats share_;    ///< per block: of each point, of the density that it keeps, in whole numbers
    Floats allowed_;  ///< of each node of `restBox_`: density as authored there, at least 1
    Floats places_;   ///< per block: x, y, z in cells
    Floats felt_;     ///< kHairPlanes per block
    Vector<HairBounds> bounds_;
    Vector<std::uint8_t> counted_;  ///< per block: asleep, and in `Work::sleepers`
    Work work_;
};

}  // namespace hairloom::runtime
