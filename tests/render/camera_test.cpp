// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/camera.h"

#include <gtest/gtest.h>

namespace hairloom::render {
namespace {

TEST(CameraTest, AnOrthographicViewIsAsHighAsItSaysAndHasNoPerspective) {
    Camera camera;
    camera.eye_ws = Vec3f(0.3f, 1.2f, 2);
    camera.target_ws = Vec3f(0.1f, 1, -0.4f);
    camera.orthographicHeight = 0.5f;
    ASSERT_TRUE(check(camera));
    const float aspect = 1.6f;
    const Mat4f clip = projectionMatrix(camera, aspect, -1, 9) * viewMatrix(camera);
    const Vec3f forward = (camera.target_ws - camera.eye_ws).normalized();
    const Vec3f right = forward.cross(camera.up_ws).normalized(), up = right.cross(forward);
    for (const float depth : {-0.9f, 0.0f, 3.0f, 8.5f}) {
        const Vec3f at = camera.eye_ws + depth * forward + 0.25f * up - 0.4f * right;
        const Vec4f seen = clip * at.homogeneous();
        EXPECT_NEAR(seen.w(), 1, 1e-6f);
        EXPECT_NEAR(seen.y(), 1, 1e-5f) << "upper edge, whatever the depth";
        EXPECT_NEAR(seen.x(), -1, 1e-5f) << "left edge";
        EXPECT_NEAR(seen.z(), (depth + 1) / 10, 1e-5f);
    }
    camera.orthographicHeight = -1;
    EXPECT_FALSE(check(camera));
}

TEST(Camera, NamedViewsSeeAllCornersAndFillTheFrame) {
    const Box3f box(Vec3f(-0.1f, 1.3f, -0.12f), Vec3f(0.2f, 1.8f, 0.15f));
    for (const float aspect : {0.5f, 1.0f, 16.0f / 9.0f}) {
        for (const char* name : {"front", "back", "left", "right", "three-quarter", "top", "bottom"}) {
            const Camera camera = frame(parseView(name).value(), box, aspect);
            ASSERT_TRUE(check(camera));
            const Mat4f m = projectionMatrix(camera.verticalFov, aspect, 0.01f, 100) * viewMatrix(camera);
            float reach = 0;
            for (int i = 0; i < 8; ++i) {
                const Vec4f clip = m * box.corner(static_cast<Box3f::CornerType>(i)).homogeneous();
                ASSERT_GT(clip.w(), 0);
                reach = std::max({reach, std::abs(clip.x() / clip.w()), std::abs(clip.y() / clip.w())});
            }
            EXPECT_LE(reach, 1.0f) << name << aspect;
            EXPECT_GE(reach, 0.85f) << name << aspect;
        }
    }
}

TEST(Camera, ViewsLookFromTheirSide) {
    const Box3f box(Vec3f::Constant(-1), Vec3f::Constant(1));
    EXPECT_GT(frame(View::Front, box, 1).eye_ws.z(), 2);
    EXPECT_LT(frame(View::Back, box, 1).eye_ws.z(), -2);
    EXPECT_GT(frame(View::Left, box, 1).eye_ws.x(), 2);
    EXPECT_LT(frame(View::Right, box, 1).eye_ws.x(), -2);
    EXPECT_FALSE(parseView("above"));
}

TEST(Camera, DepthRunsFromNearToFar) {
    const Mat4f m = projectionMatrix(40, 1, 0.5f, 8);
    const auto depth = [&](float z) {
        const Vec4f clip = m * Vec4f(0, 0, -z, 1);
        return clip.z() / clip.w();
    };
    EXPECT_NEAR(depth(0.5f), 0, 1e-6f);
    EXPECT_NEAR(depth(8), 1, 1e-6f);
    EXPECT_GT(depth(2), depth(1));
}

TEST(Camera, InvalidCamerasAreRefused) {
    Camera camera;
    camera.target_ws = camera.eye_ws;
    EXPECT_FALSE(check(camera));
    camera = {};
    camera.up_ws = camera.target_ws - camera.eye_ws;
    EXPECT_FALSE(check(camera));
    camera = {};
    camera.verticalFov = 0;
    EXPECT_FALSE(check(camera));
    camera.verticalFov = std::nanf("");
    EXPECT_FALSE(check(camera));
}

}  // namespace
}  // namespace hairloom::render
