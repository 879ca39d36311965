// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A bare window of the system, for a swap chain; one source file per window system.

#include <cstdint>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/gpu/types.h"

namespace hairloom::window {

/// Of the area that is drawn to, pixels.
struct Size {
    std::uint32_t width = 0;
    std::uint32_t height = 0;

    bool operator==(const Size&) const = default;
};

class Window {
  public:
    /// Shown when it comes back. Errors: no display.
    static Result<std::unique_ptr<Window>> open(const std::string& title, const Size& size);
    virtual ~Window() = default;

    virtual gpu::NativeWindow native() const = 0;
    /// Zero while it is minimised.
    virtual Size size() const = 0;
    /// Takes what has happened since the last call; false once the window is closed.
    virtual bool handleEvents() = 0;
};

}  // namespace hairloom::window
