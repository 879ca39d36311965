// SPDX-License-Identifier: GPL-3.0-or-later
// What the settings of operators show: names of masks, places that are found on the head, captions of the
// menu.
#include <QComboBox>
#include <QLineEdit>
#include <QWidgetAction>

#include "core/operations/found_vectors.h"
#include "editor/document/words.h"
#include "editor/tools/brush_tool.h"
#include "tests/editor/operators_fixture.h"

namespace hairloom::editor {
namespace {

class OperatorFieldsTest : public OperatorsTest {};

TEST_F(OperatorFieldsTest, MasksAreRenamedWhereTheyAreChosen) {
    const auto before = hash();
    choose(kClump);
    QWidget& panel = *window->panel("operators");
    auto* map = panel.findChild<QComboBox*>("map");
    auto* name = panel.findChild<QLineEdit*>("maskName");
    auto* problem = panel.findChild<QLabel*>("maskNameProblem");
    ASSERT_TRUE(map && name && problem);
    EXPECT_TRUE(name->parentWidget()->isHidden()) << "no painted mask is chosen";
    EXPECT_EQ(map->itemText(3), "Mask 1");
    EXPECT_EQ(map->count(), 7);
    Q_EMIT map->activated(static_cast<int>(MaskMap::mask3));
    EXPECT_FALSE(name->parentWidget()->isHidden());
    EXPECT_EQ(name->placeholderText(), "Mask 3");
    const int steps = document().stepCount();
    QTest::keyClicks(name, "Fringe");
    QTest::keyClick(name, Qt::Key_Return);
    EXPECT_EQ(groom().maskNames, (std::vector<std::string>{"", "", "Fringe"}));
    EXPECT_EQ(document().stepCount(), steps + 1);
    EXPECT_EQ(map->itemText(5), "Fringe (3)");
    // The brush shows it as well, and renames.
    QWidget& tool = *window->panel("tool");
    auto* painted = tool.findChild<QComboBox*>("brush:mask");
    auto* ofBrush = tool.findChild<QLineEdit*>("maskName");
    ASSERT_TRUE(painted && ofBrush);
    EXPECT_EQ(painted->itemText(2), "Fringe (3)");
    EXPECT_EQ(painted->count(), 4);
    painted->setCurrentIndex(2);
    Q_EMIT painted->activated(2);
    EXPECT_EQ(ofBrush->text(), "Fringe");
    EXPECT_EQ(dynamic_cast<BrushTool&>(*parts().tools.find("mask_paint")).settings().parameters.at("mask"),
              3);
    painted->setCurrentIndex(0);
    Q_EMIT painted->activated(0);
    // A name that another has is refused at the field, and the last one stays.
    QTest::keyClicks(ofBrush, "fringe");
    QTest::keyClick(ofBrush, Qt::Key_Return);
    EXPECT_FALSE(problem->isVisibleTo(&panel));
    auto* ofBrushProblem = tool.findChild<QLabel*>("maskNameProblem");
    EXPECT_TRUE(ofBrushProblem->isVisibleTo(ofBrushProblem->parentWidget()));
    EXPECT_TRUE(ofBrushProblem->text().contains("masks 1 and 3 are both called"))
        << ofBrushProblem->text().toStdString();
    EXPECT_EQ(document().stepCount(), steps + 1);
    QTest::keyClicks(ofBrush, "s");
    QTest::keyClick(ofBrush, Qt::Key_Return);
    EXPECT_FALSE(ofBrushProblem->isVisibleTo(ofBrushProblem->parentWidget()));
    EXPECT_EQ(map->itemText(3), "fringes (1)");
    undoAll();
    EXPECT_EQ(hash(), before);
    EXPECT_EQ(map->itemText(3), "Mask 1");
    EXPECT_TRUE(ofBrush->text().isEmpty());
}

TEST_F(OperatorFieldsTest, TheMenuOfOperatorsHasCaptionsThatAreSeen) {
    QMenu& menu = *find<QPushButton>("operatorAdd")->menu();
    QStringList captions, before;
    bool isOpen = false;
    for (QAction* action : menu.actions()) {
        auto* caption = qobject_cast<QWidgetAction*>(action);
        if (!caption) {
            EXPECT_TRUE(action->isSeparator() || (isOpen && !action->icon().isNull()))
                << action->text().toStdString();
            continue;
        }
        isOpen = true;
        auto* label = qobject_cast<QLabel*>(caption->defaultWidget());
        ASSERT_TRUE(label);
        captions += label->text();
        EXPECT_FALSE(action->isEnabled()) << "keys step over it";
        menu.popup({0, 0});
        QCoreApplication::processEvents();
        EXPECT_TRUE(label->isVisible());
        EXPECT_GE(label->width(), label->sizeHint().width()) << label->text().toStdString();
        menu.close();
    }
    EXPECT_EQ(captions, (QStringList{"Direction", "Length", "Locks", "Texture", "Shape"}));
}

TEST_F(OperatorFieldsTest, PlacesThatOperatorsFindAreShownAndKeptByHalves) {
    choose(1);
    const std::vector<Operator> before = groom().operators;
    for (const StackOperator& known : stackOperators()) {
        if (known.name == kSculpt) continue;
        add(hairloom::editor::labelOf(
            QString::fromUtf8(known.name.data(), static_cast<int>(known.name.size())).replace('_', ' ')));
        const auto index = static_cast<std::size_t>(list().currentRow());
        ASSERT_EQ(groom().operators[index].op, known.name);
        for (const FieldRow& row : known.fields) {
            if (row.info.kind != FieldKind::Vector || std::string_view(row.info.unit) != "m") continue;
            const auto found = vectorFound(groom(), groom().operators[index], row.info);
            ASSERT_TRUE(found) << known.name << ' ' << row.info.name << ": zeros are shown";
            Box3f head = groom().scalp->bounds();
            head.min() -= Vec3f::Constant(0.05f), head.max() += Vec3f::Constant(0.05f);
            EXPECT_TRUE(head.contains(*found)) << known.name << ' ' << row.info.name;
            auto* field = window->panel("operators")->findChild<QWidget*>(row.info.name);
            ASSERT_TRUE(field);
            const auto boxes = field->findChildren<QDoubleSpinBox*>();
            ASSERT_EQ(boxes.size(), 3);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(boxes[c]->value(), 100.0 * static_cast<double>((*found)[c]), 0.051)
                    << known.name << ' ' << row.info.name << " in cm";
            // Who changes one number keeps the others.
            const double lower = boxes[1]->value() - 1;
            boxes[1]->setValue(lower);
            const Operator& placed = groom().operators[index];
            EXPECT_FALSE(vectorFound(groom(), placed, row.info)) << "it is placed now";
            EXPECT_NEAR(settingOf(placed, row.info, 0), static_cast<double>((*found)[0]), 1e-6);
            EXPECT_NEAR(settingOf(placed, row.info, 1), 0.01 * lower, 1e-6);
            EXPECT_NEAR(settingOf(placed, row.info, 2), static_cast<double>((*found)[2]), 1e-6);
            trigger("edit.undo");
            EXPECT_TRUE(vectorFound(groom(), groom().operators[index], row.info));
        }
        trigger("edit.undo");
    }
    EXPECT_EQ(groom().operators, before);
}

}  // namespace
}  // namespace hairloom::editor
