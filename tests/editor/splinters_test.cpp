// SPDX-License-Identifier: GPL-3.0-or-later
// Small things that stand in a groomer's way, each as a person meets it.
#include <QDir>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QProgressBar>
#include <QPushButton>
#include <QStandardPaths>
#include <QTest>
#include <QToolButton>
#include <QTreeWidget>
#include <QWheelEvent>
#include <atomic>
#include <chrono>
#include <thread>

#include "core/editing/selection_commands.h"
#include "core/groom/file/project_file.h"
#include "editor/document/autosave.h"
#include "editor/fields/number_box.h"
#include "editor/overlays/overlay_mode.h"
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
    EXPECT_EQ(document().stepCount(), 0) << "the wheel is the panel's until somebody goes to the field";
    window->activateWindow();
    ASSERT_TRUE(QTest::qWaitForWindowActive(window.get()));
    count->slider().setFocus();
    ASSERT_TRUE(count->slider().hasFocus());
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
    ASSERT_TRUE(saveProject(groom(), recoveryFolder() / "left.hairloom"));
    ASSERT_EQ(recoveryCopies().size(), 1u);
    trigger("file.new");
    auto* recover = window->findChild<QPushButton*>("recover");
    ASSERT_TRUE(recover);
    recover->click();
    finishWork();
    EXPECT_EQ(recoveryCopies().size(), 1u) << "not before it is kept elsewhere";
    ASSERT_TRUE(window->saveTo(inFolder("kept.hairloom")));
    EXPECT_TRUE(recoveryCopies().empty());
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

TEST_F(SplintersTest, LengthsHaveOneUnit) {
    window->panel("spheres")->raise();
    for (const auto& [unit, name] : {std::pair(DisplayUnit::Centimetre, "cm"), {DisplayUnit::Inch, "in"}}) {
        parts().preferences.setUnit(unit);
        const QStringList others = {" m", " cm", " mm", " in"};
        int lengths = 0;
        for (NumberBox* box : window->findChildren<NumberBox*>()) {
            const QString suffix = box->spinBox().suffix();
            // Of how far away a picture is seen it is metres.
            if (!others.contains(suffix) || box->objectName() == "levelDistance") continue;
            EXPECT_EQ(suffix, QString(" ") + name) << box->objectName().toStdString();
            ++lengths;
        }
        EXPECT_GT(lengths, 8);
        QTest::mouseClick(find<QPushButton>("sphereMirror"), Qt::LeftButton);
        const auto* list = find<QTreeWidget>("spheres");
        EXPECT_TRUE(list->topLevelItem(0)->text(1).endsWith(QString(" ") + name));
        EXPECT_TRUE(find<QLabel>("head")->text().endsWith(name));
    }
}

TEST_F(SplintersTest, WorkThatDoesNotSayHowFarItIsHasNoBar) {
    auto* bar = find<QProgressBar>("progress");
    for (const bool says : {false, true}) {
        std::atomic<bool> end{false};
        parts().tasks.run<int>(
            "Work",
            [&](TaskControl& control) -> Result<int> {
                if (says) control.setProgress(0.5f);
                while (!end) std::this_thread::sleep_for(std::chrono::milliseconds(1));
                return 1;
            },
            [](int) {});
        EXPECT_TRUE(
            QTest::qWaitFor([&] { return window->statusLine().message().contains("Work"); }, kPatience));
        if (says) {
            EXPECT_TRUE(QTest::qWaitFor([&] { return bar->isVisible() && bar->value() == 50; }, kPatience));
        } else {
            QTest::qWait(250);  // a while in which it would come
            EXPECT_FALSE(bar->isVisible());
        }
        end = true;
        finishWork();
        EXPECT_FALSE(bar->isVisible());
    }
}

TEST_F(SplintersTest, ErrorsNameSettingsInWords) {
    const QString looks = QStandardPaths::writableLocation(QStandardPaths::AppDataLocation) + "/looks";
    ASSERT_TRUE(QDir().mkpath(looks));
    QFile file(looks + "/thick.look.json");
    ASSERT_TRUE(file.open(QIODevice::WriteOnly));
    file.write(R"({"rootRadius": 99})");
    file.close();
    // Looks are read when a window opens.
    window->close();
    open();
    EXPECT_TRUE(file.remove());
    const QString said = window->statusLine().message();
    EXPECT_TRUE(said.contains("Root radius is 99; expected")) << said.toStdString();
    EXPECT_FALSE(said.contains(": /"));
}

TEST_F(SplintersTest, GuidesAreLitFadeWithDepthAndShowTheSelection) {
    document().perform(editing::selectStrands(document().editing().model(), std::vector<std::uint32_t>{0},
                                              editing::Choice::Replace));
    const auto guides = std::ranges::find(overlayModes(), std::string_view("guides"),
                                          [](const OverlayMode& mode) { return std::string_view(mode.id); });
    ASSERT_NE(guides, overlayModes().end());
    Marks marks;
    guides->draw({groom(), viewport(), parts().player}, marks);
    const OrbitCamera& camera = viewport().camera();
    std::size_t segments = 0, orange = 0;
    double nearBlue = 0, farBlue = 0;
    std::size_t nearCount = 0, farCount = 0;
    const Vec3f middle = groom().bounds().center();
    for (const auto& batch : marks.overlay().batches) {
        for (const auto& vertex : batch.vertices) {
            const Vec3f at = vertex.position_ws.head<3>();
            ++segments;
            if (vertex.colour[0] > vertex.colour[2]) {
                ++orange;
                continue;
            }
            const bool isNear = (at - middle).dot(camera.forward_ws()) < 0;
            (isNear ? nearBlue : farBlue) += static_cast<double>(vertex.colour[2]);
            ++(isNear ? nearCount : farCount);
        }
    }
    const std::size_t ofOne = 2 * (groom().strand(0).size() - 1);
    EXPECT_EQ(segments, 2 * (groom().pointCount() - groom().strandCount()));
    EXPECT_EQ(orange, ofOne);
    ASSERT_GT(std::min(nearCount, farCount), 0u);
    EXPECT_GT(nearBlue / static_cast<double>(nearCount), 1.2 * farBlue / static_cast<double>(farCount));
}

TEST_F(SplintersTest, OverlaysComeWithTheirToolsAndFromAMenu) {
    const auto drawn = [this] {
        Marks marks;
        window->drawOverlays(marks);
        return marks.overlay().batches.size();
    };
    EXPECT_EQ(drawn(), 0u);
    trigger("tool.scalp_paint");
    EXPECT_GT(drawn(), 0u) << "what is painted on is seen";
    trigger("tool.comb");
    EXPECT_EQ(drawn(), 0u);
    auto* button = find<QToolButton>("overlays");
    ASSERT_TRUE(button->menu());
    EXPECT_EQ(button->menu()->actions().size(), static_cast<qsizetype>(overlayModes().size()));
    for (QAction* action : button->menu()->actions()) {
        if (action->text() == "Roots") action->trigger();
    }
    EXPECT_GT(drawn(), 0u);
    EXPECT_EQ(button->text(), "Overlays: 1");
    EXPECT_TRUE(window->actions().get("overlay.roots").isChecked()) << "the same in the menu bar";
}

TEST_F(SplintersTest, FreshlyPlacedHairStaysWhereItGrew) {
    trigger("file.new");
    openBust();
    auto* words = find<QLineEdit>("scalpExpression");
    words->setText("material:scalp");
    QTest::keyClick(words, Qt::Key_Return);
    ASSERT_EQ(groom().placement.count, 3000u);
    find<QPushButton>("place")->click();
    finishWork();
    ASSERT_GT(groom().strandCount(), 2500u);
    find<QPushButton>("sphereFit")->click();
    finishWork();
    ASSERT_EQ(groom().spheres.size(), 12u);
    for (int i = 0; i < 60; ++i) {
        trigger("play.step");
        ASSERT_TRUE(QTest::qWaitFor(
            [&] {
                const auto& frame = parts().player.frame();
                return frame && frame->time > (i + 0.5) / 60;
            },
            kPatience));
    }
    const auto& positions = parts().player.frame()->pose->positions_ws;
    ASSERT_EQ(positions.size(), groom().pointCount());
    float farthest = 0;
    for (std::size_t p = 0; p < positions.size(); ++p)
        farthest = std::max(farthest, (positions[p] - groom().positions()[p]).norm());
    EXPECT_LT(farthest, 0.001f) << "metres in a second";
}

}  // namespace
}  // namespace hairloom::editor
