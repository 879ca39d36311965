// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Programs that hair is exported for, and the formats that they read.

#include <QString>
#include <vector>

#include "exporters/strands.h"

namespace hairloom::editor {

/// A program, and the writer of the format that it reads.
struct ExportChoice {
    const HairWriter* writer;
    const ExportTarget* target;
    bool isPage = false;  ///< a folder around the writer's file
};

/// A program, with the formats that it reads, the one that carries most of the hair first.
struct ExportProgram {
    QString name;
    std::vector<ExportChoice> choices;
};

/// Each program once, in order of name.
const std::vector<ExportProgram>& programsToExportFor();
/// Of the program's format of that number; the nearest where there is none.
const ExportChoice& exportChoice(int program, int format);

/// Why the choice cannot work on this machine; empty where it can.
QString problemOf(const ExportChoice& choice);

}  // namespace hairloom::editor
