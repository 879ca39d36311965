// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A QWindow as the window system and a swap chain know it; one source file per window system.

#include <QWindow>

#include "core/gpu/types.h"

namespace hairloom::editor {

/// The window system lets a device draw to windows.
bool hasNativeWindows();
/// Before the window is created: what it will be drawn to with.
void prepareNativeWindow(QWindow& window);
/// Of a window that has been created.
gpu::NativeWindow nativeWindow(const QWindow& window);
/// Called on the thread of the windows while it waits for another thread that works on one of them: answers
/// what the window system asks of that window meanwhile.
void answerWindowSystem();

}  // namespace hairloom::editor
