// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hair that repeats with its motion: how far its end is from leading into its beginning, and a blend that
// closes what is left of that.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/simulation/time_line_motion.h"

namespace hairloom {

/// How the end of a repeat differs from what came before its first frame, the largest of all points.
struct LoopSeam {
    static constexpr double kClosedMm = 0.5, kClosedMmPerSecond = 20;

    double mm = 0;           ///< of the last frame
    double mmPerSecond = 0;  ///< of the step across the seam and of the one before
    bool isClosed() const { return mm <= kClosedMm && mmPerSecond <= kClosedMmPerSecond; }
};

inline constexpr std::uint64_t kLoopBlend = 12;    ///< frames, unless somebody asks for others
inline constexpr std::uint32_t kLoopRepeats = 12;  ///< that settle hair at most, likewise

struct LoopReport {
    std::uint64_t frames = 0, blend = 0;
    LoopSeam before, after;       ///< of the blend
    double headMm = 0;            ///< LoopSeam::mm of roots
    double blendMmPerSecond = 0;  ///< greatest speed that the blend adds to a point
};

/// Leads the last frames of a repeat over to those before its first one, so that the first follows the last.
/// Each strand goes from its own shape to the other's: points straight, by 6t⁵ − 15t⁴ + 10t³ of the way,
/// and segments with the lengths that lie between both. Positions are metres, world.
class LoopCloser {
  public:
    /// Repeats of `frames` ≥ 2, the last `blend` ≤ frames of them blended. `offsets`: of the strands.
    LoopCloser(std::span<const std::uint32_t> offsets, std::uint64_t frames, std::uint64_t blend,
               float framesPerSecond);

    /// As many frames as leads() come before the first of the repeat.
    static std::uint64_t leads(std::uint64_t blend);
    /// A frame before the repeat; those before the last leads() are not needed.
    void lead(std::span<const Vec3f> positions_ws);
    /// Of leads that are repeats themselves, behind the last frame of each: how it differs from the one
    /// before. None behind the first.
    std::optional<LoopSeam> endRepeat();

    /// The next frame of the repeat as it is in the loop. Lives until the next call. Comes after leads.
    std::span<const Vec3f> close(std::span<const Vec3f> positions_ws);
    /// After the last frame.
    const LoopReport& report() const { return report_; }

  private:
    /// Which of `earlier_` has the place of that frame, in a repeat earlier; it is one of the last ones.
    const std::vector<Vec3f>& counterpart(std::uint64_t frame) const;
    void blend(std::span<const Vec3f> target, float share);
    void measure(std::span<const Vec3f> positions_ws);

    std::vector<std::uint32_t> offsets_;
    double framesPerSecond_;
    std::uint64_t next_ = 0;                   ///< frame of close()
    std::vector<std::vector<Vec3f>> earlier_;  ///< the last leads, oldest first
    std::vector<std::vector<Vec3f>> ends_;     ///< the last two of the repeat before
    std::vector<Vec3f> closed_;                ///< what close() returns
    std::vector<Vec3f> moved_;                 ///< by the blend in the frame before
    std::vector<Vec3f> offBefore_, offAfter_;  ///< of the last frame but one from its counterpart
    LoopReport report_;
};

/// Whether the head repeats after that number of frames. Error: it is elsewhere in the next repeat, or jumps
/// from one to the other.
Status checkHeadRepeats(const HeadMotion& motion, const Groom& groom, const FramePace& pace,
                        std::uint64_t frames);

}  // namespace hairloom
