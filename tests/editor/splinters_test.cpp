// SPDX-License-Identifier: GPL-3.0-or-later
// Small things that stand in a groomer's way, each as a person meets it.
#include <QLabel>
#include <QStandardPaths>
#include <QTreeWidget>
#include <QWheelEvent>

#include "core/groom/file/project_file.h"
#include "editor/document/autosave.h"
#include "editor/fields/number_box.h"
#include "editor/shell/start_page.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class SplintersTest : public WindowTest {
  protected:
    void SetUp() override {
        WindowTest::SetUp();
        openHairFromTheFront();
    }
    void wheel(QWidget& over, int ticks) {
        const QPointF middle = over.rect().center();
        QWheelEvent event(middle, over.mapToGlobal(middle), {}, QPoint(0, 120 * ticks), Qt::NoButton,
                          Qt::NoModifier, Qt::NoScrollPhase, false);
        QCoreApplication::sendEvent(&over, &event);
    }
};

TEST_F(SplintersTest, TheWheelOverASliderChangesItOneStepATick) {
    window->panel("scalp")->raise();
    auto* count = find<NumberBox>("count");
    const auto before = hash();
    const std::uint32_t strands = groom().placement.count;
    wheel(count->slider(), 1);
    EXPECT_GT(groom().placement.count, strands);
    EXPECT_EQ(document().stepCount(), 1) << "a setting of placement is a step";
    wheel(count->slider(), 1);
    EXPECT_EQ(document().stepCount(), 2);
    document().undo();
    document().undo();
    EXPECT_EQ(hash(), before);
}

TEST_F(SplintersTest, KeysOfToolsWorkAgainAfterANumberIsTyped) {
    window->panel("physics")->raise();
    auto* wind = find<NumberBox>("windSpeed");
    for (const Qt::Key end : {Qt::Key_Return, Qt::Key_Escape}) {
        wind->spinBox().setFocus();
        wind->spinBox().selectAll();
        QTest::keyClicks(&wind->spinBox(), end == Qt::Key_Return ? "3" : "7");
        QTest::keyClick(&wind->spinBox(), end);
        EXPECT_EQ(groom().simulation.windSpeed, 3) << "Esc gives the number up";
        EXPECT_NE(QApplication::focusWidget(), &wind->spinBox());
    }
    EXPECT_EQ(wind->spinBox().value(), 3);
}

TEST_F(SplintersTest, AnErrorIsNoLongerRedWhenSomethingSucceeds) {
    parts().messages.warn("it failed");
    auto* message = window->statusLine().findChild<QLabel*>("message");
    ASSERT_TRUE(message);
    EXPECT_FALSE(message->styleSheet().isEmpty());
    ASSERT_TRUE(window->saveTo(inFolder("after.hairloom")));
    EXPECT_TRUE(message->styleSheet().isEmpty()) << message->text().toStdString();
}

TEST_F(SplintersTest, ANewSphereIsTheSelectedOne) {
    window->panel("spheres")->raise();
    auto* list = find<QTreeWidget>("spheres");
    list->setCurrentItem(list->topLevelItem(1));
    const int before = list->topLevelItemCount();
    ASSERT_GT(before, 2);
    QTest::mouseClick(find<QPushButton>("sphereMirror"), Qt::LeftButton);
    ASSERT_EQ(list->topLevelItemCount(), before + 1);
    EXPECT_EQ(list->indexOfTopLevelItem(list->currentItem()), before);
}

TEST_F(SplintersTest, ARecoveryIsGoneOnceItsDocumentIsSaved) {
    // A copy whose program is gone: its lock is not held.
    ASSERT_TRUE(saveProject(groom(), (QStandardPaths::writableLocation(QStandardPaths::AppDataLocation) +
                                      "/recovery/left.hairloom")
                                         .toStdString()));
    ASSERT_EQ(Autosave::recoveries().size(), 1);
    trigger("file.new");
    auto* recover = window->findChild<QPushButton*>("recover");
    ASSERT_TRUE(recover);
    recover->click();
    finishWork();
    EXPECT_EQ(Autosave::recoveries().size(), 1) << "not before it is kept elsewhere";
    ASSERT_TRUE(window->saveTo(inFolder("kept.hairloom")));
    EXPECT_TRUE(Autosave::recoveries().isEmpty());
    trigger("file.new");
    EXPECT_FALSE(window->findChild<QPushButton*>("recover"));
}

TEST_F(SplintersTest, FrameAllShowsTheFaceAndANewDocumentIsFramedAnew) {
    trigger("view.frame");
    const auto expectSeen = [this](float depth) {
        const float top = groom().scalp->bounds().max().y();
        for (const Vec3f& point : groom().scalp->positions()) {
            if (point.y() > top - depth) {
                ASSERT_TRUE(viewport().rect().contains(at(point))) << point.transpose();
            }
        }
    };
    expectSeen(0.23f);  // of hair, the face as well; shoulders may be cut off
    viewport().camera().zoom(6);
    trigger("file.new");
    openBust();
    expectSeen(1);
}

}  // namespace
}  // namespace hairloom::editor
