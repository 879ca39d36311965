// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The records of an editor among the operations of a script.

#include <string>
#include <vector>

#include "core/operations/script.h"

namespace hairloom::editing {

/// For parseScript(): "stroke" and the operations of records.h. Those of one call share what they derive from
/// a head.
std::vector<ScriptExtension> scriptExtensions();

}  // namespace hairloom::editing
