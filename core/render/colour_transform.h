// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What stands in place of our own tone curve and sRGB where a studio brings its own colours.

#include <memory>
#include <mutex>
#include <span>

#include "core/render/image.h"

namespace hairloom::render {

struct DisplayTable;

/// Colours of one space as those of another. Constant: any number of threads may use one.
class ColourTransform {
  public:
    ColourTransform() = default;
    ColourTransform(const ColourTransform&) = delete;
    ColourTransform& operator=(const ColourTransform&) = delete;
    virtual ~ColourTransform() = default;

    /// `rgba`: four numbers a pixel, alpha stays. Each pixel gives the same bits whatever its neighbours.
    virtual void apply(std::span<float> rgba) const = 0;

    /// bakeDisplayTable() of it, made once: all pictures of a view share it.
    const DisplayTable& displayTable() const;

  private:
    mutable std::once_flag baked_;
    mutable std::shared_ptr<const DisplayTable> table_;
};

/// The whole picture, on all cores.
void convert(std::span<float> rgba, const ColourTransform& transform);

/// As toneMap(): `exposure` is a factor on the light, `toDisplay` takes linear light in the primaries of Rec.
/// 709 to code values 0…1, which are clamped and rounded to 8 bits. Not a number becomes 0.
Image showBy(const ColourTransform& toDisplay, const LinearImage& linear, float exposure);

}  // namespace hairloom::render
