// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A person's hand on the mouse: every click lands on what is seen there. Actions are counted: clicks, drags,
// turns of the wheel and keys.

#include <QAbstractItemView>
#include <QApplication>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QDir>
#include <QDockWidget>
#include <QFileDialog>
#include <QListWidget>
#include <QMenuBar>
#include <QPushButton>
#include <QScrollArea>
#include <QScrollBar>
#include <QTabBar>
#include <QTimer>
#include <QToolButton>
#include <QWheelEvent>

#include "core/groom/strand_subset.h"
#include "editor/dialogs/export_dialog.h"
#include "editor/fields/number_box.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {

class MouseTest : public WindowTest {
  protected:
    explicit MouseTest(bool pictures = false) : WindowTest(pictures) {}
    void SetUp() override {
        WindowTest::SetUp();
        before_ = QDir::currentPath();
        QDir::setCurrent(folder.path());  // where dialogs of files begin
    }
    void TearDown() override {
        QDir::setCurrent(before_);
        WindowTest::TearDown();
    }

    /// A click there, if that is what lies there: not behind another, not scrolled out of sight.
    void clickAt(QWidget& widget, const QPoint& at) {
        ++clicks;
        QCoreApplication::processEvents();
        QWidget* const outermost = widget.window();
        const QPoint there = widget.mapTo(outermost, at);
        QWidget* const seen = outermost->childAt(there);
        EXPECT_TRUE(seen == &widget || widget.isAncestorOf(seen))
            << widget.objectName().toStdString() << " is not seen at " << there.x() << ", " << there.y();
        QTest::mouseClick(&widget, Qt::LeftButton, {}, at);
        QCoreApplication::processEvents();
    }
    /// Turns the wheel over the bar of what the widget is scrolled in until it is seen.
    void scrollTo(QWidget& widget) {
        QCoreApplication::processEvents();
        for (QWidget* outer = widget.parentWidget(); outer; outer = outer->parentWidget()) {
            auto* area = qobject_cast<QScrollArea*>(outer);
            if (!area) continue;
            QScrollBar* const bar = area->verticalScrollBar();
            for (int turns = 0; turns < 200; ++turns) {
                const QRect seen(widget.mapTo(area->viewport(), QPoint(0, 0)), widget.size());
                if (area->viewport()->rect().contains(seen)) break;
                turnWheel(*bar, seen.top() < 0 ? 1 : -1);
                clicks += turns == 0 ? 1 : 0;
            }
        }
    }
    void click(QWidget& widget) {
        scrollTo(widget);
        clickAt(widget, widget.rect().center());
    }
    void click(const char* button) { click(*find<QPushButton>(button)); }
    void tool(const char* name) {
        QAction& action = window->actions().get((std::string("tool.") + name).c_str());
        for (auto* button : window->findChildren<QToolButton*>()) {
            if (button->defaultAction() == &action && button->isVisible()) return click(*button);
        }
        ADD_FAILURE() << "no button of the tool " << name;
    }
    /// Opens the list of a box and takes an entry.
    void pick(QComboBox& box, int entry) {
        click(box);
        QAbstractItemView& names = *box.view();
        // The release of the click that opened the list is none in it.
        QTest::qWait(2 * QApplication::doubleClickInterval());
        QTest::mouseClick(names.viewport(), Qt::LeftButton, {},
                          names.visualRect(box.model()->index(entry, 0)).center());
        ++clicks;
        QCoreApplication::processEvents();
    }
    /// Brings a panel to the front by its tab.
    QDockWidget& open(const char* panel) {
        QDockWidget& dock = *window->panel(panel);
        for (auto* bar : window->findChildren<QTabBar*>()) {
            for (int i = 0; i < bar->count(); ++i) {
                if (bar->isVisible() && bar->tabText(i) == dock.windowTitle())
                    clickAt(*bar, bar->tabRect(i).center());
            }
        }
        return dock;
    }
    static QString plain(QString text) { return text.remove('&'); }
    void choose(QMenu& menu, const QString& entry) {
        ++clicks;
        for (QAction* action : menu.actions()) {
            if (plain(action->text()) != entry) continue;
            QTest::mouseClick(&menu, Qt::LeftButton, {}, menu.actionGeometry(action).center());
            QCoreApplication::processEvents();
            return;
        }
        menu.close();
        ADD_FAILURE() << "no entry " << entry.toStdString();
    }
    void chooseInMenu(const QString& menu, const QString& entry) {
        QMenuBar& bar = *window->menuBar();
        for (QAction* action : bar.actions()) {
            if (plain(action->text()) != menu) continue;
            clickAt(bar, bar.actionGeometry(action).center());
            return choose(*action->menu(), entry);
        }
        ADD_FAILURE() << "no menu " << menu.toStdString();
    }
    void addOperator(const QString& name) {
        auto& add = *find<QPushButton>("operatorAdd");
        scrollTo(add);
        // The menu of a button waits for its choice.
        QTimer::singleShot(50, &add, [&] { choose(*add.menu(), name); });
        clickAt(add, add.rect().center());
    }
    void chooseOperator(int row) {
        auto& list = *find<QListWidget>("operators");
        scrollTo(list);
        clickAt(*list.viewport(), list.visualItemRect(list.item(row)).center());
        EXPECT_EQ(list.currentRow(), row);
    }
    static void turnWheel(QWidget& over, int ticks) {
        const QPoint at = over.rect().center();
        QWheelEvent wheel(at, over.mapToGlobal(at), {}, {0, 120 * ticks}, Qt::NoButton, {}, Qt::NoScrollPhase,
                          false);
        QCoreApplication::sendEvent(&over, &wheel);
        QCoreApplication::processEvents();
    }
    /// Types a number in the unit that is shown, in place of what the field has.
    void type(QDoubleSpinBox& box, const QString& number) {
        auto& field = *box.findChild<QLineEdit*>();
        scrollTo(box);
        clickAt(field, field.rect().center());
        QTest::keyClick(&field, Qt::Key_A, Qt::ControlModifier);
        QTest::keyClicks(&field, number);
        QTest::keyClick(&field, Qt::Key_Return);
        QCoreApplication::processEvents();
        keys += 2 + static_cast<int>(number.size());
    }
    void type(NumberBox& box, const QString& number) { type(box.spinBox(), number); }
    void type(const char* field, const QString& number) { type(*find<NumberBox>(field), number); }
    /// A stroke over the viewport.
    void stroke(std::initializer_list<QPoint> points, Qt::KeyboardModifiers modifiers = {}) {
        ++clicks;
        drag(points, modifiers);
    }
    /// A key of the window's menus.
    void shortcut(const char* action) {
        ++keys;
        trigger(action);
    }
    /// Draws a curve of the chosen operator over these points of the world.
    void drawCurve(std::initializer_list<Vec3f> points) {
        click("curveDraw");
        ++clicks;
        press(at(*points.begin()));
        for (const Vec3f& point : points) moveTo(at(point));
        release(at(*(points.end() - 1)));
    }
    /// The name that a dialog of files proposes is taken.
    void onceAskedForAFileTakeIt() {
        onceAsked<QFileDialog>([this](QFileDialog& dialog) {
            clickAt(*dialog.findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Save), {8, 8});
        });
    }
    /// Exports under the name that is proposed: all strands leave.
    void exportAllOf(ExportDialog& dialog) {
        onceAskedForAFileTakeIt();
        auto* buttons = dialog.findChild<QDialogButtonBox*>();
        for (QAbstractButton* button : buttons->buttons()) {
            if (buttons->buttonRole(button) == QDialogButtonBox::AcceptRole)
                clickAt(*button, button->rect().center());
        }
        finishWork();
        EXPECT_EQ(dialog.report().strands, groom().strandCount());
        clickAt(*buttons->button(QDialogButtonBox::Close), {8, 8});
    }
    /// The selected strands become the second layer.
    void addLayerOfSelection() {
        open("layers");
        click("layerAdd");
        ASSERT_EQ(groom().layers.size(), 2u);
        EXPECT_GT(strandsOfLayer(groom(), 1).size(), 0u);
    }
    Vec3f onHead(float x, float down, float z) const { return top + Vec3f(x, -down, z); }

    Vec3f top = Vec3f::Zero();  ///< of the head
    int clicks = 0;             ///< of the mouse, with drags and turns of the wheel
    int keys = 0;               ///< pressed, each with those held meanwhile

  private:
    QString before_;
};

}  // namespace hairloom::editor
