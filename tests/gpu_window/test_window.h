// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A window of the system that the tests run on, and what its screen shows there.

#include <cstdint>
#include <memory>

#include "core/gpu/types.h"

namespace hairloom::gpu {

class TestWindow {
  public:
    /// Nothing where there is no display.
    static std::unique_ptr<TestWindow> open(std::uint32_t width, std::uint32_t height);
    virtual ~TestWindow() = default;

    virtual NativeWindow native() const = 0;
    /// What createSwapChain() must refuse.
    virtual NativeWindow broken() const = 0;
    /// Of the area that is drawn to.
    virtual void resize(std::uint32_t width, std::uint32_t height) = 0;
    /// 0xRRGGBB of a pixel from the upper left corner; all bits set where it cannot be read.
    virtual std::uint32_t pixel(int x, int y) = 0;
    /// Whether a picture is lost for good that is presented before the screen has the window, or its new
    /// size.
    virtual bool losesEarlyPictures() const { return false; }
};

}  // namespace hairloom::gpu
