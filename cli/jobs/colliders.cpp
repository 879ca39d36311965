// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <memory>

#include "cli/documents.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "cli/sphere_report.h"
#include "core/base/content_kind.h"
#include "core/base/log.h"
#include "core/base/stopwatch.h"
#include "core/documents/body_fit.h"
#include "core/editing/sphere_fit.h"
#include "core/editing/sphere_parts.h"
#include "core/groom/file/project_file.h"

namespace hairloom::cli {
namespace {

struct CollidersOptions {
    std::string input;
    std::string fit;
    double error = 1;  // mm
    std::size_t kilobytes = kMostBodyBytes / 1000;
    double near = 0.08;
    std::string character;
    std::string output;
};

Status fitField(Groom& groom, const Actor* actor, const CollidersOptions& options, Report& report) {
    auto baked = fitBody(groom, actor, static_cast<float>(1e-3 * options.error), 1000 * options.kilobytes);
    if (!baked) return tl::unexpected(inFile(baked.error(), options.input));
    for (const std::string& note : baked->notes) log::warning("{}", note);
    constexpr double kMm = 1000;
    report["worst_gap_mm"] = kMm * static_cast<double>(baked->fit.worstGap);
    report["mean_gap_mm"] = kMm * static_cast<double>(baked->fit.meanGap);
    report["worst_bulge_mm"] = kMm * static_cast<double>(baked->fit.worstBulge);
    report["cell_mm"] = kMm * static_cast<double>(baked->cell);
    report["bytes"] = baked->field->bytes();
    report["bones"] = baked->field->bones;
    report["notes"] = baked->notes;
    groom.body = std::move(baked->field);
    return {};
}

/// As few as come as close as was asked for, but not more than a fit may have.
Status fitFewSpheres(Groom& groom, const Actor* actor, const CollidersOptions& options, Report& report) {
    if (!groom.scalp) return failIn(options.input, {}, "there is no head to fit spheres to");
    editing::SphereFitOptions wanted;
    if (options.near > 0) wanted.region = editing::facesNearHair(groom, static_cast<float>(options.near));
    const auto error = static_cast<float>(1e-3 * options.error);
    for (wanted.count = 4;; wanted.count = std::min(2 * wanted.count, editing::kMaxSpheres)) {
        auto fit = editing::fitSpheres(*groom.scalp, wanted);
        if (!fit) return tl::unexpected(inFile(fit.error(), options.input));
        if (fit->worstGap > error && wanted.count < editing::kMaxSpheres) continue;
        if (actor) attachSpheres(*actor, fit->spheres);
        addFit(report, *fit);
        Report notes = Report::array();
        if (fit->worstGap > error)
            notes.push_back("more spheres than a fit may have would be needed. Use --fit field");
        for (const Report& note : notes) log::warning("{}", note.get<std::string>());
        report["notes"] = std::move(notes);
        groom.spheres = editing::spheresOfParts(groom.spheres);
        groom.spheres.insert(groom.spheres.end(), fit->spheres.begin(), fit->spheres.end());
        return {};
    }
}

Result<Report> fitColliders(const CollidersOptions& options) {
    const Stopwatch watch;
    auto groom = openGroom(options.input);
    if (!groom) return tl::unexpected(groom.error());
    const auto actor = actorForColliders(options.character, *groom);
    if (!actor) return tl::unexpected(actor.error());
    Report report;
    Status fitted;
    if (options.fit == "field") fitted = fitField(*groom, actor->get(), options, report);
    if (options.fit == "spheres") fitted = fitFewSpheres(*groom, actor->get(), options, report);
    if (options.fit == "none") groom->body.reset();
    if (!fitted) return tl::unexpected(fitted.error());
    if (auto saved = saveProject(*groom, options.output); !saved) return tl::unexpected(saved.error());
    report["fit"] = options.fit;
    report["spheres"] = groom->spheres.size();
    report["body"] = groom->body != nullptr;
    report["seconds"] = watch.seconds();
    report["output"] = options.output;
    return report;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<CollidersOptions>();
    job.add_option("groom", options->input, "Groom on a head")->required();
    job.add_option("--fit", options->fit,
                   "What hair collides with: field bakes the skin of the head, spheres replaces the fitted "
                   "spheres, none removes the baked skin")
        ->required()
        ->check(CLI::IsMember({"field", "spheres", "none"}));
    job.add_option("--error", options->error, "Skin may lie this far outside the colliders, in millimetres")
        ->check(CLI::Range(0.1, 100.0));
    job.add_option("--kilobytes", options->kilobytes,
                   "With --fit field: the most that it may take. More is finer at ears and other thin parts")
        ->check(CLI::Range(50, 10'000));
    job.add_option(
           "--near", options->near,
           "With --fit spheres: skin within this distance of hair counts, in metres. 0 uses all of it")
        ->check(CLI::Range(0.0, 10.0));
    job.add_option("--character", options->character,
                   "File with the skeleton that moves the colliders, if other than the scalp's file");
    job.add_option("-o,--output", options->output, "Project to write")->required();
    return [options](const std::string&) {
        return withOutputs({{options->output, content::kProject}}, [&] { return fitColliders(*options); });
    };
}

}  // namespace

Job collidersJob() {
    return {"colliders", "Fit what hair collides with to the head",
            "hair.hairloom --fit field --error 1 -o hair.hairloom", declare};
}

}  // namespace hairloom::cli
