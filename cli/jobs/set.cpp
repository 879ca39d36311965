// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <functional>
#include <memory>
#include <tuple>

#include "cli/advice_report.h"
#include "cli/documents.h"
#include "cli/error_report.h"
#include "cli/field_rows.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "core/base/content_kind.h"
#include "core/base/file.h"
#include "core/documents/hair_preset.h"
#include "core/documents/look_presets.h"
#include "core/documents/motions.h"
#include "core/documents/strand_values.h"
#include "core/groom/file/project_file.h"
#include "core/groom/file/settings_json.h"
#include "core/operations/full_head.h"
#include "hairloom/presets.h"
#include "hairloom/strands.h"

namespace hairloom::cli {
namespace {

struct SetOptions {
    std::string input;
    std::vector<std::string> assignments;
    std::string preset;
    std::string look;
    std::string from;
    std::string dyeImage;
    std::string dyeAttribute;
    std::string melaninImage;
    std::string melaninAttribute;
    std::string stiffnessImage;
    std::string stiffnessMask;
    std::string stiffnessAttribute;
    std::vector<float> stiffnessRange;
    bool evenStiffness = false;
    std::string character;
    std::string output;
    bool fill = false;
    bool list = false;
};

/// "simulation.windSpeed=4" into {"simulation": {"windSpeed": 4}}. A value that is no JSON is text.
void addAssignment(const std::string& assignment, nlohmann::json& document) {
    const std::size_t equals = assignment.find('=');
    const std::string path = assignment.substr(0, equals);
    if (equals == std::string::npos || path.find('.') == std::string::npos)
        throw WrongUsage(fmt::format("'{}' is not an assignment", assignment),
                         "expected SECTION.FIELD=VALUE");
    nlohmann::json* at = &document;
    std::size_t begin = 0;
    for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', begin)) {
        at = &(*at)[path.substr(begin, dot - begin)];
        begin = dot + 1;
        if (!at->is_null() && !at->is_object())
            throw WrongUsage(fmt::format("'{}' is part of another assignment", assignment),
                             "expected one of them");
    }
    const std::string text = assignment.substr(equals + 1);
    nlohmann::json value = nlohmann::json::parse(text, nullptr, false);
    if (value.is_discarded()) value = text;
    (*at)[path.substr(begin)] = std::move(value);
}

/// Fields in sections; null, which takes a material away, is one.
std::size_t fieldsIn(const nlohmann::json& document) {
    if (!document.is_object()) return 1;
    std::size_t count = 0;
    for (const auto& member : document) count += fieldsIn(member);
    return count;
}

/// Sections that are absent keep their values. Returns the number of fields that were given.
Result<std::size_t> apply(const nlohmann::json& document, const std::string& source, Groom& groom) {
    if (auto status = applySettings(document, source, groom); !status) return tl::unexpected(status.error());
    return fieldsIn(document);
}

/// Whether it is not this groom that is in the way, which may have no layer of that name.
bool isWrongForAnyGroom(const nlohmann::json& assignments) {
    Groom any;
    if (const auto layers = assignments.find("layers"); layers != assignments.end() && layers->is_object()) {
        for (const auto& [name, fields] : layers->items()) {
            any.layers.emplace_back();
            any.layers.back().name = name;
        }
    }
    return !applySettings(assignments, "", any);
}

std::size_t changedFields(const nlohmann::ordered_json& before, const nlohmann::ordered_json& after) {
    std::size_t count = 0;
    for (const auto& [name, value] : after.items()) count += before.at(name) == value ? 0 : 1;
    return count;
}

std::vector<std::string> presetNames() {
    std::vector<std::string> names;
    for (const runtime::HairPreset& preset : runtime::presets()) names.emplace_back(preset.name);
    return names;
}

Result<Report> set(const SetOptions& options) {
    if (!options.stiffnessRange.empty() && options.stiffnessImage.empty() && options.stiffnessMask.empty())
        throw WrongUsage("--stiffness-range has no image or mask",
                         "expected --stiffness-image or --stiffness-mask");
    auto groom = openGroom(options.input);
    if (!groom) return tl::unexpected(groom.error());
    std::size_t changed = 0;
    if (const runtime::HairPreset* preset = runtime::findPreset(options.preset))
        changed += applyPreset(*preset, *groom);
    if (const LookPreset* look = findLook(options.look)) {
        const nlohmann::ordered_json before = toJson(groom->material);
        applyLook(*look, *groom);
        changed += changedFields(before, toJson(groom->material));
    }
    if (options.fill) {
        const nlohmann::ordered_json before = toJson(groom->interpolation);
        if (auto status = fillHead(*groom); !status)
            return tl::unexpected(inFile(status.error(), options.input));
        changed += changedFields(before, toJson(groom->interpolation));
    }
    if (!options.from.empty()) {
        const auto text = readTextFile(options.from, kMaxJsonBytes);
        if (!text) return tl::unexpected(text.error());
        const auto document = parseJson(options.from, *text);
        if (!document) return tl::unexpected(document.error());
        const auto applied = apply(*document, options.from, *groom);
        if (!applied) return tl::unexpected(applied.error());
        changed += *applied;
    }
    nlohmann::json assignments = nlohmann::json::object();
    for (const std::string& assignment : options.assignments) addAssignment(assignment, assignments);
    const auto applied = apply(assignments, "", *groom);
    if (!applied && isWrongForAnyGroom(assignments)) throw WrongUsage(applied.error());
    if (!applied) return tl::unexpected(inFile(applied.error(), options.input));
    changed += *applied;
    StiffnessRange range;
    if (!options.stiffnessRange.empty()) range = {options.stiffnessRange[0], options.stiffnessRange[1]};
    const auto ranged = [&range](Status (*take)(const std::string&, const StiffnessRange&, Groom&)) {
        return [&range, take](const std::string& source, Groom& into) { return take(source, range, into); };
    };
    const std::tuple<const std::string&, std::function<Status(const std::string&, Groom&)>> sources[] = {
        {options.dyeImage, dyeFromImage},
        {options.dyeAttribute, dyeFromAttribute},
        {options.melaninImage, melaninFromImage},
        {options.melaninAttribute, melaninFromAttribute},
        {options.stiffnessImage, ranged(stiffnessFromImage)},
        {options.stiffnessMask, ranged(stiffnessFromMask)},
        {options.stiffnessAttribute, stiffnessFromAttribute}};
    for (const auto& [source, take] : sources) {
        if (source.empty()) continue;
        if (auto status = take(source, *groom); !status)
            return tl::unexpected(inFile(status.error(), options.input));
        ++changed;
    }
    if (options.evenStiffness) {
        changed += groom->strandAttributes.has(attribute::kStiffness) ? 1 : 0;
        groom->strandAttributes.erase(attribute::kStiffness);
    }
    if (!options.character.empty()) {
        // Read now, so that no project names what is no head.
        const auto actor = loadActor(options.character, *groom);
        if (!actor) return tl::unexpected(actor.error());
        groom->characterFile = options.character;
        ++changed;
    }
    if (auto saved = saveProject(*groom, options.output); !saved) return tl::unexpected(saved.error());
    return Report{{"changed", changed},
                  {"advice", adviceReport(*groom, runtime::kUsualFrame)},
                  {"output", options.output}};
}

Report presetRows() {
    Report rows = Report::array();
    for (const runtime::HairPreset& preset : runtime::presets()) {
        rows.push_back(
            Report{{"preset", preset.name},
                   {"fibre", preset.description},
                   {"diameter", preset.diameter},
                   {"eccentricity", preset.eccentricity},
                   {"bending_stiffness", runtime::bendingStiffness(preset.diameter, preset.eccentricity)},
                   {"curl", preset.curl},
                   {"colour", preset.colour}});
    }
    return rows;
}

Report lookRows() {
    Report rows = Report::array();
    for (const LookPreset& look : lookPresets())
        rows.push_back(Report{{"look", look.name}, {"hair", look.description}});
    return rows;
}

Result<Report> list() {
    Report rows = Report::array();
    for (const Section& section : settingsSections()) {
        for (Report& row : reportOf(section.fields, section.name + ".")) rows.push_back(std::move(row));
    }
    return Report{{"fields", std::move(rows)}, {"presets", presetRows()}, {"looks", lookRows()}};
}

void addStiffness(CLI::App& job, SetOptions& options) {
    auto* image = job.add_option("--stiffness-image", options.stiffnessImage,
                                 "PNG at the root UVs. Black and white stand for --stiffness-range");
    auto* mask = job.add_option("--stiffness-mask", options.stiffnessMask,
                                "Painted mask, by its name or number, in place of an image")
                     ->excludes(image);
    auto* attribute =
        job.add_option("--stiffness-attribute", options.stiffnessAttribute,
                       fmt::format("Strand attribute of numbers from 0 to {} that multiply the stiffness of "
                                   "the settings",
                                   runtime::kMostStiffness))
            ->excludes(image)
            ->excludes(mask);
    job.add_option("--stiffness-range", options.stiffnessRange,
                   "BLACK,WHITE: what black and white of the image or mask multiply the stiffness of the "
                   "settings by. 0 is limp, gelled hair has more than 1 (default: 0,1)")
        ->delimiter(',')
        ->expected(2)
        ->check(CLI::Range(0.0f, runtime::kMostStiffness))
        ->excludes(attribute);
    job.add_flag("--even-stiffness", options.evenStiffness,
                 "Removes the strands' own stiffness, so that all have that of the settings")
        ->excludes(image)
        ->excludes(mask)
        ->excludes(attribute);
}

JobRun declare(CLI::App& job) {
    const auto options = std::make_shared<SetOptions>();
    auto* listing =
        job.add_flag("--list", options->list,
                     "List every field with unit, range, default and meaning, the presets and the "
                     "looks");
    auto* input = job.add_option("groom", options->input, "Groom to change")->excludes(listing);
    job.add_option(
        "fields", options->assignments,
        "SECTION.FIELD=VALUE. Sections: simulation, material, shadows, interpolation. For a layer: "
        "layers.NAME.density=VALUE, layers.NAME.material.FIELD=VALUE, layers.NAME.material=null. Names of "
        "painted masks: masks.1=NAME to masks.4=NAME");
    job.add_option("--preset", options->preset,
                   "Preset of measured hair for stiffness, cross-section, thickness and colour. --from and "
                   "fields override it")
        ->check(CLI::IsMember(presetNames()));
    job.add_option(
           "--look", options->look,
           "Look of the Look panel: colours, and of some the highlights. --from and fields override it")
        ->check(CLI::IsMember(lookNames()));
    job.add_flag(
        "--full-head", options->fill,
        fmt::format("Follow hairs until the scalp is as dense as a person's: {} hairs per cm², spread "
                    "between the strands. --from and fields override it",
                    kHairsPerCm2));
    auto* image = job.add_option("--dye-image", options->dyeImage,
                                 "PNG at the root UVs. White strands take the dye of the material");
    job.add_option("--dye-attribute", options->dyeAttribute,
                   "Strand attribute of numbers from 0 to 1 with the strength of the dye")
        ->excludes(image);
    auto* melanin = job.add_option("--melanin-image", options->melaninImage,
                                   "PNG at the root UVs. White strands keep the material's melanin, black "
                                   "ones have none");
    job.add_option("--melanin-attribute", options->melaninAttribute,
                   "Strand attribute of numbers from 0 to 8 that multiply the material's melanin")
        ->excludes(melanin);
    addStiffness(job, *options);
    job.add_option("--character", options->character,
                   "Head file with mesh, skeleton and clips, if the project no longer finds it");
    job.add_option("--from", options->from, "JSON file of sections with fields");
    auto* output = job.add_option("-o,--output", options->output, "Project to write");
    job.final_callback([listing, input, output] {
        if (listing->count() == 0 && input->count() * output->count() == 0)
            throw CLI::RequiredError("groom and -o");
    });
    return [options](const std::string&) {
        if (options->list) return list();
        return withOutputs({{options->output, content::kProject}}, [&] { return set(*options); });
    };
}

}  // namespace

Job setJob() {
    return {"set", "Change settings of a groom by name",
            "hair.hairloom simulation.windSpeed=4 -o hair.hairloom", declare};
}

}  // namespace hairloom::cli
