// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>

#include "core/base/result.h"

namespace hairloom::editor {

/// "Wind speed" from "windSpeed".
QString labelOf(const QString& name);
/// With a capital at its start, for what follows a full stop.
QString asSentence(QString text);
/// What an error says, with places in JSON in words: "Material › root radius is 99; expected …".
QString errorText(const Error& error);

}  // namespace hairloom::editor
