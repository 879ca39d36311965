// SPDX-License-Identifier: MIT
#pragma once
// Hair as strands and a fluid at once, after McAdams, Selle, Ward, Sifakis and Teran 2009, "Detail preserving
// continuum simulation of straight hair".

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hairloom/host.h"
#include "hairloom/math.h"
#include "hairloom/strands.h"

namespace hairloom::runtime {

/// Ranges stand behind each field; HairFlow::make refuses what lies outside.
struct HairFlowSettings {
    float cellSize = 0.0f;  ///< metres, 0…1. 0 chooses it from the hair's spacing
    /// 125…10⁷. Bound on the grid; beyond it cells are doubled until it fits.
    std::uint32_t maxCells = 1u << 20;
    /// 1/s, 0…1000. Rate at which a strand gives up its own motion for that of the grid: 0 keeps all of it
    /// (FLIP), more blends in the grid's velocity (PIC) and rubs.
    float friction = 2.0f;
    /// 1/s, 0…1000. Rate at which hair that is 1.5 times denser than at rest spreads; 0: it only resists
    /// pressing.
    float spreading = 2.0f;
    /// 0…1. Hair sparser than this share of its density at rest may be pressed together freely.
    float fill = 0.5f;
};

/// Velocities that hair gets from the hair around it, for any solver: called between frames on positions and
/// velocities, changes velocities. Each point weighs half of its two segments, where hair weighs 1 per metre.
///
/// Momentum is summed onto the faces of a staggered grid with trilinear weights. In cells that are filled
/// with hair (density at least `fill` of the density that its points had at rest) the velocity is made free
/// of divergence, or given `spreading` · min(ρ/ρ₀ − 1.5, 1) where hair is denser than 1.5 ρ₀: face
/// velocities get −∇p/ρ, with p from ∇·(∇p/ρ) = ∇·u − s by conjugate gradients, and p = 0 in other cells.
/// Strands get the change of the grid's velocity (FLIP) and, by friction, a share of the velocity itself
/// (PIC).
///
/// Both keep the momentum: what a face gets its cells lose, up to 10⁻⁴ of a cell's density that a face has at
/// least in the equation.
///
/// Same bits for any number of threads: sums run in the order of the points and cells.
///
/// Limits: as HairVolume: sees points, not segments, and blurs over a cell. No strand meets another one
/// within a cell, which McAdams et al. leave to collisions of strands. It knows no skin: spheres and skin act
/// in the next step of the strands. Hair that was pressed together spreads only until it is 1.5 times denser
/// than at rest.
class HairFlow {
  public:
    struct Result;
    /// Errors, in words: a setting outside its range, strands as Engine::make.
    static Result make(const StrandsView& strands, const HairFlowSettings& settings, Host host = {});

    struct Report {
        float cellSize = 0.0f;         ///< metres, as used
        std::uint32_t cells = 0;       ///< filled with hair
        std::uint32_t iterations = 0;  ///< of conjugate gradients
        double divergence = 0.0;       ///< 1/s: most that a filled cell was off before
        double left = 0.0;             ///< likewise after
        std::uint64_t leftOut =
            0;  ///< points that are no numbers or lie beyond 1e6 m; they keep their velocity
    };
    /// Metres and metres per second of all points, in the order given to make(); dt in seconds. A dt that is
    /// not above 0, or arrays of another size, change nothing.
    Report apply(std::span<const Float3> positions_ws, std::span<Float3> velocities_ws, float dt);

    // Of the last apply(). x runs fastest, then y.
    const std::array<std::uint32_t, 3>& size() const { return size_; }     ///< cells along each axis
    const std::array<std::int64_t, 3>& origin() const { return origin_; }  ///< of the first cell, in cells
    bool filled(std::size_t cell) const { return unknowns_[cell] >= 0; }
    /// m/s after the solve, along `axis`, of the face before a cell.
    double faceVelocity(std::size_t axis, std::size_t cell) const { return faces_[axis][cell].velocity; }
    std::span<const float> masses() const { return masses_; }  ///< by point, metres of hair
    std::span<const float> restDensities() const {
        return restDensities_;
    }  ///< by point, metres of hair per m³
    std::size_t bytes() const;

  private:
    struct Face {
        double mass, velocity, change;
    };
    struct Cell {
        double mass;
        double rest, packing;  ///< density at rest, and density over it, times mass
    };
    /// Of the system: neighbours (−1: none of its own) and 1/ρ of the faces to them, both before and after
    /// along each axis.
    struct Row {
        std::size_t cell;
        std::array<std::int32_t, 6> other;
        std::array<double, 6> weight;
        double diagonal, right, pressure, residual, direction, image;
    };
    HairFlow() = default;

    bool layOut(std::span<const Float3> positions, std::span<const Float3> velocities);
    template <class Visit>
    void forNodes(Float3 position, Float3 offset, const Visit& visit) const;
    std::vector<float> densitiesOf(std::span<const Float3> positions,
                                   std::span<const Float3> velocities) const;
    void gatherCells(std::span<const Float3> positions, std::span<const Float3> velocities);
    void gatherFaces(std::span<const Float3> positions, std::span<const Float3> velocities);
    void makeRows(double& divergence);
    std::uint32_t solve();
    void project();
    double divergenceLeft() const;

    HairFlowSettings settings_;
    Host host_;
    std::vector<float> masses_, restDensities_;
    std::vector<float> smoothRest_;  // densitiesOf() at rest
    std::array<std::uint32_t, 3> size_{};
    std::array<std::int64_t, 3> origin_{};
    double cell_ = 0.0, wanted_ = 0.0;  // metres: in use, and before cells are doubled
    std::vector<Cell> cells_;
    std::array<std::vector<Face>, 3> faces_;
    std::vector<std::int32_t> unknowns_;  // by cell: its row, or −1
    std::vector<Row> rows_;
};

struct HairFlow::Result {
    std::optional<HairFlow> flow;
    std::string error;  ///< empty when there is a flow
};

}  // namespace hairloom::runtime
