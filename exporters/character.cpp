// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/character.h"

#include <fmt/format.h>

#include <algorithm>

namespace hairloom {

std::optional<ImportedScene> characterOf(const Groom& groom, std::vector<Finding>& findings) {
    if (groom.characterFile.empty()) return std::nullopt;
    MeshImportOptions options;
    if (groom.characterMetresPerUnit > 0) options.metresPerUnit = groom.characterMetresPerUnit;
    auto scene = importScene(groom.characterFile, options);
    const auto leave = [&](const std::string& why) {
        findings.push_back({Severity::Warning, fmt::format("the head's bones are left out: {}", why), "skin",
                            "export where the head file is unchanged. Roots now move rigidly"});
        return std::nullopt;
    };
    if (!scene) return leave(scene.error().message());
    if (scene->skeleton.empty()) return std::nullopt;
    const bool same = groom.scalp && scene->mesh.vertexCount() == groom.scalp->vertexCount() &&
                      std::ranges::equal(scene->mesh.triangles(), groom.scalp->triangles());
    if (!same) return leave(fmt::format("{} has another mesh", groom.characterFile));
    return std::move(*scene);
}

}  // namespace hairloom
