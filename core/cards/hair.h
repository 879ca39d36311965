// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What cards are made from: hair as pictures show it, at one moment, as plain arrays.

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math.h"
#include "core/base/result.h"

namespace hairloom::cards {

/// Strand s owns points [offsets[s], offsets[s + 1]), root first. World space, metres.
struct Hair {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions_ws;
    std::vector<float> radii;           ///< per point, metres, ≥ 0
    std::vector<Vec3f> albedo;          ///< per point, linear RGB in [0, 1]
    std::vector<Vec3f> rootNormals_ws;  ///< per strand, unit, out of the scalp
    float specular = 0.3f;              ///< Kajiya-Kay's c_s, ≥ 0
    float shininess = 60;               ///< Kajiya-Kay's exponent, ≥ 1

    // The head that they stand on, which hides hair behind it; may be empty.
    std::vector<Vec3f> headPositions_ws;
    std::vector<std::uint32_t> headIndices;  ///< three a triangle

    std::size_t strandCount() const { return offsets.size() - 1; }
    std::span<const Vec3f> strand(std::size_t s) const {
        return std::span(positions_ws).subspan(offsets[s], offsets[s + 1] - offsets[s]);
    }
};

/// Errors: fewer than two strands, arrays of other lengths than the points or strands, numbers that are not
/// finite, strands of fewer than two points, all strands of no length.
Status check(const Hair& hair);

/// Every strand as the same number of points, evenly by its length.
struct EvenHair {
    std::uint32_t stations = 0;  ///< points of a strand, ≥ 2
    std::vector<Vec3f> points_ws;
    std::vector<float> lengths;  ///< per strand, metres
    std::vector<float> weights;  ///< per strand, m²: the area that it shows from the side
    std::size_t strandCount() const { return lengths.size(); }
    std::span<const Vec3f> strand(std::size_t s) const {
        return std::span(points_ws).subspan(s * stations, stations);
    }
};
EvenHair evenHair(const Hair& hair, std::uint32_t stations);

/// Somebody may want to stop long work; null: nobody.
using Cancel = const std::atomic<bool>*;
inline bool cancelled(Cancel cancel) {
    return cancel != nullptr && cancel->load();
}
/// What work that was stopped answers.
tl::unexpected<Error> stopped();

}  // namespace hairloom::cards
