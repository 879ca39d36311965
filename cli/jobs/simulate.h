// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What `simulate` and `takes --record` share.

#include <CLI/App.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/job.h"
#include "core/simulation/loop.h"

namespace hairloom::cli {

struct SimulateOptions {
    std::string input;
    std::optional<std::uint64_t> frames, preRoll;  ///< by default 60 and 0, or the time line's
    std::uint64_t handles = 0;                     ///< frames at each end
    std::optional<float> framesPerSecond;          ///< by default 60, or the time line's
    std::string engine;
    std::string backend = "cpu";
    std::optional<std::uint32_t> device;
    std::string model;
    std::string integrator;
    std::uint32_t substeps = 0;
    std::string wind;
    std::string motion = "none";
    std::string character;
    std::string method = "strands";
    bool hairHair = false;
    std::vector<std::string> poses;  ///< NAME=AMOUNT
    std::string style;
    bool sag = false;
    bool take = false;
    bool loop = false;
    std::uint64_t loopBlend = kLoopBlend;  ///< frames
    std::uint32_t loopRepeats = kLoopRepeats;
    std::string record;
    std::string against;
    std::string output;
};

/// Adds those of the motion and of how it is simulated; `options` must live as long as the job.
std::vector<CLI::Option*> addSimulationOptions(CLI::App& job, SimulateOptions& options);

Result<Report> simulate(const SimulateOptions& options);

/// "loop" of a report; warns of one that is not closed.
Report loopReport(const LoopReport& loop);
/// The groom with the frame as its authored shape, on the head at rest, as rods that carry their weight.
/// `report` gets how well that holds. Errors: those of editing::takeShape().
Result<Groom> groomOfFrame(Groom groom, std::span<const Vec3f> positions_ws, const HeadPose& pose,
                           Report& report);

}  // namespace hairloom::cli
