// SPDX-License-Identifier: GPL-3.0-or-later
// What no field and no handle may take: the last good value stays, and nothing falls.

#include <gtest/gtest.h>

#include <QRegularExpression>
#include <algorithm>
#include <cmath>

#include "core/editing/stack_commands.h"
#include "core/operations/stack.h"
#include "editor/fields/number_box.h"
#include "editor/tools/handle_tool.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class BadInputTest : public WindowTest {
  protected:
    void add(std::string_view name) {
        auto command =
            editing::addOperator(document().editing().model(), groom().operators.size(), newOperator(name));
        ASSERT_TRUE(command) << command.error().message();
        document().perform(std::move(*command));
    }
    bool isFinite() {
        return std::ranges::all_of(groom().positions(), [](const Vec3f& point) { return point.allFinite(); });
    }
};

TEST_F(BadInputTest, NumberFieldsOfEveryPanelKeepWhatTheyHadWhereNoNumberIsTyped) {
    openSampleHair("short");
    openFirstStrands(40);
    add("clump");
    int fields = 0;
    for (const PanelInfo& info : panels()) {
        QDockWidget* dock = window->panel(info.id);
        dock->raise();
        QCoreApplication::processEvents();
        for (NumberBox* box : dock->findChildren<NumberBox*>()) {
            auto& spin = box->spinBox();
            if (!box->isVisible() || !spin.isEnabled()) continue;
            ++fields;
            const double before = box->value();
            for (const char* typed : {"nan", "inf", "-inf", "abc", "--5", "1e", "0x10", "9e999"}) {
                spin.setFocus();
                spin.selectAll();
                QTest::keyClicks(&spin, typed);
                QTest::keyClick(&spin, Qt::Key_Return);
                EXPECT_TRUE(std::isfinite(box->value())) << box->objectName().toStdString() << ": " << typed;
                EXPECT_GE(spin.value(), spin.minimum());
                EXPECT_LE(spin.value(), spin.maximum());
                // What is left of it may be a number ("5", "0", "10"): else all is as before.
                if (!QString(typed).contains(QRegularExpression("[0-9]"))) {
                    EXPECT_DOUBLE_EQ(box->value(), before)
                        << box->objectName().toStdString() << ": " << typed;
                }
            }
        }
    }
    EXPECT_GT(fields, 40);
    EXPECT_TRUE(isFinite());
    expectSound();
}

TEST_F(BadInputTest, HandlesDraggedOffTheHeadAndOutOfTheWindowStayInRange) {
    openHairFromTheFront();
    auto* tool = dynamic_cast<HandleTool*>(parts().tools.find("handles"));
    ASSERT_TRUE(tool);
    int dragged = 0;
    for (const StackOperator& one : stackOperators()) {
        document().perform(std::move(*editing::setOperators(document().editing().model(), {}, "None")));
        add(one.name);
        parts().tools.activate(tool);
        tool->setOperator(0);
        viewport().frameAll();
        const auto handles = tool->handles();
        for (std::size_t i = 0; i < handles.size(); ++i) {
            const auto from =
                viewport().camera().project(tool->place_ss(handles[i]), viewport().viewSize_px());
            if (!from) continue;
            ++dragged;
            const QPoint at = from->toPoint();
            press(at);
            for (const QPoint& to :
                 {QPoint(1, 1), QPoint(-4000, 30), QPoint(90'000, -90'000), at, QPoint(2, 600)})
                moveTo(to);
            release(QPoint(2, 600));
            const Operator& now = groom().operators.at(0);
            for (std::uint32_t c = 0; c < 3; ++c) {
                const double value = settingOf(now, handles[i].field, c, handles[i].part);
                EXPECT_TRUE(std::isfinite(value)) << one.name << " " << handles[i].field.name;
                EXPECT_GE(value, handles[i].field.min) << one.name << " " << handles[i].field.name;
                EXPECT_LE(value, handles[i].field.max) << one.name << " " << handles[i].field.name;
            }
        }
        EXPECT_TRUE(isFinite()) << one.name;
        expectSound();
    }
    EXPECT_GT(dragged, 10);
}

}  // namespace
}  // namespace hairloom::editor
