// SPDX-License-Identifier: MIT
#pragma once
// What is said of an authored setting, once: name, unit, range, meaning. A struct of settings has one table
// of fields, and validation, files, command lines, panels, tooltips and the reference page all read that
// table:
//
//     struct Curl {
//         float radius = 0.006f;
//         std::uint64_t seed = 1;
//     };
//     constexpr Field<Curl> kFields[] = {
//         field<&Curl::radius>("radius", "m", 0, 0.1, "of the helix"),
//         seedField<&Curl::seed>("seed", "another seed gives other angles"),
//     };
//     std::span<const Field<Curl>> fieldsOf(const Curl&) { return kFields; }
//
// The functions below find fieldsOf() in the namespace of the struct.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "hairloom/ramp.h"

namespace hairloom::runtime {

enum class FieldKind : std::uint8_t {
    Float,
    Int,     ///< a 32-bit count
    Bool,    ///< 0 or 1
    Choice,  ///< an enumeration, as the index of its value
    Vector,  ///< three floats
    Colour,  ///< three floats, linear red, green and blue
    Seed,    ///< any 64-bit number
    Ramp,    ///< a curve from root to tip
};

/// The largest 64-bit number, as nearly as a double has it.
inline constexpr double kMaxSeed = 18446744073709551615.0;

/// The description alone, whatever the struct.
struct FieldInfo {
    const char* name;  ///< as in files and on the command line
    const char* unit;  ///< "" for a pure number
    double min;        ///< for a vector of each component, for a ramp of the value at each key
    double max;
    const char* meaning;  ///< what turning it does, one sentence
    FieldKind kind;
    std::span<const char* const> choices{};  ///< names of an enumeration's values, in order; else empty

    /// 3 for a vector or colour, 0 for a ramp, which has keys instead, else 1.
    constexpr std::uint32_t components() const {
        if (kind == FieldKind::Ramp) return 0;
        return kind == FieldKind::Vector || kind == FieldKind::Colour ? 3 : 1;
    }
    /// Takes no fractions.
    constexpr bool isWhole() const {
        return kind == FieldKind::Int || kind == FieldKind::Bool || kind == FieldKind::Choice ||
               kind == FieldKind::Seed;
    }
    /// Inside, or on the border as a float rounds it, where it takes fractions. False for NaN.
    bool holds(double value) const {
        if (isWhole()) return value >= min && value <= max && value == std::floor(value);
        return value >= std::min(min, static_cast<double>(static_cast<float>(min))) &&
               value <= std::max(max, static_cast<double>(static_cast<float>(max)));
    }
};

/// A described member of S. Its default is what the member is in S{}.
template <class S>
struct Field : FieldInfo {
    double (*get)(const S&, std::uint32_t component);
    void (*set)(S&, double value, std::uint32_t component);
    const void* (*address)(const S&);
};

namespace field_detail {

template <class>
struct Member;
template <class S, class T>
struct Member<T S::*> {
    using Settings = S;
    using Type = T;
};
template <auto M>
using SettingsOf = typename Member<decltype(M)>::Settings;
template <auto M>
using TypeOf = typename Member<decltype(M)>::Type;

template <class V>
auto& component(V& vector, std::uint32_t c) {
    if constexpr (requires { vector[0]; }) {
        return vector[c];
    } else {
        return c == 0 ? vector.x : c == 1 ? vector.y : vector.z;
    }
}

template <class T>
constexpr bool isVector = std::is_class_v<T> && !std::is_same_v<T, Ramp>;

template <class T>
constexpr FieldKind kindOf() {
    if constexpr (std::is_same_v<T, float>) return FieldKind::Float;
    if constexpr (std::is_same_v<T, std::uint32_t>) return FieldKind::Int;
    if constexpr (isVector<T>) return FieldKind::Vector;
    if constexpr (std::is_same_v<T, bool>) return FieldKind::Bool;
    if constexpr (std::is_same_v<T, Ramp>) return FieldKind::Ramp;
    if constexpr (std::is_same_v<T, std::uint64_t>) return FieldKind::Seed;
    static_assert(!std::is_same_v<T, double> && !std::is_pointer_v<T>, "no kind of field has this type");
    return FieldKind::Choice;
}

template <auto M>
double get(const SettingsOf<M>& settings, std::uint32_t c) {
    using T = TypeOf<M>;
    if constexpr (isVector<T>) {
        return static_cast<double>(component(settings.*M, c));
    } else if constexpr (std::is_same_v<T, Ramp>) {
        return 0;
    } else {
        return static_cast<double>(settings.*M);
    }
}

template <auto M>
void set(SettingsOf<M>& settings, double value, std::uint32_t c) {
    using T = TypeOf<M>;
    if constexpr (isVector<T>) {
        component(settings.*M, c) = static_cast<float>(value);
    } else if constexpr (std::is_enum_v<T>) {
        settings.*M = static_cast<T>(static_cast<std::uint32_t>(value));
    } else if constexpr (std::is_same_v<T, bool>) {
        settings.*M = value != 0;
    } else if constexpr (std::is_same_v<T, std::uint64_t>) {
        settings.*M = value < kMaxSeed ? static_cast<T>(value) : ~std::uint64_t{0};
    } else if constexpr (!std::is_same_v<T, Ramp>) {
        settings.*M = static_cast<T>(value);
    }
}

template <auto M>
const void* address(const SettingsOf<M>& settings) {
    return &(settings.*M);
}

template <auto M>
constexpr Field<SettingsOf<M>> describe(FieldInfo info) {
    return {info, &get<M>, &set<M>, &address<M>};
}

}  // namespace field_detail

/// A number, a count or a vector.
template <auto M>
constexpr auto field(const char* name, const char* unit, double min, double max, const char* meaning) {
    constexpr FieldKind kind = field_detail::kindOf<field_detail::TypeOf<M>>();
    static_assert(kind == FieldKind::Float || kind == FieldKind::Int || kind == FieldKind::Vector);
    return field_detail::describe<M>({name, unit, min, max, meaning, kind});
}
template <auto M>
constexpr auto boolField(const char* name, const char* meaning) {
    static_assert(std::is_same_v<field_detail::TypeOf<M>, bool>);
    return field_detail::describe<M>({name, "", 0, 1, meaning, FieldKind::Bool});
}
/// `choices` names the values of the enumeration from 0 on.
template <auto M>
constexpr auto choiceField(const char* name, const char* meaning, std::span<const char* const> choices) {
    static_assert(std::is_enum_v<field_detail::TypeOf<M>>);
    const auto last = static_cast<double>(choices.size() - 1);
    return field_detail::describe<M>({name, "", 0, last, meaning, FieldKind::Choice, choices});
}
template <auto M>
constexpr auto colourField(const char* name, const char* meaning) {
    static_assert(field_detail::isVector<field_detail::TypeOf<M>>);
    return field_detail::describe<M>({name, "", 0, 1, meaning, FieldKind::Colour});
}
template <auto M>
constexpr auto seedField(const char* name, const char* meaning) {
    static_assert(std::is_same_v<field_detail::TypeOf<M>, std::uint64_t>);
    return field_detail::describe<M>({name, "", 0, kMaxSeed, meaning, FieldKind::Seed});
}
template <auto M>
constexpr auto rampField(const char* name, const char* meaning) {
    static_assert(std::is_same_v<field_detail::TypeOf<M>, Ramp>);
    return field_detail::describe<M>({name, "", 0, 1, meaning, FieldKind::Ramp});
}

/// Value of component < field.components(). A seed above 2^53 is rounded; member() has its bits.
template <class S>
double fieldValue(const S& settings, const Field<S>& field, std::uint32_t component = 0) {
    assert(component < field.components());
    return field.get(settings, component);
}
template <class S>
double defaultValue(const Field<S>& field, std::uint32_t component = 0) {
    return fieldValue(S{}, field, component);
}
/// Sets it where the field holds the value; else, and for a ramp, false and no change.
template <class S>
bool setFieldValue(S& settings, const Field<S>& field, double value, std::uint32_t component = 0) {
    if (component >= field.components() || !field.holds(value)) return false;
    field.set(settings, value, component);
    return true;
}

/// The member itself, whose type is T: a Ramp, or the std::uint64_t of a seed.
template <class T, class S>
const T& member(const S& settings, const Field<S>& field) {
    assert(field.kind == field_detail::kindOf<T>());
    return *static_cast<const T*>(field.address(settings));
}
template <class T, class S>
T& member(S& settings, const Field<S>& field) {
    return const_cast<T&>(member<T>(std::as_const(settings), field));
}

/// The field of that name, or null.
template <class S>
const Field<S>* findField(std::string_view name) {
    for (const Field<S>& field : fieldsOf(S())) {
        if (name == field.name) return &field;
    }
    return nullptr;
}

/// A value that its field does not hold.
struct FieldProblem {
    const FieldInfo* field;
    std::uint32_t component;
    double value;      ///< 0 for a ramp
    std::string ramp;  ///< what is wrong with a ramp, "has 1 keys; expected 2 to 16"; else empty

    /// "gravity.y", or the field's name alone.
    std::string where() const {
        return field->components() == 3 ? std::string(field->name) + '.' + "xyz"[component] : field->name;
    }
};
/// Every value outside its range; empty when all is well.
template <class S>
std::vector<FieldProblem> problemsIn(const S& settings) {
    std::vector<FieldProblem> problems;
    for (const Field<S>& field : fieldsOf(settings)) {
        if (field.kind == FieldKind::Ramp) {
            std::string problem = validationError(member<Ramp>(settings, field));
            if (!problem.empty()) problems.push_back({&field, 0, 0, std::move(problem)});
        }
        for (std::uint32_t c = 0; c < field.components(); ++c) {
            const double value = field.get(settings, c);
            if (!field.holds(value)) problems.push_back({&field, c, value, {}});
        }
    }
    return problems;
}

}  // namespace hairloom::runtime
