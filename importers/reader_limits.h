// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the process that reads foreign files may take, by what it reads. Pixels are limited by
// core/render/picture_limits.h. docs/security.md says it for administrators.

#include <chrono>
#include <cstdint>

#include "core/render/picture_limits.h"
#include "importers/child_process.h"

namespace hairloom {

/// Of a mesh that assimp or tinygltf reads: a file of a kilobyte makes them want any memory.
inline constexpr std::uint64_t kMeshMemory = std::uint64_t{3} << 29u;  // 1.5 GiB
inline ChildLimits meshLimits() {
    ChildLimits limits;
    limits.residentBytes = kMeshMemory;
    limits.startsWithLength = true;
    return limits;
}

/// Of what readers of our own make of a file of so many bytes, text or packed: 2 GiB and eight times the
/// file, a minute and a second for each 4 MiB.
inline ChildLimits limitsOfFile(std::uint64_t fileBytes) {
    constexpr std::uint64_t kMemory = std::uint64_t{2} << 30u, kBytesEachSecond = std::uint64_t{4} << 20u;
    ChildLimits limits;
    limits.residentBytes = limits.outputBytes = kMemory + 8 * fileBytes;
    limits.time = std::chrono::seconds(60 + fileBytes / kBytesEachSecond);
    limits.startsWithLength = true;
    return limits;
}

/// The largest files of pictures.
inline constexpr std::uint64_t kMaxPictureFile = std::uint64_t{1} << 30u;

/// Of a picture: what decoding may hold, its file, and what the program itself takes.
inline ChildLimits pictureLimits() {
    constexpr std::uint64_t kProgram = std::uint64_t{256} << 20u;
    ChildLimits limits;
    limits.residentBytes = render::kMaxPictureBytes + kMaxPictureFile + kProgram;
    limits.outputBytes = render::kMaxPicturePixels * 4 * sizeof(float) + kProgram;
    limits.time = std::chrono::seconds(60);
    limits.startsWithLength = true;
    return limits;
}

}  // namespace hairloom
