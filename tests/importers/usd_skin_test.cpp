// SPDX-License-Identifier: GPL-3.0-or-later
// Heads of USD that skeletons, blend shapes and points in time move, against the points that USD's own
// library computes of them (tests/interop/usd_skin_truth.py writes both).

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/animation/actor.h"
#include "importers/scene.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

namespace fs = std::filesystem;

/// The largest distance to the nearest vertex of the mesh as it is posed, over all points and times.
double farthest(const ImportedScene& scene, const nlohmann::json& truth) {
    const auto actor = Actor::make(std::make_shared<const ScalpMesh>(scene.mesh), scene.skeleton, scene.clips,
                                   scene.skin, scene.morphs);
    if (!actor) return ADD_FAILURE() << actor.error().message(), 0;
    double most = 0;
    for (const auto& frame : truth.at("frames")) {
        const ActorPose pose = scene.clips.empty()
                                   ? actor->restPose()
                                   : actor->poseAt(0, frame.at("t").get<float>(), Wrap::Clamp);
        const auto& points = frame.at("p");
        // Welding takes repeated points away, and no test stage has some.
        EXPECT_EQ(points.size(), pose.positions_ws.size());
        for (std::size_t v = 0; v < pose.positions_ws.size(); ++v) {
            const auto& p = points.at(scene.mesh.sourceVertices()[v]);
            const Vec3f expected(p[0].get<float>(), p[1].get<float>(), p[2].get<float>());
            most = std::max(most, static_cast<double>((expected - pose.positions_ws[v]).norm()));
        }
    }
    return most;
}

TEST(UsdSkins, MoveAsUsdSkelMovesThem) {
    std::size_t stages = 0;
    for (const auto& entry : fs::directory_iterator(sourceDir() / "tests/importers/files/usd_skin")) {
        if (entry.path().extension() != ".json") continue;
        std::ifstream stream(entry.path());
        const auto truth = nlohmann::json::parse(stream);
        const auto file = entry.path().parent_path() / truth.at("file").get<std::string>();
        const auto scene = importScene(file);
        ASSERT_TRUE(scene) << scene.error().message();
        EXPECT_LT(farthest(*scene, truth), 1e-5) << file;
        ++stages;
        if (!truth.value("skins", true)) continue;
        EXPECT_TRUE(scene->skeleton.find("jaw")) << file << ": joints keep their own names";
        EXPECT_FALSE(scene->mesh.cornerUvs().empty()) << file;
    }
    EXPECT_GE(stages, 19u);
}

}  // namespace
}  // namespace hairloom
