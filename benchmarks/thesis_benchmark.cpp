// SPDX-License-Identifier: GPL-3.0-or-later
// The thesis' Section 7 and Table 2 on this machine, as a page beside its own numbers.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "benchmarks/gpu_sim.h"
#include "benchmarks/sim.h"
#include "core/documents/sample.h"
#include "core/documents/sample_material.h"
#include "core/gpu/device.h"
#include "core/live/groom_scene.h"
#include "core/render/png.h"
#include "core/shading/kajiya_kay.h"
#include "core/simulation/simulation.h"
#include "core/software/device.h"
#include "importers/child_process.h"

namespace hairloom::benchmarks {
namespace {

/// Table 2: R_O(l)_Max by exponent, from 1 on, as printed.
constexpr double kPrinted[] = {19.7392, 15.5031, 13.1595, 11.6274, 10.5276, 9.68946, 8.02364,
                               8.47828, 8.02101, 7.63045, 7.29183, 6.99458, 6.73092, 6.49497,
                               6.28219, 6.08903, 6.91265, 5.75075, 5.60146, 5.46321, 5.33472};

Report tableTwo() {
    Report rows = Report::array();
    for (std::size_t i = 0; i < std::size(kPrinted); ++i) {
        const double ours = shading::kajiyaReflectance(static_cast<double>(i + 1));
        rows.push_back(
            {{"name", fmt::format("Table 2, exponent {}", i + 1)}, {"value", ours}, {"thesis", kPrinted[i]}});
    }
    return rows;
}

std::string tableTwoText() {
    std::string text =
        "\n## Table 2\n\nThe greatest share R_O of light that Kajiya and Kay's highlight sends out, by its "
        "exponent: Eq. 31 in closed form, then what is printed, and the printed number over the right one. "
        "Printed is π² times the integral of sin^m over 0 … π in place of 2 times that of sin^(m + 2), with "
        "a wrong first digit at 7 and 17.\n\n"
        "| exponent | R_O | thesis | ratio |\n|---|---|---|---|\n";
    for (std::size_t i = 0; i < std::size(kPrinted); ++i) {
        const double ours = shading::kajiyaReflectance(static_cast<double>(i + 1));
        text += fmt::format("| {} | {:.5f} | {} | {:.3f} |\n", i + 1, ours, kPrinted[i], kPrinted[i] / ours);
    }
    return text;
}

struct Drawn {
    std::string name, words;
    std::vector<std::byte> png;
    double milliseconds = 0;  ///< that a frame of simulation takes
};

struct Shot {
    const char *name, *sample, *material, *words;
    double seconds;
    Vec3f wind;
};
constexpr float kFrame = runtime::kUsualFrame;

/// A sample in wind, after some time of it.
Result<Drawn> draw(const Shot& shot, gpu::Device& device, std::uint32_t side) {
    const auto folder = findSamples(programFolder());
    auto groom = makeSample(folder, shot.sample);
    if (!groom) return tl::unexpected(groom.error());
    if (*shot.material) {
        if (auto applied = applyMaterial(folder, shot.material, *groom); !applied)
            return tl::unexpected(applied.error());
    }
    const Vec3f& wind = shot.wind;
    groom->simulation.windSpeed = wind.norm();
    groom->simulation.windDirection = {wind.x() / wind.norm(), wind.y() / wind.norm(),
                                       wind.z() / wind.norm()};
    const auto motion = makeRigidMotion("none", *groom);
    if (!motion) return tl::unexpected(motion.error());
    auto simulation = Simulation::make(*groom, (*motion)->poseAt(0));
    if (!simulation) return tl::unexpected(simulation.error());
    const int frames = static_cast<int>(std::lround(shot.seconds / static_cast<double>(kFrame)));
    for (int f = 1; f <= frames; ++f)
        simulation->step(kFrame, (*motion)->poseAt(static_cast<float>(f) * kFrame));
    auto scene = GroomScene::make(*groom, {}, {});
    if (!scene) return tl::unexpected(scene.error());
    scene->pose(simulation->positions_ws(), simulation->velocities_ws(),
                (*motion)->poseAt(static_cast<float>(frames) * kFrame));
    render::RenderScene drawn = scene->scene();
    drawn.camera = render::frame(render::View::ThreeQuarter, scene->subject(), 1.0f);
    drawn.lights = render::studioLights(drawn.camera);
    render::RenderOptions options;
    options.width = options.height = side;
    const auto picture = render::renderPicture(device, drawn, options);
    if (!picture) return tl::unexpected(picture.error());
    auto png = render::encodePng(picture->image);
    if (!png) return tl::unexpected(png.error());
    return Drawn{shot.name, shot.words, std::move(*png), simulation->stats().millisecondsPerFrame};
}

std::string bytesAsText(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Result<Outcome> runThesis(const Options& options) {
    std::size_t done = 0;
    const auto stepForward = [&] {
        if (options.progress) options.progress("measuring", ++done, 4);
    };
    Outcome outcome;
    outcome.report = Report{{"name", "thesis"}, {"rows", tableTwo()}};
    std::string page = fmt::format("# The thesis' tables and figures\n\nWritten by `{}`. Processor: {}.\n",
                                   options.commandLine, thisMachine().processor);
    page += tableTwoText();
    const auto columns = measureThesisCosts(options.repetitions.value_or(5), options.quick ? 0.02 : 0.2);
    page += thesisTable(columns);
    for (const ThesisCosts& column : columns) {
        for (std::size_t i = 0; i < kFamilies.size(); ++i) {
            if (column.measured[i].median() == 0) continue;  // rods solve all forces at once
            Report row = rowOf(column.measured[i]);
            if (column.model == runtime::StrandModel::springs) row["thesis"] = column.printed[i];
            outcome.report["rows"].push_back(std::move(row));
        }
        outcome.report["rows"].push_back(rowOf(column.whole));
    }
    stepForward();

    page +=
        "\n## Figures 25 and 26\n\nFigure 25a is a photograph, and 26a took its authors 44 seconds. "
        "These are 25b and 26b.\n\n";
    const std::unique_ptr<gpu::Device> processor = software::makeDevice();
    for (const Shot& shot :
         {Shot{"figure-25.png", "long", "", "Long hair in wind", 2, Vec3f(2.5f, 0, 1.5f)},
          Shot{"figure-26.png", "shoulder", "fire", "Hair of fire", 1, Vec3f(0.5f, 2.5f, 0)}}) {
        auto drawn = draw(shot, *processor, options.quick ? 128 : 720);
        if (!drawn) return tl::unexpected(drawn.error());
        page += fmt::format("![{}]({})\n{}: {:.2f} ms of simulation a frame.\n\n", drawn->words, drawn->name,
                            drawn->words, drawn->milliseconds);
        outcome.report["rows"].push_back(
            {{"name", drawn->name}, {"value", drawn->milliseconds}, {"unit", "ms"}});
        outcome.files.emplace_back(drawn->name, bytesAsText(drawn->png));
        stepForward();
    }

    page += "## Figure 27\n\n";
    Options measuring = options;
    measuring.strands = options.quick ? std::vector<std::uint32_t>{100, 300}
                                      : std::vector<std::uint32_t>{100, 300, 1000, 3000};
    if (const auto graph = measureFigure27(measuring); graph) {
        outcome.files.emplace_back("figure-27.svg", figureOf(*graph));
        outcome.report["figure_27"] = reportOf(*graph);
        page +=
            "The thesis' graphs of the GPU (GTX 560 Ti) and the CPU cross at about 1,000 guides.\n\n"
            "![Figure 27](figure-27.svg)\n";
    } else {
        page += fmt::format("No device drew it: {}.\n", graph.error().message());
    }
    page += "\n## Figure 28\n\nA photograph of a fibre by an electron microscope, which no program makes.\n";
    stepForward();
    outcome.files.insert(outcome.files.begin(), {"thesis.md", std::move(page)});
    return outcome;
}

}  // namespace

Benchmark thesisBenchmark() {
    return {"thesis",
            "the thesis' tables and figures on this machine",
            {"--quick", "--device", "--output"},
            runThesis};
}

}  // namespace hairloom::benchmarks
