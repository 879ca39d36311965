// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/render/image.h"

namespace hairloom::render {

/// 0…1 (clamped) as 0…255, rounded.
std::uint8_t toByte(float value);

/// Encodes one linear value 0…1 (clamped) as sRGB 0…1 (IEC 61966-2-1).
float encodeSrgb(float linear);
/// And back.
float decodeSrgb(float encoded);

/// The filmic curve of Hable 2010 scaled so that `kFilmicWhite` becomes 1; 0 stays 0, increasing.
float filmic(float linear);
inline constexpr float kFilmicWhite = 6.0f;

/// Exposure (a factor), filmic curve (half on the channels, half on luminance, to keep some saturation),
/// sRGB.
Image toneMap(const LinearImage& linear, float exposure);

}  // namespace hairloom::render
