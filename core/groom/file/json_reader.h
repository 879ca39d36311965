// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Strict reading of JSON that may be damaged or hostile. Every complaint names its JSON path
// ("/layers/0/name").

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math.h"
#include "core/base/result.h"
#include "core/groom/file/fields.h"
#include "core/groom/file/former_names.h"

namespace hairloom {

/// Parses UTF-8 text of at most kMaxJsonBytes. Errors: syntax (with the byte, `firstByte` counted in),
/// nesting beyond kMaxJsonDepth, a member that stands twice in one object.
inline constexpr std::size_t kMaxJsonBytes = std::size_t{8} << 20u;
inline constexpr std::size_t kMaxJsonDepth = 32;
Result<nlohmann::json> parseJson(const std::string& file, std::string_view text, std::uint64_t firstByte = 0);

/// Reads the members of one object. The first complaint sticks and later reads give defaults, so that a
/// caller reads all it wants and asks status() once. The JSON value must outlive the reader.
class JsonReader {
  public:
    /// `file` is named in errors.
    JsonReader(const nlohmann::json& value, const std::string& file);

    /// Counts as asking for the member.
    bool has(std::string_view key);
    /// Absent members, other types and values out of range are complaints.
    std::string string(std::string_view key);
    bool boolean(std::string_view key);
    double number(std::string_view key, double min, double max, std::string_view unit = {});
    std::uint64_t count(std::string_view key, std::uint64_t min, std::uint64_t max);
    Vec3f vector(std::string_view key, double min, double max, std::string_view unit = {});
    /// The same where single precision has too few digits.
    Vec3d exactVector(std::string_view key, double min, double max, std::string_view unit = {});
    std::vector<std::string> strings(std::string_view key);
    /// An array of at most `most` numbers.
    std::vector<double> numbers(std::string_view key, double min, double max, std::size_t maximum,
                                std::string_view unit = {});
    /// An array of at most `most` pairs of numbers, each an array.
    std::vector<std::pair<double, double>> pairs(std::string_view key, double min, double max,
                                                 std::size_t maximum);
    /// An array of at most `most` arrays of three numbers.
    std::vector<Vec3f> vectors(std::string_view key, double min, double max, std::size_t maximum);
    /// An index into `choices`.
    std::size_t choice(std::string_view key, std::span<const std::string_view> choices);
    JsonReader object(std::string_view key);
    std::vector<JsonReader> objects(std::string_view key);
    /// The names of all members, in order of name.
    std::vector<std::string> keys() const;
    /// The members but these as a JSON object. Counts as asking for them.
    std::string rest(std::span<const std::string_view> known);

    /// Every member of the object that fieldsOf(S) describes, by its name or its former one; absent ones keep
    /// their value.
    template <class S>
    void fields(S& settings) {
        alsoReadFormer(formerMembers(settings));
        for (const Field<S>& field : fieldsOf(settings)) {
            if (has(field.name)) read(field, settings);
        }
    }

    /// Complains about the first member that nobody asked for, naming those that were.
    void finish();
    void complain(std::string_view key, const std::string& problem, const std::string& expected);
    /// The same of a place further below: "keys/3/t".
    void complainBelow(std::string_view path, const std::string& problem, const std::string& expected);
    bool ok() const { return !context_->error; }
    Status status() const;
    const std::string& path() const { return path_; }

  private:
    struct Context {
        std::string file;
        std::optional<Error> error;
    };
    JsonReader(const nlohmann::json& value, std::string path, std::shared_ptr<Context> context);
    /// Null and a complaint where it is absent; `expected` is what it should have been.
    const nlohmann::json* member(std::string_view key, const std::string& expected);
    /// Complains where a member stands beside its former name.
    void alsoReadFormer(std::span<const FormerMember> members);
    /// As the object has it: the former name where that stands there.
    std::string_view written(std::string_view key) const;

    template <class S>
    void read(const Field<S>& field, S& settings) {
        if (field.kind == FieldKind::Seed) {
            runtime::member<std::uint64_t>(settings, field) = count(field.name, 0, ~std::uint64_t{0});
        } else if (field.kind == FieldKind::Ramp) {
            ramp(field.name, runtime::member<runtime::Ramp>(settings, field));
        } else {
            const Vec3d values = components(field);
            for (std::uint32_t c = 0; ok() && c < field.components(); ++c) field.set(settings, values[c], c);
        }
    }
    /// Zeros behind a complaint.
    Vec3d components(const FieldInfo& field);
    double wholeNumber(const FieldInfo& field);
    /// [[at, value], …]; stays as it was where the keys are not sound.
    void ramp(std::string_view key, runtime::Ramp& ramp);

    const nlohmann::json* value_;
    std::string path_;
    std::shared_ptr<Context> context_;
    std::set<std::string, std::less<>> asked_;
    std::span<const FormerMember> former_;
};

/// The shortest decimal number that gives the same float again.
double readableDecimal(float value);

inline nlohmann::ordered_json valueToJson(float value) {
    return readableDecimal(value);
}
inline nlohmann::ordered_json valueToJson(const Vec3f& v) {
    return {readableDecimal(v.x()), readableDecimal(v.y()), readableDecimal(v.z())};
}
nlohmann::ordered_json valueToJson(const runtime::Ramp& ramp);
/// Of a field whose components these are.
nlohmann::ordered_json valueToJson(const FieldInfo& field, const Vec3d& components);

/// All fields of the table as an object, in its order.
template <class S>
nlohmann::ordered_json fieldsToJson(const S& settings) {
    auto json = nlohmann::ordered_json::object();
    for (const Field<S>& field : fieldsOf(settings)) {
        if (field.kind == FieldKind::Seed) {
            json[field.name] = runtime::member<std::uint64_t>(settings, field);
        } else if (field.kind == FieldKind::Ramp) {
            json[field.name] = valueToJson(runtime::member<runtime::Ramp>(settings, field));
        } else {
            Vec3d values = Vec3d::Zero();
            for (std::uint32_t c = 0; c < field.components(); ++c) values[c] = field.get(settings, c);
            json[field.name] = valueToJson(field, values);
        }
    }
    return json;
}

/// What stands in lists and on the reference page: a description and the default as it stands in JSON.
struct FieldRow {
    FieldInfo info;
    nlohmann::ordered_json defaultValue;
};
template <class S>
std::vector<FieldRow> fieldRows() {
    const S settings{};
    const auto defaults = fieldsToJson(settings);
    std::vector<FieldRow> rows;
    for (const Field<S>& field : fieldsOf(settings)) rows.push_back({field, defaults.at(field.name)});
    return rows;
}

}  // namespace hairloom
