// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What hairloom-video-writer is given and gives back. In: a VideoHead, then frames of width · height · 4
// bytes (sRGB as render::Image has it), up to the end of the stream. Back: a VideoAnswer, then the file, or
// words about what went wrong. Both ends run on the same machine.

#include <cstdint>

namespace hairloom {

struct VideoHead {
    std::uint32_t width = 0, height = 0;  ///< pixels, 1 … kMostVideoSide
    double framesPerSecond = 0;           ///< kLeastVideoRate … kMostVideoRate
};

enum class VideoAnswer : std::uint32_t { Failed = 0, File = 1 };

/// Level 6.2 of H.264 allows little more.
inline constexpr std::uint32_t kMostVideoSide = 8192;
/// An image of 65,535 ms, and more than a player shows.
inline constexpr double kLeastVideoRate = 1.0 / 66, kMostVideoRate = 1000;

}  // namespace hairloom
