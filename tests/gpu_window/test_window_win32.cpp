// SPDX-License-Identifier: GPL-3.0-or-later
#include <windows.h>

#include "tests/gpu_window/test_window.h"

namespace hairloom::gpu {
namespace {

class Win32Window final : public TestWindow {
  public:
    explicit Win32Window(HWND window) : window_(window) { handleMessages(); }
    Win32Window(const Win32Window&) = delete;
    Win32Window& operator=(const Win32Window&) = delete;
    ~Win32Window() override { DestroyWindow(window_); }

    NativeWindow native() const override { return {nullptr, reinterpret_cast<std::uintptr_t>(window_)}; }
    NativeWindow broken() const override { return {nullptr, 0}; }
    void resize(std::uint32_t width, std::uint32_t height) override {
        SetWindowPos(window_, nullptr, 0, 0, static_cast<int>(width), static_cast<int>(height),
                     SWP_NOZORDER | SWP_NOMOVE | SWP_NOACTIVATE);
        handleMessages();
    }
    std::uint32_t pixel(int x, int y) override {
        handleMessages();
        POINT point{x, y};
        ClientToScreen(window_, &point);
        // The screen, not the window: what Direct3D shows is not in the window's own GDI surface.
        const HDC screen = GetDC(nullptr);
        const COLORREF colour = GetPixel(screen, point.x, point.y);
        ReleaseDC(nullptr, screen);
        if (colour == CLR_INVALID) return ~std::uint32_t{0};
        return (std::uint32_t{GetRValue(colour)} << 16u) | (std::uint32_t{GetGValue(colour)} << 8u) |
               GetBValue(colour);
    }

    /// Under Wine, whose X server keeps nothing of a window that it does not show yet.
    bool losesEarlyPictures() const override {
        const HMODULE system = GetModuleHandleW(L"ntdll.dll");
        return system != nullptr && GetProcAddress(system, "wine_get_version") != nullptr;
    }

  private:
    static void handleMessages() {
        MSG message;
        while (PeekMessageW(&message, nullptr, 0, 0, PM_REMOVE) != 0) DispatchMessageW(&message);
    }
    HWND window_;
};

}  // namespace

std::unique_ptr<TestWindow> TestWindow::open(std::uint32_t width, std::uint32_t height) {
    WNDCLASSW description{};
    description.lpfnWndProc = DefWindowProcW;
    description.hInstance = GetModuleHandleW(nullptr);
    description.lpszClassName = L"hairloom test";
    RegisterClassW(&description);
    // Without a frame, so that its size is that of the area drawn to.
    HWND window = CreateWindowExW(WS_EX_TOPMOST, description.lpszClassName, L"", WS_POPUP | WS_VISIBLE, 20,
                                  20, static_cast<int>(width), static_cast<int>(height), nullptr, nullptr,
                                  description.hInstance, nullptr);
    if (window == nullptr) return nullptr;
    return std::make_unique<Win32Window>(window);
}

}  // namespace hairloom::gpu
