// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/dialogs/comparison_dialog.h"

#include <QClipboard>
#include <QDialogButtonBox>
#include <QGuiApplication>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QTreeWidget>
#include <QVBoxLayout>

namespace hairloom::editor {
namespace {

QString summaryOf(std::size_t count, ComparedParts parts, const QString& other) {
    const QString what = parts == ComparedParts::all
                             ? QString("Strands, settings, layers, operators and head")
                             : QString("Strands and their attributes");
    if (count == 0) return QString("%1 are the same in %2").arg(what, other);
    return QString("%1 were compared. %2 and this hair differ in %L3 %4:")
        .arg(what, other)
        .arg(count)
        .arg(count == 1 ? "place" : "places");
}

}  // namespace

ComparisonDialog::ComparisonDialog(const GroomComparison& comparison, ComparedParts parts,
                                   const QString& other, QWidget* parent)
    : QDialog(parent) {
    setWindowTitle(QString("Compare with %1").arg(other));
    resize(720, 480);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(16, 16, 16, 16);
    layout->setSpacing(10);
    auto* summary = new QLabel(summaryOf(comparison.differences.size(), parts, other));
    summary->setObjectName("summary");
    summary->setWordWrap(true);
    layout->addWidget(summary);
    auto* list = new QTreeWidget;
    list->setObjectName("differences");
    list->setHeaderLabels({"Where", "Change"});
    list->setAccessibleName("What changed");
    list->setRootIsDecorated(false);
    list->setSelectionMode(QAbstractItemView::ExtendedSelection);
    QString text;
    for (const GroomDifference& one : comparison.differences) {
        const QString where = QString::fromStdString(one.where),
                      change = QString::fromStdString(changeInWords(one));
        auto* item = new QTreeWidgetItem(list, {where, change});
        item->setToolTip(0, where);
        item->setToolTip(1, change);
        text += QString("%1: %2\n").arg(where, change);
    }
    list->header()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
    list->setVisible(!comparison.differences.empty());
    layout->addWidget(list, 1);
    if (comparison.differences.empty()) layout->addStretch(1);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
    auto* copy = buttons->addButton("Copy", QDialogButtonBox::ActionRole);
    copy->setToolTip("Copy the list as text");
    copy->setAutoDefault(false);
    copy->setEnabled(!text.isEmpty());
    buttons->button(QDialogButtonBox::Close)->setDefault(true);
    layout->addWidget(buttons);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    connect(copy, &QPushButton::clicked, this, [text] { QGuiApplication::clipboard()->setText(text); });
}

}  // namespace hairloom::editor
