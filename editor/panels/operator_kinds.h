// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// How the list of operators is grouped for people who look for one.

#include <QIcon>
#include <QString>
#include <string_view>
#include <vector>

#include "core/operations/stack.h"

namespace hairloom::editor {

/// What artists look for an operator under: "Direction", "Locks".
QString operatorKind(std::string_view name);
/// In the order of a day's work.
std::vector<StackOperator> operatorsByKind();
/// That of the brush that does alike, where there is one.
QIcon operatorIcon(std::string_view name);

}  // namespace hairloom::editor
