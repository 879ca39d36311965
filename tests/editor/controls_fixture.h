// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Every control of the window and of its dialogs, whatever it is for.

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSlider>
#include <QAbstractSpinBox>
#include <QButtonGroup>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QFile>
#include <QHeaderView>
#include <QInputDialog>
#include <QKeySequenceEdit>
#include <QListWidget>
#include <QMessageBox>
#include <QProgressBar>
#include <QScrollBar>
#include <QTabBar>
#include <QTextEdit>
#include <QTreeWidget>
#include <functional>

#include "core/documents/hair_export.h"
#include "core/groom/groom_diff.h"
#include "core/simulation/take_file.h"
#include "editor/dialogs/comparison_dialog.h"
#include "editor/dialogs/export_dialog.h"
#include "editor/dialogs/head_dialog.h"
#include "editor/dialogs/import_dialog.h"
#include "editor/dialogs/manual_window.h"
#include "editor/dialogs/preferences_dialog.h"
#include "editor/dialogs/render_dialog.h"
#include "editor/dialogs/shortcut_dialog.h"
#include "editor/panels/new_take_dialog.h"
#include "editor/panels/take_export_dialog.h"
#include "editor/viewport/strand_preview.h"
#include "tests/editor/wheel.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {

class ControlsTest : public WindowTest {
  protected:
    using Look = std::function<void(QDialog&, const QString&)>;

    void SetUp() override {
        WindowTest::SetUp();
        window->activateWindow();
        ASSERT_TRUE(QTest::qWaitForWindowActive(window.get()));
    }
    /// What the controls within show.
    static QStringList valuesIn(const QWidget& widget) {
        QStringList values;
        for (const auto* box : widget.findChildren<QComboBox*>()) values += box->currentText();
        for (const auto* spin : widget.findChildren<QAbstractSpinBox*>()) values += spin->text();
        for (const auto* slider : widget.findChildren<QAbstractSlider*>()) {
            if (!qobject_cast<const QScrollBar*>(slider)) values += QString::number(slider->value());
        }
        for (const auto* button : widget.findChildren<QAbstractButton*>())
            values += QString::number(button->isChecked());
        for (const auto* list : widget.findChildren<QListWidget*>())
            values += QString::number(list->currentRow());
        return values;
    }
    static void expectWheelChangesNothingIn(QWidget& widget, const QString& name) {
        const QStringList before = valuesIn(widget);
        for (QWidget* child : widget.findChildren<QWidget*>()) {
            if (!child->isVisible() || child->hasFocus() || qobject_cast<QScrollBar*>(child) ||
                qobject_cast<QTabBar*>(child))
                continue;
            turnWheel(*child, 1);
            turnWheel(*child, 1);
        }
        EXPECT_EQ(valuesIn(widget), before) << name.toStdString();
    }
    static bool isControl(const QWidget& widget) {
        if (const auto* edit = qobject_cast<const QLineEdit*>(&widget))
            return !edit->focusProxy();  // else a part of another control
        return qobject_cast<const QAbstractButton*>(&widget) ||
               qobject_cast<const QAbstractSpinBox*>(&widget) || qobject_cast<const QComboBox*>(&widget) ||
               qobject_cast<const QKeySequenceEdit*>(&widget) || qobject_cast<const QTextEdit*>(&widget) ||
               qobject_cast<const StrandPreview*>(&widget) ||
               (qobject_cast<const QAbstractItemView*>(&widget) &&
                !qobject_cast<const QHeaderView*>(&widget));
    }
    /// That are there to be used now.
    static std::vector<QWidget*> controlsOf(const QWidget& widget) {
        std::vector<QWidget*> controls;
        for (QWidget* child : widget.findChildren<QWidget*>()) {
            if (isControl(*child) && child->isVisible() && !child->objectName().startsWith("qt_"))
                controls.push_back(child);
        }
        return controls;
    }
    /// One of several of which one is down: arrows reach it from that one.
    static bool isReachedByArrows(const QWidget& control) {
        const auto* button = qobject_cast<const QAbstractButton*>(&control);
        return button && button->group() && button->group()->exclusive() && !button->isChecked() &&
               button->group()->checkedButton();
    }
    static std::string nameOf(const QString& place, const QWidget& control) {
        const auto* button = qobject_cast<const QAbstractButton*>(&control);
        return place.toStdString() + ": " + control.objectName().toStdString() + " " +
               control.metaObject()->className() + (button ? " " + button->text().toStdString() : "");
    }
    /// All dialogs of the editor, one after the other, shown, with what they read there. Those of the
    /// system's toolkit for files and colours are not among them.
    void inEachDialog(const Look& look) {
        const PanelParts p = parts();
        QWidget* const over = window.get();
        const auto show = [&](QDialog&& dialog, const char* name) {
            dialog.show();
            ASSERT_TRUE(QTest::qWaitForWindowExposed(&dialog));
            finishWork();
            look(dialog, name);
            dialog.close();
            finishWork();
        };
        TakeInfo take;
        take.frames = 120;
        take.points = groom().pointCount();
        take.shapeHash = takeShapeHash(groom());
        Groom changed = groom();
        changed.simulation.airDrag += 0.5f;
        const GroomComparison differences = compare({groom(), {}}, {changed, {}});
        const QString hair = inFolder("walked.hair"), head = inFolder("walked.obj");
        ASSERT_TRUE(strandWriter("hair", hairWriters()).write(groom(), hair.toStdString(), {}));
        QFile mesh(head);
        ASSERT_TRUE(mesh.open(QIODevice::WriteOnly));
        mesh.write(
            "v 0 1.6 0\nv 0.2 1.6 0\nv 0 1.8 0\nv 0 1.6 0.2\ng head\nf 1 3 2\nf 1 2 4\ng collar\n"
            "f 1 4 3\nf 2 3 4\n");
        mesh.close();
        show(PreferencesDialog(p.preferences, over), "preferences");
        show(ShortcutDialog(window->actions(), over), "shortcuts");
        show(ExportDialog(p.document, p.preferences, p.tasks, p.messages, p.player, over), "export");
        show(RenderDialog(p.viewport, p.player, p.tasks, p.messages, p.document, over), "render");
        show(HeadDialog(p.tasks, p.preferences, head, over), "head");
        show(ImportDialog(p.document, p.tasks, hair, over), "import");
        show(TakeExportDialog("nod", inFolder("nod").toStdString(), take, p.document, p.tasks, p.messages,
                              over),
             "export of a take");
        show(LoopDialog("nod loop", take, groom(), over), "loop");
        show(ResimulateDialog("nod from 12", take, 12, over), "re-simulate");
        show(ComparisonDialog(differences, ComparedParts::all, "old.hairloom", over), "comparison");
        ManualWindow manual(over);
        manual.open("manual.md");
        show(std::move(manual), "manual");
        asked<QInputDialog>("select.guides", look, "clustering");
        const editing::Model& model = p.document.editing().model();
        p.document.perform(editing::setSettings(model, changed, "Air drag"));
        window->setUnsavedAnswer(MainWindow::Unsaved::Ask);
        asked<QMessageBox>("file.new", look, "unsaved changes");
        window->setUnsavedAnswer(MainWindow::Unsaved::Discard);
        trigger("edit.undo");
    }

  private:
    /// What that action asks.
    template <class Dialog>
    void asked(const char* action, const Look& look, const char* name) {
        bool isAsked = false;
        onceAsked<Dialog>([&](Dialog& dialog) {
            isAsked = true;
            look(dialog, name);
            dialog.reject();
        });
        trigger(action);
        EXPECT_TRUE(isAsked) << name;
    }
};

}  // namespace hairloom::editor
