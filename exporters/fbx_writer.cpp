// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/card_meshes.h"

namespace hairloom {
namespace {

Result<WrittenCards> writeFbx(const CardsToWrite& cards, const std::filesystem::path& path) {
    auto companions = writeCardMeshes(cards.chain, CardMeshFormat::fbx, path);
    if (!companions) return tl::unexpected(companions.error());
    return WrittenCards{std::move(*companions), {springsLeftBehind()}};
}

}  // namespace

HairWriter fbxWriter() {
    return cardWriter("fbx", "Cards as FBX", "a skin, with textures next to the file",
                      {"cards-fbx", "Engines without strands: cards (FBX)", "", {}}, "fbx", writeFbx);
}

}  // namespace hairloom
