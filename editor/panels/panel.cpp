// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/panels/panel.h"

#include <QLabel>
#include <QScrollArea>
#include <QToolButton>
#include <QVBoxLayout>

namespace hairloom::editor {

QWidget* heading(const QString& text) {
    auto* label = new QLabel(text);
    label->setProperty("role", "heading");
    return label;
}

QWidget* scrolled(QWidget* content) {
    auto* area = new QScrollArea;
    area->setWidgetResizable(true);
    area->setFrameShape(QFrame::NoFrame);
    area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    area->setWidget(content);
    area->setMinimumWidth(content->minimumSizeHint().width() + 12);
    return area;
}

QWidget* column(std::initializer_list<QWidget*> rows) {
    auto* widget = new QWidget;
    auto* layout = new QVBoxLayout(widget);
    layout->setContentsMargins(12, 8, 12, 12);
    layout->setSpacing(8);
    for (QWidget* row : rows) layout->addWidget(row);
    layout->addStretch(1);
    return widget;
}

QWidget* foldable(const QString& title, QWidget* content, bool open) {
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
    button->setToolTip(QObject::tr("Shows or hides these controls"));
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
