// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Cards as binary glTF, which carries all that they have.

#include "core/base/output_file.h"
#include "core/cards/glb.h"
#include "exporters/card_character.h"
#include "exporters/card_files.h"

namespace hairloom {

inline constexpr const char* kGlbCarries =
    "textures, a skin, levels (MSFT_lod) and springs (VRMC_springBone)";

inline Result<WrittenCards> writeGlb(const CardsToWrite& cards, const std::filesystem::path& path,
                                     cards::GlbNumbers numbers, const cards::Character& character,
                                     std::vector<Finding> findings) {
    const auto bytes = cards::glbOf(cards.chain, cards.colliders, numbers, character, cards.cancelled);
    if (!bytes) return tl::unexpected(bytes.error());
    if (auto status = writeFileAtomically(path, *bytes); !status) return tl::unexpected(status.error());
    return WrittenCards{.holdsSprings = true, .findings = std::move(findings)};
}

/// With the character's bones.
inline Result<WrittenCards> writeGlb(const CardsToWrite& cards, const std::filesystem::path& path,
                                     cards::GlbNumbers numbers) {
    std::vector<Finding> findings;
    const cards::Character character = cardCharacter({cards.groom, cards.chain.roots_ws}, findings);
    return writeGlb(cards, path, numbers, character, std::move(findings));
}

}  // namespace hairloom
