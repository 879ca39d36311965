// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Descriptions of the settings that a groom has beside the engine's, by the means of hairloom/field.h, and
// what is said of any field in messages and lists.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/groom/groom.h"
#include "hairloom/field.h"

namespace hairloom {

using runtime::boolField;
using runtime::choiceField;
using runtime::colourField;
using runtime::defaultValue;
using runtime::Field;
using runtime::field;
using runtime::FieldInfo;
using runtime::FieldKind;
using runtime::fieldValue;
using runtime::rampField;
using runtime::seedField;
using runtime::setFieldValue;

std::span<const Field<HairMaterial>> fieldsOf(const HairMaterial&);
std::span<const Field<InterpolationSettings>> fieldsOf(const InterpolationSettings&);
std::span<const Field<ShadowSettings>> fieldsOf(const ShadowSettings&);
std::span<const Field<PlacementSettings>> fieldsOf(const PlacementSettings&);

/// "5e-06 to 0.005 m": the range with its unit, for messages.
std::string rangeText(double min, double max, std::string_view unit);
/// "is 7; expected 0 to 2" completes a sentence that begins with the field's name.
std::string outOfRangeText(double value, double min, double max, std::string_view unit);
/// Inside, or on the border as a float rounds it. False for NaN.
bool withinRange(double value, double min, double max);

/// "specular is 7; expected 0 to 2", one for each component outside its range.
std::vector<std::string> sentences(const std::vector<runtime::FieldProblem>& problems);
template <class S>
std::vector<std::string> fieldsOutOfRange(const S& settings) {
    return sentences(runtime::problemsIn(settings));
}

}  // namespace hairloom
