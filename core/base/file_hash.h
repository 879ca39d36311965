// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace hairloom {

/// XXH3 of a file's bytes, as hashBytes() of them, which need not fit into memory; nothing where it cannot be
/// read.
std::optional<std::uint64_t> hashFile(const std::filesystem::path& path);

}  // namespace hairloom
