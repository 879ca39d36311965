// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What an operation of scripts is. A new one is a file in this folder that defines `Operation
// nameOperation()`, with the name of the file.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/groom/file/json_reader.h"
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
    bool stacks = true;  ///< moves points of strands and changes nothing else, so that a stack may hold it
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

template <class S>
std::string settings(JsonReader& reader) {
    S settings;
    reader.fields(settings);
    nlohmann::ordered_json json = fieldsToJson(settings);
    if (reader.has("region")) json["region"] = fieldsToJson(readRegion(reader));
    return json.dump();
}

template <class S, Result<std::size_t> (*Apply)(Groom&, const S&, const Region&)>
RunOperation read(JsonReader& reader) {
    S settings;
    reader.fields(settings);
    const Region region = readRegion(reader);
    return [settings, region](Groom& groom) { return Apply(groom, settings, region); };
}

}  // namespace operation_detail

/// An operation that has the fields of S and a region.
template <class S, Result<std::size_t> (*Apply)(Groom&, const S&, const Region&)>
Operation operation(std::string_view name, int order, std::string_view meaning) {
    return {name,          meaning,
            order,         &operation_detail::read<S, Apply>,
            &fieldRows<S>, &operation_detail::settings<S>};
}

/// One of each file, in order of file name (hairloom_registry).
const std::vector<Operation>& operationEntries();

/// In the order of lists.
const std::vector<Operation>& operations();

}  // namespace hairloom
