// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Stiffness by region: what black and white of a painted mask or an image multiply the stiffness of strands
// by.

#include <QComboBox>
#include <QPushButton>
#include <QWidget>

#include "core/documents/strand_values.h"
#include "editor/document/messages.h"
#include "editor/document/qt_document.h"
#include "editor/fields/number_spin.h"

namespace hairloom::editor {

class StrandStiffness : public QWidget {
    Q_OBJECT

  public:
    /// What cannot be taken is told by `messages`.
    StrandStiffness(QtDocument& document, Messages& messages, QWidget* parent = nullptr);

  private:
    NumberSpin* factor(const char* name, const QString& tip, double value);
    StiffnessRange range() const;
    void takeMask();
    void setShares(std::span<const float> shares);
    void refresh();

    QtDocument& document_;
    Messages& messages_;
    NumberSpin* black_;
    NumberSpin* white_;
    QComboBox* mask_;
    QPushButton* even_;
};

}  // namespace hairloom::editor
