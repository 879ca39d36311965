// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/level_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/accuracy/html_report.h"
#include "core/accuracy/plot.h"
#include "core/base/output_file.h"
#include "core/cards/atlas_images.h"
#include "core/render/png.h"

namespace hairloom {
namespace {

using cards::Chain;
using cards::Level;

std::vector<std::vector<std::string>> rowsOf(const Chain& chain) {
    std::vector<std::vector<std::string>> rows{{"level", "head, px", "from, m", "hairs", "cards", "triangles",
                                                "MB", "coverage", "light", "FLIP", "worst FLIP",
                                                "outline, px", "draw, ms", "move, ms"}};
    for (const Level& level : chain.levels) {
        const cards::Difference& off = level.difference;
        rows.push_back({level.name, fmt::format("{}", level.spec.headPx),
                        fmt::format("{:.2f}", cards::distanceOf(level.spec.headPx)),
                        fmt::format("{}", level.hairs), fmt::format("{}", level.cards()),
                        fmt::format("{}", level.triangles),
                        fmt::format("{:.2f}", static_cast<double>(level.bytes) / 1e6),
                        fmt::format("{:.3f}", off.coverage), fmt::format("{:.3f}", off.light),
                        fmt::format("{:.3f}", off.flip), fmt::format("{:.3f}", off.worstFlip),
                        fmt::format("{:.2f}", off.silhouettePx), fmt::format("{:.1f}", level.drawMs),
                        fmt::format("{:.3f}", level.moveMs)});
    }
    return rows;
}

/// Error against cost: the same diagram as that of accuracy.
Plot plotOf(const Chain& chain) {
    Plot plot;
    plot.title = "What levels lose, against what they take to draw";
    plot.x = {.title = "triangles", .scale = Scale::Logarithmic};
    plot.y = {.title = "FLIP to all strands, at the level's distance", .scale = Scale::Linear, .low = 0};
    Series series{.name = "levels", .line = LineStyle::Dashed};
    for (const Level& level : chain.levels) {
        series.points.push_back(
            {.x = static_cast<double>(level.triangles), .y = level.difference.flip, .label = level.name});
    }
    plot.series.push_back(std::move(series));
    return plot;
}

std::string csv(const Chain& chain) {
    std::string text;
    for (const auto& row : rowsOf(chain)) {
        std::string line;
        for (const std::string& cell : row)
            line +=
                (line.empty() ? "" : ",") + (cell.find(',') == std::string::npos ? cell : "\"" + cell + "\"");
        text += line + "\n";
    }
    return text;
}

void put(render::Image& page, const render::Image& picture, std::uint32_t left, std::uint32_t top) {
    for (std::uint32_t y = 0; y < picture.height; ++y) {
        const auto row = picture.rgba.begin() + std::ptrdiff_t{4} * y * picture.width;
        std::copy(row, row + std::ptrdiff_t{4} * picture.width,
                  page.rgba.begin() + std::ptrdiff_t{4} * ((std::ptrdiff_t{top} + y) * page.width + left));
    }
}

std::string html(const Chain& chain, const std::string& commandLine) {
    HtmlReport report("Levels of detail");
    report.paragraph(fmt::format("{} hairs, judged from {} directions. Made in {:.1f} s.", chain.strands,
                                 chain.views.size(), chain.makeSeconds));
    report.command(commandLine);
    report.table(rowsOf(chain));
    report.drawing(svg(plotOf(chain)));
    report.paragraph(
        "Coverage and light are those of the level's hair, times those of all strands. Outlines are off by "
        "the area "
        "between them, by their length. FLIP is the mean of all pixels and directions. Drawing is the "
        "judge's, on one "
        "core.");
    return report.html();
}

}  // namespace

nlohmann::ordered_json toJson(const Level& level) {
    const cards::Difference& off = level.difference;
    return {{"name", level.name},
            {"kind", cards::nameOf(level.spec.kind)},
            {"hairs", level.hairs},
            {"cards", level.cards()},
            {"triangles", level.triangles},
            {"bytes", level.bytes},
            {"head_px", level.spec.headPx},
            {"distance_m", cards::distanceOf(level.spec.headPx)},
            {"coverage", off.coverage},
            {"flip", off.flip},
            {"flip_worst", off.worstFlip},
            {"light", off.light},
            {"silhouette_px", off.silhouettePx},
            {"ms_draw", level.drawMs},
            {"ms_move", level.moveMs}};
}

std::string levelTable(const Chain& chain) {
    std::string text;
    const auto rows = rowsOf(chain);
    for (std::size_t r = 0; r < rows.size(); ++r) {
        text += "|";
        for (const std::string& cell : rows[r]) text += " " + cell + " |";
        text += "\n";
        if (r > 0) continue;
        text += "|";
        for (std::size_t c = 0; c < rows[r].size(); ++c) text += c == 0 ? "---|" : "---:|";
        text += "\n";
    }
    return text;
}

render::Image sideBySide(const Level& level) {
    constexpr std::size_t kMostShown = 4;
    const std::size_t step = std::max<std::size_t>(1, level.shots.size() / kMostShown);
    render::Image page;
    std::vector<std::size_t> shown;
    for (std::size_t v = 0; v < level.shots.size() && shown.size() < kMostShown; v += step)
        shown.push_back(v);
    std::uint32_t row = 0;
    for (const std::size_t v : shown) {
        page.width += level.shots[v].width;
        row = std::max(row, level.shots[v].height);
    }
    page.height = 2 * row;
    page.rgba.assign(std::size_t{4} * page.width * page.height, 255);
    std::uint32_t left = 0;
    for (const std::size_t v : shown) {
        put(page, cards::shownAs(level.strands[v]), left, 0);
        put(page, cards::shownAs(level.shots[v]), left, row);
        left += level.shots[v].width;
    }
    return page;
}

Result<std::vector<std::string>> writeChain(const Chain& chain, const std::string& commandLine,
                                            std::span<const cards::Collider> colliders,
                                            const std::filesystem::path& folder) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const Level& level : chain.levels) rows.push_back(toJson(level));
    auto names = writeFiles(folder, {{"report.html", html(chain, commandLine)},
                                     {"levels.csv", csv(chain)},
                                     {"levels.md", levelTable(chain)},
                                     {"levels.json", rows.dump(2) + "\n"},
                                     {"error.svg", svg(plotOf(chain))}});
    if (!names) return names;
    const auto write = [&](const std::string& name, const render::Image& image) -> Status {
        names->push_back(name);
        return render::writePng(folder / name, image);
    };
    for (const Level& level : chain.levels) {
        if (auto status = write(level.name + ".png", sideBySide(level)); !status)
            return tl::unexpected(status.error());
        const auto* made = std::get_if<cards::Cards>(&level.content);
        if (made == nullptr) continue;
        for (const cards::AtlasImage& image : cards::imagesOf(made->atlas)) {
            const std::string name = level.name + "_" + image.name + ".png";
            if (auto status = write(name, image.image); !status) return tl::unexpected(status.error());
        }
    }
    std::vector<const Level*> held;
    for (const Level& level : chain.levels)
        if (level.spec.kind != cards::LevelKind::strands) held.push_back(&level);
    if (held.empty()) return names;
    const auto glb = cards::glbOf(held, colliders);
    if (!glb) return tl::unexpected(glb.error());
    if (auto status = writeFileAtomically(folder / "levels.glb", *glb); !status)
        return tl::unexpected(status.error());
    names->push_back("levels.glb");
    return names;
}

}  // namespace hairloom
