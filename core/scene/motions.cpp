// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/motions.h"

#include "core/scene/keyed_motion.h"
#include "core/scene/open.h"
#include "core/simulation/clip_motion.h"

namespace hairloom {
namespace {

std::string characterOf(const std::string& character, const Groom& groom) {
    return character.empty() ? groom.characterFile : character;
}

}  // namespace

Result<std::shared_ptr<const Actor>> loadActor(const std::string& character, const Groom& groom) {
    const std::string file = characterOf(character, groom);
    if (file.empty()) return fail("the groom names no file with clips", "expected --character FILE");
    MeshImportOptions options;
    if (character.empty() && groom.characterMetresPerUnit > 0)
        options.metresPerUnit = groom.characterMetresPerUnit;
    auto scene = importSceneLoud(file, options);
    if (!scene) return tl::unexpected(scene.error());
    auto actor = Actor::make(std::make_shared<const ScalpMesh>(std::move(scene->mesh)),
                             std::move(scene->skeleton), std::move(scene->clips), std::move(scene->skin));
    if (!actor) return tl::unexpected(inFile(actor.error(), file));
    return std::make_shared<const Actor>(std::move(*actor));
}

Result<std::unique_ptr<HeadMotion>> makeMotion(const std::string& name, const std::string& character,
                                               const Groom& groom) {
    constexpr std::string_view kClip = "clip:", kFile = ".json";
    if (name.size() > kFile.size() && name.ends_with(kFile)) return readKeyedMotion(name);
    if (name.rfind(kClip, 0) != 0) return makeRigidMotion(name, groom);
    auto actor = loadActor(character, groom);
    if (!actor) return tl::unexpected(actor.error());
    auto motion = makeClipMotion(std::move(*actor), name.substr(kClip.size()), groom);
    if (!motion) return tl::unexpected(inFile(motion.error(), characterOf(character, groom)));
    return motion;
}

}  // namespace hairloom
