// SPDX-License-Identifier: GPL-3.0-or-later
// usage: hairloom-mesh-writer < SCENE > FILES
// assimp's writers, in a process of their own, so that neither they nor the readers that come with them are
// in the programs that people work in. Both ends are as exporters/card_mesh_scene.h has them.

#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <span>
#include <vector>

#include "exporters/mesh_writer/assimp_cards.h"
#include "importers/answer_stream.h"
#include "importers/confinement.h"

namespace hairloom {
namespace {

std::vector<std::byte> readInput() {
    std::vector<std::byte> bytes;
    std::array<std::byte, 65536> piece;
    while (const std::size_t got = std::fread(piece.data(), 1, piece.size(), stdin))
        bytes.insert(bytes.end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(got));
    return bytes;
}

Result<std::vector<WrittenMeshFile>> writeFiles() {
    try {
        std::string lacking;
        const auto scene =
            readAnswer<CardMeshScene>("", readInput(), AnswerKind::CardScene, lacking, kCardSceneMembers);
        if (!scene) return tl::unexpected(scene.error());
        return meshFilesOf(*scene);
    } catch (const std::exception& exception) {
        return fail(exception.what(), "cards that can be written");
    }
}

int run() {
    const auto files = writeFiles();
    bool isWritten = true;
    const auto sink = [&](std::span<const std::byte> bytes) {
        isWritten = isWritten && std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size();
    };
    writeAnswer(files, AnswerKind::MeshFiles, "", sink, kMeshFilesMembers);
    return isWritten && std::fflush(stdout) == 0 ? 0 : 1;
}

}  // namespace
}  // namespace hairloom

int main() {
    hairloom::endWithParent();
    return hairloom::run();
}
