// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/blocks.h"

#include <QDialogButtonBox>
#include <QHeaderView>
#include <QLabel>
#include <QScrollArea>
#include <QTimer>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <memory>
#include <utility>

namespace hairloom::editor {

QWidget* heading(const QString& text) {
    auto* label = new QLabel(text);
    label->setProperty("role", "heading");
    label->setIndent(0);
    return label;
}

QPushButton* pushButton(const char* name, const QString& text, const QString& tip,
                        std::function<void()> act) {
    auto* made = new QPushButton(text);
    made->setObjectName(name);
    made->setToolTip(tip);
    QObject::connect(made, &QPushButton::clicked, made, [act = std::move(act)] { act(); });
    return made;
}

QPushButton* acceptOrCancel(QDialog& dialog, QLayout& layout, const QString& text, const QString& tip) {
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Cancel);
    QPushButton* const accept = buttons->addButton(text, QDialogButtonBox::AcceptRole);
    accept->setDefault(true);
    accept->setEnabled(false);
    accept->setToolTip(tip);
    layout.addWidget(buttons);
    QObject::connect(buttons, &QDialogButtonBox::accepted, &dialog, &QDialog::accept);
    QObject::connect(buttons, &QDialogButtonBox::rejected, &dialog, &QDialog::reject);
    return accept;
}

QVBoxLayout* exportLayout(QDialog& dialog, QFormLayout& rows) {
    auto* layout = new QVBoxLayout(&dialog);
    layout->setContentsMargins(20, 20, 20, 16);
    layout->setSpacing(12);
    rows.setHorizontalSpacing(16);
    rows.setVerticalSpacing(8);
    rows.setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
    return layout;
}

namespace {

/// Two columns of them leave room for the view in a window of 856 pixels.
constexpr int kNarrowPanel_px = 252;

}  // namespace

QWidget* scrolled(QWidget* content) {
    auto* area = new QScrollArea;
    area->setWidgetResizable(true);
    area->setFrameShape(QFrame::NoFrame);
    area->setWidget(content);
    area->setMinimumWidth(std::min(content->minimumSizeHint().width() + 12, kNarrowPanel_px));
    return area;
}

QWidget* stacked(std::initializer_list<QWidget*> rows) {
    auto* widget = new QWidget;
    auto* layout = new QVBoxLayout(widget);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(6);
    for (QWidget* row : rows) layout->addWidget(row);
    return widget;
}

QWidget* column(std::initializer_list<QWidget*> rows) {
    auto* widget = new QWidget;
    auto* layout = new QVBoxLayout(widget);
    layout->setContentsMargins(10, 8, 10, 12);
    layout->setSpacing(8);
    for (QWidget* row : rows) layout->addWidget(row);
    layout->addStretch(1);
    return widget;
}

namespace {

void wrapNow(QTreeWidget& table) {
    constexpr int kAside = 12, kAbove = 8;  // pixels that a cell has besides its words
    for (int row = 0; row < table.topLevelItemCount(); ++row) {
        QTreeWidgetItem* const item = table.topLevelItem(row);
        int height = table.fontMetrics().height();
        for (int c = 0; c < table.columnCount(); ++c) {
            const int width = std::max(20, table.columnWidth(c) - kAside);
            height =
                std::max(height, table.fontMetrics()
                                     .boundingRect(QRect(0, 0, width, 4000), Qt::TextWordWrap, item->text(c))
                                     .height());
        }
        const QSize hint(0, height + kAbove);
        if (item->sizeHint(0).height() != hint.height()) item->setSizeHint(0, hint);
    }
}

}  // namespace

void wrapRows(QTreeWidget& table) {
    wrapNow(table);
    if (table.property("wraps").toBool()) return;
    table.setProperty("wraps", true);
    QObject::connect(table.header(), &QHeaderView::sectionResized, &table, [&table] { wrapNow(table); });
}

std::function<void()> paced(QObject& owner, std::function<void()> act) {
    auto* timer = new QTimer(&owner);
    timer->setSingleShot(true);
    timer->setInterval(200);
    const auto waits = std::make_shared<bool>(false);
    QObject::connect(timer, &QTimer::timeout, timer, [timer, waits, act] {
        if (!std::exchange(*waits, false)) return;
        act();
        timer->start();
    });
    return [timer, waits, act = std::move(act)] {
        *waits = timer->isActive();
        if (*waits) return;
        act();
        timer->start();
    };
}

QWidget* collapsible(const QString& title, QWidget* content, bool open) {
    auto* widget = new QWidget;
    auto* layout = new QVBoxLayout(widget);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(4);
    auto* button = new QToolButton;
    button->setText(title);
    button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    button->setArrowType(open ? Qt::DownArrow : Qt::RightArrow);
    button->setProperty("role", "fold");
    button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    button->setToolTip("Show or hide these controls");
    layout->addWidget(button);
    layout->addWidget(content);
    content->setVisible(open);
    QObject::connect(button, &QToolButton::clicked, content, [button, content] {
        const bool show = content->isHidden();
        content->setVisible(show);
        button->setArrowType(show ? Qt::DownArrow : Qt::RightArrow);
    });
    return widget;
}

}  // namespace hairloom::editor
