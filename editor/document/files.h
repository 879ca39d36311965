// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Opening files into the document: projects, heads, hair, samples. The reading runs as a task.

#include <QString>
#include <filesystem>

#include "core/animation/actor.h"
#include "editor/session.h"
#include "importers/strands.h"

namespace hairloom::editor {

enum class FileKind {
    Project,
    Head,     ///< a mesh, with its skeleton and clips
    Strands,  ///< hair of another program
};
/// From the beginning of the file, and the name where that does not tell. OBJ may be either: it is a head
/// where it has faces that are no ribbons of hair.
FileKind kindOf(const QString& path);

/// For file dialogs: all that opens, and hair of other programs alone.
QString openFilter();
QString strandFilter();

/// Project or head, opened as the document; hair as it is, without a head. `done` is called when it is there.
void openFile(Session& session, const QString& path, std::function<void()> done = {});
/// A sample of samples/hairstyles, or the bare bust where the name is empty.
void openSample(Session& session, const QString& name);
/// Strands with these options, bound to the head of the document if it has one, replacing its strands.
void importStrandsInto(Session& session, const QString& path, const StrandImportOptions& options);
/// What a crash left.
void openRecovered(Session& session, const QString& file, const QString& documentPath, const QString& name);

std::filesystem::path samplesFolder();

}  // namespace hairloom::editor
