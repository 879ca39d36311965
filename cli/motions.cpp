// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/motions.h"

#include "cli/documents.h"
#include "cli/error_report.h"
#include "cli/vectors.h"
#include "core/base/log.h"
#include "core/groom/time_line.h"

namespace hairloom::cli {

Status setWind(Groom& groom, const std::string& wind) {
    if (wind.empty()) return {};
    const Vec3f velocity = orWrongUsage(parseVector(wind, "--wind"));
    const float speed = velocity.norm();
    groom.simulation.windSpeed = speed;
    if (speed > 0) {
        const Vec3f direction = velocity / speed;
        groom.simulation.windDirection = {direction.x(), direction.y(), direction.z()};
    }
    return {};
}

void checkMotion(const std::string& motion) {
    if (motion != kTimeLineMotion && !motion.starts_with("clip:") && !motion.ends_with(".json"))
        orWrongUsage(makeRigidMotion(motion, {}));
}

void addMotionOptions(CLI::App& job, MotionOptions& options) {
    job.add_option("groom", options.input, "Project or hair file")->required();
    job.add_option("--frames", options.frames, "Number of frames in each run")->check(CLI::Range(1, 100'000));
    job.add_option("--fps", options.framesPerSecond, "Frames per second")->check(CLI::Range(10.0, 1000.0));
    job.add_option("--wind", options.wind, "Wind velocity X,Y,Z in m/s, instead of the groom's own");
    job.add_option(
        "--motion", options.motion,
        "Head motion: none, spin, nod, clip:NAME, a keyframe file F.json, or timeline: the project's "
        "clips and keys of head and wind");
    job.add_option("--character", options.character,
                   "File with skeleton and clips, if other than the scalp's file");
}

Result<MovingGroom> openMovingGroom(const MotionOptions& options) {
    checkMotion(options.motion);
    auto groom = openGroom(options.input);
    if (!groom) return tl::unexpected(groom.error());
    if (auto status = setWind(*groom, options.wind); !status) return tl::unexpected(status.error());
    auto motion = makeMotion(options.motion, options.character, *groom);
    if (!motion) return tl::unexpected(motion.error());
    if (options.motion == kTimeLineMotion && keysSimulation(timeLineOf(*groom)))
        log::warning("{}: keys of settings do not play here, and the groom's own settings hold",
                     options.input);
    return MovingGroom{std::move(*groom), std::move(*motion)};
}

}  // namespace hairloom::cli
