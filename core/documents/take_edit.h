// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Takes made of takes: one that loops, and one that is simulated anew from a frame on.

#include <filesystem>
#include <string>
#include <utility>

#include "core/base/work_watch.h"
#include "core/simulation/loop.h"
#include "core/simulation/take_file.h"

namespace hairloom {

/// First and last frame of the last whole repeat of the groom's time line in a take of it. Errors: a take of
/// another motion, of another frame rate, or with too few frames for a blend.
Result<std::pair<std::uint64_t, std::uint64_t>> lastRepeat(const TakeInfo& info, const Groom& groom,
                                                           std::uint64_t blend);

struct LoopToMake {
    std::uint64_t first = 0, last = 0;  ///< of the source, counted from 0
    std::uint64_t blend = kLoopBlend;   ///< frames
    WorkWatch watch{};
};
/// Errors: a range that the take has not, of less than two frames or shorter than the blend; too few frames
/// before it.
Status checkLoop(const TakeInfo& info, const LoopToMake& wanted);
/// Writes a take of these frames, whose end is blended into what comes before the first of them. Errors: as
/// checkLoop(); a head that is more than LoopSeam::kClosedMm elsewhere; those of reading and of TakeWriter.
/// Nothing is left then.
Result<LoopReport> makeLoop(TakeReader& source, const Groom& groom, const LoopToMake& wanted,
                            const std::filesystem::path& to);

struct TakeToResume {
    std::uint64_t at = 0;      ///< the frame that is kept last, counted from 0
    std::uint64_t frames = 0;  ///< that are simulated; 0: as many as the source has behind it
    WorkWatch watch{};
};
struct ResumeReport {
    std::uint64_t kept = 0, simulated = 0;  ///< frames
    double headMm = 0;  ///< largest distance of a root at that frame from where the motion has it
};
/// Writes a take of the source's frames up to one, and of what the groom does from there on: with its
/// settings as they are now, and by `motion`, whose start is that of the source. The strand engine runs on
/// the CPU. `name`: of the motion. Errors: a take that repeats, no such frame, nothing to simulate, a head
/// that is more than LoopSeam::kClosedMm from where the motion has it; those of reading, of TakeWriter and of
/// simulations.
Result<ResumeReport> resumeTake(TakeReader& source, const Groom& groom, const HeadMotion& motion,
                                const std::string& name, const TakeToResume& wanted,
                                const std::filesystem::path& to);

}  // namespace hairloom
