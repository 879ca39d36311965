// SPDX-License-Identifier: GPL-3.0-or-later
// What a groomer does from a body of another program to a hairstyle that is exported; docs/manual.md tells it
// as a walk, with pictures where docs/pictures/make_editor_pictures.sh runs it.
#include <QComboBox>
#include <QLineEdit>
#include <QListWidget>
#include <QMenu>
#include <QPainter>
#include <QToolButton>
#include <QTreeWidget>

#include "core/groom/file/project_file.h"
#include "core/groom/strand_subset.h"
#include "core/operations/stack.h"
#include "editor/dialogs/export_dialog.h"
#include "editor/dialogs/head_dialog.h"
#include "editor/document/autosave.h"
#include "editor/fields/number_box.h"
#include "editor/tools/brush_tool.h"
#include "editor/tools/curve_tool.h"
#include "importers/strands.h"
#include "tests/editor/window_fixture.h"
#include "tests/support/source_dir.h"

namespace hairloom::editor {
namespace {

class GroomerWalkTest : public WindowTest {
  protected:
    GroomerWalkTest() : WindowTest(isForManual()) {}
    static bool isForManual() { return !qEnvironmentVariableIsEmpty("HAIRLOOM_MANUAL"); }

    /// A picture of the manual: of this widget, or of the window with the head from that side.
    void keep(QWidget& widget) {
        if (isForManual()) stations_.push_back(widget.grab().toImage());
    }
    void keep(render::View side) {
        if (!isForManual()) return;
        const OrbitCamera before = viewport().camera();
        viewport().look(side);
        viewport().frameAll();
        viewport().camera().zoom(1.2f);
        viewport().redraw();
        EXPECT_TRUE(viewport().waitForPicture(kPatience));
        keep(*window);
        viewport().camera() = before;
    }
    /// All that were kept, two in a row.
    void keepStations() {
        if (!isForManual()) return;
        constexpr int kWidth = 640, kHeight = 400, kGap = 8;
        const int rows = (static_cast<int>(stations_.size()) + 1) / 2;
        QImage all(2 * kWidth + kGap, rows * (kHeight + kGap) - kGap, QImage::Format_RGB32);
        all.fill(QColor(0x20, 0x22, 0x26));
        QPainter painter(&all);
        int number = 0;
        for (const QImage& station : stations_) {
            const QImage small =
                station.scaled(kWidth, kHeight, Qt::KeepAspectRatio, Qt::SmoothTransformation);
            const QPoint corner(number % 2 * (kWidth + kGap), number / 2 * (kHeight + kGap));
            painter.drawImage(corner + QPoint((kWidth - small.width()) / 2, (kHeight - small.height()) / 2),
                              small);
            ++number;
        }
        keepForManual(all, "walk");
    }
    void click(const char* button) { find<QPushButton>(button)->click(); }
    void addOperator(const QString& name) {
        auto* list = find<QListWidget>("operators");
        list->setCurrentRow(list->count() - 1);
        for (QAction* action : find<QPushButton>("operatorAdd")->menu()->actions()) {
            if (action->text() == name) return action->trigger();
        }
        ADD_FAILURE() << "no operator " << name.toStdString();
    }
    /// Draws a curve of the chosen operator over these points of the world.
    void drawCurve(std::initializer_list<Vec3f> points) {
        click("curveDraw");
        ASSERT_TRUE(dynamic_cast<CurveTool*>(viewport().tool()));
        press(at(*points.begin()));
        for (const Vec3f& point : points) moveTo(at(point));
        release(at(*(points.end() - 1)));
    }
    BrushTool& brush(const char* name, float radius) {
        trigger((std::string("tool.") + name).c_str());
        auto& tool = dynamic_cast<BrushTool&>(*viewport().tool());
        tool.setRadius(radius);
        tool.setStrength(1);
        return tool;
    }
    Vec3f onHead(float x, float down, float z) const { return top + Vec3f(x, -down, z); }

    Vec3f top = Vec3f::Zero();  ///< of the head

  private:
    QList<QImage> stations_;
};

TEST_F(GroomerWalkTest, FromABodyInDecimetresToAHairstyleWithAFringeAndABraid) {
    const auto body = outsideData() / "heads/makehuman_base.obj";
    if (!std::filesystem::exists(body)) GTEST_SKIP() << body << " is not there";
    // The body comes with its unit, without helpers and joints.
    window->open(QString::fromStdString(body.string()));
    finishWork();
    auto* dialog = window->findChild<HeadDialog*>();
    ASSERT_TRUE(dialog);
    finishWork();
    EXPECT_TRUE(dialog->findChild<QToolButton*>("headUnit:dm")->isChecked());
    keep(*dialog);
    dialog->accept();
    finishWork();
    ASSERT_TRUE(groom().scalp);
    EXPECT_EQ(groom().scalp->groupNames(), std::vector<std::string>{"body"});
    for (const Vec3f& point : groom().scalp->positions()) {
        if (point.y() > top.y()) top = point;
    }
    EXPECT_NEAR(groom().scalp->bounds().sizes().y(), 1.7f, 0.1f);

    // A scalp by its words; the hairline is drawn.
    auto* words = find<QLineEdit>("scalpExpression");
    words->setText("above:0.955");
    QTest::keyClick(words, Qt::Key_Return);
    ASSERT_FALSE(groom().scalpSelection.empty());
    viewport().look(render::View::Front);
    trigger("view.frameSelection");
    const std::size_t faces = groom().scalpSelection.size();
    brush("scalp_paint", 0.012f);
    drag({at(onHead(-0.05f, 0.055f, 0.09f)), at(onHead(0, 0.05f, 0.1f)), at(onHead(0.05f, 0.055f, 0.09f))},
         Qt::ControlModifier);
    EXPECT_NE(groom().scalpSelection.size(), faces) << "the hairline is where the stroke was";

    // Two hundred guides, and hairs between them.
    find<NumberBox>("count")->spinBox().setValue(200);
    find<NumberBox>("length")->spinBox().setValue(25);
    find<NumberBox>("points")->spinBox().setValue(24);
    click("place");
    finishWork();
    ASSERT_EQ(groom().strandCount(), 200u) << window->statusLine().message().toStdString();
    EXPECT_NEAR(groom().placement.length, 0.25f, 1e-4f);
    find<NumberBox>("followPerGuide")->spinBox().setValue(10);
    keep(render::View::ThreeQuarter);

    // Five operators, one with a parting that is drawn.
    for (const char* name : {"Flow", "Part", "Clump", "Curl", "Collide"}) addOperator(name);
    ASSERT_EQ(groom().operators.size(), 5u);
    find<QListWidget>("operators")->setCurrentRow(1);
    viewport().look(render::View::Front);
    drawCurve({onHead(0.01f, 0.03f, 0.07f), onHead(0.01f, 0.015f, 0.05f), onHead(0.01f, 0.005f, 0.02f)});
    EXPECT_GE(curveOf(groom().operators[1]).points.size(), 2u);

    // Sculpted on top.
    viewport().frameAll();
    trigger("view.frameSelection");
    brush("comb", 0.05f);
    drag({at(onHead(0.04f, 0.06f, 0.05f)), at(onHead(0.06f, 0.08f, 0.05f)), at(onHead(0.07f, 0.1f, 0.05f))});
    ASSERT_EQ(groom().operators.size(), 6u);
    EXPECT_EQ(groom().operators.back().op, "sculpt");
    window->panel("operators")->raise();
    keep(render::View::ThreeQuarter);

    // A fringe of its own, and behind it a braid of the rest.
    trigger("tool.select");
    drag({at(onHead(-0.05f, 0.02f, 0.08f)), at(onHead(0.05f, 0.02f, 0.08f)), at(onHead(0.05f, 0.06f, 0.08f)),
          at(onHead(-0.05f, 0.06f, 0.08f))});
    click("layerAdd");
    ASSERT_EQ(groom().layers.size(), 2u);
    find<QTreeWidget>("layers")->topLevelItem(1)->setText(0, "Fringe");
    EXPECT_EQ(groom().layers[1].name, "Fringe");
    EXPECT_GT(strandsOfLayer(groom(), 1).size(), 0u);
    trigger("select.none");
    addOperator("Braid");
    viewport().look(render::View::Back);
    drawCurve({onHead(0, 0.12f, -0.1f), onHead(0, 0.17f, -0.1f), onHead(0, 0.22f, -0.1f)});
    auto* layer = window->panel("operators")->findChild<NumberBox*>("layer");
    ASSERT_TRUE(layer);
    layer->spinBox().setValue(1);
    EXPECT_GE(curveOf(groom().operators.back()).points.size(), 2u);
    expectSound();
    keep(render::View::Back);
    keepStations();

    // It moves, and what it has become is its shape.
    trigger("play.toggle");
    ASSERT_TRUE(played(0.2));
    const auto before = hash();
    trigger("play.take");
    EXPECT_NE(hash(), before) << window->statusLine().message().toStdString();

    // Saved, changed, killed, recovered.
    ASSERT_TRUE(window->saveTo(inFolder("walk.hairloom")));
    brush("length", 0.05f);
    viewport().look(render::View::Front);
    drag({at(onHead(0, 0.05f, 0.08f)), at(onHead(0.03f, 0.07f, 0.08f))});
    const auto unsaved = hash();
    ASSERT_TRUE(saveProject(groom(), recoveryFolder() / "killed.hairloom"));
    trigger("file.new");
    auto* recover = window->findChild<QPushButton*>("recover");
    ASSERT_TRUE(recover);
    recover->click();
    finishWork();
    EXPECT_EQ(hash(), unsaved);
    ASSERT_TRUE(window->saveTo(inFolder("recovered.hairloom")));
    EXPECT_TRUE(recoveryCopies().empty());

    // Out.
    ExportDialog out(document(), parts().preferences, parts().tasks, parts().messages, parts().player);
    out.exportTo(inFolder("walk.tfx"));
    finishWork();
    EXPECT_EQ(out.report().strands, 200u);
    const auto exported = importStrands(inFolder("walk.tfx").toStdString());
    ASSERT_TRUE(exported) << exported.error().message();
}

}  // namespace
}  // namespace hairloom::editor
