// SPDX-License-Identifier: GPL-3.0-or-later
// Tools for what is around the hair: spheres, skin, wind and the head itself.
#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTreeWidget>
#include <algorithm>
#include <set>

#include "core/editing/settings_commands.h"
#include "core/groom/spheres.h"
#include "hairloom/body_field.h"
#include "tests/editor/tools_fixture.h"

namespace hairloom::editor {
namespace {

TEST_F(ToolsTest, SpheresArePlacedMovedResizedAndRemoved) {
    Groom bare = groom();
    bare.spheres.clear();
    document().open(bare, {}, "bare");
    viewport().look(render::View::Front);
    viewport().frameAll();
    activate("sphere");
    const Box3f box = groom().scalp->bounds();
    const QPoint face = at(Vec3f(0, box.max().y() - 0.12f, 0.1f));
    press(face);
    release(face);
    ASSERT_EQ(groom().spheres.size(), 1u) << window->statusLine().message().toStdString();
    const CollisionSphere placed = groom().spheres[0];
    const QPoint centre = at(placed.centre);
    drag({centre, centre + QPoint(10, -8), centre + QPoint(20, -16)});
    EXPECT_GT((groom().spheres[0].centre - placed.centre).norm(), 0.002f);
    EXPECT_EQ(groom().spheres[0].radius, placed.radius);
    const CollisionSphere moved = groom().spheres[0];
    const QPoint newCentre = at(moved.centre);
    const auto metres = viewport().camera().metresPerPixel(moved.centre, viewport().viewSize_px());
    const QPoint rim = newCentre + QPoint(static_cast<int>(0.9f * moved.radius / metres), 0);
    drag({rim, rim + QPoint(12, 0), rim + QPoint(25, 0)});
    EXPECT_GT(groom().spheres[0].radius, moved.radius);
    EXPECT_EQ(document().doneSteps(), 3);
    find<QPushButton>("sphereRemove")->click();
    EXPECT_TRUE(groom().spheres.empty());
    document().goToStep(1);
    EXPECT_EQ(groom().spheres[0].centre, placed.centre);
}

TEST_F(ToolsTest, SpheresAreFittedToTheHead) {
    find<QPushButton>("sphereFit")->click();
    finishWork();
    EXPECT_EQ(groom().spheres.size(), 12u);
    EXPECT_EQ(document().stepName(0), "Fit spheres");
    std::set<std::string> bones;
    for (const CollisionSphere& sphere : groom().spheres) {
        EXPECT_TRUE(parts().player.actor()->skeleton().find(sphere.bone))
            << sphere.name << " on " << sphere.bone;
        bones.insert(sphere.bone);
    }
    EXPECT_TRUE(bones.contains("head"));
    auto* bone = find<QComboBox>("sphereBone");
    EXPECT_EQ(bone->currentText().toStdString(), groom().spheres[0].bone);
    find<QPushButton>("sphereMirror")->click();
    EXPECT_EQ(groom().spheres.size(), 13u);
}

TEST_F(ToolsTest, SpheresAreJoinedInCapsules) {
    find<QComboBox>("sphereShapes")->setCurrentIndex(1);
    find<QPushButton>("sphereFit")->click();
    finishWork();
    EXPECT_EQ(groom().spheres.size(), 12u);
    ASSERT_FALSE(capsulesOf(groom().spheres).empty());
    auto* joined = find<QComboBox>("sphereJoined");
    auto* list = find<QTreeWidget>("spheres");
    const auto first = static_cast<int>(capsulesOf(groom().spheres).front().first);
    list->setCurrentItem(list->topLevelItem(first));
    EXPECT_EQ(joined->currentData().toInt(), groom().spheres[static_cast<std::size_t>(first)].joined);
    EXPECT_EQ(list->topLevelItem(first)->text(3), joined->currentText());
    joined->setCurrentIndex(0);
    Q_EMIT joined->activated(0);
    EXPECT_EQ(groom().spheres[static_cast<std::size_t>(first)].joined, -1);
    EXPECT_EQ(list->topLevelItem(first)->text(3), QStringLiteral("–"));
    EXPECT_EQ(document().stepName(1), "Unjoin sphere");
    document().undo();
    EXPECT_GE(groom().spheres[static_cast<std::size_t>(first)].joined, 0);
}

TEST_F(ToolsTest, ASphereIsRenamedInTheList) {
    ASSERT_FALSE(groom().spheres.empty());
    const std::string before = groom().spheres[0].name;
    auto* list = find<QTreeWidget>("spheres");
    list->topLevelItem(0)->setText(0, "  Schädel ");
    ASSERT_TRUE(QTest::qWaitFor([&] { return groom().spheres[0].name == "Schädel"; }, kPatience));
    EXPECT_EQ(list->topLevelItem(0)->text(0), "Schädel");
    EXPECT_EQ(document().stepName(0), "Rename sphere");
    // A name of nothing is not taken.
    list->topLevelItem(0)->setText(0, " ");
    ASSERT_TRUE(QTest::qWaitFor([&] { return list->topLevelItem(0)->text(0) == "Schädel"; }, kPatience));
    EXPECT_EQ(document().stepCount(), 1);
    // By hand: names have an editor, numbers have none.
    list->setCurrentItem(list->topLevelItem(0), 1);
    list->editItem(list->topLevelItem(0), 1);
    EXPECT_FALSE(list->viewport()->findChild<QLineEdit*>());
    list->editItem(list->topLevelItem(0), 0);
    auto* editor = list->viewport()->findChild<QLineEdit*>();
    ASSERT_TRUE(editor);
    editor->setText("Skull");
    QTest::keyClick(editor, Qt::Key_Return);
    ASSERT_TRUE(QTest::qWaitFor([&] { return groom().spheres[0].name == "Skull"; }, kPatience));
    document().goToStep(0);
    EXPECT_EQ(list->topLevelItem(0)->text(0).toStdString(), before);
}

TEST_F(ToolsTest, TheSkinIsACollider) {
    auto* check = find<QCheckBox>("bodyCheck");
    ASSERT_TRUE(groom().body) << "samples come with one";
    check->click();
    EXPECT_FALSE(groom().body);
    check->click();
    finishWork();
    ASSERT_TRUE(groom().body);
    EXPECT_TRUE(check->isChecked());
    EXPECT_EQ(document().stepName(1), "Fit skin collider");
    EXPECT_TRUE(std::ranges::count(groom().body->bones, "head"));
    EXPECT_TRUE(find<QLabel>("bodyWords")->text().contains("Worst gap"))
        << find<QLabel>("bodyWords")->text().toStdString();
    EXPECT_TRUE(find<QLabel>("bodyNote")->text().isEmpty());
    const auto* spheres = find<QLabel>("bodySpheres");
    EXPECT_TRUE(spheres->text().contains("spheres lie in the skin")) << spheres->text().toStdString();
    runtime::SimulationSettings springs = groom().simulation;
    springs.strandModel = runtime::StrandModel::springs;
    document().perform(editing::setPhysics(document().editing().model(), springs, "springs"));
    EXPECT_TRUE(spheres->text().isEmpty());
    EXPECT_TRUE(find<QLabel>("bodyNote")->text().contains("Springs pass through"));
    document().goToStep(2);
    EXPECT_TRUE(find<QLabel>("bodyNote")->text().isEmpty());
    parts().player.setMethod({SimulationMethod::lattice});
    EXPECT_TRUE(find<QLabel>("bodyNote")->text().contains("strand engine"));
    parts().player.setMethod({});
    EXPECT_TRUE(find<QLabel>("bodyNote")->text().isEmpty());
    check->click();
    EXPECT_FALSE(groom().body);
    EXPECT_EQ(document().stepName(2), "Remove skin collider");
    document().goToStep(2);
    EXPECT_TRUE(groom().body);
    EXPECT_TRUE(check->isChecked());
}

TEST_F(ToolsTest, WindFollowsTheArrowAndADragIsOneStep) {
    activate("wind");
    const QPoint centre = at(viewport().camera().target_ws());
    const auto before = hash();
    drag({centre, centre + QPoint(40, 0), centre + QPoint(90, 0)});
    EXPECT_NEAR(groom().simulation.windSpeed, 5, 0.3f);
    EXPECT_GT(groom().simulation.windDirection.x, 0.99f);
    EXPECT_EQ(document().stepCount(), 1);
    trigger("edit.undo");
    EXPECT_EQ(hash(), before);
}

TEST_F(ToolsTest, TheHeadIsDraggedAndTheHairFollows) {
    activate("head");
    const auto before = hash();
    const QPoint centre = at(viewport().camera().target_ws());
    press(centre);
    moveTo(centre + QPoint(60, 0));
    ASSERT_TRUE(QTest::qWaitFor(
        [this] {
            const auto& frame = parts().player.frame();
            return frame && frame->pose->head.head_ws.translation().x() > 0.01f;
        },
        kPatience));
    release(centre + QPoint(60, 0));
    EXPECT_EQ(hash(), before);
}

}  // namespace
}  // namespace hairloom::editor
