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
#include "core/operations/mask.h"
#include "core/operations/strand_edit.h"

namespace hairloom {

/// Returns the number of strands touched; on error the groom may be half edited.
using RunOperation = std::function<Result<std::size_t>(Groom&)>;

struct Operation {
    std::string_view name;     ///< in scripts
    std::string_view meaning;  ///< what it does, one sentence, in small letters
    int order;                 ///< in lists: as hairstyles are mostly made, from lengths on
    RunOperation (*read)(JsonReader&);
    std::vector<FieldRow> (*fields)();
    /// All members that `read` takes, with those that are absent at their defaults, as a JSON object.
    std::string (*settings)(JsonReader&);
    bool stacks = true;     ///< moves points of strands and changes nothing else, so that a stack may hold it
    bool hasCurve = false;  ///< takes a "curve" (drawn_curve.h)
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

template <class S, bool Masked>
std::string settings(JsonReader& reader) {
    const S settings = readSettings<S>(reader);
    nlohmann::ordered_json json = fieldsToJson(settings);
    if constexpr (hasCurve<S>) json["curve"] = toJson(settings.curve);
    if (reader.has("region")) json["region"] = fieldsToJson(readRegion(reader));
    if (Masked && reader.has("mask")) json["mask"] = toJson(readMask(reader));
    return json.dump();
}

template <class S, Result<std::size_t> (*Apply)(Groom&, const S&, const Region&), bool Masked>
RunOperation read(JsonReader& reader) {
    const S settings = readSettings<S>(reader);
    const Region region = readRegion(reader);
    const Mask mask = Masked ? readMask(reader) : Mask{};
    return [settings, region, mask](Groom& groom) {
        return runMasked(groom, mask, [&](Groom& edited) { return Apply(edited, settings, region); });
    };
}

}  // namespace operation_detail

/// An operation that moves points and nothing else, with the fields of S, a region and a mask.
template <class S, Result<std::size_t> (*Apply)(Groom&, const S&, const Region&)>
Operation operation(std::string_view name, int order, std::string_view meaning) {
    using namespace operation_detail;
    return {name, meaning,    order, &read<S, Apply, true>, &fieldRows<S>, &settings<S, true>,
            true, hasCurve<S>};
}

/// One that does more, which no stack holds. It has no mask.
template <class S, Result<std::size_t> (*Apply)(Groom&, const S&, const Region&)>
Operation lastingOperation(std::string_view name, int order, std::string_view meaning) {
    using namespace operation_detail;
    return {name, meaning, order, &read<S, Apply, false>, &fieldRows<S>, &settings<S, false>, false};
}

/// One of each file, in order of file name (hairloom_registry).
const std::vector<Operation>& operationEntries();

/// In the order of lists.
const std::vector<Operation>& operations();

}  // namespace hairloom
