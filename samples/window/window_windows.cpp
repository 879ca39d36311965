// SPDX-License-Identifier: GPL-3.0-or-later
#include <windows.h>

#include "samples/window/window.h"

namespace hairloom::window {
namespace {

/// What has happened to the window; it finds this through its user data.
struct State {
    bool open = true;
};

LRESULT CALLBACK handle(HWND window, UINT message, WPARAM w, LPARAM l) {
    auto* state = reinterpret_cast<State*>(GetWindowLongPtrW(window, GWLP_USERDATA));
    if (message == WM_CLOSE && state != nullptr) {
        // It is destroyed after the swap chain that draws to it.
        state->open = false;
        return 0;
    }
    return DefWindowProcW(window, message, w, l);
}

class Win32Window final : public Window {
  public:
    explicit Win32Window(HWND window) : window_(window) {
        SetWindowLongPtrW(window, GWLP_USERDATA, reinterpret_cast<LONG_PTR>(&state_));
        ShowWindow(window, SW_SHOW);
        handleEvents();
    }
    Win32Window(const Win32Window&) = delete;
    Win32Window& operator=(const Win32Window&) = delete;
    ~Win32Window() override { DestroyWindow(window_); }

    gpu::NativeWindow native() const override { return {nullptr, reinterpret_cast<std::uintptr_t>(window_)}; }
    Size size() const override {
        RECT area{};
        if (GetClientRect(window_, &area) == 0) return {};
        return {static_cast<std::uint32_t>(area.right), static_cast<std::uint32_t>(area.bottom)};
    }
    bool handleEvents() override {
        MSG message;
        while (PeekMessageW(&message, nullptr, 0, 0, PM_REMOVE) != 0) {
            TranslateMessage(&message);
            DispatchMessageW(&message);
        }
        return state_.open;
    }

  private:
    HWND window_;
    State state_;
};

std::wstring wide(const std::string& utf8) {
    const int bytes = static_cast<int>(utf8.size());
    std::wstring text(
        static_cast<std::size_t>(MultiByteToWideChar(CP_UTF8, 0, utf8.data(), bytes, nullptr, 0)), L' ');
    MultiByteToWideChar(CP_UTF8, 0, utf8.data(), bytes, text.data(), static_cast<int>(text.size()));
    return text;
}

}  // namespace

Result<std::unique_ptr<Window>> Window::open(const std::string& title, const Size& size) {
    WNDCLASSW description{};
    description.lpfnWndProc = handle;
    description.hInstance = GetModuleHandleW(nullptr);
    description.hCursor = LoadCursorW(nullptr, MAKEINTRESOURCEW(32512));  // the arrow
    description.lpszClassName = L"hairloom window";
    RegisterClassW(&description);
    RECT area{0, 0, static_cast<LONG>(size.width), static_cast<LONG>(size.height)};
    AdjustWindowRect(&area, WS_OVERLAPPEDWINDOW, FALSE);
    HWND window = CreateWindowExW(0, description.lpszClassName, wide(title).c_str(), WS_OVERLAPPEDWINDOW,
                                  CW_USEDEFAULT, CW_USEDEFAULT, area.right - area.left,
                                  area.bottom - area.top, nullptr, nullptr, description.hInstance, nullptr);
    if (window == nullptr) return fail("no display to open a window on");
    return std::make_unique<Win32Window>(window);
}

}  // namespace hairloom::window
