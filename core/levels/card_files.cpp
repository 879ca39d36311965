// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/levels/card_files.h"

#include <fmt/format.h>

#include "core/base/output_batch.h"
#include "core/cards/atlas_images.h"
#include "core/render/png.h"

namespace hairloom {

LevelTextures texturesOf(const cards::Level& level, const cards::LevelArrays& arrays,
                         const std::string& stem) {
    LevelTextures textures;
    const auto* made = std::get_if<cards::Cards>(&level.content);
    if (made == nullptr) return textures;
    const cards::Picture picture = cards::brightened(made->atlas, arrays.albedoScale);
    textures.colour = fmt::format("{}_{}_colour.png", stem, level.name);
    textures.normal = fmt::format("{}_{}_normal.png", stem, level.name);
    textures.images.emplace_back(textures.colour, cards::colourImage(picture, 1));
    textures.images.emplace_back(textures.normal, cards::normalImage(picture));
    return textures;
}

Result<std::vector<std::string>> writeTogether(
    std::vector<std::pair<std::filesystem::path, std::vector<std::byte>>> files, const NamedImages& images) {
    for (const auto& [name, image] : images) {
        auto bytes = render::encodePng(image);
        if (!bytes) return tl::unexpected(bytes.error());
        files.emplace_back(files.front().first.parent_path() / name, std::move(*bytes));
    }
    OutputBatch batch;
    std::vector<std::string> names;
    for (const auto& [to, bytes] : files) {
        if (auto status = writeFileAtomically(to, bytes); !status) return tl::unexpected(status.error());
        if (&to != &files.front().first) names.push_back(to.filename().string());
    }
    if (auto status = batch.commit(); !status) return tl::unexpected(status.error());
    return names;
}

}  // namespace hairloom
