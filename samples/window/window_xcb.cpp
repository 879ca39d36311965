// SPDX-License-Identifier: GPL-3.0-or-later
#include <xcb/xcb.h>

#include <cstdlib>

#include "samples/window/window.h"

namespace hairloom::window {
namespace {

struct Free {
    void operator()(void* memory) const { std::free(memory); }  // NOLINT: xcb hands out malloc'ed memory
};

class XcbWindow final : public Window {
  public:
    XcbWindow(xcb_connection_t* connection, const std::string& title, const Size& size)
        : connection_(connection), window_(xcb_generate_id(connection)), size_(size) {
        const xcb_screen_t* screen = xcb_setup_roots_iterator(xcb_get_setup(connection)).data;
        const std::uint32_t events = XCB_EVENT_MASK_STRUCTURE_NOTIFY;
        xcb_create_window(connection, XCB_COPY_FROM_PARENT, window_, screen->root, 0, 0,
                          static_cast<std::uint16_t>(size.width), static_cast<std::uint16_t>(size.height), 0,
                          XCB_WINDOW_CLASS_INPUT_OUTPUT, screen->root_visual, XCB_CW_EVENT_MASK, &events);
        xcb_change_property(connection, XCB_PROP_MODE_REPLACE, window_, XCB_ATOM_WM_NAME, XCB_ATOM_STRING, 8,
                            static_cast<std::uint32_t>(title.size()), title.data());
        askToBeTold();
        xcb_map_window(connection, window_);
        xcb_flush(connection);
    }
    XcbWindow(const XcbWindow&) = delete;
    XcbWindow& operator=(const XcbWindow&) = delete;
    ~XcbWindow() override { xcb_disconnect(connection_); }

    gpu::NativeWindow native() const override { return {connection_, window_}; }
    Size size() const override { return size_; }
    bool handleEvents() override {
        while (const auto event = std::unique_ptr<xcb_generic_event_t, Free>(xcb_poll_for_event(connection_)))
            handle(*event);
        return open_ && xcb_connection_has_error(connection_) == 0;
    }

  private:
    xcb_atom_t atom(const std::string& name) const {
        const auto cookie =
            xcb_intern_atom(connection_, 0, static_cast<std::uint16_t>(name.size()), name.data());
        const std::unique_ptr<xcb_intern_atom_reply_t, Free> reply(
            xcb_intern_atom_reply(connection_, cookie, nullptr));
        return reply == nullptr ? xcb_atom_t{XCB_ATOM_NONE} : reply->atom;
    }
    /// The window manager sends a message instead of taking the window away.
    void askToBeTold() {
        closing_ = atom("WM_DELETE_WINDOW");
        xcb_change_property(connection_, XCB_PROP_MODE_REPLACE, window_, atom("WM_PROTOCOLS"), XCB_ATOM_ATOM,
                            32, 1, &closing_);
    }
    void handle(const xcb_generic_event_t& event) {
        constexpr unsigned kSentByOthers = 0x80;
        switch (event.response_type & ~kSentByOthers) {
            case XCB_CONFIGURE_NOTIFY: {
                const auto& now = reinterpret_cast<const xcb_configure_notify_event_t&>(event);
                size_ = {now.width, now.height};
                break;
            }
            case XCB_CLIENT_MESSAGE: {
                const auto& message = reinterpret_cast<const xcb_client_message_event_t&>(event);
                open_ = open_ && message.data.data32[0] != closing_;
                break;
            }
            case XCB_DESTROY_NOTIFY:
                open_ = false;
                break;
            default:
                break;
        }
    }

    xcb_connection_t* connection_;
    xcb_window_t window_;
    xcb_atom_t closing_ = XCB_ATOM_NONE;
    Size size_;
    bool open_ = true;
};

}  // namespace

Result<std::unique_ptr<Window>> Window::open(const std::string& title, const Size& size) {
    xcb_connection_t* connection = xcb_connect(nullptr, nullptr);
    if (xcb_connection_has_error(connection) != 0) {
        xcb_disconnect(connection);
        return fail("no X11 display to open a window on", "the environment variable DISPLAY");
    }
    return std::make_unique<XcbWindow>(connection, title, size);
}

}  // namespace hairloom::window
