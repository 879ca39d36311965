// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "cli/documents.h"
#include "cli/job.h"
#include "core/groom/project_file.h"

namespace hairloom::cli {
namespace {

struct SpheresOptions {
    std::string input;
    std::string from;
    bool replace = false;
    std::string output;
};

Result<Report> placeSpheres(const SpheresOptions& options) {
    auto groom = loadDocument(options.input);
    if (!groom) return tl::unexpected(groom.error());
    const auto spheres = readSpheres(options.from);
    if (!spheres) return tl::unexpected(spheres.error());
    if (options.replace) groom->spheres.clear();
    groom->spheres.insert(groom->spheres.end(), spheres->begin(), spheres->end());
    if (auto saved = saveProject(*groom, options.output); !saved) return tl::unexpected(saved.error());
    return Report{{"added", spheres->size()}, {"spheres", groom->spheres.size()}, {"output", options.output}};
}

}  // namespace

void addSpheresJob(Jobs& jobs) {
    const auto options = std::make_shared<SpheresOptions>();
    CLI::App& job =
        jobs.add("spheres", "Place collision spheres", "hair.hairloom --from spheres.json -o hair.hairloom",
                 [options] { return placeSpheres(*options); });
    job.add_option("groom", options->input, "Groom to add them to")->required();
    job.add_option("--from", options->from,
                   R"(JSON list of {"name", "centre": [x, y, z], "radius", "bone"}, metres)")
        ->required();
    job.add_flag("--replace", options->replace, "Remove the spheres that are there");
    job.add_option("-o,--output", options->output, "Project to write")->required();
}

}  // namespace hairloom::cli
