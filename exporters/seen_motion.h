// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What is seen of moving hair far off, and how far two motions are apart in it.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math.h"

namespace hairloom {

/// Collects frames of a groom's strands, 60 a second. Which strand swings a little earlier is not in it.
class SeenMotion {
  public:
    /// `offsets` of the strands, where they are at rest (metres, Y up), and the layer of each.
    SeenMotion(std::span<const std::uint32_t> offsets, std::span<const Vec3f> rest_ws,
               std::span<const std::uint32_t> layers);

    /// The next frame: all points.
    void add(std::span<const Vec3f> positions_ws);

    /// Metres.
    struct Difference {
        float outline = 0;   ///< root mean square over directions, views and frames
        float shape = 0;     ///< the same over stations and parts of layers, of where they hang on the mean
        float motion = 0;    ///< of the rate (an octave of it) and layer where it is largest
        float decibels = 0;  ///< the same as a ratio of amplitudes, of all that move
        float largest() const { return std::max({outline, shape, motion}); }
    };
    /// Of two that have collected as many frames of the same strands. `moves`, metres: decibels are of
    /// octaves that move so far.
    static Difference between(const SeenMotion& a, const SeenMotion& b, double moves = 5e-4);

  private:
    static constexpr std::size_t kStations = 8, kViews = 4, kDirections = 16;
    using Outline = std::array<float, kViews * kDirections>;  ///< metres from the middle; < 0: too few points

    void addShape(std::span<const Vec3f> positions_ws);
    void addOutline(std::span<const Vec3f> positions_ws);
    std::vector<double> amplitudes(std::size_t layer) const;

    std::vector<std::uint32_t> offsets_;
    std::vector<std::uint32_t> parts_;       ///< of each strand
    std::vector<std::uint32_t> strandsOf_;   ///< how many there are of each part
    std::vector<Eigen::Vector3d> stations_;  ///< sums over frames and strands, of each part
    Vec3f middle_ws = Vec3f::Zero();
    std::vector<std::uint32_t> outlined_;               ///< points
    std::vector<Outline> outlines_;                     ///< of some frames
    std::vector<std::vector<std::uint32_t>> followed_;  ///< points whose motion is looked at, of each layer
    std::vector<std::vector<Vec3f>> paths_;             ///< of these points, of each layer, frame after frame
    std::size_t frames_ = 0;
};

}  // namespace hairloom
