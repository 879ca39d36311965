// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What both placements share: checks, density and masked area. Private to core/geometry.

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/placement.h"

namespace hairloom {

Status checkPlacement(const ScalpMesh& mesh, const FaceSet& faces, std::span<const float> mask);

/// Densities at the corners of a triangle, in [0, 1].
inline Vec3f cornerDensities(const ScalpMesh& mesh, std::span<const float> mask, std::uint32_t triangle) {
    if (mask.empty()) return Vec3f::Ones();
    const Triangle& t = mesh.triangles()[triangle];
    return {mask[t[0]], mask[t[1]], mask[t[2]]};
}

/// m², each bit of area weighted with its density.
double maskedArea(const ScalpMesh& mesh, const FaceSet& faces, std::span<const float> mask);

/// Number of roots that a request asks for. Errors: none or too many to hold (with the density that would
/// fit).
Result<std::size_t> requestedCount(const PlacementRequest& request, double maskedSquareMetres);

/// Picks faces in proportion to their weight in constant expected time (the cutpoint method, Chen and Asau
/// 1974).
class FacePicker {
  public:
    explicit FacePicker(const std::vector<double>& weights)
        : cumulated_(weights.size()), first_(weights.size()) {
        double sum = 0;
        for (std::size_t i = 0; i < weights.size(); ++i) cumulated_[i] = sum += weights[i];
        std::size_t face = 0;
        for (std::size_t i = 0; i < first_.size(); ++i) {
            const double bound = sum * static_cast<double>(i) / static_cast<double>(first_.size());
            while (cumulated_[face] <= bound && face + 1 < cumulated_.size()) ++face;
            first_[i] = static_cast<std::uint32_t>(face);
        }
    }
    /// `u` in [0, 1)
    std::size_t pick(double u) const {
        const double bound = u * cumulated_.back();
        std::size_t face = first_[static_cast<std::size_t>(u * static_cast<double>(first_.size()))];
        while (cumulated_[face] <= bound && face + 1 < cumulated_.size()) ++face;
        return face;
    }

  private:
    std::vector<double> cumulated_;
    std::vector<std::uint32_t> first_;
};

}  // namespace hairloom
