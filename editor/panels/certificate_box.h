// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the hair withstands, found by random storms on it in the background.

#include <QDateTime>
#include <QLabel>
#include <QPushButton>
#include <QWidget>
#include <optional>

#include "core/stability/certificate.h"
#include "editor/document/qt_document.h"
#include "editor/document/tasks.h"

namespace hairloom::editor {

class CertificateBox : public QWidget {
    Q_OBJECT

  public:
    CertificateBox(QtDocument& document, Tasks& tasks, QWidget* parent = nullptr);

  private:
    void certify();
    void refresh();

    QtDocument& document_;
    Tasks& tasks_;
    QLabel* words_;
    QPushButton* certify_;
    std::optional<Certificate> certificate_;
    QDateTime triedAt_;
    std::uint32_t documents_ = 0;                  ///< that were opened: a certificate is of one
    std::uint32_t changes_ = 0, triedChange_ = 0;  ///< of the document, and when `certificate_` began
};

}  // namespace hairloom::editor
