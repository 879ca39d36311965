// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/show_job.h"

#include <fmt/format.h>

#include "cli/backend.h"
#include "cli/documents.h"
#include "cli/error_report.h"
#include "cli/outputs.h"
#include "cli/vectors.h"
#include "core/documents/look_presets.h"
#include "core/documents/sample.h"
#include "core/documents/sample_material.h"
#include "core/live/shown.h"
#include "core/render/png.h"
#include "importers/child_process.h"

namespace hairloom::cli {
namespace {

constexpr std::pair<std::uint32_t, std::uint32_t> kUsualSize{1280, 860};

Result<std::pair<std::uint32_t, std::uint32_t>> sizeOf(const RenderJobOptions& options) {
    const auto size = options.size.empty() ? kUsualSize : orWrongUsage(parseSize(options.size));
    if (size.first < kMinShownWidth || size.second < kMinShownHeight ||
        std::uint64_t{size.first} * size.second > render::kMaxPixels) {
        return fail(fmt::format("a chart of {}x{} pixels", size.first, size.second),
                    fmt::format("--size from {}x{} to {} pixels in all", kMinShownWidth, kMinShownHeight,
                                render::kMaxPixels));
    }
    return size;
}

Result<ShownHair> hairOf(const RenderJobOptions& options) {
    ShownHair hair;
    if (!options.view.empty()) {
        auto read = readViewFile(options.view, {options.imageFolders.begin(), options.imageFolders.end()});
        if (!read) return tl::unexpected(read.error());
        hair.view = std::move(*read);
    }
    if (!options.shading.empty()) hair.view.fibre.model = kShadingModels.at(options.shading);
    hair.inclinationDegrees = options.inclination;
    Groom groom;
    if (!options.input.empty()) {
        auto opened = openGroom(options.input);
        if (!opened) return tl::unexpected(opened.error());
        groom = std::move(*opened);
    }
    if (const LookPreset* look = findLook(options.look)) {
        applyLook(*look, groom);
    } else if (auto status = applyLookOfView(options.view, hair.view.look, groom); !status) {
        return tl::unexpected(status.error());
    }
    if (!options.material.empty()) {
        const auto status = applyMaterial(findSamples(programFolder()), options.material, groom);
        if (!status) return tl::unexpected(status.error());
    }
    hair.material = groom.material;
    takeShadows(options, groom.shadows, hair.view, hair.shadows);
    hair.groom = std::make_shared<const Groom>(std::move(groom));
    return hair;
}

}  // namespace

Result<Report> showToFile(const RenderJobOptions& options) {
    const auto size = sizeOf(options);
    if (!size) return tl::unexpected(size.error());
    const auto hair = hairOf(options);
    if (!hair) return tl::unexpected(hair.error());
    const auto shown = show(*shownKind(options.show), *hair);
    if (!shown) return tl::unexpected(shown.error());
    ChartImage drawn = shownImage(*shown, size->first, size->second);
    const render::Image image{drawn.width, drawn.height, std::move(drawn.rgba)};
    if (auto written = render::writePng(options.output, image); !written)
        return tl::unexpected(written.error());
    Report report{{"show", options.show}};
    if (isReportJson()) report.update(shownNumbers(*shown));
    report["engine"] = "software";
    report["why"] = "charts and the maps in them are computed on the processor";
    report["output"] = options.output;
    return report;
}

}  // namespace hairloom::cli
