// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/motions.h"

#include <algorithm>
#include <optional>
#include <tuple>

#include "core/documents/head_import.h"
#include "core/documents/keyed_motion.h"
#include "core/documents/open.h"
#include "core/simulation/clip_motion.h"
#include "core/simulation/time_line_motion.h"

namespace hairloom {
namespace {

std::string characterOf(const std::string& character, const Groom& groom) {
    return character.empty() ? groom.characterFile : character;
}

/// For each vertex of `head` the one of `all` in its place, where all have one: `head` is then `all` without
/// some of its groups.
std::optional<std::vector<std::uint32_t>> verticesIn(const ScalpMesh& all, const ScalpMesh& head) {
    const auto placeOf = [&](std::uint32_t v) {
        const Vec3f& p = all.positions()[v];
        return std::tuple(p.x(), p.y(), p.z());
    };
    std::vector<std::uint32_t> sorted(all.vertexCount());
    for (std::uint32_t v = 0; v < sorted.size(); ++v) sorted[v] = v;
    std::ranges::sort(sorted, {}, placeOf);
    std::vector<std::uint32_t> found;
    for (const Vec3f& p : head.positions()) {
        const std::tuple place(p.x(), p.y(), p.z());
        const auto at = std::ranges::lower_bound(sorted, place, {}, placeOf);
        if (at == sorted.end() || placeOf(*at) != place) return std::nullopt;
        found.push_back(*at);
    }
    return found;
}

/// The character on the groom's head where that has fewer groups than the file.
void fitTo(const std::shared_ptr<const ScalpMesh>& head, std::shared_ptr<const ScalpMesh>& mesh,
           SkinWeights& skin, std::vector<MorphTarget>& morphs) {
    if (!head || head->triangleCount() >= mesh->triangleCount()) return;
    const auto from = verticesIn(*mesh, *head);
    if (!from) return;
    skin = weightsOf(skin, *from);
    morphs = morphsOf(morphs, *from);
    mesh = head;
}

}  // namespace

Result<std::shared_ptr<const Actor>> loadActor(const std::string& character, const Groom& groom) {
    const std::string file = characterOf(character, groom);
    if (file.empty())
        return fail("the groom does not refer to a file with clips", "expected --character FILE");
    MeshImportOptions options;
    if (character.empty() && groom.characterMetresPerUnit > 0)
        options.metresPerUnit = groom.characterMetresPerUnit;
    auto scene = importSceneLoud(file, options);
    if (!scene) return tl::unexpected(scene.error());
    auto mesh = std::make_shared<const ScalpMesh>(std::move(scene->mesh));
    fitTo(groom.scalp, mesh, scene->skin, scene->morphs);
    auto actor = Actor::make(std::move(mesh), std::move(scene->skeleton), std::move(scene->clips),
                             std::move(scene->skin), std::move(scene->morphs));
    if (!actor) return tl::unexpected(inFile(actor.error(), file));
    return std::make_shared<const Actor>(std::move(*actor));
}

Result<std::unique_ptr<HeadMotion>> makeMotion(const std::string& name, const std::string& character,
                                               const Groom& groom) {
    constexpr std::string_view kClip = "clip:", kFile = ".json";
    if (name.size() > kFile.size() && name.ends_with(kFile)) return readKeyedMotion(name);
    if (name == kTimeLineMotion) {
        const TimeLine& line = timeLineOf(groom);
        std::shared_ptr<const Actor> actor;
        if (!line.clips.empty()) {
            auto loaded = loadActor(character, groom);
            if (!loaded) return tl::unexpected(loaded.error());
            actor = std::move(*loaded);
        }
        auto motion = makeTimeLineMotion(line, std::move(actor), groom);
        if (!motion && !line.clips.empty())
            return tl::unexpected(inFile(motion.error(), characterOf(character, groom)));
        return motion;
    }
    if (name.rfind(kClip, 0) != 0) return makeRigidMotion(name, groom);
    auto actor = loadActor(character, groom);
    if (!actor) return tl::unexpected(actor.error());
    auto motion = makeClipMotion(std::move(*actor), name.substr(kClip.size()), groom);
    if (!motion) return tl::unexpected(inFile(motion.error(), characterOf(character, groom)));
    return motion;
}

MotionSpan motionSpanOf(std::string_view motion, const Groom& groom, std::optional<float> framesPerSecond,
                        std::optional<std::uint64_t> frames, std::optional<std::uint64_t> preRoll) {
    MotionSpan span;
    if (motion == kTimeLineMotion) {
        TimeLine line = timeLineOf(groom);
        line.framesPerSecond = framesPerSecond.value_or(line.framesPerSecond);
        span = {paceOf(line), line.frameCount()};
    }
    return {{framesPerSecond.value_or(span.pace.framesPerSecond), preRoll.value_or(span.pace.preRoll)},
            frames.value_or(span.frames)};
}

}  // namespace hairloom
