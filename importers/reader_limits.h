// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the process that reads foreign files may take, by what it reads. Pixels are limited by
// core/render/picture_limits.h. docs/security.md says it for administrators.

#include <chrono>
#include <cstdint>

#include "core/render/picture_limits.h"
#include "importers/child_process.h"
#include "importers/sanitized.h"

namespace hairloom {

/// `least` seconds and one for each 4 MiB.
inline std::chrono::seconds timeOfFile(std::uint64_t fileBytes, std::uint64_t least) {
    constexpr std::uint64_t kBytesEachSecond = std::uint64_t{4} << 20u;
    constexpr int kTimesSlower = kSanitized ? 10 : 1;
    return kTimesSlower * std::chrono::seconds(least + fileBytes / kBytesEachSecond);
}

/// Of a mesh that assimp or tinygltf reads: 8 seconds and one for each 4 MiB, and bounded memory, for a file
/// of a kilobyte makes them want any.
inline constexpr std::uint64_t kMeshMemory = std::uint64_t{3} << 29u;  // 1.5 GiB
inline ChildLimits meshLimits(std::uint64_t fileBytes) {
    ChildLimits limits;
    limits.residentBytes = kMeshMemory;
    limits.time = timeOfFile(fileBytes, 8);
    limits.startsWithLength = true;
    return limits;
}

/// Of what readers of our own make of a file of so many bytes, text or packed: 2 GiB and eight times the
/// file, a minute and a second for each 4 MiB.
inline ChildLimits limitsOfFile(std::uint64_t fileBytes) {
    constexpr std::uint64_t kMemory = std::uint64_t{2} << 30u;
    ChildLimits limits;
    limits.residentBytes = limits.outputBytes = kMemory + 8 * fileBytes;
    limits.time = timeOfFile(fileBytes, 60);
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
    limits.time = timeOfFile(0, 60);
    limits.startsWithLength = true;
    return limits;
}

}  // namespace hairloom
