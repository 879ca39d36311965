// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/selection_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>

#include "core/editing/delta_command.h"
#include "core/editing/document.h"
#include "core/editing/records.h"
#include "core/editing/settings_commands.h"
#include "core/groom/white_strands.h"
#include "core/operations/mask.h"
#include "hairloom/strands.h"

namespace hairloom::editing {
namespace {

/// Carries deltas out on a copy of the groom (which shares what is not touched) and takes them back, so that
/// the command is ready to be done.
template <class Change>
std::unique_ptr<Command> prepared(const Model& model, std::string name, std::string record, Change change) {
    Model trial{model.groom, {}};
    Deltas deltas;
    change(trial.groom, deltas);
    auto command = commandOf(std::move(name), std::move(deltas));
    if (!command) return nullptr;
    command->exchange(trial);
    command->setRecord(std::move(record));
    return command;
}

std::string strandsRecord(std::string_view action, std::span<const std::uint32_t> strands) {
    return recordOf("strands", {{"do", action}, {"strands", runsOf(strands)}});
}

Indices chosen(const Indices& now, std::span<const std::uint32_t> given, Choice choice) {
    Indices result;
    const auto out = std::back_inserter(result);
    switch (choice) {
        case Choice::Replace:
            result.assign(given.begin(), given.end());
            break;
        case Choice::Add:
            std::set_union(now.begin(), now.end(), given.begin(), given.end(), out);
            break;
        case Choice::Remove:
            std::set_difference(now.begin(), now.end(), given.begin(), given.end(), out);
            break;
        case Choice::Toggle:
            std::set_symmetric_difference(now.begin(), now.end(), given.begin(), given.end(), out);
            break;
    }
    return result;
}

Indices without(const Indices& all, const Indices& some) {
    Indices rest;
    std::set_difference(all.begin(), all.end(), some.begin(), some.end(), std::back_inserter(rest));
    return rest;
}

}  // namespace

std::unique_ptr<Command> selectStrands(const Model& model, std::span<const std::uint32_t> strands,
                                       Choice choice) {
    const Indices now = strandsWithFlag(model.groom, attribute::kSelected);
    const Indices wanted = chosen(now, strands, choice);
    return prepared(model, "Select", strandsRecord("select", wanted), [&](Groom& groom, Deltas& deltas) {
        deltas.selected.set(groom, without(now, wanted), false);
        deltas.selected.set(groom, without(wanted, now), true);
    });
}

std::vector<std::uint32_t> strandsOfGroup(const Groom& groom, std::uint32_t group) {
    const auto groups = groom.strandAttributes.view<std::uint32_t>(attribute::kGroup);
    Indices strands;
    for (std::size_t s = 0; s < groups.size(); ++s) {
        if (groups[s] == group) strands.push_back(static_cast<std::uint32_t>(s));
    }
    return strands;
}

std::vector<std::uint32_t> strandsWithFlag(const Groom& groom, std::string_view attribute) {
    const auto flags = groom.strandAttributes.view<std::uint8_t>(attribute);
    Indices strands;
    for (std::size_t s = 0; s < flags.size(); ++s) {
        if (flags[s] != 0) strands.push_back(static_cast<std::uint32_t>(s));
    }
    return strands;
}

std::vector<std::uint32_t> allStrands(const Groom& groom) {
    Indices strands(groom.strandCount());
    std::iota(strands.begin(), strands.end(), 0u);
    return strands;
}

std::unique_ptr<Command> hideStrands(const Model& model, std::span<const std::uint32_t> strands) {
    return prepared(model, "Hide", strandsRecord("hide", strands),
                    [&](Groom& groom, Deltas& deltas) { deltas.hidden.set(groom, strands, true); });
}

std::unique_ptr<Command> showStrands(const Model& model) {
    const Indices hidden = strandsWithFlag(model.groom, attribute::kHidden);
    return prepared(model, "Show all", recordOf("strands", {{"do", "show"}}),
                    [&](Groom& groom, Deltas& deltas) { deltas.hidden.set(groom, hidden, false); });
}

std::unique_ptr<Command> freezeStrands(const Model& model, std::span<const std::uint32_t> strands,
                                       bool frozen) {
    return prepared(model, frozen ? "Freeze" : "Thaw", strandsRecord(frozen ? "freeze" : "thaw", strands),
                    [&](Groom& groom, Deltas& deltas) { deltas.frozen.set(groom, strands, frozen); });
}

std::unique_ptr<Command> deleteStrands(const Model& model, std::span<const std::uint32_t> strands) {
    return prepared(model, "Delete", strandsRecord("delete", strands),
                    [&](Groom& groom, Deltas& deltas) { deltas.strands.remove(groom, strands); });
}

std::unique_ptr<Command> selectScalp(const Model& model, const FaceSet& faces, Choice choice,
                                     std::string expression) {
    FaceSet wanted = chosen(model.groom.scalpSelection, faces, choice);
    std::string record = recordOf("scalp", {{"faces", runsOf(wanted)}, {"expression", expression}});
    return prepared(model, "Select scalp", std::move(record), [&](Groom& groom, Deltas& deltas) {
        deltas.faces.set(groom, std::move(wanted), std::move(expression));
    });
}

std::unique_ptr<Command> setDensity(const Model& model, std::span<const float> density) {
    auto recorded = nlohmann::ordered_json::array();
    for (const float value : density) recorded.push_back(readableDecimal(value));
    std::string record = recordOf("density", {{"values", std::move(recorded)}});
    return prepared(model, "Density", std::move(record), [&](Groom& groom, Deltas& deltas) {
        Indices vertices;
        std::vector<float> values;
        for (std::uint32_t v = 0; v < density.size(); ++v) {
            const float now = groom.scalpDensity.empty() ? 1.0f : groom.scalpDensity[v];
            if (density[v] == now) continue;
            vertices.push_back(v);
            values.push_back(density[v]);
        }
        deltas.density.set(groom, vertices, values);
    });
}

std::unique_ptr<Command> setMask(const Model& model, std::uint32_t number, std::span<const float> values) {
    auto recorded = nlohmann::ordered_json::array();
    for (const float value : values) recorded.push_back(readableDecimal(value));
    std::string record = recordOf("mask", {{"mask", number}, {"values", std::move(recorded)}});
    return prepared(model, "Mask", std::move(record), [&](Groom& groom, Deltas& deltas) {
        deltas.mask.keep(groom, maskAttribute(number), allStrands(groom));
        groom.strandAttributes.set(maskAttribute(number), std::vector<float>(values.begin(), values.end()));
        deltas.mask.finish(groom);
    });
}

namespace {

/// What strands have of a strand attribute of that name, or none; the step of a script has its name, too.
std::unique_ptr<Command> setFactors(const Model& model, std::string_view attribute, const char* title,
                                    std::span<const float> values) {
    auto recorded = nlohmann::ordered_json::array();
    for (const float value : values) recorded.push_back(readableDecimal(value));
    Groom groom = model.groom;
    if (values.empty()) {
        groom.strandAttributes.erase(attribute);
    } else {
        groom.strandAttributes.set(attribute, std::vector<float>(values.begin(), values.end()));
    }
    return replaceGroom(model, std::move(groom), title,
                        recordOf(attribute, {{"values", std::move(recorded)}}));
}

}  // namespace

std::unique_ptr<Command> setMelanin(const Model& model, std::span<const float> values) {
    return setFactors(model, attribute::kMelanin, "Melanin", values);
}

std::unique_ptr<Command> setStiffness(const Model& model, std::span<const float> values) {
    return setFactors(model, attribute::kStiffness, "Stiffness", values);
}

// --- As operations of a script ---

namespace {

MakeCommand readStrands(JsonReader& reader) {
    constexpr std::string_view kActions[] = {"select", "hide", "show", "freeze", "thaw", "delete"};
    const std::string_view action = kActions[reader.choice("do", kActions)];
    const Indices strands = action == "show" ? Indices() : readRuns(reader, "strands");
    return [action, strands](const Document& document) -> CommandResult {
        const Model& model = document.model();
        if (auto status = checkBelow(strands, model.groom.strandCount(), "strand"); !status)
            return tl::unexpected(status.error());
        if (action == "select") return selectStrands(model, strands, Choice::Replace);
        if (action == "hide") return hideStrands(model, strands);
        if (action == "show") return showStrands(model);
        if (action == "delete") return deleteStrands(model, strands);
        return freezeStrands(model, strands, action == "freeze");
    };
}

MakeCommand readScalp(JsonReader& reader) {
    const Indices faces = readRuns(reader, "faces");
    const std::string expression = reader.string("expression");
    return [faces, expression](const Document& document) -> CommandResult {
        const std::size_t count = document.groom().scalp ? document.groom().scalp->triangleCount() : 0;
        if (auto status = checkBelow(faces, count, "face"); !status) return tl::unexpected(status.error());
        return selectScalp(document.model(), faces, Choice::Replace, expression);
    };
}

MakeCommand readDensity(JsonReader& reader) {
    std::vector<float> values;
    for (const double value : reader.numbers("values", 0, 1, kMaxNumbers))
        values.push_back(static_cast<float>(value));
    return [values](const Document& document) -> CommandResult {
        const std::size_t vertices = document.groom().scalp ? document.groom().scalp->vertexCount() : 0;
        if (values.size() != vertices)
            return fail(fmt::format("{} densities", values.size()),
                        fmt::format("one for each of {} vertices", vertices));
        return setDensity(document.model(), values);
    };
}

MakeCommand readMaskValues(JsonReader& reader) {
    const auto number = static_cast<std::uint32_t>(reader.count("mask", 1, kPaintedMasks));
    std::vector<float> values;
    for (const double value : reader.numbers("values", 0, 1, kMaxNumbers))
        values.push_back(static_cast<float>(value));
    return [number, values](const Document& document) -> CommandResult {
        const std::size_t strands = document.groom().strandCount();
        if (values.size() != strands)
            return fail(fmt::format("{} values of a mask", values.size()),
                        fmt::format("one for each of {} strands", strands));
        return setMask(document.model(), number, values);
    };
}

template <auto set>
MakeCommand readFactors(JsonReader& reader, const char* what, float most) {
    std::vector<float> values;
    for (const double value : reader.numbers("values", 0, most, kMaxNumbers))
        values.push_back(static_cast<float>(value));
    return [values, what](const Document& document) -> CommandResult {
        const std::size_t strands = document.groom().strandCount();
        if (!values.empty() && values.size() != strands)
            return fail(fmt::format("{} values of {}", values.size(), what),
                        fmt::format("one for each of {} strands, or none", strands));
        return set(document.model(), values);
    };
}

MakeCommand readMelanin(JsonReader& reader) {
    return readFactors<setMelanin>(reader, "melanin", kMostMelanin);
}
MakeCommand readStiffness(JsonReader& reader) {
    return readFactors<setStiffness>(reader, "stiffness", runtime::kMostStiffness);
}

constexpr RecordedOperation kSelectionCommandsRecords[] = {
    {"strands", readStrands}, {"scalp", readScalp},     {"density", readDensity},
    {"mask", readMaskValues}, {"melanin", readMelanin}, {"stiffness", readStiffness},
};

}  // namespace

RecordList selectionCommandsRecords() {
    return kSelectionCommandsRecords;
}

}  // namespace hairloom::editing
