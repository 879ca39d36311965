// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/dialogs/shortcut_dialog.h"

#include <QDialogButtonBox>
#include <QHeaderView>
#include <QKeySequenceEdit>
#include <QPushButton>
#include <QVBoxLayout>

#include "editor/fields/blocks.h"

namespace hairloom::editor {
namespace {

QString plainText(QString text) {
    return text.remove('&').remove(QChar(0x2026));
}

}  // namespace

ShortcutDialog::ShortcutDialog(Actions& actions, QWidget* parent)
    : QDialog(parent), actions_(actions), list_(new QTreeWidget), message_(new QLabel) {
    setWindowTitle("Keyboard shortcuts");
    resize(620, 560);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(16, 16, 16, 16);
    layout->setSpacing(10);
    auto* search = searchBox("searchShortcuts", "Search actions",
                             "Show only actions whose name contains this text", *list_);
    layout->addWidget(search);
    list_->setHeaderLabels({"Action", "Shortcut"});
    list_->setAccessibleName("Actions and their shortcuts");
    list_->setRootIsDecorated(false);
    list_->header()->setStretchLastSection(false);
    list_->header()->setSectionResizeMode(0, QHeaderView::Stretch);
    list_->header()->setSectionResizeMode(1, QHeaderView::Fixed);
    list_->header()->resizeSection(1, 180);
    list_->setSelectionMode(QAbstractItemView::NoSelection);
    layout->addWidget(list_, 1);
    message_->setProperty("role", "dim");
    message_->hide();
    layout->addWidget(message_);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
    auto* reset = buttons->addButton("Reset all", QDialogButtonBox::ResetRole);
    reset->setToolTip("Restore the default shortcut of every action");
    // Return is the list's, which it goes from to an action's keys.
    for (auto* button : {reset, buttons->button(QDialogButtonBox::Close)}) button->setAutoDefault(false);
    connect(list_, &QTreeWidget::itemActivated, this,
            [this](QTreeWidgetItem* item) { list_->itemWidget(item, 1)->setFocus(Qt::TabFocusReason); });
    layout->addWidget(buttons);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    connect(reset, &QPushButton::clicked, this, [this] {
        actions_.resetShortcuts();
        fill();
    });
    connect(search, &QLineEdit::textChanged, this, &ShortcutDialog::filter);
    fill();
}

void ShortcutDialog::fill() {
    list_->clear();
    for (const ActionInfo& info : actions_.all()) {
        auto* item = new QTreeWidgetItem({plainText(info.text)});
        item->setToolTip(0, info.tip);
        item->setSizeHint(0, {0, 34});
        list_->addTopLevelItem(item);
        auto* edit = new QKeySequenceEdit(actions_.get(info.id).shortcut());
        edit->setObjectName(info.id);
        edit->setToolTip(QString("Click and press a new shortcut for: %1").arg(plainText(info.text)));
        list_->setItemWidget(item, 1, edit);
        connect(edit, &QKeySequenceEdit::editingFinished, this, [this, edit, id = info.id] {
            if (edit->keySequence() == actions_.get(id).shortcut()) return;
            const QString robbed = actions_.setShortcut(id, edit->keySequence());
            if (robbed.isEmpty()) return;
            message_->setText(QString("Removed from %1").arg(plainText(actions_.get(robbed).text())));
            message_->show();
            if (auto* other = list_->findChild<QKeySequenceEdit*>(robbed)) other->clear();
        });
    }
}

void ShortcutDialog::filter(const QString& text) {
    for (int row = 0; row < list_->topLevelItemCount(); ++row) {
        QTreeWidgetItem* const item = list_->topLevelItem(row);
        item->setHidden(!item->text(0).contains(text, Qt::CaseInsensitive));
    }
}

}  // namespace hairloom::editor
