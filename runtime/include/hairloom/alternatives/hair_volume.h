// SPDX-License-Identifier: MIT
#pragma once
// Hair against hair through a grid of density and velocity, after Petrovic, Henne, Anderson 2005, "Volumetric
// methods for simulation and rendering of hair".

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hairloom/host.h"
#include "hairloom/math.h"

namespace hairloom::runtime {

/// Ranges stand behind each field; HairVolume::make refuses what lies outside.
struct HairVolumeSettings {
    float cellSize = 0.01f;  ///< metres, 0.0001…10. Smaller: finer locks, more nodes
    /// 125…10⁷. Bound on the grid; beyond it cells are doubled until it fits.
    std::uint32_t maxNodes = 1u << 18;
    float targetDensity = 1e6f;  ///< points per m³, 1…1e12. Hair denser than this pushes apart
    float repulsion = 0.01f;     ///< m²/s², 0…1000. Pressure at twice the target density; 0 is off
    float friction = 5.0f;  ///< 1/s, 0…1000. Rate at which hair takes on the velocity around it; 0 is off
};

/// Velocities that hair gets from the hair around it, for any solver: called between frames on positions and
/// velocities, changes velocities. Each point has the mass 1.
///
/// Density and momentum are summed into nodes with trilinear weights, in 64-bit integers, so that the result
/// does not depend on the order or the number of threads. A weight is a whole number of 2⁻²⁴ (a position in
/// its cell counts to 1/256 of the cell); the eight weights of a point add up to 1 exactly. The unit of
/// velocity is a power of two, as fine as the number of points and the fastest of them allow before a sum of
/// all could leave 62 bits: nothing overflows. Components above 1000 m/s count as 1000 m/s in the sums.
///
/// Repulsion: acceleration −∇p with the pressure p = repulsion · max(0, density/targetDensity − 1), by
/// central differences. A push moves no point farther than half a cell in dt. Friction: each
/// point's difference to the grid's velocity, as it was at the call, decays by exp(−friction · dt), exactly;
/// as a whole friction conserves momentum.
///
/// Limits: sees points, not segments: where segments are longer than a cell the grid has gaps, and a strand
/// of many points weighs more. Blurs over a cell, so that two locks in one cell do not see each other, and
/// friction also slows a lock's own inner motion. The grid is one box: a stray point widens it for all, and
/// cells that double change the forces at once. It knows no skin and no directions of hair.
class HairVolume {
  public:
    struct Result;
    /// Takes all its memory here. Errors, in words: a setting outside its range.
    static Result make(const HairVolumeSettings& settings, Host host = {});

    struct Report {
        float cellSize = 0.0f;    ///< metres, as used
        std::uint32_t nodes = 0;  ///< in use; 0 when nothing was done
        std::uint64_t leftOut =
            0;  ///< points that are no numbers or lie beyond 1e6 m; they keep their velocity
    };
    /// Metres and metres per second of the same points; dt in seconds. A dt that is not above 0, or
    /// arrays of different sizes, change nothing.
    Report apply(std::span<const Float3> positions_ws, std::span<Float3> velocities_ws, float dt);

    /// What the grid of the last apply() holds, before it changed anything.
    struct Totals {
        double mass = 0.0;                 ///< points
        std::array<double, 3> momentum{};  ///< points · m/s
    };
    Totals totals() const;
    /// Memory of the grid.
    std::size_t bytes() const;

  private:
    static constexpr std::size_t kChunks = 64;
    struct Box {
        Float3 low, high;
        float fastest = 0.0f;
        std::uint64_t points = 0;
    };
    /// Integer sums: mass in units of 2⁻²⁴, momentum in units of 2⁻²⁴ · velocityUnit_.
    struct Node {
        std::int64_t mass, x, y, z;
    };
    /// What a point reads.
    struct Field {
        Float3 velocity, push;  ///< m/s; m/s²
    };
    /// Corner of a point's cell and its share of the way to the next, in 1/256, along each axis.
    struct Place {
        std::array<std::uint32_t, 3> corner, share;
    };
    HairVolume() = default;

    template <class Body>
    void forChunks(std::size_t count, const Body& body);
    Box measure(std::span<const Float3> positions, std::span<const Float3> velocities);
    void layOut(const Box& box);
    Place placeOf(Float3 position) const;
    std::size_t nodeOf(const Place& place, unsigned corner) const;
    void accumulate(std::span<const Float3> positions, std::span<const Float3> velocities);
    float pressureAt(std::size_t node) const;
    void resolve();
    void changeVelocity(Float3 position, Float3& velocity, float share, float dt) const;

    HairVolumeSettings settings_;
    Host host_;
    std::vector<Node> nodes_;
    std::vector<Field> fields_;
    std::array<Box, kChunks> boxes_;
    std::array<std::uint32_t, 3> size_{};   // nodes along each axis
    std::array<std::int64_t, 3> origin_{};  // of the first node, in cells from the world's origin
    float cell_ = 0.0f;                     // metres, of the grid in use
    double velocityUnit_ = 0.0;             // m/s
};

struct HairVolume::Result {
    std::optional<HairVolume> volume;
    std::string error;  ///< empty when there is a volume
};

}  // namespace hairloom::runtime
