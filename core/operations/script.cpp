// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/script.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/operations/clump.h"
#include "core/operations/collide.h"
#include "core/operations/curl.h"
#include "core/operations/drape.h"
#include "core/operations/dye.h"
#include "core/operations/flow.h"
#include "core/operations/noise.h"
#include "core/operations/set_length.h"
#include "core/operations/smooth.h"
#include "core/operations/trim.h"

namespace hairloom {
namespace {

using Run = std::function<Result<std::size_t>(Groom&)>;

/// One operation with its settings' type erased.
struct Operation {
    std::string_view name;
    std::string_view meaning;
    Run (*read)(JsonReader&);
    std::vector<FieldRow> (*fields)();
};

template <class S, Result<std::size_t> (*Apply)(Groom&, const S&, const Region&)>
Run readOperation(JsonReader& reader) {
    S settings;
    reader.fields(settings);
    Region region;
    if (reader.has("region")) {
        JsonReader part = reader.object("region");
        part.fields(region);
        part.finish();
    }
    return [settings, region](Groom& groom) { return Apply(groom, settings, region); };
}

template <class S, Result<std::size_t> (*Apply)(Groom&, const S&, const Region&)>
constexpr Operation operation(std::string_view name, std::string_view meaning) {
    return {name, meaning, &readOperation<S, Apply>, &fieldRows<S>};
}

constexpr Operation kOperations[] = {
    operation<SetLengthSettings, setLength>("set_length", "gives strands a length"),
    operation<FlowSettings, flow>("flow", "lays strands along the head: from a crown, a parting, by a sweep"),
    operation<ClumpSettings, clump>("clump", "pulls strands together in locks"),
    operation<NoiseSettings, noise>("noise", "bends strands at random: frizz, an uneven fall"),
    operation<CurlSettings, curl>("curl", "winds strands into helices"),
    operation<SmoothSettings, smooth>("smooth", "takes bends out of strands"),
    operation<DrapeSettings, drape>("drape", "bends strands down as gravity does"),
    operation<TrimSettings, trim>("trim", "cuts strands by a plane or at a length, blunt or ragged"),
    operation<CollideSettings, collide>("collide", "pushes strands out of the head"),
    operation<DyeSettings, dye>("dye", "says which strands the material's dye colours, and how much"),
};

std::vector<std::string_view> operationNames(std::span<const ScriptExtension> extensions) {
    std::vector<std::string_view> names;
    for (const Operation& entry : kOperations) names.push_back(entry.name);
    for (const ScriptExtension& entry : extensions) names.push_back(entry.name);
    return names;
}

/// Strand of each id; of each index where there are no ids.
std::map<std::uint32_t, std::size_t> strandsById(const Groom& groom) {
    const auto ids = groom.strandAttributes.view<std::uint32_t>(attribute::kStrandId);
    std::map<std::uint32_t, std::size_t> strands;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        strands.emplace(s < ids.size() ? ids[s] : static_cast<std::uint32_t>(s), s);
    }
    return strands;
}

std::size_t changedStrands(const Groom& before, const Groom& after) {
    const auto old = strandsById(before);
    std::size_t kept = 0;
    std::size_t changed = 0;
    for (const auto& [id, s] : strandsById(after)) {
        const auto found = old.find(id);
        if (found == old.end()) {
            ++changed;
            continue;
        }
        ++kept;
        const auto a = before.strand(found->second);
        const auto b = after.strand(s);
        changed += !std::equal(a.begin(), a.end(), b.begin(), b.end());
    }
    return changed + (old.size() - kept);
}

}  // namespace

Result<Script> parseScript(const std::string& file, std::string_view text,
                           std::span<const ScriptExtension> extensions) {
    const auto json = parseJson(file, text);
    if (!json) return tl::unexpected(json.error());
    JsonReader reader(*json, file);
    const auto version = reader.count("hairloom_script", 1, ~std::uint64_t{0});
    if (reader.ok() && version > kScriptVersion) {
        return failIn(file, {},
                      fmt::format("script is version {}; this program reads versions up to {}", version,
                                  kScriptVersion));
    }
    Script script;
    const auto names = operationNames(extensions);
    for (JsonReader& step : reader.objects("operations")) {
        const std::size_t chosen = step.choice("op", names);
        Run run = chosen < std::size(kOperations) ? kOperations[chosen].read(step)
                                                  : extensions[chosen - std::size(kOperations)].read(step);
        step.finish();
        script.steps.push_back({std::string(names[chosen]), std::move(run)});
    }
    reader.finish();
    if (auto status = reader.status(); !status) return tl::unexpected(status.error());
    return script;
}

Result<ScriptReport> runScript(const Script& script, Groom& groom) {
    Groom edited = groom;
    ScriptReport report;
    for (const ScriptStep& step : script.steps) {
        const auto touched = step.run(edited);
        if (!touched) {
            Error error = touched.error();
            error.problem = fmt::format("operation {}: {}", report.strokes, error.problem);
            return tl::unexpected(std::move(error));
        }
        report.touchedByStep.push_back(*touched);
        ++report.strokes;
    }
    report.touchedStrands = changedStrands(groom, edited);
    groom = std::move(edited);
    return report;
}

const std::vector<OperationInfo>& scriptOperations() {
    static const std::vector<OperationInfo> infos = [] {
        std::vector<OperationInfo> list;
        for (const Operation& entry : kOperations) {
            list.push_back({std::string(entry.name), std::string(entry.meaning), entry.fields()});
        }
        return list;
    }();
    return infos;
}

const std::vector<FieldRow>& scriptRegionFields() {
    static const std::vector<FieldRow> fields = fieldRows<Region>();
    return fields;
}

}  // namespace hairloom
