// SPDX-License-Identifier: MIT
#pragma once
// Hair as a continuum of particles, after Hadap and Magnenat-Thalmann 2001, "Modeling dynamic hair as a
// continuum" (Rünz 2012, Section 3.1), by smoothed particles (Monaghan 1992).

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hairloom/alternatives/point_cells.h"
#include "hairloom/host.h"
#include "hairloom/math.h"
#include "hairloom/strands.h"

namespace hairloom::runtime {

/// Ranges stand behind each field; HairParticles::make refuses what lies outside.
struct HairParticleSettings {
    /// Metres, 0…1: reach of a particle. 0 chooses it from the hair's spacing. Larger: smoother, and more
    /// neighbours to look at.
    float radius = 0.0f;
    float stiffness = 1.0f;  ///< m²/s², 0…1000. Pressure by density of hair twice as dense as at rest; 0: off
    float friction = 5.0f;  ///< 1/s, 0…1000. Rate at which hair takes on the velocity around it; 0: off
};

/// Velocities that hair gets from the hair around it, for any solver: called between frames on positions and
/// velocities, changes velocities. Each point is a particle that weighs half of its two segments, where hair
/// weighs 1 per metre.
///
/// With W the cubic spline of that radius, ρ_i = Σ_j m_j W_ij. Hair that is denser than at rest has the
/// pressure p = K ρ₀ min(ρ/ρ₀ − 1, 1), with ρ₀ the particle's own density at rest: an authored style feels
/// none. Acceleration is −Σ_j m_j (p_i/ρ_i² + p_j/ρ_j²) ∇W_ij, and velocity is smoothed by Σ_j m_j W_ij
/// 2/(ρ_i + ρ_j) (v_j − v_i). Both act on pairs, so that they keep the momentum.
///
/// Stability: K is taken as what lets pressure cross 0.4 of the radius in dt, where it is larger, and
/// friction takes at most half of a difference.
///
/// Same bits for any number of threads: each particle sums over its neighbours in the order of the points.
///
/// Limits: sees points, not segments: a radius below their distance finds no neighbours. It knows no skin and
/// no directions of hair.
class HairParticles {
  public:
    struct Result;
    /// Errors, in words: a setting outside its range, strands as Engine::make.
    static Result make(const StrandsView& strands, const HairParticleSettings& settings, Host host = {});

    struct Report {
        std::uint64_t pairs = 0;  ///< neighbours within reach, each pair twice
        std::uint64_t leftOut =
            0;  ///< points that are no numbers or lie beyond 1e6 m; they keep their velocity
    };
    /// Metres and metres per second of all points, in the order given to make(); dt in seconds. A dt that is
    /// not above 0, or arrays of another size, change nothing.
    Report apply(std::span<const Float3> positions_ws, std::span<Float3> velocities_ws, float dt);

    float radius() const { return radius_; }  ///< metres
    // Of the last apply(), before it changed anything; by point.
    std::span<const float> densities() const { return densities_; }          ///< metres of hair per m³
    std::span<const float> restDensities() const { return restDensities_; }  ///< likewise, at rest
    std::span<const float> masses() const { return masses_; }                ///< metres of hair
    std::size_t bytes() const;

  private:
    HairParticles() = default;

    void sort(std::span<const Float3> positions);
    void measure(std::span<const Float3> positions, std::vector<float>& densities);

    HairParticleSettings settings_;
    Host host_;
    float radius_ = 0.0f;
    std::vector<float> masses_, densities_, restDensities_;
    std::vector<float> pushes_;  // p/ρ² without K
    std::vector<Float3> speeds_;
    PointCells cells_;  // of a radius at least
};

struct HairParticles::Result {
    std::optional<HairParticles> particles;
    std::string error;  ///< empty when there are particles
};

}  // namespace hairloom::runtime
