// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <memory>

#include "cli/documents.h"
#include "cli/error_report.h"
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
#include "core/groom/spheres.h"
#include "core/simulation/scene_input.h"

namespace hairloom::cli {
namespace {

struct CollidersOptions {
    std::string input;
    std::string fit;
    double error = 1;  // mm
    std::size_t kilobytes = kMostBodyBytes / 1000;
    std::uint32_t count = 0;  // of spheres; 0: as few as --error takes
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

/// As many as were asked for, else as few as come as close as was asked for, but not more than a fit may
/// have; joined in capsules where these are wanted.
Status fitFewSpheres(Groom& groom, const Actor* actor, const CollidersOptions& options, Report& report) {
    if (!groom.scalp)
        return failIn(options.input, {}, "there is no head to fit spheres to",
                      "expected a groom on a head: create, or import --mesh");
    editing::SphereFitOptions wanted;
    if (options.near > 0) wanted.region = editing::facesNearHair(groom, static_cast<float>(options.near));
    const auto error = static_cast<float>(1e-3 * options.error);
    for (wanted.count = options.count > 0 ? options.count : 4;;
         wanted.count = std::min(2 * wanted.count, editing::kMaxSpheres)) {
        auto fit = editing::fitSpheres(*groom.scalp, wanted);
        if (!fit) return tl::unexpected(inFile(fit.error(), options.input));
        if (actor) attachSpheres(*actor, fit->spheres);
        if (options.fit == "capsules") {
            editing::joinSpheres(*groom.scalp, wanted.region, error, fit->spheres);
            *fit = editing::measureSpheres(*groom.scalp, wanted.region, std::move(fit->spheres));
        }
        if (options.count == 0 && fit->worstGap > error && wanted.count < editing::kMaxSpheres) continue;
        addFit(report, *fit);
        Report notes = Report::array();
        if (options.count == 0 && fit->worstGap > error)
            notes.push_back("more spheres than a fit may have would be needed. Use --fit field");
        for (const Report& note : notes) log::warning("{}", note.get<std::string>());
        report["notes"] = std::move(notes);
        groom.spheres = editing::spheresOfParts(groom.spheres);
        appendSpheres(groom.spheres, fit->spheres);
        return {};
    }
}

/// What hair meets, a row for each capsule, each sphere that is the end of none, and each bone that moves
/// skin; without bones the whole head moves it.
Report rowsOf(const Groom& groom) {
    Report rows = Report::array();
    const auto ofSkin = skinSpheresOf(groom);
    const auto isOfSkin = [&](std::size_t s) { return !ofSkin.empty() && ofSkin[s] != 0; };
    const auto bone = [](const std::string& name) { return name.empty() ? Report(nullptr) : Report(name); };
    const auto rowOf = [&](const char* kind, const CollisionSphere& sphere) {
        return Report{{"kind", kind},
                      {"name", sphere.name},
                      {"bone", bone(sphere.bone)},
                      {"centre", {sphere.centre.x(), sphere.centre.y(), sphere.centre.z()}},
                      {"radius", sphere.radius}};
    };
    std::vector<bool> isEnd(groom.spheres.size());
    for (const auto& [first, second] : capsulesOf(groom.spheres)) {
        isEnd[first] = isEnd[second] = true;
        Report row = rowOf("capsule", groom.spheres[first]);
        row["end"] = rowOf("sphere", groom.spheres[second]);
        row["end"].erase("kind");
        row["of_skin"] = isOfSkin(first) && isOfSkin(second);
        rows.push_back(std::move(row));
    }
    for (std::size_t s = 0; s < groom.spheres.size(); ++s) {
        if (isEnd[s]) continue;
        rows.push_back(rowOf("sphere", groom.spheres[s]));
        rows.back()["of_skin"] = isOfSkin(s);
    }
    if (!groom.body) return rows;
    if (groom.body->bones.empty()) rows.push_back(Report{{"kind", "field"}, {"bone", nullptr}});
    for (const auto& name : groom.body->bones)
        rows.push_back(Report{{"kind", "field"}, {"bone", bone(std::string(name))}});
    return rows;
}

/// How far the skin of the head and what hair meets are apart: of the field, else of the spheres near hair.
void measureColliders(const Groom& groom, const CollidersOptions& options, Report& report) {
    report["worst_gap_mm"] = report["worst_bulge_mm"] = nullptr;
    if (!groom.scalp || (!groom.body && groom.spheres.empty())) return;
    constexpr double kMm = 1000;
    if (groom.body) {
        const BodyFit fit = measureBody(*groom.scalp, *groom.body);
        report["worst_gap_mm"] = kMm * static_cast<double>(fit.worstGap);
        report["mean_gap_mm"] = kMm * static_cast<double>(fit.meanGap);
        report["worst_bulge_mm"] = kMm * static_cast<double>(fit.worstBulge);
        return;
    }
    FaceSet near;
    if (options.near > 0) near = editing::facesNearHair(groom, static_cast<float>(options.near));
    addFit(report, editing::measureSpheres(*groom.scalp, near, groom.spheres));
}

Result<Report> listColliders(const CollidersOptions& options) {
    const auto groom = openGroom(options.input);
    if (!groom) return tl::unexpected(groom.error());
    Report report;
    measureColliders(*groom, options, report);
    report["colliders"] = rowsOf(*groom);
    report["spheres"] = groom->spheres.size();
    report["capsules"] = capsulesOf(groom->spheres).size();
    report["body"] = groom->body != nullptr;
    return report;
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
    if (options.fit == "spheres" || options.fit == "capsules")
        fitted = fitFewSpheres(*groom, actor->get(), options, report);
    if (options.fit == "none") groom->body.reset();
    if (!fitted) return tl::unexpected(fitted.error());
    if (!options.output.empty()) {
        if (auto saved = saveProject(*groom, options.output); !saved) return tl::unexpected(saved.error());
    }
    report["fit"] = options.fit;
    report["colliders"] = rowsOf(*groom);
    report["spheres"] = groom->spheres.size();
    report["capsules"] = capsulesOf(groom->spheres).size();
    report["body"] = groom->body != nullptr;
    report["seconds"] = watch.seconds();
    if (!options.output.empty()) report["output"] = options.output;
    return report;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<CollidersOptions>();
    job.add_option("groom", options->input, "Groom on a head")->required();
    CLI::Option* fit =
        job.add_option(
               "--fit", options->fit,
               "What hair collides with: field bakes the skin of the head, capsules and spheres replace "
               "the fitted ones, none removes the baked skin. Without it, colliders are listed and "
               "measured")
            ->check(CLI::IsMember({"field", "capsules", "spheres", "none"}));
    job.add_option("--error", options->error, "Skin may lie this far outside the colliders, in millimetres")
        ->check(CLI::Range(0.1, 100.0))
        ->needs(fit);
    job.add_option("--kilobytes", options->kilobytes,
                   "With --fit field: the most that it may take. More is finer at ears and other thin parts")
        ->check(CLI::Range(50, 10'000))
        ->needs(fit);
    job.add_option("--count", options->count,
                   "With --fit spheres or capsules: this number of spheres, in place of as few as --error "
                   "takes")
        ->check(CLI::Range(1u, editing::kMaxSpheres))
        ->needs(fit);
    job.add_option("--near", options->near,
                   "Spheres and capsules are fitted and measured to skin within this distance of hair, in "
                   "metres. 0 uses "
                   "all of it")
        ->check(CLI::Range(0.0, 10.0));
    job.add_option("--character", options->character,
                   "File with the skeleton that moves the colliders, if other than the scalp's file")
        ->needs(fit);
    job.add_option("-o,--output", options->output,
                   "Project to write. Without it, a fit is measured and not kept")
        ->needs(fit);
    return [options](const std::string&) {
        if (options->fit.empty()) return listColliders(*options);
        if (options->count > 0 && options->fit != "spheres" && options->fit != "capsules")
            throw WrongUsage("--count counts spheres", "expected it with --fit spheres or --fit capsules");
        return withOutputs({{options->output, content::kProject}}, [&] { return fitColliders(*options); });
    };
}

}  // namespace

Job collidersJob() {
    return {"colliders", "List what hair collides with, or fit it to the head",
            "hair.hairloom --fit field --error 1 -o hair.hairloom", declare};
}

}  // namespace hairloom::cli
