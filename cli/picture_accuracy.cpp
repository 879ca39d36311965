// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/picture_accuracy.h"

#include <optional>
#include <tuple>

#include "cli/accuracy_jobs.h"
#include "cli/backend.h"
#include "cli/documents.h"
#include "cli/error_report.h"
#include "cli/progress.h"
#include "cli/vectors.h"
#include "core/live/picture_cost_report.h"
#include "core/live/picture_shadows.h"
#include "core/live/view_file.h"

namespace hairloom::cli {
namespace {

Report rowsOf(const PictureCost& cost) {
    Report rows = Report::array();
    for (const PictureCostRun& run : cost.runs) {
        rows.push_back(Report{{"setting", run.setting},
                              {"value", run.value},
                              {"now", run.now},
                              {"ms", run.milliseconds.median},
                              {"ms_spread", toReport(run.milliseconds)},
                              {"flip", run.flip},
                              {"light", run.light}});
    }
    return rows;
}

}  // namespace

void addPictureAccuracyOptions(CLI::App& job, PictureAccuracyOptions& options) {
    auto* picture = job.add_flag("--picture", options.wanted,
                                 "Measure render settings instead of simulation settings: samples, shadows, "
                                 "curves, transparency, follow hairs");
    const auto add = [&](const char* name, auto& value, const char* does) {
        return job.add_option(name, value, does)->needs(picture);
    };
    add("--shading", options.shading, "Shading model (default: the project's)")
        ->check(CLI::IsMember(namesOf(kShadingModels)));
    add("--scatter", options.scatter,
        "Light scattered by other hairs (default: that of the view, or volume). Not for kajiya")
        ->check(CLI::IsMember(namesOf(kScatterings)));
    add("--size", options.size, "Image size WxH in pixels (default: that of the view, or 640x640)");
    add("--passes", options.frames, "Number of frames averaged in the compared images")
        ->check(CLI::Range(1, 1024));
    add("--hairs", options.hairs,
        "Maximum number of hairs to draw, 0 for all (default: all, and 2000 on a software device, which is "
        "slow)");
    job.add_option("--device", options.device, "GPU to render or simulate on, by its index in `devices`");
}

Result<Report> pictureAccuracy(const PictureAccuracyOptions& options, const std::string& groomFile,
                               const std::string& view, std::uint32_t repeats, const std::string& folder,
                               const std::string& commandLine) {
    PictureCostOptions measuring;
    if (!view.empty()) {
        auto read = readViewFile(view);
        if (!read) return tl::unexpected(read.error());
        measuring.view = std::move(*read);
    }
    if (!options.shading.empty()) measuring.view.fibre.model = kShadingModels.at(options.shading);
    if (!options.scatter.empty()) measuring.view.fibre.scattering = kScatterings.at(options.scatter);
    std::pair<std::uint32_t, std::uint32_t> size = measuring.view.size.value_or(std::pair(640u, 640u));
    if (!options.size.empty()) size = orWrongUsage(parseSize(options.size));
    std::tie(measuring.picture.width, measuring.picture.height) = size;
    measuring.picture.frames = options.frames;
    measuring.repeats = repeats;
    auto groom = openGroom(groomFile);
    if (!groom) return tl::unexpected(groom.error());
    takeShadows(groom->shadows, measuring.view, measuring.picture);
    const auto gpu = GpuBackend::make(std::nullopt, options.device);
    if (!gpu) return tl::unexpected(gpu.error());
    measuring.mostHairs = options.hairs.value_or(mostHairsOn((*gpu)->device()));
    std::optional<Progress> progress;
    measuring.progress = [&](std::size_t done, std::size_t total) {
        if (!progress) progress.emplace("drawing", total);
        progress->done(done);
    };
    const auto cost = measurePictureCost((*gpu)->device(), *groom, measuring);
    progress.reset();
    if (!cost) return tl::unexpected(cost.error());
    const auto files = writePictureCost(*cost, groomFile, commandLine, folder);
    if (!files) return tl::unexpected(files.error());
    return Report{{"device", cost->device}, {"hairs", cost->hairs},     {"all_hairs", cost->allHairs},
                  {"frames", cost->frames}, {"picture", rowsOf(*cost)}, {"notes", cost->notes},
                  {"output", folder},       {"files", *files}};
}

}  // namespace hairloom::cli
