// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/card_character.h"
#include "exporters/card_meshes.h"

namespace hairloom {
namespace {

Result<WrittenCards> writeFbx(const CardsToWrite& cards, const std::filesystem::path& path) {
    WrittenCards written{.leftBehind = {springsLeftBehind()}};
    const cards::Character character = cardCharacter({cards.groom, cards.chain.roots_ws}, written.findings);
    auto companions = writeCardMeshes(cards.chain, CardMeshFormat::fbx, path, character, cards.cancelled);
    if (!companions) return tl::unexpected(companions.error());
    written.companions = std::move(*companions);
    return written;
}

}  // namespace

HairWriter fbxWriter() {
    return cardWriter("fbx", "Cards as FBX",
                      "a skin on the character's bones, with textures next to the file",
                      {"cards-fbx", "Engines without strands: cards (FBX)", "", {}}, "fbx", writeFbx);
}

}  // namespace hairloom
