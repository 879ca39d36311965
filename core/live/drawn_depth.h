// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How deep hair that moves is in the head that it grows on: all hair that is drawn, in all frames.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "core/groom/groom.h"
#include "core/simulation/motion.h"

namespace hairloom {

/// Of all frames so far. Depths are beyond those of the authored shape at the same place of the same hair,
/// and not of the first 5 mm of a hair.
struct DrawnDepth {
    double deepest = 0;                         ///< metres, of what is drawn
    double deepestGuide = 0;                    ///< metres, of what is simulated
    double authored = 0;                        ///< metres, of the authored shape, of what is drawn
    double shareInside = 0;                     ///< 0 … 1 of places that were looked at
    std::optional<std::uint64_t> deepestFrame;  ///< the first such; none where nothing was inside
};

/// Looks at hair every 2 mm along the curves that are drawn (uniform Catmull-Rom), follow hairs where the
/// groom has some. The same numbers for any number of threads.
class DrawnDepthMeter {
  public:
    /// Errors: no scalp, a scalp that encloses nothing, those of bindFollowHairs().
    static Result<DrawnDepthMeter> make(const Groom& groom);
    DrawnDepthMeter(DrawnDepthMeter&&) noexcept;
    DrawnDepthMeter& operator=(DrawnDepthMeter&&) noexcept;
    ~DrawnDepthMeter();

    /// Points in the order of the groom's, metres, with their velocities in m/s, by which wisps widen, or
    /// none; on the scalp in that pose. Hairs with a point that is not finite are left out.
    void add(std::uint64_t frame, std::span<const Vec3f> positions_ws, std::span<const Vec3f> velocities_ws,
             const HeadPose& pose);
    DrawnDepth result() const;

  private:
    struct Impl;
    explicit DrawnDepthMeter(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace hairloom
