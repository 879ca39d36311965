// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The native project, `.hairloom`: one JSON head for people and programs, then aligned binary arrays, each
// with its checksum. Byte by byte in docs/formats/hairloom.md.

#include <filesystem>

#include "core/groom/groom.h"

namespace hairloom {

inline constexpr std::uint32_t kProjectVersion = 12;

/// Whether the file starts as a project does; false for one that cannot be read.
bool looksLikeProject(const std::filesystem::path& path);

/// Replaces `path` atomically; on error the old file stands.
Status saveProject(const Groom& groom, const std::filesystem::path& path);

/// The file as it is: settings of its operators are still JSON, since core/groom does not know operations. To
/// open a project use openProject() (core/operations/stack.h), and for a hair file of any format openGroom()
/// (core/documents/open.h).
/// Errors: not a project, a newer version (named, with the version this program reads), and any damage with
/// its place: a short file, a checksum that does not match, offsets or counts that contradict each other.
Result<Groom> readProjectFile(const std::filesystem::path& path);

}  // namespace hairloom
