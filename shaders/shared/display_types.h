// SPDX-License-Identifier: GPL-3.0-or-later
// The table that stands for a view of a colour config on a device (core/render/display_table.h).
#ifndef HAIRLOOM_SHARED_DISPLAY_TYPES_H
#define HAIRLOOM_SHARED_DISPLAY_TYPES_H
#include "runtime/shaders/types.h"
#ifdef __cplusplus
namespace hairloom::shaders {
#endif

struct DisplayConstants {
    float scale;        // factor on the sum of frames: exposure over their number
    float alphaScale;   // the same without exposure
    float decodesSrgb;  // 1 when the device encodes what the shader returns
    float width;        // pixels in a row
    float toe;          // a channel x of light is at log2(1 + toe x) * stretch, 0…side - 1
    float stretch;
    float top;  // the most light that the table knows
    uint side;  // nodes, at least 2; red changes fastest
};

#ifdef __cplusplus
static_assert(sizeof(DisplayConstants) == 32);
}  // namespace hairloom::shaders
#endif
#endif
