// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "cli/documents.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "core/base/content_kind.h"
#include "core/base/log.h"
#include "core/documents/hair_blend.h"
#include "core/editing/document.h"
#include "core/groom/file/project_file.h"

namespace hairloom::cli {
namespace {

struct BlendOptions {
    std::string input, with, output, map = "none", formula;
    bool invert = false;
    BlendSettings settings;
};

std::vector<std::string> mapsOfMasks() {
    const auto map = std::ranges::find(scriptMaskFields(), std::string_view("map"),
                                       [](const FieldRow& row) { return std::string_view(row.info.name); });
    return {map->info.choices.begin(), map->info.choices.end()};
}

Result<Mask> maskOf(const BlendOptions& options) {
    nlohmann::json mask{{"map", options.map}, {"invert", options.invert}};
    if (!options.formula.empty()) mask["formula"] = options.formula;
    const nlohmann::json json{{"mask", std::move(mask)}};
    JsonReader reader(json, "");
    Mask read = readMask(reader);
    if (auto status = reader.status(); !status) return tl::unexpected(status.error());
    return read;
}

Result<Report> run(const BlendOptions& options) {
    auto groom = openGroom(options.input);
    if (!groom) return tl::unexpected(groom.error());
    BlendSettings settings = options.settings;
    const auto mask = maskOf(options);
    if (!mask) return tl::unexpected(mask.error());
    settings.mask = *mask;
    editing::Document document(std::move(*groom));
    auto blend = blendWithFile(document.model(), options.with, settings);
    if (!blend) return tl::unexpected(blend.error());
    document.perform(std::move(blend->command));
    const std::size_t strands = document.groom().strandCount(), matched = blend->shape.matched;
    if (matched < strands)
        log::warning("{}: {} of {} strands stay as they are: no hair of {} grows within {} mm of their roots",
                     options.input, strands - matched, strands, options.with,
                     readableDecimal(1e3f * settings.reach));
    if (auto saved = saveProject(document.groom(), options.output); !saved)
        return tl::unexpected(saved.error());
    return Report{{"strands", strands},
                  {"matched", matched},
                  {"farthest_root_mm", 1e3 * static_cast<double>(blend->shape.farthest)},
                  {"operators", document.groom().operators.size()},
                  {"output", options.output}};
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<BlendOptions>();
    job.add_option("groom", options->input, "Hair to change")->required();
    job.add_option("--with", options->with, "Project or hair file with the other shape, on the same head")
        ->required();
    job.add_option("--weight", options->settings.weight,
                   "Share of the way: 0 changes nothing, 1 is the other shape")
        ->check(CLI::Range(0.0, 1.0));
    job.add_option("--reach", options->settings.reach,
                   "Distance between roots in metres within which the other hair counts")
        ->check(CLI::Range(0.0001, 0.5));
    job.add_option("--mask", options->map, "Painted map that limits the effect")
        ->check(CLI::IsMember(mapsOfMasks()));
    job.add_flag("--invert", options->invert, "Invert the map");
    job.add_option("--formula", options->formula, "Formula that limits the effect, as of operators");
    job.add_option("-o,--output", options->output, "Project to write")->required();
    return [options](const std::string&) {
        return withOutputs({{options->output, content::kProject}}, [&] { return run(*options); });
    };
}

}  // namespace

Job blendJob() {
    return {"blend", "Blend the shape of a hairstyle with another on the same head",
            "bob.hairloom --with bob-wet.abc --weight 0.3 -o bob2.hairloom", declare};
}

}  // namespace hairloom::cli
