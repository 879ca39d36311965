// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Operators as JSON: one form for project files, scripts and the command line.

#include <span>

#include "core/groom/file/json_reader.h"
#include "core/groom/groom.h"

namespace hairloom {

/// An operation as scripts have it, and beside it "enabled", "weight" and, of a sculpt, "number".
nlohmann::ordered_json toJson(const Operator& one);
nlohmann::ordered_json toJson(std::span<const Operator> operators);

/// Without its settings. Absent members have their defaults. Complaints are the reader's.
Operator readOperatorHead(JsonReader& reader);
/// Takes settings as they are; readOperator() of core/operations/stack.h knows them.
Operator readOperatorShape(JsonReader& reader);
/// The member "operators", with at most kMaxOperators of them, each as `readOne` takes it.
std::vector<Operator> readOperatorList(JsonReader& reader, Operator (*readOne)(JsonReader&));

}  // namespace hairloom
