// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/file/json_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace hairloom {
namespace {

using nlohmann::json;

constexpr std::size_t kQuotedBytes = 60;  ///< of a wrong value, in a message

/// Carries a complaint out of the parser's callback; caught in parseJson.
struct Refused {
    std::string problem;
};

std::optional<std::uint64_t> tooDeepAt(std::string_view text) {
    std::size_t depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted) {
            if (c == '\\') ++i;
            if (c == '"') quoted = false;
        } else if (c == '"') {
            quoted = true;
        } else if (c == '{' || c == '[') {
            if (++depth > kMaxJsonDepth) return i;
        } else if ((c == '}' || c == ']') && depth > 0) {
            --depth;
        }
    }
    return std::nullopt;
}

std::string quoted(const json& value) {
    if (value.is_structured()) return value.is_array() ? "an array" : "an object";
    std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
    if (text.size() > kQuotedBytes) text = text.substr(0, kQuotedBytes) + "…";
    return text;
}

/// "~" and "/" as RFC 6901 writes them; over-long names are cut.
std::string pathPart(std::string_view key) {
    std::string part = "/";
    for (const char c : key.substr(0, kQuotedBytes))
        part += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
    return part;
}

}  // namespace

Result<json> parseJson(const std::string& file, std::string_view text, std::uint64_t firstByte) {
    if (text.size() > kMaxJsonBytes) {
        return failIn(file, {}, fmt::format("holds {} bytes of JSON", text.size()),
                      fmt::format("expected at most {}", kMaxJsonBytes));
    }
    if (const auto deep = tooDeepAt(text)) {
        return failIn(file, Byte{firstByte + *deep}, "JSON is nested too deeply",
                      fmt::format("expected at most {} levels", kMaxJsonDepth));
    }
    std::vector<std::set<std::string>> open;
    const auto refuseRepeats = [&](int, json::parse_event_t event, json& parsed) {
        if (event == json::parse_event_t::object_start) open.emplace_back();
        if (event == json::parse_event_t::object_end) open.pop_back();
        if (event == json::parse_event_t::key && !open.back().insert(parsed.get<std::string>()).second) {
            throw Refused{fmt::format("JSON has {} twice in one object", quoted(parsed))};
        }
        return true;
    };
    try {
        return json::parse(text, refuseRepeats);
    } catch (const json::parse_error& error) {
        return failIn(file, Byte{firstByte + (error.byte > 0 ? error.byte - 1 : 0)}, "JSON is damaged",
                      "expected valid JSON");
    } catch (const json::exception& error) {
        return failIn(file, {}, fmt::format("JSON cannot be read: {}", error.what()), "expected valid JSON");
    } catch (const Refused& refused) {
        return failIn(file, {}, refused.problem, "expected each name once");
    }
}

JsonReader::JsonReader(const json& value, const std::string& file)
    : JsonReader(value, {}, std::make_shared<Context>(Context{file, std::nullopt})) {}

JsonReader::JsonReader(const json& value, std::string path, std::shared_ptr<Context> context)
    : value_(&value), path_(std::move(path)), context_(std::move(context)) {
    if (!value.is_object()) complain({}, "is " + quoted(value), "expected an object");
}

bool JsonReader::has(std::string_view key) {
    asked_.emplace(key);
    return value_->is_object() && value_->contains(written(key));
}

void JsonReader::alsoReadFormer(std::span<const FormerMember> members) {
    former_ = members;
    if (!value_->is_object()) return;
    for (const FormerMember& member : members) {
        if (member.former != member.name && value_->contains(member.former) && value_->contains(member.name))
            complain(member.former, "cannot be used together with " + member.name, "expected one of the two");
    }
}

std::string_view JsonReader::written(std::string_view key) const {
    if (!value_->is_object() || value_->contains(key)) return key;
    const auto member = std::ranges::find(former_, key, &FormerMember::name);
    return member != former_.end() && value_->contains(member->former) ? std::string_view(member->former)
                                                                       : key;
}

std::vector<std::string> JsonReader::keys() const {
    std::vector<std::string> names;
    if (!value_->is_object()) return names;
    for (const auto& item : value_->items()) names.push_back(item.key());
    return names;
}

std::string JsonReader::rest(std::span<const std::string_view> known) {
    json others = json::object();
    for (const std::string& name : keys()) {
        if (std::ranges::find(known, name) != known.end()) continue;
        asked_.emplace(name);
        others[name] = (*value_)[name];
    }
    return others.dump();
}

const json* JsonReader::member(std::string_view key, const std::string& expected) {
    asked_.emplace(key);
    if (value_->is_object()) {
        const auto found = value_->find(written(key));
        if (found != value_->end()) return &currentValue(former_, key, *found);
    }
    complain(key, "is missing", expected);
    return nullptr;
}

void JsonReader::complain(std::string_view key, const std::string& problem, const std::string& expected) {
    if (context_->error) return;
    std::string where = key.empty() ? path_ : path_ + pathPart(written(key));
    if (where.empty()) where = "/";
    context_->error = Error{context_->file, {}, where + " " + problem, expected};
}

void JsonReader::complainBelow(std::string_view path, const std::string& problem,
                               const std::string& expected) {
    if (context_->error) return;
    context_->error = Error{context_->file, {}, fmt::format("{}/{} {}", path_, path, problem), expected};
}

Status JsonReader::status() const {
    if (context_->error) return tl::unexpected(*context_->error);
    return {};
}

std::string JsonReader::string(std::string_view key) {
    constexpr const char* kExpected = "expected text in quotes";
    const json* value = member(key, kExpected);
    if (!value) return {};
    if (value->is_string()) return value->get<std::string>();
    complain(key, "is " + quoted(*value), kExpected);
    return {};
}

bool JsonReader::boolean(std::string_view key) {
    constexpr const char* kExpected = "expected true or false";
    const json* value = member(key, kExpected);
    if (!value) return false;
    if (value->is_boolean()) return value->get<bool>();
    complain(key, "is " + quoted(*value), kExpected);
    return false;
}

double JsonReader::number(std::string_view key, double min, double max, std::string_view unit) {
    const std::string expected = "expected a number from " + rangeText(min, max, unit);
    const json* value = member(key, expected);
    if (!value) return 0;
    if (value->is_number() && withinRange(value->get<double>(), min, max)) return value->get<double>();
    complain(key, "is " + quoted(*value), expected);
    return 0;
}

std::uint64_t JsonReader::count(std::string_view key, std::uint64_t min, std::uint64_t max) {
    const bool hasEnd = max != ~std::uint64_t{0};
    const std::string expected = min == max ? fmt::format("expected {}", min)
                                 : hasEnd   ? fmt::format("expected a whole number from {} to {}", min, max)
                                            : fmt::format("expected a whole number from {}", min);
    const json* value = member(key, expected);
    if (!value) return 0;
    if (value->is_number_unsigned()) {
        const auto number = value->get<std::uint64_t>();
        if (number >= min && number <= max) return number;
    }
    complain(key, "is " + quoted(*value), expected);
    return 0;
}

Vec3f JsonReader::vector(std::string_view key, double min, double max, std::string_view unit) {
    return exactVector(key, min, max, unit).cast<float>();
}

Vec3d JsonReader::exactVector(std::string_view key, double min, double max, std::string_view unit) {
    const std::string expected = "expected an array of three numbers from " + rangeText(min, max, unit);
    const json* value = member(key, expected);
    if (!value) return Vec3d::Zero();
    Vec3d result = Vec3d::Zero();
    bool good = value->is_array() && value->size() == 3;
    for (std::size_t i = 0; good && i < 3; ++i) {
        const json& part = (*value)[i];
        good = part.is_number() && withinRange(part.get<double>(), min, max);
        if (good) result[static_cast<Eigen::Index>(i)] = part.get<double>();
    }
    if (good) return result;
    complain(key, "is not a vector", expected);
    return Vec3d::Zero();
}

std::vector<std::string> JsonReader::strings(std::string_view key) {
    constexpr const char* kExpected = "expected an array of strings";
    const json* value = member(key, kExpected);
    if (!value) return {};
    std::vector<std::string> result;
    bool good = value->is_array();
    for (std::size_t i = 0; good && i < value->size(); ++i) {
        good = (*value)[i].is_string();
        if (good) result.push_back((*value)[i].get<std::string>());
    }
    if (good) return result;
    complain(key, "is not a list of names", kExpected);
    return {};
}

std::vector<double> JsonReader::numbers(std::string_view key, double min, double max, std::size_t maximum,
                                        std::string_view unit) {
    const std::string expected =
        fmt::format("expected an array of up to {} numbers from {}", maximum, rangeText(min, max, unit));
    const json* value = member(key, expected);
    if (!value) return {};
    std::vector<double> result;
    bool good = value->is_array() && value->size() <= maximum;
    for (std::size_t i = 0; good && i < value->size(); ++i) {
        good = (*value)[i].is_number() && withinRange((*value)[i].get<double>(), min, max);
        if (good) result.push_back((*value)[i].get<double>());
    }
    if (good) return result;
    complain(key, "is not a list of numbers", expected);
    return {};
}

std::vector<std::pair<double, double>> JsonReader::pairs(std::string_view key, double min, double max,
                                                         std::size_t maximum) {
    const std::string expected = fmt::format("expected an array of up to {} pairs of numbers from {}",
                                             maximum, rangeText(min, max, {}));
    const json* value = member(key, expected);
    if (!value) return {};
    const auto isNumber = [&](const json& entry) {
        return entry.is_number() && withinRange(entry.get<double>(), min, max);
    };
    std::vector<std::pair<double, double>> result;
    bool good = value->is_array() && value->size() <= maximum;
    for (std::size_t i = 0; good && i < value->size(); ++i) {
        const json& pair = (*value)[i];
        good = pair.is_array() && pair.size() == 2 && isNumber(pair[0]) && isNumber(pair[1]);
        if (good) result.emplace_back(pair[0].get<double>(), pair[1].get<double>());
    }
    if (good) return result;
    complain(key, "is not a list of pairs", expected);
    return {};
}

std::vector<Vec3f> JsonReader::vectors(std::string_view key, double min, double max, std::size_t maximum) {
    const std::string expected = fmt::format("expected an array of up to {} arrays of three numbers from {}",
                                             maximum, rangeText(min, max, {}));
    const json* value = member(key, expected);
    if (!value) return {};
    std::vector<Vec3f> result;
    bool good = value->is_array() && value->size() <= maximum;
    for (std::size_t i = 0; good && i < value->size(); ++i) {
        const json& vector = (*value)[i];
        good = vector.is_array() && vector.size() == 3;
        Vec3f read = Vec3f::Zero();
        for (std::size_t c = 0; good && c < 3; ++c) {
            good = vector[c].is_number() && withinRange(vector[c].get<double>(), min, max);
            if (good) read[static_cast<int>(c)] = vector[c].get<float>();
        }
        result.push_back(read);
    }
    if (good) return result;
    complain(key, "is not a list of vectors", expected);
    return {};
}

std::size_t JsonReader::choice(std::string_view key, std::span<const std::string_view> choices) {
    const std::string expected = fmt::format("expected one of {}", fmt::join(choices, ", "));
    const json* value = member(key, expected);
    if (!value || !ok()) return 0;
    for (std::size_t i = 0; value->is_string() && i < choices.size(); ++i) {
        if (choices[i] == value->get_ref<const std::string&>()) return i;
    }
    complain(key, "is " + quoted(*value), expected);
    return 0;
}

JsonReader JsonReader::object(std::string_view key) {
    static const json nothing = json::object();
    const json* value = member(key, "expected an object");
    return JsonReader(value ? *value : nothing, path_ + pathPart(key), context_);
}

std::vector<JsonReader> JsonReader::objects(std::string_view key) {
    constexpr const char* kExpected = "expected an array of objects";
    const json* value = member(key, kExpected);
    std::vector<JsonReader> result;
    if (!value) return result;
    if (!value->is_array()) complain(key, "is " + quoted(*value), kExpected);
    for (std::size_t i = 0; value->is_array() && i < value->size() && ok(); ++i) {
        result.push_back(JsonReader((*value)[i], fmt::format("{}{}/{}", path_, pathPart(key), i), context_));
    }
    return result;
}

void JsonReader::finish() {
    if (!value_->is_object()) return;
    for (const auto& item : value_->items()) {
        if (asked_.contains(currentName(former_, item.key()))) continue;
        return complain(item.key(), "is not known to this program",
                        fmt::format("expected only {}", fmt::join(asked_, ", ")));
    }
}

double JsonReader::wholeNumber(const FieldInfo& field) {
    const std::string expected = "expected a whole number from " + rangeText(field.min, field.max, {});
    const json* value = member(field.name, expected);
    if (!value) return 0;
    if (value->is_number() && field.holds(value->get<double>())) return value->get<double>();
    complain(field.name, "is " + quoted(*value), expected);
    return 0;
}

Vec3d JsonReader::components(const FieldInfo& field) {
    switch (field.kind) {
        case FieldKind::Int:
            return {wholeNumber(field), 0, 0};
        case FieldKind::Bool:
            return {boolean(field.name) ? 1.0 : 0.0, 0, 0};
        case FieldKind::Choice: {
            const std::vector<std::string_view> choices(field.choices.begin(), field.choices.end());
            return {static_cast<double>(choice(field.name, choices)), 0, 0};
        }
        case FieldKind::Vector:
        case FieldKind::Colour:
            return vector(field.name, field.min, field.max, field.unit).cast<double>();
        case FieldKind::Float:
        case FieldKind::Seed:
        case FieldKind::Ramp:
            break;
    }
    return {number(field.name, field.min, field.max, field.unit), 0, 0};
}

void JsonReader::ramp(std::string_view key, runtime::Ramp& ramp) {
    std::vector<runtime::Ramp::Key> keys;
    for (const auto& [at, value] : pairs(key, 0, 1, runtime::Ramp::kMaxKeys))
        keys.push_back({static_cast<float>(at), static_cast<float>(value)});
    if (!ok()) return;
    const auto read = runtime::Ramp::of(keys);
    const std::string words = runtime::validationError(read);
    if (!words.empty()) {
        const Error error = errorOfWords(words);
        return complain(key, error.problem, error.expected);
    }
    ramp = read;
}

nlohmann::ordered_json valueToJson(const runtime::Ramp& ramp) {
    auto keys = nlohmann::ordered_json::array();
    for (const auto& [at, value] : ramp.inUse())
        keys.push_back({readableDecimal(at), readableDecimal(value)});
    return keys;
}

nlohmann::ordered_json valueToJson(const FieldInfo& field, const Vec3d& components) {
    switch (field.kind) {
        case FieldKind::Int:
            return static_cast<std::uint32_t>(components[0]);
        case FieldKind::Bool:
            return components[0] != 0;
        case FieldKind::Choice:
            return field.choices[static_cast<std::size_t>(components[0])];
        case FieldKind::Vector:
        case FieldKind::Colour:
            return valueToJson(Vec3f(components.cast<float>()));
        case FieldKind::Float:
        case FieldKind::Seed:
        case FieldKind::Ramp:
            break;
    }
    return valueToJson(static_cast<float>(components[0]));
}

double readableDecimal(float value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof(text), value).ptr;
    double decimal = 0;
    std::from_chars(text, end, decimal);
    return static_cast<float>(decimal) == value ? decimal : static_cast<double>(value);
}

}  // namespace hairloom
