// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/animation/actor.h"
#include "importers/scene.h"
#include "tests/support/source_dir.h"

namespace hairloom::test {

/// Hair on the sample head, which has a skeleton and a clip.
struct Character {
    std::shared_ptr<const Actor> actor;
    Groom groom;
};
inline Character character() {
    const std::string file = (sourceDir() / "samples/bust/bust.glb").string();
    auto scene = importScene(file).value();
    auto mesh = std::make_shared<const ScalpMesh>(scene.mesh);
    FaceSet top;
    std::vector<SurfacePoint> roots;
    const Box3f bounds = mesh->bounds();
    for (std::uint32_t t = 0; t < mesh->triangleCount(); ++t) {
        if (mesh->pointAt(t, Vec3f(1, 1, 1) / 3).y() < bounds.max().y() - 0.04f) continue;
        top.push_back(t);
        if (t % 9 == 0) roots.push_back({t, Vec3f(0.25f, 0.25f, 0.5f)});
    }
    Character made;
    made.groom = growStraight(mesh, top, roots, 0.12f, 10).value();
    made.groom.characterFile = file;
    made.groom.spheres = {
        {"ball", bounds.max() - Vec3f(0, 0.1f, 0), 0.05f, scene.skeleton.bones().back().name}};
    made.actor = std::make_shared<const Actor>(
        Actor::make(mesh, std::move(scene.skeleton), std::move(scene.clips), std::move(scene.skin)).value());
    return made;
}

}  // namespace hairloom::test
