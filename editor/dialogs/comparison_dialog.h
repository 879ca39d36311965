// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What changed between another version of the hair and the document.

#include <QDialog>
#include <QString>

#include "core/groom/groom_diff.h"

namespace hairloom::editor {

class ComparisonDialog : public QDialog {
    Q_OBJECT

  public:
    /// `other`: the file that was compared with; `parts`: what of it.
    ComparisonDialog(const GroomComparison& comparison, ComparedParts parts, const QString& other,
                     QWidget* parent = nullptr);
};

}  // namespace hairloom::editor
