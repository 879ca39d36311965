// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What publishing asks of names that people choose: versions (core/base/versioned_name.h), and manifests of
// what is written.

#include <QString>

#include "core/groom/file/manifest.h"
#include "editor/document/qt_document.h"

namespace hairloom::editor {

/// With the next free version in place of `v###`; as it is where there is none.
QString withNextVersion(const QString& path);
/// "bob_v002.hairloom" for "bob.hairloom" and for "bob_v001.hairloom", or the next one that is free.
QString nextVersionOf(const QString& path);

/// Of what `command` writes; the project's file is an input where there is one.
ManifestSource manifestSource(const QtDocument& document, const QString& command);

}  // namespace hairloom::editor
