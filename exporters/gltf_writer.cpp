// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/glb_cards.h"

namespace hairloom {
namespace {

Result<WrittenCards> writeGltf(const CardsToWrite& cards, const std::filesystem::path& path) {
    return writeGlb(cards, path, cards::GlbNumbers::floats);
}

}  // namespace

HairWriter gltfWriter() {
    return cardWriter("gltf", "Cards as binary glTF 2.0", kGlbCarries,
                      {"cards", "Engines without strands: cards (glTF)", "", {}}, "glb", writeGltf);
}

}  // namespace hairloom
