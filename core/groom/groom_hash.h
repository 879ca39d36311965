// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether two grooms hold the same document, for undo, determinism and round-trip tests.

#include <cstdint>

#include "core/groom/groom.h"

namespace hairloom {

/// XXH3 of everything a project saves (strands, attributes with their names and types, layers, groups,
/// spheres, settings, scalp, selection, triangulation), bit by bit: 0 and −0 differ. Sharing and versions do
/// not count.
std::uint64_t contentHash(const Groom& groom);

/// Equal content hashes.
inline bool sameContent(const Groom& a, const Groom& b) {
    return contentHash(a) == contentHash(b);
}

}  // namespace hairloom
