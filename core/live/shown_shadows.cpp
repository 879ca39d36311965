// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/live/groom_scene.h"
#include "core/live/shown_parts.h"
#include "core/render/light_probe.h"
#include "core/render/tone_map.h"
#include "core/software/device.h"

namespace hairloom {
namespace {

constexpr std::uint32_t kMostTexels = 256;  // along a side: what a chart can show
constexpr std::size_t kInColour = 3;        // layers in the colours of one chart

std::vector<double> middles(std::uint32_t side) {
    std::vector<double> places;
    for (std::uint32_t i = 0; i < side; ++i) places.push_back((i + 0.5) / side);
    return places;
}

ShownTable tableOf(const char* name, const char* layer, const render::OpacityTexels& texels) {
    ShownTable table{name, "across the light's view", "up", middles(texels.side), middles(texels.side), {}};
    for (std::uint32_t l = 0; l < texels.layers; ++l) {
        ShownTable::Channel channel{fmt::format("{} {}", layer, l + 1), {}};
        for (std::uint32_t row = texels.side; row-- > 0;) {
            for (std::uint32_t x = 0; x < texels.side; ++x)
                channel.values.push_back(
                    texels.fibres[(std::size_t{row} * texels.side + x) * texels.layers + l]);
        }
        table.channels.push_back(std::move(channel));
    }
    return table;
}

/// Light that is left behind each of three layers as red, green and blue: where the last alone has hair it is
/// yellow, where the last two have it red.
Plot lightBehind(const ShownTable& table, std::size_t first, const char* layer) {
    const std::size_t last = std::min(first + kInColour, table.channels.size());
    Plot plot;
    const bool one = first + 1 == last;
    plot.title = one ? fmt::format("{}, {} {}", table.name, layer, last)
                     : fmt::format("{}, {}s {} to {}", table.name, layer, first + 1, last);
    plot.x = {.title = table.xName, .low = 0.0, .high = 1.0};
    plot.y = {.title = table.yName, .low = 0.0, .high = 1.0};
    plot.map = FilledMap{cellEdges(table.x, Scale::Linear), cellEdges(table.y, Scale::Linear), {}};
    for (std::size_t i = 0; i < table.x.size() * table.y.size(); ++i) {
        float fibres = 0;
        for (std::size_t l = 0; l < first; ++l) fibres += table.channels[l].values[i];
        std::array<std::uint8_t, 3> colour{};
        for (std::size_t c = 0; c < kInColour; ++c) {
            if (first + c < last) fibres += table.channels[first + c].values[i];
            colour[c] = render::toByte(render::encodeSrgb(std::exp(-0.5f * fibres)));
        }
        plot.map->colours.push_back({colour[0], colour[1], colour[2]});
    }
    const char* const colours[] = {"red", "green", "blue"};
    for (std::size_t l = first; l < last && !one; ++l)
        plot.note += fmt::format("{}behind {} {} {}", l == first ? "Light is shown " : ", ", layer, l + 1,
                                 l == first ? "in red" : std::string("in ") + colours[l - first]);
    if (!one) plot.note += ".";
    return plot;
}

Result<Shown> shownMap(const ShownHair& hair, render::Shadows kind, const char* name, const char* layer) {
    if (!hair.groom || hair.groom->strandCount() == 0)
        return fail("there is no hair whose shadow map could be drawn", "a groom with strands");
    auto groom = GroomScene::make(*hair.groom, hair.view, {});
    if (!groom) return tl::unexpected(groom.error());
    render::RenderScene scene = groom->scene();
    scene.camera =
        hair.view.camera.value_or(render::frame(render::View::ThreeQuarter, groom->subject(), 1.0f));
    scene.lights = hair.view.hasLights ? hair.view.lights : render::studioLights(scene.camera);
    std::erase_if(scene.lights, [](const render::Light& light) { return !light.castsShadow; });
    if (scene.lights.size() > 1) scene.lights.resize(1);
    render::RenderOptions options = hair.shadows;
    options.shadows = kind;
    options.shadowResolution = std::min(options.shadowResolution, kMostTexels);
    const auto device = software::makeDevice();
    const auto texels = render::readOpacity(*device, scene, options);
    if (!texels) return tl::unexpected(texels.error());
    Shown shown;
    shown.tables.push_back(tableOf(name, layer, *texels));
    for (std::size_t first = 0; first < texels->layers; first += kInColour)
        shown.plots.push_back(lightBehind(shown.tables[0], first, layer));
    shown.parameters = {{"layers", {static_cast<double>(texels->layers)}},
                        {"texels", {static_cast<double>(texels->side)}}};
    return shown;
}

}  // namespace

Result<Shown> deepOpacityMap(const ShownHair& hair) {
    return shownMap(hair, render::Shadows::deepOpacity, "Deep opacity map", "layer");
}

Result<Shown> opacityMaps(const ShownHair& hair) {
    return shownMap(hair, render::Shadows::opacityMaps, "Opacity maps", "slice");
}

}  // namespace hairloom
