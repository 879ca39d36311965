// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of the samples against those that somebody has looked at and accepted. `./dev golden` shows what
// has changed.
#include <gtest/gtest.h>

#include <memory>

#include "core/software/device.h"
#include "tests/golden/golden_pictures.h"
#include "tests/gpu/test_backend.h"

namespace hairloom::golden {
namespace {

/// One test a sample, for making it takes longer than drawing it.
class GoldenTest : public testing::TestWithParam<const char*> {
  protected:
    /// Each model with what it has by default, and what kernels draw: enough to tell the renderers apart.
    static bool isOfModelsOrKernels(const Case& which) {
        return which.name == which.sample + "-kajiya" || which.name == which.sample + "-marschner" ||
               which.name == which.sample + "-sadeghi" || which.options.ribbons == render::Ribbons::compute;
    }
    /// The software renderer against what a graphics API draws: its own passes where it has them, and hair in
    /// its order instead of by weights.
    void expectTheSameBySoftware(Painter& painter, Case which, const render::Image& accepted) {
        const bool same = which.options.ribbons == render::Ribbons::compute;
        which.options.ribbons = render::Ribbons::compute;
        if (!same) which.options.transparency = render::Transparency::sorted;
        painter.use(*software_);
        const auto drawn = painter.draw(which);
        ASSERT_TRUE(drawn) << drawn.error().message();
        const auto difference = render::flipDifference(accepted, *drawn);
        ASSERT_TRUE(difference) << difference.error().message();
        EXPECT_LT(difference->mean, same ? kTolerance : kOtherWay);
    }

  private:
    /// Between hair that is blended by weights, and in its order.
    static constexpr double kOtherWay = 0.03;
    std::unique_ptr<gpu::Device> software_ = software::makeDevice();
};

TEST_P(GoldenTest, LooksAsAccepted) {
    const auto device = gpu::createDevice(gpu::testDevice());
    ASSERT_TRUE(device) << device.error().message();
    Painter painter(**device);
    int drawnCases = 0;
    for (const Case& which : cases()) {
        if (which.sample != GetParam()) continue;
        SCOPED_TRACE(which.name);
        const auto accepted = acceptedPicture(which);
        ASSERT_TRUE(accepted) << accepted.error().message() << "; ./dev golden --accept " << which.name;
        const auto drawn = painter.draw(which);
        ASSERT_TRUE(drawn) << drawn.error().message();
        const auto difference = render::flipDifference(*accepted, *drawn);
        ASSERT_TRUE(difference) << difference.error().message();
        EXPECT_LT(difference->mean, kTolerance) << "look at it with ./dev golden";
        ++drawnCases;
        if (!isOfModelsOrKernels(which)) continue;
        expectTheSameBySoftware(painter, which, *accepted);
        painter.use(**device);
    }
    EXPECT_GE(drawnCases, 3);
    for (const std::string& message : (*device)->validationMessages()) ADD_FAILURE() << message;
}
INSTANTIATE_TEST_SUITE_P(Samples, GoldenTest, testing::Values("long", "short", "shoulder"));

double flipBetween(const std::string& a, const std::string& b) {
    Case first, second;
    first.name = a;
    second.name = b;
    const auto left = acceptedPicture(first), right = acceptedPicture(second);
    EXPECT_TRUE(left && right);
    return left && right ? render::flipDifference(*left, *right)->mean : 0;
}

// The tolerance must see what it is there to see.
TEST(GoldenTolerance, SeesOtherShadowsModelsAndMaterials) {
    for (const char* const other : {"no-shadows", "opacity-maps", "single", "kajiya", "streaked"}) {
        EXPECT_GT(flipBetween("shoulder-marschner", std::string("shoulder-") + other), 1.5 * kTolerance)
            << other;
    }
}

}  // namespace
}  // namespace hairloom::golden
