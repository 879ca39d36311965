// SPDX-License-Identifier: GPL-3.0-or-later
// For platforms whose assimp writes nothing.
#include "core/levels/card_meshes.h"

namespace hairloom {

bool canWriteCardMeshes() {
    return false;
}

Result<std::vector<std::string>> writeCardMeshes(const cards::Chain&, CardMeshFormat,
                                                 const std::filesystem::path&) {
    return fail("this build cannot export cards as OBJ or FBX", "glTF");
}

}  // namespace hairloom
