// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/card_meshes.h"

namespace hairloom {
namespace {

Result<WrittenCards> writeObjCards(const CardsToWrite& cards, const std::filesystem::path& path) {
    auto companions = writeCardMeshes(cards.chain, CardMeshFormat::obj, path, {}, cards.cancelled);
    if (!companions) return tl::unexpected(companions.error());
    return WrittenCards{std::move(*companions), {springsLeftBehind(), jointsLeftBehind()}};
}

}  // namespace

HairWriter objCardsWriter() {
    return cardWriter("obj-cards", "Cards as OBJ", "textures and materials next to the file",
                      {"cards-obj", "Engines without strands: cards (OBJ)", "", {}}, "obj", writeObjCards);
}

}  // namespace hairloom
