// SPDX-License-Identifier: GPL-3.0-or-later
// From an empty window to an exported, moving hairstyle, as a person goes: the walk that docs/manual.md
// shows.
#include <QComboBox>
#include <QDir>
#include <QPushButton>

#include "editor/dialogs/export_dialog.h"
#include "editor/fields/number_box.h"
#include "editor/tools/brush_tool.h"
#include "editor/viewport/device_work.h"
#include "importers/strands.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

/// With pictures where HAIRLOOM_VIEWPORT says how they are shown, else without any.
class WalkTest : public WindowTest {
  protected:
    WalkTest() : WindowTest(!qEnvironmentVariableIsEmpty("HAIRLOOM_VIEWPORT")) {}

    /// Hair is simulated on the device that draws, where one does and it is not the software renderer.
    static bool drawsOnDevice() {
        return !qEnvironmentVariableIsEmpty("HAIRLOOM_VIEWPORT") && chosenDevice().why.empty();
    }

    /// While it plays: the screen shows the head, and the picture moves. The screen stays as a file.
    void expectLivePicture() {
        if (!viewport().presents()) return;
        // A slow device is pictures behind; after a few of them it is where the walk is.
        for (int i = 0; i < 3; ++i) {
            const QImage before = viewportOnScreen();
            ASSERT_TRUE(QTest::qWaitFor([&] { return viewportOnScreen() != before; }, kPatience));
        }
        const QImage screen = onScreen();
        QDir().mkpath(HAIRLOOM_SCREENSHOTS);
        EXPECT_TRUE(screen.save(QStringLiteral(HAIRLOOM_SCREENSHOTS "/walk.png")));
        EXPECT_GT(skinPixels(viewportOnScreen()), 300);
    }
};

TEST_F(WalkTest, FromAnEmptyWindowToAnExportedMovingHairstyle) {
    // A head.
    openBust();
    viewport().look(render::View::Front);
    viewport().frameAll();
    // A scalp, painted from the front and from behind.
    trigger("tool.scalp_paint");
    auto& paint = dynamic_cast<BrushTool&>(*parts().tools.find("scalp_paint"));
    paint.setRadius(0.03f);
    const Box3f box = groom().scalp->bounds();
    const auto onHead = [&](float x, float down, float z) { return at(Vec3f(x, box.max().y() - down, z)); };
    drag({onHead(-0.05f, 0.04f, 0.05f), onHead(-0.03f, 0.02f, 0.06f), onHead(0.03f, 0.02f, 0.06f),
          onHead(0.05f, 0.04f, 0.05f)});
    viewport().look(render::View::Back);
    drag({onHead(0.05f, 0.05f, -0.1f), onHead(0, 0.04f, -0.1f), onHead(-0.05f, 0.05f, -0.1f),
          onHead(-0.05f, 0.10f, -0.1f), onHead(0.05f, 0.10f, -0.1f)});
    ASSERT_GT(groom().scalpSelection.size(), 50u);
    EXPECT_EQ(document().stepCount(), 2);
    // Hair on it.
    find<NumberBox>("count")->spinBox().setValue(800);
    find<NumberBox>("length")->setFocus();
    Groom settings = groom();
    settings.placement.length = 0.12f;
    change("Length", settings);
    find<QPushButton>("placePreview")->click();
    finishWork();
    find<QPushButton>("place")->click();
    finishWork();
    ASSERT_EQ(groom().strandCount(), 800u) << window->statusLine().message().toStdString();
    expectSound();
    // With a curl, which the next placing of straight hair takes away.
    find<QComboBox>("placeCurl")->setCurrentText("Wavy");
    find<QPushButton>("place")->click();
    finishWork();
    ASSERT_EQ(groom().operators.size(), 1u);
    EXPECT_EQ(groom().operators[0].op, "wave");
    expectSound();
    find<QComboBox>("placeCurl")->setCurrentText("Straight");
    find<QPushButton>("place")->click();
    finishWork();
    EXPECT_TRUE(groom().operators.empty());
    // Grooming: comb down behind, cut the ends.
    trigger("tool.comb");
    auto& comb = dynamic_cast<BrushTool&>(*parts().tools.find("comb"));
    comb.setRadius(0.04f);
    comb.setStrength(0.8f);
    const auto placed = hash();
    drag({onHead(0.02f, 0.06f, -0.15f), onHead(0.02f, 0.10f, -0.16f), onHead(0.02f, 0.16f, -0.16f)});
    const auto combed = hash();
    EXPECT_NE(combed, placed);
    trigger("tool.cut_line");
    drag({onHead(0.12f, 0.14f, -0.15f), onHead(0, 0.14f, -0.15f), onHead(-0.12f, 0.14f, -0.15f)});
    const auto cut = hash();
    EXPECT_NE(cut, combed);
    trigger("edit.undo");
    EXPECT_EQ(hash(), combed);
    trigger("edit.redo");
    EXPECT_EQ(hash(), cut);
    // Spheres.
    find<QPushButton>("sphereFit")->click();
    finishWork();
    ASSERT_FALSE(groom().spheres.empty());
    // As few hairs as a software device draws while they move.
    drawQuickly();
    Groom thinner = groom();
    thinner.interpolation.followPerGuide = 2;
    change("Fewer follow hairs", thinner);
    // Wind, and let it blow.
    trigger("tool.wind");
    const QPoint centre = at(viewport().camera().target_ws());
    drag({centre, centre + QPoint(70, 0), centre + QPoint(110, 0)});
    EXPECT_GT(groom().simulation.windSpeed, 4);
    for (const SimulateOn where : {SimulateOn::Cpu, SimulateOn::Gpu}) {
        parts().preferences.setSimulateOn(where);
        trigger("play.toggle");
        ASSERT_TRUE(played(0.3));
        const EngineChoice& engine = *parts().player.engine();
        const bool device = where == SimulateOn::Gpu && drawsOnDevice();
        EXPECT_EQ(engine.kind, device ? EngineKind::gpu : EngineKind::cpu) << engine.why;
        expectLivePicture();
        const SimulationStats stats = parts().player.frame()->stats;
        EXPECT_EQ(stats.nanCount, 0u);
        EXPECT_EQ(stats.restoredStrands, 0u);
        trigger("play.reset");
    }
    expectSound();
    // Out, and back in again.
    ASSERT_TRUE(window->saveTo(inFolder("walk.hairloom")));
    const auto saved = hash();
    ExportDialog dialog(document(), parts().preferences, parts().tasks, parts().messages, parts().player);
    dialog.exportTo(inFolder("walk.tfx"));
    finishWork();
    EXPECT_EQ(dialog.report().strands, groom().strandCount());
    const auto exported = importStrands(inFolder("walk.tfx").toStdString());
    ASSERT_TRUE(exported) << exported.error().message();
    EXPECT_EQ(exported->groom.strandCount(), groom().strandCount());
    trigger("file.new");
    window->open(inFolder("walk.hairloom"));
    finishWork();
    EXPECT_EQ(hash(), saved);
}

}  // namespace
}  // namespace hairloom::editor
