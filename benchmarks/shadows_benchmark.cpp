// SPDX-License-Identifier: GPL-3.0-or-later
// How far shadow maps of hair are from fibres counted on the CPU, by kind, layers and resolution; and those
// of the head on hair from rays; with memory and times of the former.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "benchmarks/benchmark.h"
#include "core/charts/plot.h"
#include "core/cost/head_scene.h"
#include "core/render/opacity_layers.h"
#include "core/render/picture.h"
#include "core/render/plan.h"
#include "core/render/shadow_truth.h"

namespace hairloom::benchmarks {
namespace {

using render::Shadows;

constexpr std::uint32_t kTimed = 1024;  // pixels

struct Kind {
    std::string name;
    render::RenderOptions options;
    std::optional<render::DeepLayers> layers = {};  ///< in place of those of the options
    bool inFigure = true;
};

Kind deepOpacity(std::string name, const render::DeepLayers& layers,
                 render::ShadowFilter filter = render::ShadowFilter::three) {
    Kind kind{std::move(name), {}, layers};
    kind.options.shadowFilter = filter;
    return kind;
}

Kind layered(std::uint32_t layers, render::LayerEnds ends, const char* named, float growth = 2) {
    Kind kind{fmt::format("deep opacity, {} layers, {}", layers, named), {}, {}};
    kind.options.shadowLayers = layers;
    kind.options.layerEnds = ends;
    kind.options.layerGrowth = growth;
    return kind;
}

Kind sliced(std::uint32_t slices) {
    Kind kind{fmt::format("opacity maps, {} slices", slices), {}, {}};
    kind.options.shadows = Shadows::opacityMaps;
    kind.options.shadowSlices = slices;
    return kind;
}

Kind noded(std::uint32_t nodes) {
    Kind kind{fmt::format("adaptive, {} nodes", nodes), {}, {}};
    kind.options.shadows = Shadows::adaptive;
    kind.options.shadowNodes = nodes;
    return kind;
}

/// Ends of layers as parts of the depth that hair takes up. Layers that end where the next begins are none.
std::vector<Kind> kinds() {
    using render::LayerEnds, render::ShadowFilter;
    std::vector<Kind> all{deepOpacity("deep opacity, 1 layer", {0.9998f, 0.9999f, 1.0f}),
                          deepOpacity("deep opacity, 2 layers (0.1, 1)", {0.1f, 0.9999f, 1.0f}),
                          deepOpacity("deep opacity, 3 layers (0.02, 0.08, 1)", {0.02f, 0.08f, 1.0f}),
                          deepOpacity("deep opacity, 3 layers (0.04, 0.14, 1)", {0.04f, 0.14f, 1.0f}),
                          deepOpacity("deep opacity, 3 layers (0.08, 0.25, 1)", {0.08f, 0.25f, 1.0f}),
                          deepOpacity("deep opacity, 3 layers (0.15, 0.4, 1)", {0.15f, 0.4f, 1.0f}),
                          layered(3, LayerEnds::linear, "linear"),
                          deepOpacity("deep opacity, 3 layers (0.04, 0.14, 1), no filter",
                                      {0.04f, 0.14f, 1.0f}, ShadowFilter::off),
                          deepOpacity("deep opacity, 3 layers (0.04, 0.14, 1), 5 × 5 texels",
                                      {0.04f, 0.14f, 1.0f}, ShadowFilter::five)};
    for (const std::uint32_t layers : {7u, 11u}) {
        all.push_back(layered(layers, LayerEnds::early, "early"));
        all.push_back(layered(layers, LayerEnds::linear, "linear"));
        all.push_back(layered(layers, LayerEnds::growing, "growing by 1.5", 1.5f));
        all.push_back(layered(layers, LayerEnds::growing, "growing by 2", 2));
    }
    for (Kind& kind : all) {
        const bool isUsual = kind.layers == render::DeepLayers{0.04f, 0.14f, 1.0f};
        kind.inFigure = kind.layers ? isUsual : kind.options.layerEnds != LayerEnds::growing;
    }
    for (const std::uint32_t slices : {4u, 8u, 16u}) all.push_back(sliced(slices));
    for (const std::uint32_t nodes : {4u, 8u, 16u}) all.push_back(noded(nodes));
    Kind absorption{"absorption by depth", {}, {}};
    absorption.options.shadows = Shadows::absorption;
    all.push_back(absorption);
    return all;
}

struct HeadKind {
    const char* name;
    float absorption;  ///< 1/m
};
constexpr HeadKind kHeadKinds[] = {{"test of depth", 0},
                                   {"absorption, 100 a metre", 100},
                                   {"absorption, 300 a metre", 300},
                                   {"absorption, 1000 a metre", 1000},
                                   {"absorption, 3000 a metre", 3000}};

struct ShadowRow {
    std::string name;
    /// Root mean square of the transmittance, by resolution; not a number where the device has no buffer for
    /// it.
    std::vector<double> errors;
    bool inFigure = true;
    std::uint32_t bytes = 0;  ///< of a texel
    double milliseconds = 0;  ///< that maps and what looks them up take at kTimed²; 0: not measured
};

struct ShadowBench {
    std::string device;
    std::size_t hairs = 0, points = 0;
    double fibres = 0;  ///< mean of those counted
    std::vector<std::uint32_t> resolutions;
    std::vector<ShadowRow> rows;
    double visible = 0;               ///< share of the points that the head does not shade
    std::vector<ShadowRow> headRows;  ///< of the head's shadow on hair
};

/// Hair combed down around a head that is not there.
render::RenderScene sceneOf(const scenes::CombedStrands& hair) {
    render::RenderScene scene;
    render::RenderStrands strands;
    strands.offsets = hair.offsets;
    strands.positions_ws = hair.positions;
    strands.radii = hair.radii;
    scene.strands = {strands};
    render::Light light;
    light.toLight_ws = Vec3f(0.4f, 0.8f, 0.45f);
    scene.lights = {light};
    return scene;
}

Status measureHead(gpu::Device& device, render::RenderScene scene, ShadowBench& bench) {
    const scenes::HeadSkin head(48, 72);
    render::RenderMesh mesh;
    mesh.positions_ws = head.points;
    mesh.indices = head.indices;
    scene.meshes = {mesh};
    const render::HeadCases cases = castRays(scene, bench.points, 8);
    bench.visible = std::accumulate(cases.visible.begin(), cases.visible.end(), 0.0) /
                    static_cast<double>(cases.visible.size());
    for (const HeadKind& kind : kHeadKinds) {
        ShadowRow row{kind.name, {}};
        for (const std::uint32_t resolution : bench.resolutions) {
            const auto error = headShadowError(device, scene, cases, kind.absorption, resolution);
            if (!error) return tl::unexpected(error.error());
            row.errors.push_back(*error);
        }
        bench.headRows.push_back(std::move(row));
    }
    return {};
}

/// The first hair's depth, and the layers.
std::uint32_t bytesOf(const render::RenderOptions& options) {
    const bool first = options.shadows == Shadows::deepOpacity || options.shadows == Shadows::absorption;
    return 4 * ((first ? 1 : 0) + render::opacityWords(options.shadows, render::layerCount(options)));
}

/// Of the passes that make maps and that look them up, for a frame; median.
Result<double> timeOf(gpu::Device& device, const render::RenderScene& scene, render::RenderOptions options,
                      std::size_t repeats) {
    options.width = options.height = kTimed;
    options.shadowResolution = kTimed;
    options.frames = 1;
    std::vector<double> times;
    for (std::size_t i = 0; i <= repeats; ++i) {
        const auto picture = render::renderPicture(device, scene, options);
        if (!picture) return tl::unexpected(picture.error());
        double sum = 0;
        for (const gpu::PassTime& pass : picture->passes) {
            for (const render::Pass one :
                 {render::Pass::firstHair, render::Pass::opacity, render::Pass::shade})
                if (pass.name == render::passName(one)) sum += pass.milliseconds;
        }
        if (i > 0) times.push_back(sum);  // the first compiles
    }
    std::ranges::sort(times);
    return times[times.size() / 2];
}

Report rowsOf(const std::vector<ShadowRow>& all) {
    Report rows = Report::array();
    for (const ShadowRow& row : all) {
        Report one{{"name", row.name}, {"errors", row.errors}};
        if (row.bytes > 0) one["bytes_per_texel"] = row.bytes;
        if (row.bytes > 0) one["ms"] = row.milliseconds;
        rows.push_back(std::move(one));
    }
    return rows;
}

std::string tableOf(const std::vector<std::uint32_t>& resolutions, const std::vector<ShadowRow>& rows) {
    std::string text = "| map |";
    for (const std::uint32_t resolution : resolutions) text += fmt::format(" {}² |", resolution);
    const bool priced = !rows.empty() && rows.front().bytes > 0;
    if (priced) text += " bytes a texel | ms |";
    text += "\n|---|";
    for (std::size_t i = 0; i < resolutions.size() + (priced ? 2 : 0); ++i) text += "---|";
    text += "\n";
    for (const ShadowRow& row : rows) {
        text += fmt::format("| {} |", row.name);
        for (const double error : row.errors)
            text += std::isnan(error) ? " – |" : fmt::format(" {:.3f} |", error);
        if (priced) text += fmt::format(" {} | {:.3f} |", row.bytes, row.milliseconds);
        text += "\n";
    }
    return text;
}

Result<ShadowBench> measureAll(const Options& options) {
    gpu::DeviceOptions wanted;
    wanted.index = options.device;
    const auto device = gpu::createDevice(wanted);
    if (!device) return tl::unexpected(device.error());
    constexpr std::uint32_t kHairs = 1500;
    const scenes::CombedStrands hair(kHairs);
    const render::RenderScene scene = sceneOf(hair);
    ShadowBench bench;
    bench.device = (*device)->info().name;
    bench.hairs = kHairs;
    bench.points = options.quick ? 100 : 600;
    bench.resolutions = {32, 64, 128, 256, 512, 1024, 2048};
    if (options.quick) bench.resolutions = {64, 128};
    const render::ShadowCases cases = countFibres(scene, bench.points, 8);
    bench.fibres = std::accumulate(cases.counted.begin(), cases.counted.end(), 0.0) /
                   static_cast<double>(cases.counted.size());
    const std::vector<Kind> all = kinds();
    for (const Kind& kind : all) {
        ShadowRow row{kind.name, {}};
        render::RenderOptions picture = kind.options;
        for (const std::uint32_t resolution : bench.resolutions) {
            picture.shadowResolution = resolution;
            const bool has = render::layerCount(picture) > 0;
            if (has && render::layersThatFit(picture, (*device)->info()) < render::layerCount(picture)) {
                row.errors.push_back(std::numeric_limits<double>::quiet_NaN());
                continue;
            }
            const auto error = shadowError(**device, scene, cases, picture, kind.layers);
            if (!error) return tl::unexpected(error.error());
            row.errors.push_back(*error);
        }
        const auto time = timeOf(**device, scene, kind.options, options.quick ? 1 : 7);
        if (!time) return tl::unexpected(time.error());
        row.inFigure = kind.inFigure;
        row.milliseconds = *time;
        row.bytes = bytesOf(kind.options);
        bench.rows.push_back(std::move(row));
        if (options.progress) options.progress("shadow maps", bench.rows.size(), all.size());
    }
    if (auto measured = measureHead(**device, scene, bench); !measured)
        return tl::unexpected(measured.error());
    return bench;
}

Report reportOf(const ShadowBench& bench) {
    return Report{{"device", bench.device},           {"hairs", bench.hairs},
                  {"points", bench.points},           {"fibres", bench.fibres},
                  {"resolutions", bench.resolutions}, {"rows", rowsOf(bench.rows)},
                  {"visible", bench.visible},         {"head_rows", rowsOf(bench.headRows)}};
}

std::string markdownOf(const ShadowBench& bench, const std::string& command) {
    std::string text = fmt::format(
        "Root mean square error of the transmittance exp(−n/2) of {} points in {} hairs, against n counted "
        "along beams of\n"
        "{:.0f} mm across (mean n {:.2f}); bytes of a texel are those of the first hair's depth and of its "
        "layers, 16 bits each, or of nodes, 32 bits\n"
        "each, without the lists that these come from (12 bytes a piece of hair in a texel).\n"
        "Times are of maps of {}², of the same hair, and of looking them up. {}. `{}`\n\n",
        bench.points, bench.hairs, 2000 * render::kShadowFootprint, bench.fibres, kTimed, bench.device,
        command);
    text += tableOf(bench.resolutions, bench.rows);
    text += fmt::format(
        "\nThe head on hair: root mean square error of what it leaves of the light, against rays ({:.0f} % "
        "of "
        "the points see\nthe light).\n\n",
        100 * bench.visible);
    return text + tableOf(bench.resolutions, bench.headRows);
}

std::string figureOf(const ShadowBench& bench) {
    Plot plot;
    plot.title = "Shadow maps of hair against counted fibres";
    plot.note = fmt::format("{} points in {} hairs, beams of {:.0f} mm across", bench.points, bench.hairs,
                            2000 * render::kShadowFootprint);
    std::vector<double> sides(bench.resolutions.begin(), bench.resolutions.end());
    plot.x = {.title = "resolution along a side", .scale = Scale::Logarithmic, .ticks = ticksAt(sides)};
    plot.y = {.title = "error of the transmittance", .low = 0};
    for (const ShadowRow& row : bench.rows) {
        if (!row.inFigure) continue;
        const bool isDeep = row.name.starts_with("deep"), isAdaptive = row.name.starts_with("adaptive");
        Series series{.name = row.name,
                      .marker = isDeep       ? Marker::Circle
                                : isAdaptive ? Marker::TriangleUp
                                             : Marker::Square,
                      .line = isDeep || isAdaptive ? LineStyle::Solid : LineStyle::Dashed};
        for (std::size_t i = 0; i < sides.size(); ++i) {
            if (!std::isnan(row.errors[i])) series.points.push_back({sides[i], row.errors[i]});
        }
        plot.series.push_back(std::move(series));
    }
    return svg(plot);
}

Result<Outcome> runShadows(const Options& options) {
    const auto bench = measureAll(options);
    if (!bench) return tl::unexpected(bench.error());
    return Outcome{
        reportOf(*bench),
        {},
        {{"shadows.md", markdownOf(*bench, options.commandLine)}, {"shadows.svg", figureOf(*bench)}}};
}

}  // namespace

Benchmark shadowsBenchmark() {
    return {"shadows",
            "errors of shadow maps against counted fibres",
            {"--quick", "--device", "--output"},
            runShadows};
}

}  // namespace hairloom::benchmarks
