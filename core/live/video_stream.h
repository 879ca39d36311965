// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What hairloom-video-writer is given and gives back. In: a VideoHead, then frames of width · height · 4
// bytes (sRGB as render::Image has it), up to the end of the stream. Back: a VideoAnswer and as many bytes as
// it says, of the file or of words about what went wrong. Both ends run on the same machine.

#include <cstdint>

namespace hairloom {

/// Changes with the structs: programs of two builds do not understand each other.
inline constexpr std::uint32_t kVideoStream = 0x6876'0001;

struct VideoHead {
    std::uint32_t stream = kVideoStream;
    std::uint32_t width = 0, height = 0;  ///< pixels, 1 … kMostVideoSide
    double framesPerSecond = 0;           ///< kLeastVideoRate … kMostVideoRate
};

struct VideoAnswer {
    std::uint32_t stream = kVideoStream;
    std::uint32_t isFile = 0;  ///< 0: words about what went wrong
    std::uint64_t bytes = 0;
};

inline constexpr std::uint32_t kMostVideoSide = 8192;
/// Blocks of 16 × 16 pixels of a frame: MaxFS of level 6.2, the highest of H.264 (ITU-T H.264, table A-1).
inline constexpr std::uint32_t kMostVideoBlocks = 139'264;

constexpr bool isVideoSize(std::uint32_t width, std::uint32_t height) {
    return width >= 1 && height >= 1 && width <= kMostVideoSide && height <= kMostVideoSide &&
           (width + 15) / 16 * ((height + 15) / 16) <= kMostVideoBlocks;
}

/// An image of 65,535 ms, and more than a player shows.
inline constexpr double kLeastVideoRate = 1.0 / 66, kMostVideoRate = 1000;

}  // namespace hairloom
