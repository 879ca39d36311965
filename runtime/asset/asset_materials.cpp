// SPDX-License-Identifier: MIT
// Whether what an asset says of the look of hair is sound.
#include <algorithm>
#include <cmath>

#include "asset/asset_error.h"
#include "engine/checks.h"
#include "hairloom/asset.h"

namespace hairloom::runtime {

using namespace asset;

namespace {

/// Infinite, or none at all.
bool isNoNumber(std::uint16_t half) {
    return (half & 0x7c00u) == 0x7c00u;
}

/// Whether all of a material's numbers are within 1e6, but for the counts at its end.
bool hasNumbers(const Material& material) {
    const auto* const at = reinterpret_cast<const float*>(&material);
    constexpr std::size_t kAbsorbs = offsetof(Material, absorbs) / sizeof(float);
    for (std::size_t i = 0; i < offsetof(Material, model) / sizeof(float); ++i) {
        if (i != kAbsorbs && !(std::abs(at[i]) <= kFarthest)) return false;
    }
    return std::abs(material.axisRatio) <= kFarthest;
}

}  // namespace

std::size_t Asset::materialCount() const {
    std::size_t count = 1;
    for (const Layer& layer : layers) count += layer.ownMaterial != 0 ? 1 : 0;
    return count;
}

std::optional<AssetError> Asset::checkMaterials() const {
    const auto all = materials();
    const auto tables = fibreTables();
    if (tables.size() % kTableHalves != 0)
        return damaged(placeOf(tables.data()), number(tables.size()) + " numbers of tables; expected " +
                                                   number(kTableHalves) + " of each");
    const auto bad = std::find_if(tables.begin(), tables.end(), isNoNumber);
    if (bad != tables.end()) return damaged(placeOf(&*bad), "a table of what is no number");
    if (!all.empty() && all.size() != materialCount())
        return damaged(placeOf(all.data()),
                       number(all.size()) + " materials; the layers have " + number(materialCount()));
    for (const Material& material : all) {
        const auto wrong = [&](const char* words) {
            return damaged(placeOf(&material), std::string("a material ") + words);
        };
        if (!hasNumbers(material)) return wrong("with a number beyond 1e6");
        if (material.absorbs > 1 || material.model > kMarschner) return wrong("of a kind that there is not");
        if (!(material.axisRatio > 0) || !(material.spread >= 0 && material.spread <= 1))
            return wrong("whose spread or ratio of axes is out of range");
        if (material.model != kMarschner) continue;
        if (material.table >= tables.size() / kTableHalves) return wrong("whose tables are not in the file");
        const bool wide =
            std::all_of(material.widths.begin(), material.widths.begin() + 3, [](float w) { return w > 0; });
        if (!wide || !(material.ownScale != 0)) return wrong("without widths or a scale of its colours");
    }
    if (!hairLooks().empty() && hairLooks().size() != hairCount())
        return damaged(placeOf(hairLooks().data()),
                       number(hairLooks().size()) + " looks of " + number(hairCount()) + " hairs");
    return std::nullopt;
}

}  // namespace hairloom::runtime
