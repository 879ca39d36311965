// SPDX-License-Identifier: GPL-3.0-or-later
#include <xcb/xcb.h>

#include <array>
#include <cstdlib>

#include "tests/gpu_window/test_window.h"

namespace hairloom::gpu {
namespace {

struct Free {
    void operator()(void* memory) const { std::free(memory); }  // NOLINT: xcb hands out malloc'ed memory
};

class XcbWindow final : public TestWindow {
  public:
    XcbWindow(xcb_connection_t* connection, std::uint32_t width, std::uint32_t height)
        : connection_(connection), window_(xcb_generate_id(connection)) {
        const xcb_screen_t* screen = xcb_setup_roots_iterator(xcb_get_setup(connection)).data;
        xcb_create_window(connection, XCB_COPY_FROM_PARENT, window_, screen->root, 0, 0,
                          static_cast<std::uint16_t>(width), static_cast<std::uint16_t>(height), 0,
                          XCB_WINDOW_CLASS_INPUT_OUTPUT, screen->root_visual, 0, nullptr);
        xcb_map_window(connection, window_);
        sync();
    }
    XcbWindow(const XcbWindow&) = delete;
    XcbWindow& operator=(const XcbWindow&) = delete;
    ~XcbWindow() override { xcb_disconnect(connection_); }

    NativeWindow native() const override { return {connection_, window_}; }
    NativeWindow broken() const override { return {nullptr, window_}; }
    void resize(std::uint32_t width, std::uint32_t height) override {
        const std::array<std::uint32_t, 2> size{width, height};
        xcb_configure_window(connection_, window_, XCB_CONFIG_WINDOW_WIDTH | XCB_CONFIG_WINDOW_HEIGHT,
                             size.data());
        sync();
    }
    std::uint32_t pixel(int x, int y) override {
        const auto cookie =
            xcb_get_image(connection_, XCB_IMAGE_FORMAT_Z_PIXMAP, window_, static_cast<std::int16_t>(x),
                          static_cast<std::int16_t>(y), 1, 1, ~std::uint32_t{0});
        const std::unique_ptr<xcb_get_image_reply_t, Free> reply(
            xcb_get_image_reply(connection_, cookie, nullptr));
        if (reply == nullptr) return ~std::uint32_t{0};
        const std::uint8_t* bgr = xcb_get_image_data(reply.get());
        return (std::uint32_t{bgr[2]} << 16u) | (std::uint32_t{bgr[1]} << 8u) | bgr[0];
    }

  private:
    void sync() {
        const std::unique_ptr<xcb_get_input_focus_reply_t, Free> reply(
            xcb_get_input_focus_reply(connection_, xcb_get_input_focus(connection_), nullptr));
    }
    xcb_connection_t* connection_;
    xcb_window_t window_;
};

}  // namespace

std::unique_ptr<TestWindow> TestWindow::open(std::uint32_t width, std::uint32_t height) {
    xcb_connection_t* connection = xcb_connect(nullptr, nullptr);
    if (xcb_connection_has_error(connection) != 0) {
        xcb_disconnect(connection);
        return nullptr;
    }
    return std::make_unique<XcbWindow>(connection, width, height);
}

}  // namespace hairloom::gpu
