// SPDX-License-Identifier: GPL-3.0-or-later
// The pictures of docs/manual.md, from the window itself: docs/pictures/make_editor_pictures.sh runs it. Only
// when HAIRLOOM_MANUAL names a folder, because full heads of hair take a software device minutes.
#include <QCheckBox>
#include <QComboBox>
#include <QDir>
#include <QListWidget>
#include <QPushButton>

#include "core/documents/look_presets.h"
#include "core/editing/document.h"
#include "core/groom/time_line_keys.h"
#include "editor/dialogs/export_dialog.h"
#include "editor/fields/number_box.h"
#include "editor/panels/track_rows.h"
#include "editor/tools/brush_tool.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class ManualTest : public WindowTest {
  protected:
    ManualTest() : WindowTest(true) {}
    void SetUp() override {
        if (qEnvironmentVariableIsEmpty("HAIRLOOM_MANUAL")) GTEST_SKIP() << "HAIRLOOM_MANUAL names no folder";
        qputenv("HAIRLOOM_VIEWPORT", "readback");
        WindowTest::SetUp();
        window->resize(1280, 800);
        trigger("view.resetLayout");
        ASSERT_TRUE(QDir().mkpath(qEnvironmentVariable("HAIRLOOM_MANUAL")));
    }
    void TearDown() override {
        if (window) WindowTest::TearDown();
    }
    void shoot(QWidget& widget, const QString& name) {
        QCoreApplication::processEvents();
        keepForManual(widget.grab().toImage(), name);
    }
    void shootWindow(const QString& name) {
        EXPECT_TRUE(viewport().waitForPicture(kPatience)) << name.toStdString();
        shoot(*window, name);
    }
    /// Head and hair, in as many frames as a software device draws in a minute.
    void showFromThreeQuarters() {
        PictureQuality quality = viewport().quality();
        quality.frames = 4;
        viewport().setQuality(quality);
        viewport().look(render::View::ThreeQuarter);
        viewport().frameAll();
        viewport().camera().zoom(1.35f);
        viewport().redraw();
    }
    void raise(const char* panel) {
        window->panel(panel)->raise();
        QCoreApplication::processEvents();
    }
    BrushTool& brush(const char* id) {
        trigger((std::string("tool.") + id).c_str());
        return dynamic_cast<BrushTool&>(*parts().tools.find(id));
    }
    QPoint onHead(float x, float down, float z) {
        return at(Vec3f(x, groom().scalp->bounds().max().y() - down, z));
    }
    void show(const char* overlay, bool on) {
        window->actions().get(QString("overlay.") + overlay).setChecked(on);
    }
};

TEST_F(ManualTest, ScalpAndRoots) {
    shoot(*window, "start");
    openBust();
    viewport().look(render::View::ThreeQuarter);
    viewport().frameAll();
    shootWindow("head");
    raise("tool");
    auto& paint = brush("scalp_paint");
    paint.setRadius(0.035f);
    show("scalp", true);
    drag({onHead(-0.02f, 0.05f, 0.09f), onHead(0.03f, 0.03f, 0.07f), onHead(0.06f, 0.05f, 0.03f),
          onHead(0.07f, 0.08f, -0.02f)});
    moveTo(onHead(0.05f, 0.06f, 0.04f));
    shootWindow("selection");
    raise("scalp");
    trigger("tool.view");
    Groom groom = document().groom();
    groom.placement.count = 400;
    groom.placement.length = 0.16f;
    change("Placement", groom);
    find<QPushButton>("placePreview")->click();
    finishWork();
    shootWindow("placement");
}

TEST_F(ManualTest, GroomingSpheresAndLook) {
    openSampleHair("shoulder");
    // As many hairs as a software device draws in a minute.
    Groom fewer = groom();
    fewer.interpolation.followPerGuide = 5;
    change("Follow hairs", fewer);
    showFromThreeQuarters();
    trigger("tool.comb");
    raise("tool");
    raise("look");
    brush("comb").setRadius(0.03f);
    moveTo(onHead(0.08f, 0.10f, 0.05f));
    shootWindow("grooming");
    trigger("tool.view");
    raise("operators");
    find<QListWidget>("operators")->setCurrentRow(7);
    shootWindow("operators");
    raise("view");
    raise("spheres");
    show("spheres", true);
    shootWindow("spheres");
    show("spheres", false);
    // Marschner's model beside Kajiya and Kay's, in auburn.
    raise("look");
    raise("tool");
    Groom auburn = groom();
    applyLook(lookPresets()[4], auburn.material);
    change("Look", auburn);
    find<QPushButton>("compareKeep")->click();
    auburn.material.shadingModel = ShadingModel::marschner;
    change("Model", auburn);
    find<QPushButton>("compareShow")->setChecked(true);
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    // Thumbnails come when nothing else is to be drawn.
    auto* looks = find<QListWidget>("looks");
    const auto drawn = [&] {
        for (int i = 0; i < looks->count(); ++i) {
            if (!looks->item(i)->data(Qt::UserRole).toBool()) return false;
        }
        return true;
    };
    EXPECT_TRUE(QTest::qWaitFor(drawn, kPatience));
    shootWindow("look");
    find<QPushButton>("compareShow")->setChecked(false);
    ExportDialog exporting(document(), parts().preferences, parts().tasks, parts().messages, parts().player,
                           window.get());
    exporting.show();
    exporting.exportTo(inFolder("shoulder.usdc"));
    finishWork();
    shoot(exporting, "export");
}

TEST_F(ManualTest, Effects) {
    openSampleHair("shoulder");
    Groom windy = groom();
    windy.interpolation.followPerGuide = 5;
    windy.simulation.windSpeed = 7;
    windy.simulation.windDirection = {-1, 0.1f, 0.1f};
    document().open(windy, {}, "shoulder");
    showFromThreeQuarters();
    raise("effects");
    find<QPushButton>("certify")->click();
    finishWork();
    trigger("tool.wind");
    trigger("play.toggle");
    const auto& frame = parts().player.frame();
    ASSERT_TRUE(QTest::qWaitFor([&] { return frame && frame->time > 1.2; }, kPatience));
    trigger("play.toggle");
    shootWindow("wind");
}

TEST_F(ManualTest, TimeLine) {
    openSampleHair("shoulder");
    Groom fewer = groom();
    fewer.interpolation.followPerGuide = 5;
    document().open(fewer, {}, "shoulder");
    TimeLine line;
    line.framesPerSecond = 30;
    line.preRoll = 15;
    line.end = 2;
    line.loop = false;
    for (const auto& [time, turn] : {std::pair{0.0f, 0.0f}, {0.6f, 35.0f}, {1.4f, -25.0f}, {2.0f, 0.0f}}) {
        HeadKey key;
        key.time = time;
        key.degrees = turn;
        key.interpolation = KeyInterpolation::smooth;
        keyHead(line, key);
    }
    keySetting(line, "simulation.windSpeed", 0.3f, {0, 0, 0});
    keySetting(line, "simulation.windSpeed", 1, {6, 0, 0});
    keySetting(line, "simulation.windSpeed", 1.6f, {1, 0, 0});
    ASSERT_TRUE(parts().keying.change(line, "Time line"));
    showFromThreeQuarters();
    raise("physics");
    trigger("play.toggle");
    const auto& frame = parts().player.frame();
    ASSERT_TRUE(QTest::qWaitFor([&] { return frame && frame->time > 1.2; }, kPatience));
    parts().player.scrub(1);
    auto& rows = *find<TrackRows>("timeTracks");
    const KeyTrack wind{KeyTrack::Of::setting, "simulation.windSpeed"};
    QTest::mouseClick(&rows, Qt::LeftButton, {}, rows.placeOf({wind, 1}));
    shootWindow("timeline");
}

TEST_F(ManualTest, Levels) {
    openSampleHair("shoulder");
    Groom fewer = groom();
    fewer.interpolation.followPerGuide = 1;  // each level is held against all hairs
    document().open(fewer, {}, "shoulder");
    showFromThreeQuarters();
    raise("levels");
    find<QPushButton>("levelsMake")->click();
    finishWork();
    find<QCheckBox>("levelOver")->click();
    shootWindow("levels");
}

TEST_F(ManualTest, Accuracy) {
    openSampleHair("shoulder");
    showFromThreeQuarters();
    raise("accuracy");
    find<QPushButton>("accuracyMeasure")->click();
    finishWork();
    // Of a document that was just opened the head is seen first.
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    find<NumberBox>("accuracyPixels")->spinBox().setValue(0.5);
    find<QPushButton>("accuracyShow")->click();
    finishWork();
    const auto atRest = viewport().pose();
    ASSERT_TRUE(QTest::qWaitFor([&] { return viewport().pose() && viewport().pose() != atRest; }, kPatience));
    QTest::qWait(30'000);  // it moves, and is never the last picture
    shoot(*window, "accuracy");
    find<QPushButton>("accuracyShow")->click();
    raise("physics");
    shootWindow("prices");
}

TEST_F(ManualTest, Dye) {
    openSampleHair("shoulder");
    Groom teal = groom();
    teal.interpolation.followPerGuide = 5;
    teal.material.dyeColour = Vec3f(0.01f, 0.3f, 0.4f);
    document().open(teal, {}, "shoulder");
    showFromThreeQuarters();
    raise("tool");
    auto& dye = brush("dye_paint");
    dye.setRadius(0.045f);
    dye.setStrength(1);
    for (auto* profile : window->findChildren<QComboBox*>("brushProfile")) {
        if (!profile->isVisible()) continue;
        profile->setCurrentIndex(1);
        Q_EMIT profile->activated(1);
    }
    const Box3f hair = groom().bounds();
    const auto nearTips = [&](float z) { return at({0.9f * hair.max().x(), hair.min().y() + 0.05f, z}); };
    for (int stroke = 0; stroke < 2; ++stroke)
        drag({nearTips(0.07f), nearTips(0.03f), nearTips(-0.01f), nearTips(-0.05f), nearTips(-0.09f)});
    moveTo(nearTips(-0.02f));
    shootWindow("dye");
}

}  // namespace
}  // namespace hairloom::editor
