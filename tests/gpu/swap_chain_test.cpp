// SPDX-License-Identifier: GPL-3.0-or-later
// What a window shows after present(), as the X server sees it.
#include <xcb/xcb.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "tests/gpu/gpu_fixture.h"

namespace hairloom::gpu {
namespace {

using Colour = std::array<float, 4>;
constexpr Colour kRed{1, 0, 0, 1};
constexpr Colour kTeal{0, 0.4f, 0.8f, 1};

struct Free {
    void operator()(void* memory) const { std::free(memory); }  // NOLINT: xcb hands out malloc'ed memory
};

class SwapChainTest : public GpuTest {
  protected:
    void SetUp() override {
        connection = xcb_connect(nullptr, nullptr);
        if (xcb_connection_has_error(connection) != 0) GTEST_SKIP() << "no X server";
        GpuTest::SetUp();
        if (device == nullptr || !device->info().presents) GTEST_SKIP() << "no device that presents";
        screen = xcb_setup_roots_iterator(xcb_get_setup(connection)).data;
        window = xcb_generate_id(connection);
        xcb_create_window(connection, XCB_COPY_FROM_PARENT, window, screen->root, 0, 0, 200, 100, 0,
                          XCB_WINDOW_CLASS_INPUT_OUTPUT, screen->root_visual, 0, nullptr);
        xcb_map_window(connection, window);
        sync();
    }
    void TearDown() override {
        chain.reset();
        GpuTest::TearDown();
        xcb_disconnect(connection);
    }
    void sync() {
        std::unique_ptr<xcb_get_input_focus_reply_t, Free> reply(
            xcb_get_input_focus_reply(connection, xcb_get_input_focus(connection), nullptr));
    }
    void open(std::uint32_t width, std::uint32_t height, bool waitForDisplay = true) {
        auto result = device->createSwapChain({{connection, window}, width, height, waitForDisplay});
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
    /// 0xRRGGBB that the X server holds.
    std::uint32_t pixel(std::int16_t x, std::int16_t y) {
        const auto cookie =
            xcb_get_image(connection, XCB_IMAGE_FORMAT_Z_PIXMAP, window, x, y, 1, 1, ~std::uint32_t{0});
        std::unique_ptr<xcb_get_image_reply_t, Free> reply(xcb_get_image_reply(connection, cookie, nullptr));
        if (reply == nullptr) return ~std::uint32_t{0};
        const std::uint8_t* bgr = xcb_get_image_data(reply.get());
        return (std::uint32_t{bgr[2]} << 16u) | (std::uint32_t{bgr[1]} << 8u) | bgr[0];
    }
    /// Presenting is not done when present() returns: looks again for up to two seconds.
    std::uint32_t pixelOnceShown(std::int16_t x, std::int16_t y, std::uint32_t expected) {
        for (int i = 0; i < 200 && pixel(x, y) != expected; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        return pixel(x, y);
    }
    void resizeWindow(std::uint32_t width, std::uint32_t height) {
        const std::array<std::uint32_t, 2> size{width, height};
        xcb_configure_window(connection, window, XCB_CONFIG_WINDOW_WIDTH | XCB_CONFIG_WINDOW_HEIGHT,
                             size.data());
        sync();
    }

    xcb_connection_t* connection = nullptr;
    xcb_screen_t* screen = nullptr;
    xcb_window_t window = 0;
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
        resizeWindow(width, height);
        // One picture of the old size comes while the owner of the window has not heard of the new one.
        show(kTeal);
        ASSERT_TRUE(chain->resize(width, height));
        show(kRed);
        const auto x = static_cast<std::int16_t>(width - 1);
        EXPECT_EQ(pixelOnceShown(x, static_cast<std::int16_t>(height - 1), 0xff0000u), 0xff0000u);
    }
}

TEST_F(SwapChainTest, OutsideTheBackBufferIsBlack) {
    open(50, 50);
    show(kTeal);
    EXPECT_EQ(pixelOnceShown(49, 49, 0x0066ccu), 0x0066ccu);
    EXPECT_EQ(pixel(50, 49), 0u);
    EXPECT_EQ(pixel(199, 99), 0u);
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

TEST_F(SwapChainTest, WhatCannotBeIsAnError) {
    EXPECT_FALSE(device->createSwapChain({{nullptr, window}, 10, 10}));
    EXPECT_FALSE(device->createSwapChain({{connection, window}, 0, 10}));
    open(10, 10);
    EXPECT_FALSE(chain->resize(1u << 20u, 10));
    EXPECT_EQ(chain->backBuffer()->desc().width, 10u);
}

}  // namespace
}  // namespace hairloom::gpu
