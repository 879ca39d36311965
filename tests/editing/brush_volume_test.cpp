// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/brush_volume.h"

#include <gtest/gtest.h>

#include "tests/geometry/test_meshes.h"

namespace hairloom::editing {
namespace {

/// Along an axis, in a plane of two, nearly along one, or anyhow.
Vec3f randomAxis(Random& random) {
    Vec3f axis = test::randomPoint(random, 1) + Vec3f(0, 0, 1e-3f);
    const std::uint32_t kind = random.below(4);
    if (kind < 3) axis[random.below(3)] = kind == 2 ? 1e-20f : 0.0f;
    if (kind == 1) axis = Vec3f::Unit(random.below(3)) * (random.below(2) == 0 ? 1.0f : -1.0f);
    return axis.normalized();
}

/// Also boxes that are flat, a line or a point.
TEST(BoxTest, MissesNoBoxWithAPointInside) {
    Random random(1);
    std::size_t touched = 0, passed = 0;
    for (int i = 0; i < 20000; ++i) {
        const BrushVolume volume{test::randomPoint(random, 0.1f), randomAxis(random),
                                 i % 3 == 0 ? 0.0f : random.uniform(0, 0.1f), random.uniform(0.001f, 0.05f)};
        const BoxTest test(volume);
        const Vec3f corner = test::randomPoint(random, 0.15f);
        Vec3f size = test::randomPoint(random, 0.1f).cwiseAbs();
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            if (random.below(4) == 0) size[axis] = 0;
        }
        bool isTouched = false;
        for (int k = 0; k < 64; ++k) {
            const Vec3f share = test::randomPoint(random, 0.5f) + Vec3f::Constant(0.5f);
            const Vec3f point = corner + size.cwiseProduct(share);
            isTouched = isTouched || volume.squaredDistance(point) < volume.radius * volume.radius;
        }
        const bool passes = test(corner, corner + size);
        touched += isTouched ? 1 : 0;
        passed += passes ? 1 : 0;
        if (isTouched) {
            ASSERT_TRUE(passes) << "box " << i;
        }
    }
    EXPECT_GT(touched, 500u);
    EXPECT_LT(passed, 13000u);
}

TEST(BoxTest, LeavesOutWhatIsBesideTheVolume) {
    const BrushVolume volume{Vec3f::Zero(), Vec3f::UnitZ(), 0.05f, 0.02f};
    const BoxTest test(volume);
    EXPECT_TRUE(test(Vec3f(0.01f, 0, 0.06f), Vec3f(0.02f, 0.1f, 0.1f)));
    EXPECT_FALSE(test(Vec3f(0.021f, -1, -1), Vec3f(1, 1, 1)));
    EXPECT_FALSE(test(Vec3f(-1, -1, 0.0701f), Vec3f(1, 1, 1)));
}

}  // namespace
}  // namespace hairloom::editing
