// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a file holds, told from how it begins: a writer replaces only what is of the kind that it writes.

#include <cstddef>
#include <span>
#include <string_view>

namespace hairloom {

namespace content {
inline constexpr std::string_view kEmpty = "empty";
inline constexpr std::string_view kProject = "a Hairloom project";
inline constexpr std::string_view kJson = "JSON";
inline constexpr std::string_view kPng = "a PNG image";
inline constexpr std::string_view kMp4 = "an MP4 video";
inline constexpr std::string_view kFrames = "a record of frames";
inline constexpr std::string_view kTake = "a take";
}  // namespace content

/// Bytes from the start of a file that tell its kind.
inline constexpr std::size_t kContentKindBytes = 4096;

/// The kind in words that fit behind "is": one of content's, "an OBJ file", "text", "of no known kind" …
std::string_view contentKind(std::span<const std::byte> beginning);

/// That of files which writers give the suffix ("hair", "glb"), for what must be known before one is made;
/// empty where contentKind() does not tell.
std::string_view contentKindOfSuffix(std::string_view suffix);

}  // namespace hairloom
