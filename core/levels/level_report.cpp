// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/levels/level_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/output_batch.h"
#include "core/cards/atlas_images.h"
#include "core/charts/html_report.h"
#include "core/charts/plot.h"
#include "core/groom/file/card_edits_json.h"
#include "core/levels/held_cards.h"
#include "core/operations/script.h"
#include "core/render/png.h"

namespace hairloom {
namespace {

using cards::Chain;
using cards::Level;

std::vector<std::vector<std::string>> rowsOf(const Chain& chain) {
    const std::vector<double> steps = cards::lightSteps(chain.levels);
    std::vector<std::vector<std::string>> rows{{"level", "head, px", "from, m", "hairs", "cards", "triangles",
                                                "MB", "coverage", "light", "step, %", "FLIP", "worst FLIP",
                                                "outline, px", "draw, ms", "move, ms"}};
    for (std::size_t i = 0; i < chain.levels.size(); ++i) {
        const Level& level = chain.levels[i];
        const cards::Difference& off = level.difference;
        rows.push_back({level.name, fmt::format("{}", level.spec.headPx),
                        fmt::format("{:.2f}", cards::distanceOf(level.spec.headPx)),
                        fmt::format("{}", level.hairs), fmt::format("{}", level.cards()),
                        fmt::format("{}", level.triangles),
                        fmt::format("{:.2f}", static_cast<double>(level.bytes) / 1e6),
                        fmt::format("{:.3f}", off.coverage), fmt::format("{:.3f}", off.light),
                        fmt::format("{:.1f}", 100 * steps[i]), fmt::format("{:.3f}", off.flip),
                        fmt::format("{:.3f}", off.worstFlip), fmt::format("{:.2f}", off.silhouettePx),
                        fmt::format("{:.1f}", level.drawMs), fmt::format("{:.3f}", level.moveMs)});
    }
    return rows;
}

/// What each level has of the measures, and in words which of them fail.
std::vector<std::vector<std::string>> measuresOf(const Chain& chain) {
    std::vector<std::vector<std::string>> rows{{"level"}};
    for (const cards::Measure& measure : cards::allMeasures()) {
        rows[0].push_back(measure.unit.empty() ? std::string(measure.label)
                                               : fmt::format("{}, {}", measure.label, measure.unit));
    }
    rows[0].emplace_back("fails");
    for (const Level& level : chain.levels) {
        if (!level.measures) continue;
        std::vector<std::string> row{level.name};
        std::string fails;
        for (const cards::Measure& measure : cards::allMeasures()) {
            const std::optional<double>& value = *level.measures.*measure.value;
            row.push_back(value ? fmt::format("{:.2f}", measure.scale * *value) : "");
            if (!level.failsBy(measure)) continue;
            fails += (fails.empty() ? "" : ", ") + std::string(measure.label);
        }
        row.push_back(std::move(fails));
        rows.push_back(std::move(row));
    }
    return rows;
}

/// Which rows of the body of measuresOf() fail.
std::vector<bool> failing(const Chain& chain) {
    std::vector<bool> fails;
    for (const Level& level : chain.levels)
        if (level.measures) fails.push_back(!level.fails().empty());
    return fails;
}

/// Levels are compared at equal distances.
Plot plotOf(const Chain& chain) {
    Plot plot;
    plot.title = "Visible difference at equal distances";
    plot.x = {.title = "distance, m", .scale = Scale::Logarithmic};
    plot.y = {.title = "FLIP vs. all strands", .scale = Scale::Linear, .low = 0};
    for (const Level& level : chain.levels) {
        Series series{.name = level.name, .line = LineStyle::Solid};
        for (const cards::FlipAt& at : level.flips)
            series.points.push_back({.x = cards::distanceOf(at.headPx), .y = at.flip});
        if (series.points.empty())
            series.points.push_back({.x = cards::distanceOf(level.spec.headPx), .y = level.difference.flip});
        plot.series.push_back(std::move(series));
    }
    return plot;
}

/// The measures behind all else.
std::string csv(const Chain& chain) {
    std::string text;
    auto rows = rowsOf(chain);
    if (const auto measures = measuresOf(chain); measures.size() == rows.size())
        for (std::size_t r = 0; r < rows.size(); ++r)
            rows[r].insert(rows[r].end(), measures[r].begin() + 1, measures[r].end());
    for (const auto& row : rows) {
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

/// A table; columns but the first and one of words stand to the right.
std::string markdown(const std::vector<std::vector<std::string>>& rows) {
    std::string text;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        text += "|";
        for (const std::string& cell : rows[r]) text += " " + cell + " |";
        text += "\n";
        if (r > 0) continue;
        text += "|";
        for (const std::string& head : rows[r]) text += head == "level" || head == "fails" ? "---|" : "---:|";
        text += "\n";
    }
    return text;
}

std::string springWords(const cards::SpringFit& fit) {
    return fmt::format(
        "At {:g} updates per second, while the head makes the motion {} for {:g} s, springs keep the joints "
        "{:.1f} mm from the strands, "
        "{:.1f} mm at most. Springs that are not fitted: {:.1f} and {:.1f} mm. Under a still head they "
        "settle "
        "{:.2g} mm at most.",
        fit.hz, fit.motion, fit.seconds, fit.after.meanMm, fit.after.largestMm, fit.before.meanMm,
        fit.before.largestMm, fit.settlingMm);
}

/// What springs do at the rates of engines.
std::vector<std::vector<std::string>> ratesOf(const cards::SpringFit& fit) {
    std::vector<std::vector<std::string>> rows{{"updates per second", "joints off, mm", "largest, mm"}};
    for (const cards::SpringRate& rate : fit.rates)
        rows.push_back({fmt::format("{:g}", rate.hz), fmt::format("{:.1f}", rate.error.meanMm),
                        fmt::format("{:.1f}", rate.error.largestMm)});
    return rows;
}

std::string html(const Chain& chain, const std::string& commandLine) {
    HtmlReport report("Levels of detail");
    report.paragraph(fmt::format("{} hairs, compared from {} directions. Created in {:.1f} s.", chain.strands,
                                 chain.views.size(), chain.makeSeconds));
    report.command(commandLine);
    report.table(rowsOf(chain));
    if (const auto rows = measuresOf(chain); rows.size() > 1) {
        report.heading("What a mean does not see");
        report.table(rows, failing(chain), HtmlReport::Strong::red);
    }
    report.drawing(svg(plotOf(chain)));
    if (chain.springFit) {
        report.paragraph(springWords(*chain.springFit));
        report.table(ratesOf(*chain.springFit));
    }
    report.paragraph(
        "Coverage and light are relative to those of all strands. The step is the largest change of light "
        "when a level replaces the one before it, and on the way to the next. The outline error is the area "
        "between the outlines divided by their length. FLIP is the mean over all pixels and directions. Draw "
        "time is that of the reference renderer on one core. Levels in red fail a measure.");
    return report.html();
}

/// A script that holds all cards of a level as they are.
std::string cardScript(const Level& level, const cards::Cards& made, std::span<const Vec3f> roots_ws) {
    std::vector<CardEdit> edits;
    for (const cards::Card& card : made.cards) {
        CardEdit edit = editOf(card, static_cast<std::uint32_t>(level.spec.amount), roots_ws);
        edit.width = card.width, edit.bend = card.bend, edit.deleted = card.deleted;
        if (card.pinned) edit.strip = stationsOf(card.strip);
        edits.push_back(std::move(edit));
    }
    const nlohmann::ordered_json step{{"op", "card_edits"}, {"card_edits", toJson(edits)}};
    return nlohmann::ordered_json{{"hairloom_script", kScriptVersion}, {"operations", {step}}}.dump() + "\n";
}

}  // namespace

std::string failureWords(const Level& level) {
    if (!level.measures) return {};
    return cards::failureWords(*level.measures, cards::pixelMillimetres(level.measuredPx()));
}

nlohmann::ordered_json toJson(const Level& level) {
    const cards::Difference& off = level.difference;
    nlohmann::ordered_json lights = nlohmann::ordered_json::array();
    for (const cards::LightAt& at : level.lights)
        lights.push_back({{"distance_m", cards::distanceOf(at.headPx)}, {"light", at.light}});
    nlohmann::ordered_json flips = nlohmann::ordered_json::array();
    for (const cards::FlipAt& at : level.flips)
        flips.push_back({{"distance_m", cards::distanceOf(at.headPx)}, {"flip", at.flip}});
    nlohmann::ordered_json json{{"name", level.name},
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
                                {"flips", std::move(flips)},
                                {"light", off.light},
                                {"lights", std::move(lights)},
                                {"silhouette_px", off.silhouettePx},
                                {"ms_draw", level.drawMs},
                                {"ms_move", level.moveMs}};
    if (!level.measures) return json;
    for (const cards::Measure& measure : cards::allMeasures()) {
        const std::optional<double>& value = *level.measures.*measure.value;
        json[std::string(measure.name)] = value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
    }
    json["fails"] = level.fails();
    return json;
}

nlohmann::ordered_json toJson(const cards::SpringFit& fit) {
    nlohmann::ordered_json rates = nlohmann::ordered_json::array();
    for (const cards::SpringRate& rate : fit.rates)
        rates.push_back(
            {{"hz", rate.hz}, {"error_mm", rate.error.meanMm}, {"largest_mm", rate.error.largestMm}});
    return {{"motion", fit.motion},
            {"seconds", fit.seconds},
            {"error_mm", fit.after.meanMm},
            {"largest_mm", fit.after.largestMm},
            {"default_error_mm", fit.before.meanMm},
            {"default_largest_mm", fit.before.largestMm},
            {"settling_mm", fit.settlingMm},
            {"hz", fit.hz},
            {"rates", std::move(rates)}};
}

std::string levelTable(const Chain& chain) {
    std::string text = markdown(rowsOf(chain));
    auto measures = measuresOf(chain);
    if (measures.size() == 1) return text;
    const std::vector<bool> fails = failing(chain);
    for (std::size_t r = 0; r < fails.size(); ++r)
        if (fails[r]) measures[r + 1].front() = fmt::format("**{}**", measures[r + 1].front());
    return text + "\n" + markdown(measures);
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

render::Image chainPicture(const Chain& chain) {
    constexpr std::uint32_t kGap = 8;
    struct Pair {
        const Level* level;
        std::size_t direction;
        std::uint32_t left, row;
    };
    std::vector<Pair> pairs;
    render::Image page;
    std::vector<std::uint32_t> heights;
    for (const std::size_t direction : {std::size_t{0}, std::size_t{1}}) {
        std::uint32_t left = 0, height = 0;
        for (const Level& level : chain.levels) {
            if (level.spec.kind == cards::LevelKind::strands || direction >= level.shots.size()) continue;
            pairs.push_back({&level, direction, left, static_cast<std::uint32_t>(heights.size())});
            left += 2 * level.shots[direction].width + kGap;
            height = std::max(height, level.shots[direction].height);
        }
        page.width = std::max(page.width, left);
        heights.push_back(height);
        page.height += height;
    }
    page.rgba.assign(std::size_t{4} * page.width * page.height, 255);
    for (const Pair& pair : pairs) {
        const cards::Shot& shot = pair.level->shots[pair.direction];
        const std::uint32_t top = (pair.row == 0 ? 0 : heights[0]) + heights[pair.row] - shot.height;
        put(page, cards::shownAs(pair.level->strands[pair.direction]), pair.left, top);
        put(page, cards::shownAs(shot), pair.left + shot.width, top);
    }
    return page;
}

Result<std::vector<std::string>> writeChain(const Chain& chain, const std::string& commandLine,
                                            std::span<const cards::Collider> colliders,
                                            const cards::Character& character,
                                            const std::filesystem::path& folder) {
    OutputBatch batch;
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const Level& level : chain.levels) rows.push_back(toJson(level));
    std::vector<std::pair<std::string, std::string>> texts{{"report.html", html(chain, commandLine)},
                                                           {"levels.csv", csv(chain)},
                                                           {"levels.md", levelTable(chain)},
                                                           {"levels.json", rows.dump(2) + "\n"},
                                                           {"error.svg", svg(plotOf(chain))}};
    for (const Level& level : chain.levels)
        if (const auto* made = std::get_if<cards::Cards>(&level.content))
            texts.emplace_back(level.name + ".json", cardScript(level, *made, chain.roots_ws));
    auto names = writeFiles(folder, texts);
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
    const auto inPlace = [&]() -> Result<std::vector<std::string>> {
        if (auto status = batch.commit(); !status) return tl::unexpected(status.error());
        return std::move(*names);
    };
    const auto isStrands = [](const Level& level) { return level.spec.kind == cards::LevelKind::strands; };
    if (std::ranges::all_of(chain.levels, isStrands)) return inPlace();
    if (auto status = write("chain.png", chainPicture(chain)); !status) return tl::unexpected(status.error());
    const auto glb = cards::glbOf(chain, colliders, cards::GlbNumbers::floats, character);
    if (!glb) return tl::unexpected(glb.error());
    if (auto status = writeFileAtomically(folder / "levels.glb", *glb); !status)
        return tl::unexpected(status.error());
    names->push_back("levels.glb");
    return inPlace();
}

}  // namespace hairloom
