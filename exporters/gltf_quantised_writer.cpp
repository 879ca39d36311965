// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/glb_cards.h"

namespace hairloom {
namespace {

Result<WrittenCards> writeQuantisedGltf(const CardsToWrite& cards, const std::filesystem::path& path) {
    return writeGlb(cards, path, cards::GlbNumbers::quantised);
}

}  // namespace

HairWriter gltfQuantisedWriter() {
    return cardWriter("gltf-quantised", "Cards as binary glTF 2.0, quantised",
                      "like gltf, with 40 bytes per vertex instead of 88 (KHR_mesh_quantization)",
                      {"cards-small",
                       "Engines without strands: cards (glTF, quantised)",
                       " For readers of KHR_mesh_quantization.",
                       {}},
                      "glb", writeQuantisedGltf);
}

}  // namespace hairloom
