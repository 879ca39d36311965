// SPDX-License-Identifier: GPL-3.0-or-later
// From the bare bust to an exported hairstyle with a fringe and a braid, with the mouse alone: every click
// lands on what is seen there.
#include <QCheckBox>
#include <QStandardPaths>
#include <QStyleOptionSlider>
#include <QTreeWidget>

#include "core/groom/file/project_file.h"
#include "core/operations/stack.h"
#include "editor/document/autosave.h"
#include "importers/strands.h"
#include "tests/editor/mouse_fixture.h"

namespace hairloom::editor {
namespace {

class MouseWalkTest : public MouseTest {
  protected:
    /// Drags the handle of a slider until its box shows about that, and turns the wheel over it for the rest.
    void slideTo(NumberBox& box, double value) {
        scrollTo(box);
        QSlider& slider = box.slider();
        QStyleOptionSlider option;
        option.initFrom(&slider);
        option.orientation = Qt::Horizontal;
        option.minimum = slider.minimum();
        option.maximum = slider.maximum();
        option.sliderPosition = slider.value();
        const QRect handle =
            slider.style()->subControlRect(QStyle::CC_Slider, &option, QStyle::SC_SliderHandle, &slider);
        QPoint at = handle.center();
        QTest::mousePress(&slider, Qt::LeftButton, {}, at);
        const int step = box.value() > value ? -1 : 1;
        while ((box.value() - value) * step < 0 && slider.rect().contains(at)) {
            at.rx() += step;
            QTest::mouseMove(&slider, at);
            QCoreApplication::processEvents();
        }
        QTest::mouseRelease(&slider, Qt::LeftButton, {}, at);
        QCoreApplication::processEvents();
        // The rest is typed, in the unit that is shown.
        if (box.value() != 0) box.spinBox().setValue(box.spinBox().value() * value / box.value());
        QCoreApplication::processEvents();
    }
};

TEST_F(MouseWalkTest, FromTheBustToAnExportedHairstyleWithAFringeAndABraid) {
    window->resize(1440, 900);
    click("sample:");
    finishWork();
    ASSERT_TRUE(groom().scalp);
    top = Vec3f(0, groom().scalp->bounds().max().y(), 0);

    // The scalp of the file, and a hairline drawn a little higher.
    open("scalp");
    auto& groups = *find<QComboBox>("scalpGroup");
    pick(groups, groups.findData("material:scalp"));
    ASSERT_FALSE(groom().scalpSelection.empty());
    chooseInMenu("View", "From the front");
    chooseInMenu("View", "Frame selection");
    const std::size_t faces = groom().scalpSelection.size();
    tool("scalp_paint");
    for (auto* box : open("tool").findChildren<QCheckBox*>()) {
        if (box->isVisible() && box->text() == "Invert") clickAt(*box, {8, box->height() / 2});
    }
    drag({at(onHead(-0.03f, 0.05f, 0.08f)), at(onHead(0, 0.05f, 0.085f)), at(onHead(0.03f, 0.05f, 0.08f))});
    EXPECT_LT(groom().scalpSelection.size(), faces) << "the hairline is where the stroke was";
    open("scalp");

    // About two hundred guides.
    slideTo(*find<NumberBox>("count"), 200);
    slideTo(*find<NumberBox>("length"), 0.25);
    slideTo(*find<NumberBox>("points"), 24);
    EXPECT_NEAR(groom().placement.count, 200, 20);
    EXPECT_NEAR(groom().placement.length, 0.25f, 0.03f) << "a pixel of the slider is up to 2 cm";
    EXPECT_NEAR(groom().placement.points, 24, 2);
    click("place");
    finishWork();
    const std::size_t guides = groom().strandCount();
    ASSERT_GT(guides, 150u) << window->statusLine().message().toStdString();

    // Five operators, one with a parting that is drawn.
    open("operators");
    for (const char* name : {"Flow", "Part", "Clump", "Curl", "Collide"}) addOperator(name);
    ASSERT_EQ(groom().operators.size(), 5u);
    chooseOperator(1);
    drawCurve({onHead(0.01f, 0.03f, 0.07f), onHead(0.01f, 0.015f, 0.05f), onHead(0.01f, 0.005f, 0.02f)});
    EXPECT_GE(curveOf(groom().operators[1]).points.size(), 2u);

    // Sculpted on top.
    tool("comb");
    drag({at(onHead(0.04f, 0.06f, 0.05f)), at(onHead(0.06f, 0.08f, 0.05f)), at(onHead(0.07f, 0.1f, 0.05f))});
    ASSERT_EQ(groom().operators.size(), 6u);
    EXPECT_EQ(groom().operators.back().op, "sculpt");

    // A fringe of its own, and behind it a braid of the rest.
    tool("select");
    drag({at(onHead(-0.05f, 0.01f, 0.06f)), at(onHead(0.05f, 0.01f, 0.06f)), at(onHead(0.05f, 0.06f, 0.08f)),
          at(onHead(-0.05f, 0.06f, 0.08f))});
    ASSERT_NO_FATAL_FAILURE(addLayerOfSelection());
    chooseInMenu("Select", "None");
    open("operators");
    chooseOperator(5);
    addOperator("Braid");
    chooseInMenu("View", "From the back");
    drawCurve({onHead(0, 0.12f, -0.1f), onHead(0, 0.17f, -0.1f), onHead(0, 0.22f, -0.1f)});
    for (auto* fold : window->panel("operators")->findChildren<QToolButton*>()) {
        if (fold->isVisible() && fold->text() == "Region") click(*fold);
    }
    auto* layer = window->panel("operators")->findChild<NumberBox*>("layer");
    ASSERT_TRUE(layer);
    scrollTo(*layer);
    layer->spinBox().stepBy(1);  // its upper arrow
    EXPECT_GE(curveOf(groom().operators.back()).points.size(), 2u);
    EXPECT_EQ(layer->value(), 1);
    expectSound();

    // It moves, and what it has become is its shape.
    chooseInMenu("Simulation", "Play");
    ASSERT_TRUE(played(0.2));
    const auto before = hash();
    chooseInMenu("Simulation", "Set as rest shape");
    EXPECT_NE(hash(), before) << window->statusLine().message().toStdString();

    // Saved under the name that is proposed, changed, killed, recovered.
    onceAskedForAFileTakeIt();
    chooseInMenu("File", "Save");
    EXPECT_FALSE(document().isModified()) << window->statusLine().message().toStdString();
    EXPECT_TRUE(QFileInfo::exists(document().path()));
    tool("length");
    drag({at(onHead(0, 0.05f, -0.08f)), at(onHead(0.03f, 0.07f, -0.08f))});
    const auto unsaved = hash();
    ASSERT_TRUE(saveProject(groom(), (QStandardPaths::writableLocation(QStandardPaths::AppDataLocation) +
                                      "/recovery/killed.hairloom")
                                         .toStdString()));
    chooseInMenu("File", "New");
    click("recover");
    finishWork();
    EXPECT_EQ(hash(), unsaved);

    // Out.
    onceAsked<ExportDialog>([this](ExportDialog& dialog) { exportAllOf(dialog); });
    chooseInMenu("File", "Export hair…");
    const QStringList written = QDir(folder.path()).entryList({"*.tfx", "*.hair", "*.abc", "*.usd*"});
    ASSERT_EQ(written.size(), 1) << "the first target's format";
    const auto exported = importStrands(inFolder(written.front().toUtf8().constData()).toStdString());
    ASSERT_TRUE(exported) << exported.error().message();
    EXPECT_EQ(exported->groom.strandCount(), guides);
}

}  // namespace
}  // namespace hairloom::editor
