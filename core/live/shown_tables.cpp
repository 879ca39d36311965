// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/live/shown_parts.h"
#include "core/render/tone_map.h"
#include "core/shading/tables.h"

namespace hairloom {
namespace {

using shading::Table;

/// Coarser than those of shaders, so that a table can be read as text, too.
constexpr shading::TableSizes kSizes{96, 128, 32};

std::vector<double> placesOf(std::uint32_t count, double from, double to) {
    std::vector<double> places;
    for (std::uint32_t i = 0; i < count; ++i) places.push_back(from + (to - from) * i / (count - 1));
    return places;
}

std::vector<float> channelOf(const Table& table, std::size_t channel) {
    std::vector<float> values;
    for (std::size_t i = channel; i < table.rgba.size(); i += 4) values.push_back(table.rgba[i]);
    return values;
}

/// What of a table to show: its first channels, by these names.
ShownTable shownTable(std::string name, const Table& table, const char* xName, const char* yName,
                      std::vector<double> x, std::vector<double> y,
                      std::initializer_list<std::pair<std::size_t, const char*>> channels) {
    ShownTable shown{std::move(name), xName, yName, std::move(x), std::move(y), {}};
    for (const auto& [channel, title] : channels)
        shown.channels.push_back({title, channelOf(table, channel)});
    return shown;
}

std::uint8_t coded(float share) {
    return render::toByte(render::encodeSrgb(share));
}

Plot mapPlot(const ShownTable& table) {
    Plot plot;
    plot.title = table.name;
    plot.x.title = table.xName;
    plot.y.title = table.yName;
    plot.map = FilledMap{cellEdges(table.x, Scale::Linear), cellEdges(table.y, Scale::Linear), {}};
    plot.x.low = table.x.front();
    plot.x.high = table.x.back();
    plot.y.low = table.y.front();
    plot.y.high = table.y.back();
    return plot;
}

/// What shows full red, green or blue: the greatest of each channel, or, in tables of M, that of light across
/// the fibre, since grazing light piles up.
std::array<float, 3> fullOf(const ShownTable& table, bool ofMiddle) {
    std::array<float, 3> full{};
    const std::size_t columns = table.x.size();
    for (std::size_t c = 0; c < 3; ++c) {
        const std::vector<float>& values = table.channels[c].values;
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (!ofMiddle || i % columns == columns / 2) full[c] = std::max(full[c], values[i]);
        }
        full[c] = std::max(full[c], 1e-20f);
    }
    return full;
}

void paint(Plot& plot, const ShownTable& table, const std::array<float, 3>& full) {
    for (std::size_t i = 0; i < table.channels[0].values.size(); ++i) {
        const auto of = [&](std::size_t c) { return coded(table.channels[c].values[i] / full[c]); };
        plot.map->colours.push_back({of(0), of(1), of(2)});
    }
}

/// Three lobes as red, green and blue.
Plot lobes(const ShownTable& table, bool ofMiddle) {
    Plot plot = mapPlot(table);
    const std::array<float, 3> full = fullOf(table, ofMiddle);
    paint(plot, table, full);
    const auto& names = table.channels;
    plot.note = fmt::format("Full red is {} = {:.3g}, green {} = {:.3g}, blue {} = {:.3g}.", names[0].name,
                            full[0], names[1].name, full[1], names[2].name, full[2]);
    return plot;
}

/// A colour as itself.
Plot coloured(const ShownTable& table) {
    Plot plot = mapPlot(table);
    std::array<float, 3> full = fullOf(table, false);
    full.fill(std::ranges::max(full));
    paint(plot, table, full);
    plot.note = fmt::format("White is {:.3g}.", full[0]);
    return plot;
}

Plot valued(const ShownTable& table, std::size_t channel, const char* title) {
    Plot plot = mapPlot(table);
    plot.title = title;
    const std::vector<float>& values = table.channels[channel].values;
    plot.map->values.assign(values.begin(), values.end());
    plot.map->colour.title = table.channels[channel].name;
    plot.map->colour.low = 0;
    return plot;
}

ShownTable longitudinalTable(const char* name, const Table& table) {
    const std::vector<double> sines = placesOf(table.width, -1, 1);
    return shownTable(name, table, "sin θ_i", "sin θ_o", sines, sines,
                      {{0, "M_R"}, {1, "M_TT"}, {2, "M_TRT"}, {3, "2|θ_d|/π"}});
}

}  // namespace

Result<Shown> marschnerTables(const ShownHair& hair) {
    const shading::MarschnerParameters model = fibreOf(hair, render::ShadingModel::marschner).marschner;
    const shading::MarschnerTables baked = bakeMarschner(shading::Marschner(model), kSizes);
    const std::vector<double> cosines = placesOf(kSizes.azimuth, -1, 1);
    const std::vector<double> differences = placesOf(kSizes.inclination, 0, 1);
    Shown shown;
    shown.tables.push_back(longitudinalTable("Marschner: M cos θ_i / cos²θ_d", baked.longitudinal));
    shown.tables.push_back(shownTable("Marschner: N_TT and N_R", baked.transmitted, "cos φ", "2|θ_d|/π",
                                      cosines, differences,
                                      {{0, "N_TT red"}, {1, "N_TT green"}, {2, "N_TT blue"}, {3, "N_R"}}));
    shown.tables.push_back(shownTable("Marschner: N_TRT", baked.reflected, "cos φ", "2|θ_d|/π", cosines,
                                      differences,
                                      {{0, "N_TRT red"}, {1, "N_TRT green"}, {2, "N_TRT blue"}}));
    shown.plots = {lobes(shown.tables[0], true), valued(shown.tables[1], 3, "Marschner: N_R"),
                   coloured(shown.tables[1]), coloured(shown.tables[2])};
    shown.plots[2].title = "Marschner: N_TT";
    shown.parameters = parametersOf(model);
    return shown;
}

Result<Shown> sadeghiTables(const ShownHair& hair) {
    const shading::SadeghiParameters model = fibreOf(hair, render::ShadingModel::sadeghi).sadeghi;
    const shading::SadeghiTables baked = bakeSadeghi(model, kSizes);
    Shown shown;
    shown.tables.push_back(longitudinalTable("Sadeghi: M' cos θ_i / cos²θ_d", baked.longitudinal));
    shown.tables.push_back(shownTable("Sadeghi: N'", baked.azimuthal, "cos φ", "glint: 0 nearest, 1 farthest",
                                      placesOf(kSizes.azimuth, -1, 1), placesOf(kSizes.inclination, 0, 1),
                                      {{0, "N'_R"}, {1, "N'_TT"}, {2, "N'_TRT"}}));
    shown.plots = {lobes(shown.tables[0], true), lobes(shown.tables[1], false)};
    shown.parameters = parametersOf(model);
    return shown;
}

}  // namespace hairloom
