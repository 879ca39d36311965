// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One table per settings struct: name, unit, range and meaning of each member. Validation, project files,
// scripts, command lines and panels read the tables, so that a field is described once.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/math.h"
#include "core/groom/groom.h"

namespace hairloom {

/// One authored field. For a vector the range holds for each component; a truth value is 0 or 1. The default
/// is the member's value in a value-initialised S.
template <class S>
struct Field {
    using Settings = S;
    using Member = std::variant<float S::*, std::uint32_t S::*, std::uint64_t S::*, Vec3f S::*, bool S::*>;
    const char* name;  ///< as in files and on the command line
    const char* unit;  ///< "" for a pure number
    double min;        ///< kLargestSeed as max stands for the largest 64-bit number
    double max;
    const char* meaning;  ///< what turning it does, one sentence
    Member member;
};

inline constexpr double kLargestSeed = 18446744073709551615.0;

std::span<const Field<HairMaterial>> fieldsOf(const HairMaterial&);
std::span<const Field<InterpolationSettings>> fieldsOf(const InterpolationSettings&);
std::span<const Field<PlacementSettings>> fieldsOf(const PlacementSettings&);

/// False for member types that are larger than S: no field has one, and compilers warn of reading beyond S
/// there.
template <class S, class Member>
constexpr bool mayHold() {
    return sizeof(std::declval<S&>().*std::declval<Member>()) <= sizeof(S);
}

/// 3 for a vector, else 1.
template <class S>
std::uint32_t componentCount(const Field<S>& field) {
    return std::holds_alternative<Vec3f S::*>(field.member) ? 3 : 1;
}

/// Value of component < componentCount(field). A seed above 2^53 is rounded; read the member itself for its
/// bits.
template <class S>
double fieldValue(const S& settings, const Field<S>& field, std::uint32_t component = 0) {
    return std::visit(
        [&](auto member) -> double {
            if constexpr (!mayHold<S, decltype(member)>()) {
                return 0;
            } else if constexpr (std::is_same_v<decltype(member), Vec3f S::*>) {
                return static_cast<double>((settings.*member)[component]);
            } else {
                return static_cast<double>(settings.*member);
            }
        },
        field.member);
}

/// "5e-06 to 0.005 m": the range with its unit, for messages.
std::string rangeText(double min, double max, std::string_view unit);
/// "is 7; expected 0 to 2" completes a sentence that begins with the field's name.
std::string outOfRangeText(double value, double min, double max, std::string_view unit);
/// Inside, or on the border as a float rounds it. False for NaN.
bool withinRange(double value, double min, double max);

/// "specular is 7; expected 0 to 2", one for each component outside its range.
template <class S>
std::vector<std::string> fieldsOutOfRange(const S& settings) {
    std::vector<std::string> problems;
    for (const Field<S>& field : fieldsOf(settings)) {
        for (std::uint32_t c = 0; c < componentCount(field); ++c) {
            const double value = fieldValue(settings, field, c);
            if (withinRange(value, field.min, field.max)) continue;
            problems.push_back(std::string(field.name) +
                               (componentCount(field) == 3 ? std::string(".") + "xyz"[c] : "") + " " +
                               outOfRangeText(value, field.min, field.max, field.unit));
        }
    }
    return problems;
}

}  // namespace hairloom
