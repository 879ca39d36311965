// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/made_levels.h"

#include <algorithm>

#include "core/base/stopwatch.h"
#include "core/cards/atlas_images.h"

namespace hairloom::editor {
namespace {

constexpr int kShownSide = 512;         // texels of a texture
constexpr std::size_t kDirections = 4;  // of those that levels are judged from

QImage imageOf(const render::Image& image) {
    const QImage borrowed(image.rgba.data(), static_cast<int>(image.width), static_cast<int>(image.height),
                          QImage::Format_RGBA8888);
    return borrowed.copy();
}

std::vector<QImage> imagesOf(const std::vector<cards::Shot>& shots) {
    std::vector<QImage> images;
    const std::size_t step = std::max<std::size_t>(1, shots.size() / kDirections);
    for (std::size_t v = 0; v < shots.size() && images.size() < kDirections; v += step)
        images.push_back(imageOf(cards::shownAs(shots[v])));
    return images;
}

std::vector<MadeLevel::Texture> texturesOf(const cards::Atlas& atlas) {
    std::vector<MadeLevel::Texture> textures;
    for (const cards::AtlasImage& made : cards::imagesOf(atlas)) {
        if (made.name.find('.') != std::string::npos) continue;  // mip maps
        QImage image = imageOf(made.image);
        if (image.width() > kShownSide)
            image = image.scaled(kShownSide, kShownSide, Qt::KeepAspectRatio, Qt::SmoothTransformation);
        textures.push_back({QString::fromStdString(made.name), image});
    }
    return textures;
}

}  // namespace

Result<MadeLevels> makeShownLevels(const Groom& groom, const LevelBudget& budget, TaskControl& control) {
    const Stopwatch watch;
    auto chain = makeLevels(
        groom, budget, LevelsMade::all,
        [&](std::string_view, double share) { control.setProgress(static_cast<float>(share)); },
        control.cancelFlag());
    if (!chain) return tl::unexpected(chain.error());
    auto file = levelFile(*chain, groom);
    if (!file) return tl::unexpected(file.error());
    MadeLevels made;
    made.strands = chain->strands;
    made.roots_ws = std::move(chain->roots_ws);
    made.file = std::move(*file);
    const std::vector<double> steps = cards::lightSteps(chain->levels);
    for (cards::Level& level : chain->levels) {
        MadeLevel kept;
        kept.lightStep = steps[made.levels.size()];
        kept.strands = imagesOf(level.strands);
        kept.shots = imagesOf(level.shots);
        level.strands = {}, level.shots = {};
        if (auto* cards = std::get_if<cards::Cards>(&level.content)) {
            kept.textures = texturesOf(cards->atlas);
            const std::uint32_t side = cards->atlas.side();
            cards->atlas.levels = {cards::Picture{side, side, {}}};
        }
        if (auto* hair = std::get_if<cards::Hair>(&level.content)) *hair = {};
        kept.level = std::move(level);
        made.levels.push_back(std::move(kept));
    }
    made.seconds = watch.seconds();
    return made;
}

}  // namespace hairloom::editor
