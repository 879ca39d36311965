// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Names of outputs with a version: `v###` in them becomes the next one that is free.

#include <filesystem>

namespace hairloom {

/// "v" and one to nine "#" at the beginning of a name in `path` or behind a character that is no letter or
/// digit.
bool hasVersionToken(const std::filesystem::path& path);
/// One more than the highest version of names in the folder that begin as this one does, whatever is behind;
/// 1 where there are none. `path` has a token.
unsigned nextVersion(const std::filesystem::path& path);
/// With the version in place of all tokens, in as many digits as they have "#", or more.
std::filesystem::path withVersion(const std::filesystem::path& path, unsigned version);
/// Up to and with the version, without what is behind: names that begin so are of this version.
std::filesystem::path versionBeginning(const std::filesystem::path& path, unsigned version);
/// The name with a token in place of its last version ("bob_v###.hairloom" for "bob_v007.hairloom"), or
/// behind it where it has none ("bob_v###.hairloom" for "bob.hairloom"). Folders stay as they are.
std::filesystem::path withVersionToken(const std::filesystem::path& path);

}  // namespace hairloom
