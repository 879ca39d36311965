// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/file_hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <fstream>
#include <memory>
#include <vector>

namespace hairloom {

std::optional<std::uint64_t> hashFile(const std::filesystem::path& path) {
    constexpr std::size_t kPiece = std::size_t{1} << 20u;
    std::ifstream file(path, std::ios::binary);
    if (!file) return std::nullopt;
    const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), XXH3_freeState);
    if (!state || XXH3_64bits_reset(state.get()) != XXH_OK) return std::nullopt;
    std::vector<char> piece(kPiece);
    while (file) {
        file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
        XXH3_64bits_update(state.get(), piece.data(), static_cast<std::size_t>(file.gcount()));
    }
    if (!file.eof()) return std::nullopt;
    return XXH3_64bits_digest(state.get());
}

}  // namespace hairloom
