// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Questions about projects that somebody else has to do with, too.

#include <QString>
#include <QWidget>
#include <string>
#include <utility>
#include <vector>

#include "core/documents/recovery.h"

namespace hairloom::editor {

/// The project was saved by another program or window since it was opened here.
enum class ChangedAnswer { SaveAs, Overwrite, Reload, Cancel };
ChangedAnswer askAboutChangedProject(QWidget* parent, const QString& path);

/// Other windows have the project open that is to be opened.
enum class ElsewhereAnswer { Open, OpenCopy, Cancel };
ElsewhereAnswer askAboutOpenProject(QWidget* parent, const QString& path,
                                    const std::vector<OpenDocument>& windows);
/// Other windows have the project open that is to be replaced.
bool askToReplaceOpenProject(QWidget* parent, const QString& path, const std::vector<OpenDocument>& windows);

/// Unsaved work waits of the project that is to be opened.
enum class WaitingAnswer { Recover, OpenSaved, Cancel };
WaitingAnswer askAboutWaitingCopy(QWidget* parent, const QString& path, const RecoveryCopy& copy);

/// What readerSecurity() found, a line each.
QString securityText(const std::vector<std::pair<std::string, std::string>>& rows);

/// "3 minutes ago" would be wrong soon: date and time.
QString timeText(std::filesystem::file_time_type time);

}  // namespace hairloom::editor
