// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What an operation of scripts is. A new one is a file in this folder that defines `Operation
// nameOperation()`, with the name of the file.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/groom/file/json_reader.h"
#include "core/operations/drawn_curve.h"
#include "core/operations/head_places.h"
#include "core/operations/mask.h"
#include "core/operations/strand_edit.h"
#include "core/operations/varied.h"

namespace hairloom {

/// Returns the number of strands touched; on error the groom may be half edited.
using RunOperation = std::function<Result<std::size_t>(Groom&)>;

using SettingsText = std::function<std::string(float scale)>;

struct Operation {
    std::string_view name;     ///< in scripts
    std::string_view meaning;  ///< what it does, one sentence, in small letters
    int order;                 ///< in lists: as hairstyles are mostly made, from lengths on
    RunOperation (*read)(JsonReader&);
    std::vector<FieldRow> (*fields)();
    /// Gives all members that `read` takes as a JSON object, with those that are absent at their defaults for
    /// a head of that headScale().
    SettingsText (*settings)(JsonReader&);
    bool stacks = true;     ///< moves points of strands and changes nothing else, so that a stack may hold it
    bool hasCurve = false;  ///< takes a "curve" (drawn_curve.h)
    /// Names of the fields that may be formulas, one value for each strand ("formulas").
    std::span<const char* const> formulaFields{};
};

namespace operation_detail {

inline Region readRegion(JsonReader& reader) {
    Region region;
    if (!reader.has("region")) return region;
    JsonReader part = reader.object("region");
    part.fields(region);
    part.finish();
    return region;
}

/// Settings with a curve have a member of that name.
template <class S>
constexpr bool hasCurve = requires(S settings) {
    settings.curve;
};

template <class S>
S readSettings(JsonReader& reader) {
    S settings;
    reader.fields(settings);
    if constexpr (hasCurve<S>) settings.curve = readCurve(reader);
    return settings;
}

/// Fields that the object leaves at their defaults, which follow the size of the head.
template <class S>
std::vector<const Field<S>*> leftOut(JsonReader& reader, const S& settings) {
    std::vector<const Field<S>*> fields;
    for (const Field<S>& field : fieldsOf(settings)) {
        if (!reader.has(field.name)) fields.push_back(&field);
    }
    return fields;
}

template <class S>
S fitted(S settings, const std::vector<const Field<S>*>& fields, float scale) {
    for (const Field<S>* field : fields) fitToHead(settings, *field, scale);
    return settings;
}

template <class S, bool Masked>
SettingsText settings(JsonReader& reader, std::span<const char* const> formulaFields) {
    const S read = readSettings<S>(reader);
    nlohmann::ordered_json rest = nlohmann::ordered_json::object();
    if constexpr (hasCurve<S>) rest["curve"] = toJson(read.curve);
    if (!formulaFields.empty()) {
        const SettingFormulas formulas = readFormulas(reader, formulaFields);
        if (!formulas.empty()) rest["formulas"] = formulas;
    }
    if (reader.has("region")) rest["region"] = fieldsToJson(readRegion(reader));
    if (Masked && reader.has("mask")) rest["mask"] = toJson(readMask(reader));
    return [read, open = leftOut(reader, read), rest](float scale) {
        nlohmann::ordered_json json = fieldsToJson(fitted(read, open, scale));
        json.update(rest);
        return json.dump();
    };
}

template <class S, Result<std::size_t> (*Apply)(Groom&, const S&, const Region&), bool Masked>
RunOperation read(JsonReader& reader) {
    const S settings = readSettings<S>(reader);
    const Region region = readRegion(reader);
    const Mask mask = Masked ? readMask(reader) : Mask{};
    return [settings, open = leftOut(reader, settings), region, mask](Groom& groom) {
        const S own = fitted(settings, open, open.empty() ? 1 : headScale(groom));
        return runMasked(groom, mask, [&](Groom& edited) { return Apply(edited, own, region); });
    };
}

template <class S, Result<std::size_t> (*Apply)(Groom&, const Varied<S>&, const Region&), const auto& Fields>
RunOperation readVaried(JsonReader& reader) {
    const S settings = readSettings<S>(reader);
    const SettingFormulas formulas = readFormulas(reader, Fields);
    const Region region = readRegion(reader);
    const Mask mask = readMask(reader);
    return [settings, open = leftOut(reader, settings), formulas, region,
            mask](Groom& groom) -> Result<std::size_t> {
        const S own = fitted(settings, open, open.empty() ? 1 : headScale(groom));
        const auto varied = Varied<S>::make(groom, own, formulas, region);
        if (!varied) return tl::unexpected(varied.error());
        return runMasked(groom, mask, [&](Groom& edited) { return Apply(edited, *varied, region); });
    };
}

template <class S, bool Masked>
SettingsText plainSettings(JsonReader& reader) {
    return settings<S, Masked>(reader, {});
}
template <class S, const auto& Fields>
SettingsText variedSettings(JsonReader& reader) {
    return settings<S, true>(reader, Fields);
}

}  // namespace operation_detail

/// An operation that moves points and nothing else, with the fields of S, a region and a mask.
template <class S, Result<std::size_t> (*Apply)(Groom&, const S&, const Region&)>
Operation operation(std::string_view name, int order, std::string_view meaning) {
    using namespace operation_detail;
    return {name, meaning,    order, &read<S, Apply, true>, &fieldRows<S>, &plainSettings<S, true>,
            true, hasCurve<S>};
}

/// The same where those fields may be formulas. `Apply` asks for the settings of each strand.
template <class S, Result<std::size_t> (*Apply)(Groom&, const Varied<S>&, const Region&), const auto& Fields>
Operation variedOperation(std::string_view name, int order, std::string_view meaning) {
    using namespace operation_detail;
    return {
        name, meaning,     order, &readVaried<S, Apply, Fields>, &fieldRows<S>, &variedSettings<S, Fields>,
        true, hasCurve<S>, Fields};
}

/// One that does more, which no stack holds. It has no mask.
template <class S, Result<std::size_t> (*Apply)(Groom&, const S&, const Region&)>
Operation lastingOperation(std::string_view name, int order, std::string_view meaning) {
    using namespace operation_detail;
    return {name, meaning, order, &read<S, Apply, false>, &fieldRows<S>, &plainSettings<S, false>, false};
}

/// One of each file, in order of file name (hairloom_registry).
const std::vector<Operation>& operationEntries();

/// In the order of lists.
const std::vector<Operation>& operations();

}  // namespace hairloom
