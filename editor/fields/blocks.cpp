// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/blocks.h"

#include <QDialogButtonBox>
#include <QEvent>
#include <QHeaderView>
#include <QKeyEvent>
#include <QLabel>
#include <QScrollArea>
#include <QScrollBar>
#include <QTimer>
#include <QToolButton>
#include <QVBoxLayout>
#include <QWidgetAction>
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

void addCaption(QMenu& menu, const QString& text) {
    if (!menu.isEmpty()) menu.addSeparator();
    auto* label = new QLabel(text);
    label->setProperty("role", "caption");
    auto* caption = new QWidgetAction(&menu);
    caption->setText(text);
    caption->setDefaultWidget(label);
    // Keys step over it.
    caption->setEnabled(false);
    menu.addAction(caption);
}

namespace {

class SearchBox : public QLineEdit {
  public:
    explicit SearchBox(QTreeWidget& list) : list_(list) {}

  protected:
    void keyPressEvent(QKeyEvent* event) override {
        const int key = event->key();
        if (key != Qt::Key_Return && key != Qt::Key_Enter && key != Qt::Key_Down)
            return QLineEdit::keyPressEvent(event);
        goToList();
    }

  private:
    void goToList() {
        QTreeWidgetItem* row = list_.currentItem();
        if (!row || row->isHidden()) row = nullptr;
        for (int i = 0; !row && i < list_.topLevelItemCount(); ++i) {
            if (!list_.topLevelItem(i)->isHidden()) row = list_.topLevelItem(i);
        }
        if (!row) return;
        list_.setCurrentItem(row, 0, QItemSelectionModel::NoUpdate);
        list_.setFocus(Qt::TabFocusReason);
    }

    QTreeWidget& list_;
};

}  // namespace

QLineEdit* searchBox(const char* name, const QString& words, const QString& tip, QTreeWidget& list) {
    auto* box = new SearchBox(list);
    box->setObjectName(name);
    box->setPlaceholderText(words);
    box->setAccessibleName(words);
    box->setToolTip(tip);
    box->setClearButtonEnabled(true);
    return box;
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
constexpr int kNarrowPanel_px = 259;

/// Scrolls up and down alone: it is as wide as what lies in it needs at the time, but in narrow windows.
class PanelArea : public QScrollArea {
  public:
    explicit PanelArea(QWidget* content) {
        setWidgetResizable(true);
        setFrameShape(QFrame::NoFrame);
        setWidget(content);
    }
    QSize minimumSizeHint() const override {
        const int needed = widget()->minimumSizeHint().width() + verticalScrollBar()->sizeHint().width();
        return {std::min(needed, kNarrowPanel_px), QScrollArea::minimumSizeHint().height()};
    }

  protected:
    bool eventFilter(QObject* watched, QEvent* event) override {
        if (watched == widget() && event->type() == QEvent::LayoutRequest) updateGeometry();
        return QScrollArea::eventFilter(watched, event);
    }
};

}  // namespace

QWidget* scrolled(QWidget* content) {
    return new PanelArea(content);
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

constexpr int kAside_px = 12, kAbove_px = 8;  // that a cell has besides its words

int wrappedHeight(const QTreeWidget& table, const QString& words, int width_px) {
    const QRect room(0, 0, std::max(20, width_px - kAside_px), 4000);
    return table.fontMetrics().boundingRect(room, Qt::TextWordWrap, words).height();
}

void setHeight(QTreeWidgetItem& item, int height_px) {
    const QSize hint(0, height_px + kAbove_px);
    if (item.sizeHint(0).height() != hint.height()) item.setSizeHint(0, hint);
}

void wrapNow(QTreeWidget& table) {
    for (int row = 0; row < table.topLevelItemCount(); ++row) {
        QTreeWidgetItem* const item = table.topLevelItem(row);
        int height = table.fontMetrics().height();
        for (int c = 0; c < table.columnCount(); ++c)
            height = std::max(height, wrappedHeight(table, item->text(c), table.columnWidth(c)));
        setHeight(*item, height);
        // What is below it has the whole width.
        const int width = table.header()->length() - table.indentation();
        for (int child = 0; child < item->childCount(); ++child)
            setHeight(*item->child(child), wrappedHeight(table, item->child(child)->text(0), width));
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
