// SPDX-License-Identifier: GPL-3.0-or-later
// What a window shows after present(), as the screen has it.
#include <chrono>
#include <thread>

#include "tests/gpu/gpu_fixture.h"
#include "tests/gpu_window/test_window.h"

namespace hairloom::gpu {
namespace {

using Colour = std::array<float, 4>;
constexpr Colour kRed{1, 0, 0, 1};
constexpr Colour kTeal{0, 0.4f, 0.8f, 1};

class SwapChainTest : public GpuTest {
  protected:
    void SetUp() override {
        window = TestWindow::open(200, 100);
        if (window == nullptr) GTEST_SKIP() << "no display";
        ASSERT_NO_FATAL_FAILURE(GpuTest::SetUp());
        if (device == nullptr || !device->info().presents) GTEST_SKIP() << "no device that presents";
    }
    void TearDown() override {
        chain.reset();
        GpuTest::TearDown();
    }
    void open(std::uint32_t width, std::uint32_t height, bool waitForDisplay = true) {
        auto result = device->createSwapChain({window->native(), width, height, waitForDisplay});
        ASSERT_TRUE(result) << result.error().message();
        chain = std::move(*result);
    }
    void fill(const Colour& colour) {
        PassDesc pass;
        pass.name = "fill";
        pass.colour = {{chain->backBuffer(), LoadOp::Clear, colour, nullptr}};
        const std::string error = submitError([&](CommandList& list) {
            list.beginPass(pass);
            list.endPass();
        });
        ASSERT_EQ(error, "");
    }
    void show(const Colour& colour) {
        fill(colour);
        const auto status = chain->present();
        ASSERT_TRUE(status) << status.error().message();
    }
    /// Presenting is not done when present() returns: looks again for up to ten seconds.
    std::uint32_t pixelOnceShown(int x, int y, std::uint32_t expected) {
        std::uint32_t seen = window->pixel(x, y);
        for (int i = 0; i < 1000 && seen != expected; ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            if (window->losesEarlyPictures() && i % 100 == 99) {
                EXPECT_TRUE(chain->present());
            }
            seen = window->pixel(x, y);
        }
        return seen;
    }

    std::unique_ptr<TestWindow> window;
    std::unique_ptr<SwapChain> chain;
};

TEST_F(SwapChainTest, ShowsWhatWasDrawn) {
    for (const bool wait : {true, false}) {
        open(200, 100, wait);
        for (int frame = 0; frame < 5; ++frame) show(frame % 2 == 0 ? kRed : kTeal);
        EXPECT_EQ(pixelOnceShown(10, 10, 0xff0000u), 0xff0000u);
        show(kTeal);
        EXPECT_EQ(pixelOnceShown(199, 99, 0x0066ccu), 0x0066ccu);
        chain.reset();
    }
}

TEST_F(SwapChainTest, FollowsTheSizeOfTheWindow) {
    open(200, 100);
    show(kRed);
    const auto sizes = {std::pair{300u, 250u}, {60u, 40u}, {301u, 77u}};
    for (const auto& [width, height] : sizes) {
        window->resize(width, height);
        // One picture of the old size comes while the owner of the window has not heard of the new one.
        show(kTeal);
        ASSERT_TRUE(chain->resize(width, height));
        show(kRed);
        const int x = static_cast<int>(width) - 1, y = static_cast<int>(height) - 1;
        EXPECT_EQ(pixelOnceShown(x, y, 0xff0000u), 0xff0000u);
    }
}

TEST_F(SwapChainTest, OutsideTheBackBufferIsBlack) {
    open(50, 50);
    show(kTeal);
    EXPECT_EQ(pixelOnceShown(49, 49, 0x0066ccu), 0x0066ccu);
    EXPECT_EQ(window->pixel(50, 49), 0u);
    EXPECT_EQ(window->pixel(199, 99), 0u);
}

TEST_F(SwapChainTest, BackBufferKeepsItsContentAndCanBeRead) {
    open(8, 4);
    show(kRed);
    ASSERT_TRUE(chain->present());
    const auto bytes = read<std::uint8_t>(chain->backBuffer());
    ASSERT_EQ(bytes.size(), 8u * 4u * 4u);
    for (std::size_t i = 0; i < bytes.size(); i += 4) {
        EXPECT_EQ(bytes[i], 0);
        EXPECT_EQ(bytes[i + 2], 255);
    }
}

TEST_F(SwapChainTest, InvalidRequestsAreErrors) {
    EXPECT_FALSE(device->createSwapChain({window->broken(), 10, 10}));
    EXPECT_FALSE(device->createSwapChain({window->native(), 0, 10}));
    open(10, 10);
    EXPECT_FALSE(chain->resize(1u << 20u, 10));
    EXPECT_EQ(chain->backBuffer()->desc().width, 10u);
}

}  // namespace
}  // namespace hairloom::gpu
