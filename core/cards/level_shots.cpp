// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/level_shots.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/base/stopwatch.h"

namespace hairloom::cards {
namespace {

constexpr std::uint32_t kSamplesAPixel = 4;  // of cards and shells, along each axis

/// Draws all strands from each direction and calls develop(direction, plate); the mean time of drawing, ms.
template <class Develop>
Result<double> drawAll(const Stage& stage, const StrandLight& light, std::span<const View> views,
                       std::uint32_t samplesPerHead, const Develop& develop) {
    std::vector<double> seconds(views.size());
    parallelFor(views.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end && !cancelled(stage.cancel); ++v) {
            stage.plates.draw(views[v], samplesPerHead, [&](Plate& plate) {
                plate.drawHead(stage.hair);
                const Stopwatch watch;
                plate.drawStrands(stage.hair, light);
                seconds[v] = watch.seconds();
                develop(v, plate);
            });
        }
    });
    if (cancelled(stage.cancel)) return stopped();
    double mean = 0;
    for (const double s : seconds) mean += 1000 * s / static_cast<double>(seconds.size());
    return mean;
}

}  // namespace

Shooting shoot(const Stage& stage, const LevelContent& content, std::span<const View> views, std::uint32_t px,
               std::uint32_t samplesOfHair, Shown shown) {
    Shooting result;
    result.shots.resize(views.size());
    std::vector<double> seconds(views.size());
    const auto* const hair = std::get_if<Hair>(&content);
    // The light in thinner hair is that of all hair.
    const StrandLight light =
        hair != nullptr && shown == Shown::all ? strandLight(*hair, stage.light) : StrandLight{};
    const std::uint32_t samples = hair != nullptr ? samplesOfHair : std::max(32u, px * kSamplesAPixel);
    parallelFor(views.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && !cancelled(stage.cancel); ++i) {
            stage.plates.draw(views[i], samples, [&](Plate& plate) {
                plate.drawHead(stage.hair);
                const Stopwatch watch;
                if (hair != nullptr && shown == Shown::all) plate.drawStrands(*hair, light);
                if (hair != nullptr && shown == Shown::coverage) plate.coverByStrands(*hair);
                if (const auto* cards = std::get_if<Cards>(&content))
                    plate.drawCards(stage.hair, stage.light, *cards, px);
                if (const auto* shell = std::get_if<Shell>(&content))
                    plate.drawShell(stage.hair, stage.light, *shell);
                seconds[i] = watch.seconds();
                result.shots[i] = plate.developed(px);
            });
        }
    });
    for (const double s : seconds) result.drawMs += 1000 * s / static_cast<double>(seconds.size());
    return result;
}

Result<StrandShots> shootStrands(const Stage& stage, const StrandLight& light, std::span<const View> views,
                                 std::span<const std::uint32_t> heightsPx) {
    StrandShots result;
    for (const std::uint32_t px : heightsPx) result.shots[px].resize(views.size());
    const auto mean = drawAll(stage, light, views, kSamplesPerHead, [&](std::size_t v, const Plate& plate) {
        for (auto& [px, all] : result.shots) all[v] = plate.developed(px);
    });
    if (!mean) return tl::unexpected(mean.error());
    result.drawMs = *mean;
    return result;
}

Result<std::map<std::uint32_t, std::vector<Print>>> printStrands(const Stage& stage, const StrandLight& light,
                                                                 std::span<const View> views,
                                                                 std::span<const std::uint32_t> heightsPx) {
    std::map<std::uint32_t, std::vector<Print>> prints;
    for (const std::uint32_t px : heightsPx) prints[px].resize(views.size());
    const auto drawn = drawAll(stage, light, views, kSamplesBetween, [&](std::size_t v, const Plate& plate) {
        for (auto& [px, all] : prints) all[v] = printOf(plate.developed(px));
    });
    if (!drawn) return tl::unexpected(drawn.error());
    return prints;
}

}  // namespace hairloom::cards
