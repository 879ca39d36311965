// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/body_fit.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/animation/bone_near.h"
#include "core/base/log.h"
#include "core/documents/motions.h"

namespace hairloom {

Result<std::shared_ptr<const Actor>> actorForColliders(const std::string& character, const Groom& groom) {
    if (character.empty() && groom.characterFile.empty()) return nullptr;
    auto actor = loadActor(character, groom);
    if (!actor && !character.empty()) return tl::unexpected(actor.error());
    if (!actor) {
        log::warning(
            "{}. The colliders have no bone and do not move with clips: set the file with --character",
            actor.error().message());
        return nullptr;
    }
    if ((*actor)->skeleton().empty()) return nullptr;
    return std::move(*actor);
}

void attachSpheres(const Actor& actor, std::span<CollisionSphere> spheres) {
    for (CollisionSphere& sphere : spheres) sphere.bone = boneUnder(actor, sphere.centre, sphere.radius);
}

Result<BakedBody> fitBody(const Groom& groom, const Actor* actor, float error, std::size_t mostBytes) {
    constexpr float kCoarsest = 0.004f, kFinest = 0.0005f;  // metres
    BakeBodyOptions options;
    options.mostBytes = mostBytes;
    options.finest = std::clamp(2 * error, kFinest, kCoarsest);
    auto baked = bakeBodyOf(groom, actor, options);
    while (baked && baked->fit.worstGap > error && baked->cell <= 1.01f * options.finest &&
           options.finest > kFinest) {
        options.finest = std::max(0.6f * options.finest, kFinest);
        baked = bakeBodyOf(groom, actor, options);
    }
    if (!baked || baked->fit.worstGap <= error) return baked;
    const auto mm = [](float metres) { return 1e3 * static_cast<double>(metres); };
    baked->notes.push_back(
        fmt::format("skin lies up to {:.2f} mm outside, more than the {:.2f} mm asked for, at {:.3f} {:.3f} "
                    "{:.3f}",
                    mm(baked->fit.worstGap), mm(error), static_cast<double>(baked->fit.worstGapAt_ss.x()),
                    static_cast<double>(baked->fit.worstGapAt_ss.y()),
                    static_cast<double>(baked->fit.worstGapAt_ss.z())));
    return baked;
}

}  // namespace hairloom
