// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <vector>

#include "cli/advice_report.h"
#include "cli/documents.h"
#include "cli/error_report.h"
#include "cli/groom_comparison.h"
#include "cli/job.h"
#include "core/base/file.h"
#include "core/base/log.h"
#include "core/geometry/selection.h"
#include "core/groom/file/project_file.h"
#include "hairloom/asset.h"

namespace hairloom::cli {
namespace {

Report attributeNames(const AttributeSet& attributes) {
    Report names = Report::array();
    for (const auto& [name, data] : attributes.all())
        names.push_back(name + ": " + std::string(typeName(data)));
    return names;
}

Report scalpReport(const Groom& groom) {
    return Report{{"vertices", groom.scalp->vertexCount()},
                  {"triangles", groom.scalp->triangleCount()},
                  {"groups", groom.scalp->groupNames()},
                  {"materials", groom.scalp->materialNames()},
                  {"selected_triangles", groom.scalpSelection.size()},
                  {"selected_area_cm2", selectionArea(*groom.scalp, groom.scalpSelection) * 1e4},
                  {"character", groom.characterFile}};
}

/// Files that the project names and that are not there.
Report missingFiles(const std::string& path, const Groom& groom) {
    Report rows = Report::array();
    std::error_code code;
    if (groom.characterFile.empty() || std::filesystem::exists(groom.characterFile, code)) return rows;
    const std::string fix = "put it next to the project, or set it: set GROOM --character FILE -o GROOM";
    log::warning("{}: its head file {} was not found, so skeleton and clips are missing; {}", path,
                 groom.characterFile, fix);
    rows.push_back(Report{{"what", "character"}, {"file", groom.characterFile}, {"fix", fix}});
    return rows;
}

/// What an asset for games has that a groom has not; null for other files.
Result<Report> assetReport(const std::string& path) {
    const auto bytes = readFile(path);
    if (!bytes) return tl::unexpected(bytes.error());
    const auto opened = runtime::Asset::open(*bytes);
    if (!opened.asset) return Report(nullptr);
    const runtime::Asset& asset = *opened.asset;
    Report sections = Report::array();
    for (const runtime::AssetSection& section : asset.sections())
        sections.push_back(
            {{"kind", std::string(section.kind)}, {"records", section.count}, {"bytes", section.bytes}});
    Report clip(nullptr);
    if (const runtime::asset::Clip* const found = asset.clip())
        clip = Report{{"name", std::string(asset.text(found->name))},
                      {"frames", found->frames},
                      {"fps", found->framesPerSecond},
                      {"loops", found->loops != 0},
                      {"bytes", asset.clipPlaces().size_bytes() + asset.clipFrames().size()},
                      {"max_error_mm", 1e3 * static_cast<double>(found->largestError)}};
    Report poses = Report::array();
    for (const runtime::asset::Pose& pose : asset.poses())
        poses.push_back({{"name", std::string(asset.text(pose.name))},
                         {"amount", pose.amount},
                         {"partial", pose.weights > 0}});
    return Report{{"version", fmt::format("{}.{}", asset.major(), asset.minor())},
                  {"bytes", asset.bytes()},
                  {"follow_hairs", asset.hairCount()},
                  {"bones", asset.bones.size()},
                  {"greatest_error_mm", asset.greatestError() * 1e3},
                  {"clip", std::move(clip)},
                  {"poses", std::move(poses)},
                  {"sections", std::move(sections)}};
}

Result<Report> info(const std::string& path, const std::string& unit) {
    const auto opened = openAny(path, unit);
    if (!opened) return tl::unexpected(opened.error());
    const Groom& groom = opened->groom;
    Report report;
    report["strands"] = groom.strandCount();
    report["points"] = groom.pointCount();
    report["guides"] = groom.guideCount();
    report["spheres"] = groom.spheres.size();
    const Box3f bounds = groom.strandCount() > 0 || !groom.scalp ? groom.bounds() : groom.scalp->bounds();
    report["bounds"] = bounds.isEmpty()
                           ? Report(nullptr)
                           : Report{{"min", toReport(bounds.min())}, {"max", toReport(bounds.max())}};
    report["format"] = opened->format;
    report["version"] = opened->format == "hairloom" ? Report(kProjectVersion) : Report(nullptr);
    report["strand_attributes"] = attributeNames(groom.strandAttributes);
    report["point_attributes"] = attributeNames(groom.pointAttributes);
    if (opened->format == kAssetFormat) {
        const auto asset = assetReport(path);
        if (!asset) return tl::unexpected(asset.error());
        report["asset"] = *asset;
    }
    report["advice"] = adviceReport(groom, runtime::kUsualFrame);
    if (groom.scalp) report["scalp"] = scalpReport(groom);
    report["missing"] = missingFiles(path, groom);
    return report;
}

JobRun declare(CLI::App& job) {
    struct Options {
        std::string file, unit;
        std::vector<std::string> versions;
    };
    const auto options = std::make_shared<Options>();
    job.add_option("file", options->file, "Project, hair file or mesh");
    job.add_option(
           "--diff", options->versions,
           "Two files instead: lists what changed from the first to the second. Strands are matched by their "
           "ids, else by order or roots")
        ->expected(2);
    addUnitOption(job, options->unit);
    return [options](const std::string&) {
        if (options->file.empty() == options->versions.empty())
            throw WrongUsage(options->file.empty() ? "no file is given" : "a file is given beside --diff",
                             "expected FILE, or --diff A B");
        if (options->versions.empty()) return info(options->file, options->unit);
        return compareFiles(options->versions[0], options->versions[1], options->unit);
    };
}

}  // namespace

Job infoJob() {
    return {"info", "Summarise a project, hair file or mesh, or compare two", "hair.hairloom --json",
            declare};
}

}  // namespace hairloom::cli
