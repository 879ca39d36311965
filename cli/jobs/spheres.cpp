// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <memory>

#include "cli/documents.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "cli/sphere_report.h"
#include "core/base/content_kind.h"
#include "core/documents/body_fit.h"
#include "core/editing/sphere_parts.h"
#include "core/groom/file/project_file.h"
#include "core/groom/spheres.h"

namespace hairloom::cli {
namespace {

struct SpheresOptions {
    std::string input;
    std::string from;
    std::uint32_t fit = 0;
    double near = 0.08;
    std::string character;
    std::uint64_t seed = 1;
    bool replace = false;
    std::string output;
};

Result<std::vector<CollisionSphere>> fitted(const Groom& groom, const SpheresOptions& options,
                                            Report& report) {
    if (!groom.scalp)
        return failIn(options.input, {}, "there is no head to fit spheres to",
                      "expected a groom on a head: create, or import --mesh");
    editing::SphereFitOptions wanted;
    wanted.count = options.fit;
    wanted.seed = options.seed;
    if (options.near > 0) wanted.region = editing::facesNearHair(groom, static_cast<float>(options.near));
    auto fit = editing::fitSpheres(*groom.scalp, wanted);
    if (!fit) return tl::unexpected(inFile(fit.error(), options.input));
    const auto actor = actorForColliders(options.character, groom);
    if (!actor) return tl::unexpected(actor.error());
    if (*actor) attachSpheres(**actor, fit->spheres);
    report["on_bones"] =
        std::ranges::count_if(fit->spheres, [](const auto& one) { return !one.bone.empty(); });
    addFit(report, *fit);
    return std::move(fit->spheres);
}

Result<Report> placeSpheres(const SpheresOptions& options) {
    auto groom = openGroom(options.input);
    if (!groom) return tl::unexpected(groom.error());
    Report report;
    const auto spheres = options.fit > 0 ? fitted(*groom, options, report) : readSpheres(options.from);
    if (!spheres) return tl::unexpected(spheres.error());
    if (options.replace) {
        groom->spheres =
            options.fit > 0 ? editing::spheresOfParts(groom->spheres) : std::vector<CollisionSphere>{};
    }
    appendSpheres(groom->spheres, *spheres);
    if (auto saved = saveProject(*groom, options.output); !saved) return tl::unexpected(saved.error());
    report["added"] = spheres->size();
    report["spheres"] = groom->spheres.size();
    report["output"] = options.output;
    return report;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<SpheresOptions>();
    job.add_option("groom", options->input, "Groom to add spheres to")->required();
    CLI::App& source = *job.add_option_group("source");
    source.add_option(
        "--from", options->from,
        R"(JSON list of {"name", "centre": [x, y, z], "radius", "bone"}, metres. "joined", the number in )"
        R"(the list of another sphere, from 0, makes a tapered capsule with it)");
    source.add_option("--fit", options->fit, "Fit this number of spheres to the skin near the hair")
        ->check(CLI::Range(1, 64));
    source.require_option(1);
    job.add_option("--near", options->near,
                   "With --fit: skin within this distance of hair counts, in metres. 0 uses all of it")
        ->check(CLI::Range(0.0, 10.0));
    job.add_option("--character", options->character,
                   "With --fit: file with the skeleton for the spheres, if other than the scalp's file");
    job.add_option("--seed", options->seed, "With --fit: random seed of the points on the skin");
    job.add_flag("--replace", options->replace,
                 "Remove existing spheres. With --fit, those of colliding groups stay (create)");
    job.add_option("-o,--output", options->output, "Project to write")->required();
    return [options](const std::string&) {
        return withOutputs({{options->output, content::kProject}}, [&] { return placeSpheres(*options); });
    };
}

}  // namespace

Job spheresJob() {
    return {"spheres", "Add collision spheres", "hair.hairloom --from spheres.json -o hair.hairloom",
            declare};
}

}  // namespace hairloom::cli
