// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <optional>
#include <tuple>

#include "cli/documents.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "core/base/content_kind.h"
#include "core/base/stopwatch.h"
#include "core/documents/mask_image.h"
#include "core/editing/document.h"
#include "core/editing/mask_commands.h"
#include "core/editing/selection_commands.h"
#include "core/editing/stack_commands.h"
#include "core/groom/file/operators_json.h"
#include "core/groom/file/project_file.h"
#include "core/groom/mask_names.h"
#include "core/operations/curl_class.h"
#include "core/operations/mask.h"
#include "core/operations/stack_file.h"

namespace hairloom::cli {
namespace {

struct StackOptions {
    std::string input;
    std::string from;
    std::string add;
    std::string curl;
    std::string keep;
    std::string layer;  ///< name; empty: all
    std::string maskImage;
    std::string regionsImage;
    std::string mask;  ///< name or number; empty: one that is free
    std::string output;
    std::optional<std::size_t> at, solo, duplicate, remove, only;
    bool bake = false;
};

/// The mask that --mask names; nothing where it does not.
Result<std::optional<std::uint32_t>> askedMask(const StackOptions& options, const Groom& groom) {
    if (options.mask.empty()) return std::optional<std::uint32_t>();
    const auto number = findMask(groom, options.mask);
    if (!number) return tl::unexpected(inFile(number.error(), options.input));
    return std::optional<std::uint32_t>(*number);
}

/// Masks that have a name or paint.
Report maskRows(const Groom& groom) {
    Report rows = Report::array();
    for (std::uint32_t number = 1; number <= kPaintedMasks; ++number) {
        const auto painted = groom.strandAttributes.view<float>(maskAttribute(number));
        const auto strands = std::ranges::count_if(painted, [](float share) { return share > 0; });
        const bool isNamed = number <= groom.maskNames.size() && !groom.maskNames[number - 1].empty();
        if (strands == 0 && !isNamed) continue;
        rows.push_back(Report{{"mask", number}, {"name", maskName(groom, number)}, {"strands", strands}});
    }
    return rows;
}

/// A mask for each colour of the image, and what is in which.
Result<Report> fillRegions(const StackOptions& options, editing::Document& document) {
    const editing::Model& model = document.model();
    const auto image = MaskImage::read(options.regionsImage);
    if (!image) return tl::unexpected(image.error());
    const auto regions = regionsAtRoots(*image, model.groom);
    if (!regions) return tl::unexpected(inFile(regions.error(), options.regionsImage));
    const auto first = askedMask(options, model.groom);
    if (!first) return tl::unexpected(first.error());
    const auto numbers = editing::masksFor(model.groom, regions->size(), first->value_or(0));
    if (!numbers) return tl::unexpected(inFile(numbers.error(), options.regionsImage));
    std::vector<std::vector<float>> values;
    Report filled = Report::array();
    for (std::size_t i = 0; i < regions->size(); ++i) {
        const ColourRegion& region = (*regions)[i];
        filled.push_back(Report{{"colour", region.name},
                                {"rgb", fmt::format("#{:06x}", region.rgb)},
                                {"mask", (*numbers)[i]},
                                {"strands", region.strands}});
        values.push_back(region.shares);
    }
    document.perform(editing::fillMasks(model, "Regions from image", *numbers, values,
                                        namesOfRegions(model.groom, *numbers, *regions)));
    return filled;
}

/// What images were read into.
struct Filled {
    std::optional<std::uint32_t> mask;
    std::optional<Report> regions;
};

/// The steps that the options ask for, in the order of the help.
Status perform(const StackOptions& options, editing::Document& document, Filled& filled) {
    const auto step = [&](editing::StackCommand command, const std::string& file = {}) -> Status {
        if (!command) return tl::unexpected(file.empty() ? command.error() : inFile(command.error(), file));
        document.perform(std::move(*command));
        return {};
    };
    const editing::Model& model = document.model();
    if (!options.maskImage.empty()) {
        const auto image = MaskImage::read(options.maskImage);
        if (!image) return tl::unexpected(image.error());
        const auto values = valuesAtRoots(*image, model.groom);
        if (!values) return tl::unexpected(inFile(values.error(), options.input));
        const auto asked = askedMask(options, model.groom);
        if (!asked) return tl::unexpected(asked.error());
        const auto number = *asked ? Result<std::uint32_t>(**asked) : editing::freeMask(model.groom);
        if (!number) return tl::unexpected(inFile(number.error(), options.input));
        document.perform(editing::setMask(model, *number, *values));
        filled.mask = *number;
    }
    if (!options.regionsImage.empty()) {
        auto regions = fillRegions(options, document);
        if (!regions) return tl::unexpected(regions.error());
        filled.regions = std::move(*regions);
    }
    if (!options.from.empty()) {
        auto operators = loadOperators(options.from);
        if (!operators) return tl::unexpected(operators.error());
        if (auto done = step(editing::setOperators(model, std::move(*operators), "Operators"), options.from);
            !done)
            return done;
    }
    if (const CurlClass* curl = findCurlClass(options.curl)) {
        if (auto done = step(editing::setOperators(model, withCurl(model.groom.operators, *curl), "Curl"),
                             options.input);
            !done)
            return done;
    }
    if (!options.add.empty()) {
        auto operators = loadOperators(options.add);
        if (!operators) return tl::unexpected(operators.error());
        const std::size_t at = options.at.value_or(model.groom.operators.size());
        if (auto done =
                step(editing::addOperators(model, at, std::move(*operators), "Add operators"), options.add);
            !done)
            return done;
    }
    if (options.duplicate) {
        if (auto done = step(editing::copyOperator(model, *options.duplicate)); !done) return done;
    }
    if (options.remove) {
        if (auto done = step(editing::removeOperator(model, *options.remove)); !done) return done;
    }
    if (options.solo) {
        if (auto done = step(editing::soloOperator(model, *options.solo)); !done) return done;
    }
    return options.bake ? step(editing::bakeOperators(model)) : Status{};
}

Result<Report> edit(const StackOptions& options, Groom groom) {
    const Stopwatch watch;
    editing::Document document(std::move(groom));
    Filled filled;
    if (auto done = perform(options, document, filled); !done) return tl::unexpected(done.error());
    if (auto saved = saveProject(document.groom(), options.output); !saved)
        return tl::unexpected(saved.error());
    Report report{{"operators", toJson(document.groom().operators)}, {"masks", maskRows(document.groom())}};
    if (filled.mask) report["mask"] = *filled.mask;
    if (filled.regions) report["regions"] = std::move(*filled.regions);
    report["seconds"] = watch.seconds();
    report["output"] = options.output;
    return report;
}

Result<Report> run(const StackOptions& options) {
    auto groom = openGroom(options.input);
    if (!groom) return tl::unexpected(groom.error());
    if (!options.output.empty()) return edit(options, std::move(*groom));
    std::vector<Operator> shown = groom->operators;
    if (!options.layer.empty()) {
        const auto layer = std::ranges::find(groom->layers, options.layer, &Layer::name);
        if (layer == groom->layers.end())
            return failIn(options.input, {}, fmt::format("no layer is called '{}'", options.layer),
                          "list them with the job `layers`");
        const auto number = static_cast<std::uint32_t>(layer - groom->layers.begin()) + 1;
        std::erase_if(shown,
                      [&](const Operator& one) { return layerOf(one) != 0 && layerOf(one) != number; });
    }
    if (options.only) {
        if (*options.only >= shown.size())
            return failIn(options.input, {}, fmt::format("operator {} does not exist", *options.only),
                          fmt::format("there are {} operators", shown.size()));
        shown = {shown[*options.only]};
    }
    Report report{{"operators", toJson(shown)}, {"masks", maskRows(*groom)}};
    if (!options.keep.empty()) {
        if (auto kept = saveOperators(options.keep, shown); !kept) return tl::unexpected(kept.error());
        report["kept"] = options.keep;
    }
    return report;
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<StackOptions>();
    job.add_option("groom", options->input, "Groom")->required();
    auto* output = job.add_option("-o,--output", options->output, "Project to write");
    auto* from = job.add_option(
        "--from", options->from,
        "Replaces the operators with those of this file, as printed by --json (docs/formats/script.md)");
    auto* bake =
        job.add_flag("--bake", options->bake, "Bake: apply all operators permanently and clear the stack");
    auto* add = job.add_option("--add", options->add, "Adds the operators of such a file or of a preset");
    job.add_option("--curl", options->curl,
                   "Adds the operators of a class of curl, in place of those of another: see create --curl")
        ->check(CLI::IsMember(curlNames()))
        ->needs(output);
    job.add_option("--at", options->at,
                   "Position of added operators: before this one, from 0 (default: at the end)")
        ->needs(add);
    for (auto [name, number, help] :
         {std::tuple{"--duplicate", &options->duplicate, "Operator to duplicate, counted from 0"},
          std::tuple{"--remove", &options->remove, "Operator to remove"},
          std::tuple{"--solo", &options->solo,
                     "Solo: applies only this operator. Repeat it to apply all again"}})
        job.add_option(name, *number, help)->needs(output);
    add->needs(output);
    job.add_option("--layer", options->layer, "Lists only operators of the layer with this name")
        ->excludes(output);
    job.add_option("--only", options->only, "Lists only this operator")->excludes(output);
    job.add_option(
           "--keep", options->keep,
           "File for the listed operators, for --from, --add and the editor's presets. Sculpts are left out")
        ->excludes(output);
    auto* image = job.add_option("--mask-image", options->maskImage,
                                 "PNG whose values at the root UVs become a mask of operators");
    image->needs(output);
    auto* regions = job.add_option("--regions-image", options->regionsImage,
                                   "PNG of flat colours: each colour at the root UVs becomes a mask");
    regions->needs(output)->excludes(image);
    auto* number =
        job.add_option("--mask", options->mask,
                       "Name or number of that mask, or of the mask of the first region (default: unused "
                       "ones). Names: set masks.1=NAME");
    job.final_callback([number, image, regions, options] {
        if (number->count() > 0 && image->count() + regions->count() == 0)
            throw CLI::RequiresError("--mask", "--mask-image or --regions-image");
        const bool isNumber =
            std::ranges::all_of(options->mask, [](unsigned char c) { return std::isdigit(c); });
        if (const auto found = findMask(Groom(), options->mask); number->count() > 0 && isNumber && !found)
            throw CLI::ValidationError("--mask", found.error().problem + "; " + found.error().expected);
    });
    from->needs(output);
    bake->needs(output);
    return [options](const std::string&) {
        return withOutputs({{options->output, content::kProject}, {options->keep, content::kJson}},
                           [&] { return run(*options); });
    };
}

}  // namespace

Job stackJob() {
    return {"stack", "List, set, copy, solo or bake the operators of a groom", "hair.hairloom --json",
            declare};
}

}  // namespace hairloom::cli
