// SPDX-License-Identifier: GPL-3.0-or-later
// The collision spheres hug the bust from inside.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "core/base/file.h"
#include "samples/bust/head_shape.h"
#include "tests/samples/bust_files.h"

namespace hairloom::bust {
namespace {

struct Ball {
    Vec3d centre;
    double radius;
};

std::vector<Ball> readBalls() {
    const auto text = readTextFile(bustFolder() / "spheres.json");
    std::vector<Ball> balls;
    if (!text) return balls;
    for (const auto& entry : nlohmann::json::parse(*text)) {
        const auto c = entry.at("centre").get<std::array<double, 3>>();
        EXPECT_TRUE((std::set<std::string>{"root", "neck", "head"}.contains(entry.at("bone"))));
        balls.push_back({{c[0], c[1], c[2]}, entry.at("radius")});
    }
    return balls;
}

TEST(BustSpheres, StandOutByThreeMillimetresAtMost) {
    const auto balls = readBalls();
    ASSERT_GE(balls.size(), 5u);
    ASSERT_LE(balls.size(), 14u);
    Assimp::Importer importer;
    const aiScene* scene = readBust(importer, "bust.obj");
    ASSERT_NE(scene, nullptr);
    const BustFile file = weld(*scene);
    for (const Ball& ball : balls) {
        EXPECT_LT(surface(ball.centre), 0.0);
        for (const Vec3d& p : file.positions) ASSERT_GT((p - ball.centre).norm(), ball.radius - 0.003);
    }
}

TEST(BustSpheres, LieAtMostEightMillimetresBelowTheScalp) {
    const auto balls = readBalls();
    Assimp::Importer importer;
    const aiScene* scene = readBust(importer, "bust.obj");
    ASSERT_NE(scene, nullptr);
    const BustFile file = weld(*scene);
    for (std::size_t t = 0; t < file.triangles.size(); ++t) {
        if (file.groups[t] != "scalp") continue;
        for (const int v : file.triangles[t]) {
            double depth = 1.0;
            for (const Ball& ball : balls) {
                depth = std::min(depth, (file.positions[v] - ball.centre).norm() - ball.radius);
            }
            ASSERT_LE(depth, 0.008) << file.positions[v].transpose();
        }
    }
}

}  // namespace
}  // namespace hairloom::bust
