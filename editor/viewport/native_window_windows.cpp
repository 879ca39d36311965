// SPDX-License-Identifier: GPL-3.0-or-later
#include <windows.h>

#include <QGuiApplication>

#include "editor/viewport/native_window.h"

namespace hairloom::editor {

bool hasNativeWindows() {
    return QGuiApplication::platformName() == "windows";
}

void prepareNativeWindow(QWindow& window) {
    window.setSurfaceType(QSurface::Direct3DSurface);
}

gpu::NativeWindow nativeWindow(const QWindow& window) {
    return {nullptr, static_cast<std::uintptr_t>(window.winId())};
}

// DXGI sends messages to the window from the thread that makes or resizes its swap chain, and waits for them.
void answerWindowSystem() {
    MSG message;
    PeekMessageW(&message, nullptr, 0, 0, PM_NOREMOVE | PM_QS_SENDMESSAGE);
}

}  // namespace hairloom::editor
