// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/fields/input_rules.h"

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSpinBox>
#include <QAccessible>
#include <QApplication>
#include <QComboBox>
#include <QDialog>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QMainWindow>
#include <QProgressBar>
#include <QPushButton>
#include <QScrollBar>
#include <QSlider>
#include <QTextDocumentFragment>
#include <QToolButton>

namespace hairloom::editor {
namespace {

bool changesByWheel(const QObject& object) {
    return qobject_cast<const QAbstractSpinBox*>(&object) || qobject_cast<const QComboBox*>(&object) ||
           qobject_cast<const QSlider*>(&object);
}

/// Keys that belong to the control and to no shortcut of the window.
bool ownsKey(const QObject& object, const QKeyEvent& key) {
    if (key.modifiers() & ~(Qt::KeypadModifier | Qt::ShiftModifier)) return false;
    const bool isList = qobject_cast<const QAbstractItemView*>(&object) != nullptr;
    switch (key.key()) {
        case Qt::Key_Space:
            return key.modifiers() == Qt::NoModifier &&
                   (isList || qobject_cast<const QAbstractButton*>(&object) ||
                    qobject_cast<const QComboBox*>(&object));
        case Qt::Key_Delete:
            return isList;
        case Qt::Key_Home:
        case Qt::Key_End:
            return isList || qobject_cast<const QAbstractSlider*>(&object);
        default:
            return false;
    }
}

/// In dialogs, boxes that are ticked leave Return to the default button.
QAbstractButton* pressedByReturn(QObject& object, const QKeyEvent& key) {
    if (key.key() != Qt::Key_Return && key.key() != Qt::Key_Enter) return nullptr;
    auto* button = qobject_cast<QAbstractButton*>(&object);
    if (!button || !qobject_cast<QDialog*>(button->window())) return button;
    return qobject_cast<QPushButton*>(button) || qobject_cast<QToolButton*>(button) ? button : nullptr;
}

/// One that people type words in beside the view, and no part of another control.
QLineEdit* wordsBesideTheView(QObject& object) {
    auto* edit = qobject_cast<QLineEdit*>(&object);
    if (!edit || !qobject_cast<QMainWindow*>(edit->window())) return nullptr;
    const QWidget* parent = edit->parentWidget();
    const bool isPart = qobject_cast<const QAbstractSpinBox*>(parent) ||
                        qobject_cast<const QComboBox*>(parent) ||
                        qobject_cast<const QAbstractItemView*>(parent->parentWidget());
    return isPart ? nullptr : edit;
}

constexpr const char* kWordsBefore = "wordsBefore";

QString labelFor(const QWidget& control) {
    for (const QWidget* widget = &control; widget && !widget->isWindow(); widget = widget->parentWidget()) {
        if (!widget->accessibleName().isEmpty()) return widget->accessibleName();
        const QWidget* parent = widget->parentWidget();
        if (!parent) break;
        for (const QLabel* label : parent->findChildren<QLabel*>(QString(), Qt::FindDirectChildrenOnly)) {
            if (label->buddy() == widget) return label->text();
        }
    }
    return {};
}

QString plain(const QString& text) {
    return Qt::mightBeRichText(text) ? QTextDocumentFragment::fromHtml(text).toPlainText() : text;
}

}  // namespace

QString spokenName(const QWidget& control) {
    QString name = control.accessibleName();
    if (const auto* button = qobject_cast<const QAbstractButton*>(&control); name.isEmpty() && button)
        name = button->text();
    if (name.isEmpty()) name = labelFor(control);
    for (const QWidget* widget = &control; name.isEmpty() && widget && !widget->isWindow();
         widget = widget->parentWidget())
        name = plain(widget->toolTip()).section('\n', 0, 0);
    return name.remove('&').trimmed();
}

InputRules::InputRules(QObject* parent) : QObject(parent) {
    qApp->installEventFilter(this);
}

bool InputRules::eventFilter(QObject* object, QEvent* event) {
    switch (event->type()) {
        case QEvent::Polish:
            if (auto* widget = qobject_cast<QWidget*>(object)) {
                if (changesByWheel(*widget) && widget->focusPolicy() == Qt::WheelFocus)
                    widget->setFocusPolicy(Qt::StrongFocus);
                const bool isSpoken =
                    widget->focusPolicy() != Qt::NoFocus || qobject_cast<const QProgressBar*>(widget);
                if (isSpoken && widget->accessibleName().isEmpty())
                    widget->setAccessibleName(spokenName(*widget));
            }
            break;
        case QEvent::Wheel:
            if (changesByWheel(*object) && !static_cast<QWidget*>(object)->hasFocus()) {
                event->ignore();  // and what it lies in gets it
                return true;
            }
            break;
        case QEvent::ShortcutOverride:
            if (ownsKey(*object, *static_cast<QKeyEvent*>(event))) {
                event->accept();
                return true;
            }
            break;
        case QEvent::FocusIn:
            if (QLineEdit* edit = wordsBesideTheView(*object)) edit->setProperty(kWordsBefore, edit->text());
            break;
        case QEvent::KeyPress:
            // The keys of tools are theirs again once words are given up, as with numbers.
            if (QLineEdit* edit = wordsBesideTheView(*object);
                edit && static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape) {
                edit->setText(edit->property(kWordsBefore).toString());
                edit->clearFocus();
                return true;
            }
            if (QAbstractButton* button = pressedByReturn(*object, *static_cast<QKeyEvent*>(event))) {
                if (button->isEnabled()) button->click();
                return true;
            }
            break;
        default:
            break;
    }
    return QObject::eventFilter(object, event);
}

}  // namespace hairloom::editor
