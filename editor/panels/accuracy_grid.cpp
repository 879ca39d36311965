// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/accuracy_grid.h"

namespace hairloom::editor {
namespace {

constexpr std::uint32_t kFrames = 30;
constexpr std::uint32_t kRepeats = 3;
constexpr std::uint32_t kMostStrands = 4000;  ///< that run; times of more are in proportion
constexpr std::size_t kTrueStrands = 12;      ///< that the reference solves
constexpr std::uint32_t kTrueSubsteps = 16;   ///< hair that slides over spheres would take minutes with more
constexpr double kTolerance_mm = 0.02;

}  // namespace

Result<WorkPrecision> measureGrid(const Groom& groom, const HeadMotion& motion, TaskControl& control,
                                  const std::function<void(const WorkPrecision&)>& partial) {
    WorkPrecisionOptions options;
    options.axes = axesToTry(groom);
    options.time.frames = kFrames;
    options.strands = kMostStrands;
    options.repeats = kRepeats;
    options.keepTrajectories = true;
    options.progress = [&](std::size_t done, std::size_t total) {
        control.setProgress(static_cast<float>(done) / static_cast<float>(total));
    };
    options.partial = partial;
    options.cancelled = [&] { return control.isCancelled(); };
    ReferenceConverged::Options truth;
    truth.strands = kTrueStrands;
    truth.toleranceMm = kTolerance_mm;
    truth.maxSubsteps = kTrueSubsteps;
    truth.cancelled = options.cancelled;
    return measureWorkPrecision(groom, motion, options, ReferenceConverged(truth));
}

}  // namespace hairloom::editor
