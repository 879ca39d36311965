// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDialog>

#include "editor/document/preferences.h"

namespace hairloom::editor {

/// Every control takes effect at once.
class PreferencesDialog : public QDialog {
    Q_OBJECT

  public:
    explicit PreferencesDialog(Preferences& preferences, QWidget* parent = nullptr);
};

}  // namespace hairloom::editor
