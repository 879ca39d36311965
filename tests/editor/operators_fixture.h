// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The Operators panel with the stack of a sample, for tests.

#include <QLabel>
#include <QListWidget>
#include <QMenu>
#include <QPushButton>
#include <algorithm>

#include "core/operations/stack.h"
#include "editor/fields/number_box.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {

/// Of the sample that each test opens.
inline QStringList sampleStack() {
    return {"Set length", "Flow",  "Flow",  "Set length", "Set length", "Set length",
            "Clump",      "Clump", "Noise", "Flyaways",   "Collide"};
}
inline constexpr int kClump = 7;

/// The stack with a row more.
inline QStringList stackWith(const QString& name, qsizetype row) {
    QStringList rows = sampleStack();
    rows.insert(row, name);
    return rows;
}

class OperatorsTest : public WindowTest {
  protected:
    void SetUp() override {
        WindowTest::SetUp();
        openSampleHair("short");
        window->panel("operators")->raise();
        QCoreApplication::processEvents();
    }
    QListWidget& list() { return *find<QListWidget>("operators"); }
    QStringList rows() {
        QStringList names;
        for (int i = 0; i < list().count(); ++i) names += list().item(i)->text();
        return names;
    }
    void choose(int row) {
        list().setCurrentRow(row);
        QCoreApplication::processEvents();
    }
    void click(const char* button) { find<QPushButton>(button)->click(); }
    void add(const QString& name) {
        for (QAction* action : find<QPushButton>("operatorAdd")->menu()->actions()) {
            if (action->text() == name) return action->trigger();
        }
        ADD_FAILURE() << "no operator " << name.toStdString();
    }
    NumberBox* number(const char* field) {
        auto* box = window->panel("operators")->findChild<NumberBox*>(field);
        EXPECT_TRUE(box) << field;
        return box;
    }
    /// The hair is what its operators make of its base shape.
    void expectEvaluated() {
        StackCache cache;
        const auto shape = evaluateStack(groom(), cache);
        ASSERT_TRUE(shape) << shape.error().message();
        EXPECT_TRUE(std::ranges::equal(std::get<CowArray<Vec3f>>(*shape).view(), groom().positions()));
        expectSound();
    }
    void undoAll() {
        while (document().editing().canUndo()) trigger("edit.undo");
    }
};

}  // namespace hairloom::editor
