// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/file/operators_json.h"

#include <fmt/format.h>

#include <array>
#include <limits>

namespace hairloom {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 4> kOwnMembers = {"op", "enabled", "weight", "number"};

}  // namespace

Json toJson(const Operator& one) {
    Json json{{"op", one.op}};
    const Json settings = Json::parse(one.settings);
    for (const auto& [name, value] : settings.items()) json[name] = value;
    json["enabled"] = one.enabled;
    json["weight"] = readableDecimal(one.weight);
    if (one.op == kSculpt) json["number"] = one.number;
    return json;
}

Json toJson(std::span<const Operator> operators) {
    Json list = Json::array();
    for (const Operator& one : operators) list.push_back(toJson(one));
    return list;
}

Operator readOperatorHead(JsonReader& reader) {
    Operator one;
    one.op = reader.string("op");
    if (reader.has("enabled")) one.enabled = reader.boolean("enabled");
    if (reader.has("weight")) one.weight = static_cast<float>(reader.number("weight", 0, 1));
    constexpr std::uint64_t kMax = std::numeric_limits<std::uint32_t>::max();
    if (one.op == kSculpt && reader.has("number"))
        one.number = static_cast<std::uint32_t>(reader.count("number", 0, kMax));
    return one;
}

Operator readOperatorShape(JsonReader& reader) {
    Operator one = readOperatorHead(reader);
    one.settings = reader.rest(kOwnMembers);
    return one;
}

std::vector<Operator> readOperatorList(JsonReader& reader, Operator (*readOne)(JsonReader&)) {
    std::vector<Operator> operators;
    for (JsonReader& entry : reader.objects("operators")) operators.push_back(readOne(entry));
    if (operators.size() > kMaxOperators)
        reader.complain("operators", fmt::format("has {} entries", operators.size()),
                        fmt::format("expected at most {}", kMaxOperators));
    return operators;
}

}  // namespace hairloom
