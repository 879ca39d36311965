// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The window with hair from the front, for tests that work with tools.

#include "core/editing/document.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {

class ToolsTest : public WindowTest {
  protected:
    void SetUp() override {
        WindowTest::SetUp();
        openHairFromTheFront();
        middle = QPoint(viewport().width() / 2, viewport().height() / 2);
        // Hair, not skin, is under the pointer in the upper part of the head.
        Box3f roots;
        for (std::size_t s = 0; s < groom().strandCount(); ++s) roots.extend(groom().strand(s).front());
        crown = at(Vec3f(0, roots.max().y() - 0.03f, roots.max().z()));
    }
    Tool& activate(const QString& id) {
        trigger(("tool." + id).toUtf8().constData());
        Tool* const tool = parts().tools.find(id);
        EXPECT_EQ(viewport().tool(), tool);
        return *tool;
    }
    /// A stroke across the hair, and what becomes of it when it is undone and done again.
    void strokeAndBack(const QString& id, Qt::KeyboardModifiers modifiers = {}) {
        const auto before = hash();
        const int steps = document().doneSteps();
        drag({crown, crown + QPoint(20, 4), crown + QPoint(45, 10), crown + QPoint(70, 12)}, modifiers);
        const auto after = hash();
        EXPECT_NE(after, before) << id.toStdString() << " did nothing";
        EXPECT_EQ(document().doneSteps(), steps + 1) << id.toStdString();
        expectSound();
        trigger("edit.undo");
        EXPECT_EQ(hash(), before) << id.toStdString();
        trigger("edit.redo");
        EXPECT_EQ(hash(), after) << id.toStdString();
        trigger("edit.undo");
    }

    QPoint middle, crown;
};

}  // namespace hairloom::editor
