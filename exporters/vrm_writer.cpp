// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/glb_cards.h"

namespace hairloom {
namespace {

Result<WrittenCards> writeVrm(const CardsToWrite& cards, const std::filesystem::path& path) {
    const std::string name = path.stem().string();
    std::vector<Finding> findings;
    const cards::Character character =
        avatarCharacter({cards.groom, cards.chain.roots_ws}, name.empty() ? "hair" : name, findings);
    return writeGlb(cards, path, cards::GlbNumbers::floats, character, std::move(findings));
}

}  // namespace

HairWriter vrmWriter() {
    return cardWriter(
        "vrm", "Cards as an avatar, VRM 1.0", "like gltf, and the bones of a humanoid (VRMC_vrm)",
        {"avatar",
         "Programs for avatars (VRM)",
         " A head file without a body gets joints of one. Name author and licence in the program "
         "that publishes it.",
         {}},
        "vrm", writeVrm);
}

}  // namespace hairloom
