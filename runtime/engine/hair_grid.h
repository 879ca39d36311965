// SPDX-License-Identifier: MIT
#pragma once
// Hair against hair: how dense the hair is and how it moves, on a grid that goes with the head, and what each
// point feels of it in a frame (docs/engine.md, "Hair against hair"). After Petrovic, Henne, Anderson 2005,
// "Volumetric methods for simulation and rendering of hair"; the density that hair keeps is the authored one.

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "engine/state.h"

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

/// What it knows follows from the rest shape, the settings and the state of each frame: copies and snapshots
/// go on with the same bits. Sums are of whole numbers: their order does not matter.
class HairGrid {
  public:
    HairGrid() = default;
    HairGrid(const HairGrid& other) { *this = other; }
    HairGrid& operator=(const HairGrid& other);

    /// Takes all its memory, and counts the authored hair; none where the settings do not ask for it.
    void take(const RestShape& shape, const SimulationSettings& settings, const Host& host);
    bool isOn() const { return !points_.empty(); }
    /// Metres: as authored or chosen, larger where the authored hair would take more than 2¹⁴ cells.
    float cell() const { return cell_; }

    /// What points of blocks that move feel in a frame of `count` substeps of h seconds; roots as
    /// State::roots, at its end. Points that are no numbers, or far outside of all hair, feel nothing.
    void update(const RestShape& shape, const State& state, const Floats& nextRoots,
                const SimulationSettings& settings, float h, std::uint32_t count, const Host& host);
    /// Sleepers have moved, or are others.
    void forget() { sleepersCounted_ = false; }
    void show(const Block& block, BlockView& view) const;
    std::size_t bytes() const;

  private:
    static constexpr std::size_t kSlots = 8;
    /// Mass in units of 2⁻¹⁸ of a point's, with the room that it takes, and with its velocity.
    struct Node {
        std::int64_t mass, room, x, y, z;
    };
    /// What points read: push, m/s²; resistance, 1/s²; velocity, m/s; density, 1 as authored.
    struct Field {
        float values[8];
    };
    struct Point {
        std::uint16_t mass, room;  ///< one over the density that it keeps
    };
    struct Box {
        std::array<std::int32_t, 3> low{}, size{};
        std::size_t nodes() const {
            return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
                   static_cast<std::size_t>(size[2]);
        }
        friend bool operator==(const Box&, const Box&) = default;
    };
    struct Bounds {
        float low[3], high[3];  ///< cells
    };
    /// Where the head is: from the rest space to the world.
    struct Head {
        Quat rotation;
        Float3 at, center;  ///< world, rest
        friend bool operator==(const Head&, const Head&) = default;
    };
    struct Motion {
        Float3 velocity, spin;  ///< m/s, 1/s
        Float3 reference;       ///< m/s, that velocities are counted from
    };
    struct Cell {
        std::size_t node;
        float share[3];
    };

    template <class Body>
    static void forEach(const Host& host, std::size_t count, std::size_t grain, const Body& body);
    void count(const RestShape& shape, const Host& host);
    Head headAt(const RestShape& shape, const Floats& roots) const;
    void locate(const RestShape& shape, const State& state, std::size_t block);
    Box boxOf(const std::vector<Bounds>& bounds) const;
    bool findCell(const float* at, std::size_t pitch, Cell& cell) const;
    void deposit(const RestShape& shape, const State& state, std::size_t block,
                 std::vector<Node>& nodes) const;
    void sum(const State& state, const RestShape& shape, const Host& host);
    void resolve(const SimulationSettings& settings, float time, const Host& host);
    void press(const RestShape& shape, const State& state, const SimulationSettings& settings, float h,
               std::size_t block);

    float cell_ = 0.0f;
    double massUnit_ = 0.0;  ///< metres of hair
    float roomUnit_ = 0.0f;  ///< of a node's room: 1 where it is full
    float pushUnit_ = 0.0f;  ///< of a point's room: 1 at the mean density
    Box restBox_, box_;
    Head head_;
    Motion motion_;
    std::vector<Point> points_;  ///< as a plane of all blocks
    Floats places_;              ///< per block: x, y, z in cells
    Floats felt_;                ///< kHairPlanes per block
    std::vector<Bounds> bounds_;
    std::array<std::vector<Node>, kSlots> slots_;
    std::array<std::atomic<bool>, kSlots> taken_{};
    std::array<bool, kSlots> used_{};
    std::vector<Node> sleepers_;         ///< of the blocks of `counted_`
    std::vector<std::uint8_t> counted_;  ///< per block: asleep, and in `sleepers_`
    bool sleepersCounted_ = false;
    bool anySleep_ = true;
    std::vector<float> pressure_;
    std::vector<Field> fields_;
};

}  // namespace hairloom::runtime
