// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <memory>
#include <string>

#include "core/documents/motions.h"
#include "core/simulation/motion.h"

namespace hairloom::cli {

/// The wind of --wind, "X,Y,Z" in m/s, instead of the groom's own; an empty text changes nothing.
Status setWind(Groom& groom, const std::string& wind);

/// Throws WrongUsage where --motion is no word that there is; what a file holds is not asked.
void checkMotion(const std::string& motion);

/// What jobs have in common that run a scene a few times over.
struct MotionOptions {
    std::string input;
    std::string motion = "none";
    std::string character;
    std::string wind;
    std::uint32_t frames = 60;
    float framesPerSecond = 60;
};
void addMotionOptions(CLI::App& job, MotionOptions& options);

struct MovingGroom {
    Groom groom;
    std::unique_ptr<HeadMotion> motion;
};
Result<MovingGroom> openMovingGroom(const MotionOptions& options);

}  // namespace hairloom::cli
