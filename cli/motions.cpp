// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/motions.h"

#include <fmt/format.h>

#include "cli/documents.h"
#include "cli/vectors.h"
#include "core/simulation/clip_motion.h"

namespace hairloom::cli {

Result<std::unique_ptr<HeadMotion>> makeMotion(const std::string& name, const std::string& character,
                                               const Groom& groom) {
    constexpr std::string_view kClip = "clip:";
    if (name.rfind(kClip, 0) != 0) return makeRigidMotion(name, groom);
    const std::string file = character.empty() ? groom.characterFile : character;
    if (file.empty()) return fail("the groom names no file with clips", "expected --character FILE");
    MeshImportOptions options;
    if (character.empty() && groom.characterMetresPerUnit > 0)
        options.metresPerUnit = groom.characterMetresPerUnit;
    auto scene = importSceneLoud(file, options);
    if (!scene) return tl::unexpected(scene.error());
    auto actor = Actor::make(std::make_shared<const ScalpMesh>(std::move(scene->mesh)),
                             std::move(scene->skeleton), std::move(scene->clips), std::move(scene->skin));
    if (!actor) return tl::unexpected(inFile(actor.error(), file));
    auto motion =
        makeClipMotion(std::make_shared<const Actor>(std::move(*actor)), name.substr(kClip.size()), groom);
    if (!motion) return tl::unexpected(inFile(motion.error(), file));
    return motion;
}

Status setWind(Groom& groom, const std::string& wind) {
    if (wind.empty()) return {};
    const auto velocity = parseVector(wind, "--wind");
    if (!velocity) return tl::unexpected(velocity.error());
    const float speed = velocity->norm();
    groom.simulation.windSpeed = speed;
    if (speed > 0) {
        const Vec3f direction = *velocity / speed;
        groom.simulation.windDirection = {direction.x(), direction.y(), direction.z()};
    }
    return {};
}

void addMotionOptions(CLI::App& job, MotionOptions& options) {
    job.add_option("groom", options.input, "Project or hair file")->required();
    job.add_option("--frames", options.frames, "Frames of each run")->check(CLI::Range(1, 100'000));
    job.add_option("--fps", options.framesPerSecond, "Frames per second")->check(CLI::Range(10.0, 1000.0));
    job.add_option("--wind", options.wind, "Velocity of the air X,Y,Z in m/s, instead of the groom's own");
    job.add_option("--motion", options.motion, "How the head moves: none, spin, nod or clip:NAME");
    job.add_option("--character", options.character,
                   "File with the skeleton and clips, instead of the one the scalp came from");
}

Result<MovingGroom> openMovingGroom(const MotionOptions& options) {
    auto groom = loadDocument(options.input);
    if (!groom) return tl::unexpected(groom.error());
    if (auto status = setWind(*groom, options.wind); !status) return tl::unexpected(status.error());
    auto motion = makeMotion(options.motion, options.character, *groom);
    if (!motion) return tl::unexpected(motion.error());
    return MovingGroom{std::move(*groom), std::move(*motion)};
}

}  // namespace hairloom::cli
