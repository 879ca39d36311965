// SPDX-License-Identifier: GPL-3.0-or-later
#include <qguiapplication_platform.h>
#include <QGuiApplication>

#include "editor/viewport/native_window.h"

namespace hairloom::editor {
namespace {

const QNativeInterface::QX11Application* x11() {
    return qApp->nativeInterface<QNativeInterface::QX11Application>();
}

}  // namespace

bool hasNativeWindows() {
    return x11() != nullptr;
}

void prepareNativeWindow(QWindow& window) {
    window.setSurfaceType(QSurface::VulkanSurface);
}

gpu::NativeWindow nativeWindow(const QWindow& window) {
    return {x11()->connection(), static_cast<std::uint32_t>(window.winId())};
}

void answerWindowSystem() {}

}  // namespace hairloom::editor
