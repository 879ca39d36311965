// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/script.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace hairloom {
namespace {

std::vector<std::string_view> operationNames(std::span<const ScriptExtension> extensions) {
    std::vector<std::string_view> names;
    for (const Operation& entry : operations()) names.push_back(entry.name);
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

bool keepsSomeStrands(const Groom& groom) {
    const auto frozen = groom.strandAttributes.view<std::uint8_t>(attribute::kFrozen);
    return std::ranges::any_of(frozen, [](std::uint8_t value) { return value != 0; }) ||
           std::ranges::any_of(groom.layers, &Layer::locked);
}

/// Where there are operators, which would make the points anew and drop what it did, it joins them.
RunOperation onTopOfStack(Operator one, SettingsText settings, RunOperation run) {
    return [one = std::move(one), settings = std::move(settings),
            run = std::move(run)](Groom& groom) -> Result<std::size_t> {
        if (groom.operators.empty()) return run(groom);
        // Operators act on all strands.
        if (keepsSomeStrands(groom))
            return fail(fmt::format("{}: frozen or locked strands in a hairstyle with operators", one.op),
                        "unfreeze them, or bake the operators first (bake_operators)");
        if (groom.operators.size() >= kMaxOperators)
            return fail(fmt::format("{}: the hairstyle already has {} operators", one.op, kMaxOperators),
                        "bake some of them first (bake_operators)");
        auto touched = run(groom);
        if (!touched) return touched;
        groom.operators.push_back(one);
        groom.operators.back().settings = settings(headScale(groom));
        return touched;
    };
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
                      fmt::format("the script is version {}, but this program reads versions up to {}",
                                  version, kScriptVersion),
                      "expected a newer Hairloom to read it");
    }
    Script script;
    const auto names = operationNames(extensions);
    for (JsonReader& step : reader.objects("operations")) {
        const std::size_t chosen = step.choice("op", names);
        const std::size_t own = operations().size();
        RunOperation run =
            chosen < own ? operations()[chosen].read(step) : extensions[chosen - own].read(step);
        if (chosen < own && operations()[chosen].stacks) {
            Operator one;
            one.op = names[chosen];
            run = onTopOfStack(std::move(one), operations()[chosen].settings(step), std::move(run));
        }
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

const std::vector<Operation>& operations() {
    static const std::vector<Operation> kSorted = [] {
        std::vector<Operation> list = operationEntries();
        std::ranges::stable_sort(list, {}, &Operation::order);
        return list;
    }();
    return kSorted;
}

const std::vector<FieldRow>& scriptRegionFields() {
    static const std::vector<FieldRow> fields = fieldRows<Region>();
    return fields;
}

}  // namespace hairloom
