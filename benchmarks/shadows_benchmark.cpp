// SPDX-License-Identifier: GPL-3.0-or-later
// How far shadow maps of hair are from fibres counted on the CPU, by kind, layers and resolution; and those
// of the head on hair from rays. Errors, not times.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "benchmarks/benchmark.h"
#include "core/charts/plot.h"
#include "core/cost/head_scene.h"
#include "core/render/shadow_truth.h"

namespace hairloom::benchmarks {
namespace {

using render::Shadows;

struct Kind {
    const char* name;
    Shadows shadows;
    render::DeepLayers layers;
    render::ShadowFilter filter = render::ShadowFilter::three;
};
// Ends of layers as parts of the depth that hair takes up. Layers that end where the next begins are none.
constexpr Kind kKinds[] = {
    {"deep opacity, 1 layer", Shadows::deepOpacity, {0.9998f, 0.9999f, 1.0f}},
    {"deep opacity, 2 layers (0.1, 1)", Shadows::deepOpacity, {0.1f, 0.9999f, 1.0f}},
    {"deep opacity, 3 layers (0.02, 0.08, 1)", Shadows::deepOpacity, {0.02f, 0.08f, 1.0f}},
    {"deep opacity, 3 layers (0.04, 0.14, 1)", Shadows::deepOpacity, {0.04f, 0.14f, 1.0f}},
    {"deep opacity, 3 layers (0.08, 0.25, 1)", Shadows::deepOpacity, {0.08f, 0.25f, 1.0f}},
    {"deep opacity, 3 layers (0.15, 0.4, 1)", Shadows::deepOpacity, {0.15f, 0.4f, 1.0f}},
    {"deep opacity, 3 equal layers", Shadows::deepOpacity, {0.3333f, 0.6667f, 1.0f}},
    {"deep opacity, 3 layers (0.04, 0.14, 1), no filter",
     Shadows::deepOpacity,
     {0.04f, 0.14f, 1.0f},
     render::ShadowFilter::off},
    {"deep opacity, 3 layers (0.04, 0.14, 1), 5 × 5 texels",
     Shadows::deepOpacity,
     {0.04f, 0.14f, 1.0f},
     render::ShadowFilter::five},
    {"opacity maps, 4 equal layers", Shadows::opacityMaps, {}},
    {"absorption by depth", Shadows::absorption, {}},
};

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
    std::vector<double> errors;  ///< root mean square of the transmittance, by resolution
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

Report rowsOf(const std::vector<ShadowRow>& all) {
    Report rows = Report::array();
    for (const ShadowRow& row : all) rows.push_back(Report{{"name", row.name}, {"errors", row.errors}});
    return rows;
}

std::string tableOf(const std::vector<std::uint32_t>& resolutions, const std::vector<ShadowRow>& rows) {
    std::string text = "| map |";
    for (const std::uint32_t resolution : resolutions) text += fmt::format(" {}² |", resolution);
    text += "\n|---|";
    for (std::size_t i = 0; i < resolutions.size(); ++i) text += "---|";
    text += "\n";
    for (const ShadowRow& row : rows) {
        text += fmt::format("| {} |", row.name);
        for (const double error : row.errors) text += fmt::format(" {:.3f} |", error);
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
    for (const Kind& kind : kKinds) {
        ShadowRow row{kind.name, {}};
        for (const std::uint32_t resolution : bench.resolutions) {
            const auto error =
                shadowError(**device, scene, cases, kind.shadows, resolution, kind.layers, kind.filter);
            if (!error) return tl::unexpected(error.error());
            row.errors.push_back(*error);
        }
        bench.rows.push_back(std::move(row));
        if (options.progress) options.progress("shadow maps", bench.rows.size(), std::size(kKinds));
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
        "{:.0f} mm across (mean n {:.2f}); maps of one RGBA16 texture but absorption, which has none. {}. "
        "`{}`\n\n",
        bench.points, bench.hairs, 2000 * render::kShadowFootprint, bench.fibres, bench.device, command);
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
        const bool isDeep = row.name.starts_with("deep");
        Series series{.name = row.name,
                      .marker = isDeep ? Marker::Circle : Marker::Square,
                      .line = isDeep ? LineStyle::Solid : LineStyle::Dashed};
        for (std::size_t i = 0; i < sides.size(); ++i) series.points.push_back({sides[i], row.errors[i]});
        plot.series.push_back(std::move(series));
    }
    return svg(plot);
}

Result<Outcome> run(const Options& options) {
    const auto bench = measureAll(options);
    if (!bench) return tl::unexpected(bench.error());
    return Outcome{
        reportOf(*bench),
        {},
        {{"shadows.md", markdownOf(*bench, options.commandLine)}, {"shadows.svg", figureOf(*bench)}}};
}

}  // namespace

Benchmark shadowsBenchmark() {
    return {
        "shadows", "errors of shadow maps against counted fibres", {"--quick", "--device", "--output"}, run};
}

}  // namespace hairloom::benchmarks
