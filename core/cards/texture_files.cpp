// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/texture_files.h"

#include <fmt/format.h>

#include "core/cards/atlas_images.h"
#include "core/render/png.h"

namespace hairloom::cards {

Result<TextureFiles> textureFilesOf(const Level& level, const LevelArrays& arrays, const std::string& stem,
                                    Cancel cancel) {
    TextureFiles textures;
    const auto* made = std::get_if<Cards>(&level.content);
    if (made == nullptr) return textures;
    const Picture picture = brightened(made->atlas, arrays.albedoScale);
    textures.colour = fmt::format("{}_{}_colour.png", stem, level.name);
    textures.normal = fmt::format("{}_{}_normal.png", stem, level.name);
    for (const auto& [name, image] : {std::pair(textures.colour, colourImage(picture, 1)),
                                      std::pair(textures.normal, normalImage(picture))}) {
        if (cancelled(cancel)) return stopped();
        auto bytes = render::encodePng(image);
        if (!bytes) return tl::unexpected(bytes.error());
        textures.files.emplace_back(name, std::move(*bytes));
    }
    return textures;
}

}  // namespace hairloom::cards
