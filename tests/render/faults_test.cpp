// SPDX-License-Identifier: GPL-3.0-or-later
// A device that fails at any point gives an error, and a picture afterwards.
#include "core/gpu/validation.h"
#include "tests/render/render_fixture.h"

namespace hairloom::render {
namespace {

class FaultTest : public RenderTest {
  protected:
    Result<Picture> render() {
        RenderScene scene = head.scene();
        RenderOptions options;
        options.width = options.height = 32;
        options.frames = 1;
        options.shadowResolution = 64;
        return renderPicture(*device, scene, options);
    }
    TestHead head{8};
};

TEST_F(FaultTest, EveryCreationMayFail) {
    gpu::ValidationDevice* watch = gpu::validationOf(*device);
    ASSERT_NE(watch, nullptr);
    std::uint64_t failed = 0;
    for (;; ++failed) {
        ASSERT_LT(failed, 500u) << "more creations than a small picture can need";
        watch->failCreation(failed);
        const auto picture = render();
        if (picture) break;
        EXPECT_NE(picture.error().message().find("out of device memory"), std::string::npos)
            << picture.error().message();
    }
    EXPECT_GT(failed, 10u);
}

TEST_F(FaultTest, LosingTheDeviceIsAnError) {
    gpu::ValidationDevice* watch = gpu::validationOf(*device);
    ASSERT_NE(watch, nullptr);
    watch->loseDevice(0);
    const auto picture = render();
    ASSERT_FALSE(picture);
    EXPECT_NE(picture.error().message().find("lost"), std::string::npos);
}

}  // namespace
}  // namespace hairloom::render
