// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The name of a painted mask, where one chooses it.

#include <QLabel>
#include <QLineEdit>
#include <QWidget>
#include <functional>

#include "editor/document/qt_document.h"

namespace hairloom::editor {

/// "Fringe (1)" or "Mask 1", from mask 1 to the last.
QStringList maskLabels(const Groom& groom);

class MaskNameEdit : public QWidget {
    Q_OBJECT

  public:
    /// `number` is asked which mask is chosen, from 1; 0 is none, and then there is nothing to be named.
    MaskNameEdit(QtDocument& document, std::function<std::uint32_t()> number, QWidget* parent = nullptr);

    /// After another mask was chosen.
    void refresh();

  private:
    void store();

    QtDocument& document_;
    std::function<std::uint32_t()> number_;
    std::uint32_t shown_ = 0;
    QLineEdit* edit_;
    QLabel* problem_;
};

}  // namespace hairloom::editor
