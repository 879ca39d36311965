// SPDX-License-Identifier: GPL-3.0-or-later
// The camera, the pictures, the live simulation.
#include <QCheckBox>
#include <QComboBox>
#include <QDir>
#include <QScreen>
#include <array>
#include <cstdlib>
#include <functional>

#include "editor/tools/brush_tool.h"
#include "editor/tools/surface_pick.h"
#include "editor/viewport/canvas.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

TEST(OrbitCameraTest, RaysGoThroughThePointsThatProjectThere) {
    OrbitCamera camera;
    camera.frame(Box3f(Vec3f(-0.2f, 1.4f, -0.2f), Vec3f(0.2f, 1.9f, 0.2f)), 1.5f);
    const QSizeF view(900, 600);
    for (const bool orthographic : {false, true}) {
        camera.setOrthographic(orthographic);
        for (const Vec3f& point : {Vec3f(0, 1.6f, 0), Vec3f(0.1f, 1.7f, 0.15f), Vec3f(-0.12f, 1.5f, -0.1f)}) {
            const auto px = camera.project(point, view);
            ASSERT_TRUE(px);
            const Ray ray = camera.rayThrough(*px, view);
            const Vec3f off = (point - ray.origin_ws).cross(ray.direction_ws);
            EXPECT_LT(off.norm(), 2e-4f) << "orthographic " << orthographic;
        }
    }
}

TEST(OrbitCameraTest, OrthographicViewsHaveNoPerspective) {
    OrbitCamera camera;
    const QSizeF view(800, 600);
    camera.setOrthographic(true);
    const Vec3f near = camera.target_ws() + 0.1f * camera.right_ws() - 0.3f * camera.forward_ws();
    const Vec3f far = near + 0.8f * camera.forward_ws();
    const Vec3f behindTheEye = near - 5 * camera.forward_ws();
    ASSERT_TRUE(camera.project(behindTheEye, view));
    for (const Vec3f& point : {far, behindTheEye}) {
        const QPointF off = *camera.project(point, view) - *camera.project(near, view);
        EXPECT_LT(off.manhattanLength(), 0.05);
    }
    const Ray a = camera.rayThrough({10, 20}, view), b = camera.rayThrough({700, 500}, view);
    EXPECT_LT((a.direction_ws - b.direction_ws).norm(), 1e-6f);
    // Lengths across the view are as long in pixels as in metres, wherever they are.
    const auto length = [&](const Vec3f& from, float metres) {
        const QPointF along =
            *camera.project(from + metres * camera.right_ws(), view) - *camera.project(from, view);
        return std::hypot(along.x(), along.y());
    };
    EXPECT_NEAR(length(far, 0.3f), 3 * length(near, 0.1f), 0.01);
    EXPECT_NEAR(length(behindTheEye, 0.3f), 3 * length(near, 0.1f), 0.01);
    // Turning perspective off keeps the size of what is in the middle.
    const float flat = camera.metresPerPixel(camera.target_ws(), view);
    camera.setOrthographic(false);
    EXPECT_NEAR(camera.metresPerPixel(camera.target_ws(), view), flat, 1e-6f);
}

TEST(OrbitCameraTest, FramingShowsTheWholeBox) {
    OrbitCamera camera;
    const Box3f box(Vec3f(-0.3f, 1, -0.1f), Vec3f(0.3f, 2, 0.4f));
    for (const QSizeF view : {QSizeF(1200, 600), QSizeF(300, 800)}) {
        for (int turn = 0; turn < 12; ++turn) {
            camera.spin(30);
            camera.frame(box, static_cast<float>(view.width() / view.height()));
            for (int corner = 0; corner < 8; ++corner) {
                const auto px = camera.project(box.corner(static_cast<Box3f::CornerType>(corner)), view);
                ASSERT_TRUE(px);
                EXPECT_TRUE(QRectF(QPointF(), view).contains(*px)) << px->x() << " " << px->y();
            }
        }
    }
}

TEST(OrbitCameraTest, MovingKeepsThePointUnderThePointer) {
    OrbitCamera camera;
    const QSizeF view(800, 600);
    const Vec3f point = camera.target_ws();
    const QPointF before = *camera.project(point, view);
    camera.move({40, -25}, view);
    const QPointF after = *camera.project(point, view);
    EXPECT_NEAR(after.x() - before.x(), 40, 0.2);
    EXPECT_NEAR(after.y() - before.y(), -25, 0.2);
}

class ViewportTest : public WindowTest {};

class PictureTest : public WindowTest {
  protected:
    PictureTest() : WindowTest(true) {}
    void SetUp() override {
        WindowTest::SetUp();
        window->resize(900, 560);
        drawQuickly();
    }
    /// A sample without the hairs between its guides, which take a software device long.
    void openGuides() {
        openSampleHair("short");
        Groom guides = groom();
        guides.interpolation.followPerGuide = 0;
        document().open(std::move(guides), {}, "guides");
    }
    void paintAndUndo(const QString& file, int least, int most,
                      const std::function<bool(const QColor& now, const QColor& before)>& differs);
    /// Each of these overlays changes the picture.
    void expectDrawn(std::initializer_list<const char*> overlays) {
        ASSERT_TRUE(viewport().waitForPicture(kPatience));
        const QImage without = viewport().grab().toImage(), picture = viewport().picture();
        for (const char* name : overlays) {
            trigger((std::string("overlay.") + name).c_str());
            ASSERT_TRUE(viewport().waitForPicture(kPatience));
            EXPECT_NE(viewport().grab().toImage(), without) << name;
            EXPECT_EQ(viewport().picture(), picture) << name << " is laid over it";
            trigger((std::string("overlay.") + name).c_str());
        }
    }
};

TEST_F(PictureTest, ThatTakeLongSayWhatTheyDraw) {
    if (viewport().presents()) GTEST_SKIP() << "pictures are not read back";
    Canvas alone;
    alone.setWaiting("Drawing the hair");
    ASSERT_TRUE(QTest::qWaitFor([&] { return !alone.waitingWords().isEmpty(); }, kPatience));
    EXPECT_TRUE(alone.waitingWords().startsWith("Drawing the hair, ")) << alone.waitingWords().toStdString();
    alone.setWaiting({});
    EXPECT_EQ(alone.waitingWords(), "");
    auto* canvas = viewport().findChild<Canvas*>();
    ASSERT_TRUE(canvas);
    QStringList after;
    QObject::connect(&viewport(), &Viewport::drawn, canvas, [&] { after += canvas->waiting(); });
    files().openSample("short");
    finishWork();
    const auto isDone = [&] { return after.contains("Drawing the hair") && after.last().isEmpty(); };
    EXPECT_TRUE(QTest::qWaitFor(isDone, kPatience))
        << after.join('|').toStdString() << ": the head comes first";
}

TEST_F(PictureTest, ShowsHairAndHead) {
    if (viewport().presents()) GTEST_SKIP() << "pictures are not read back";
    openGuides();
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    const QImage both = viewport().picture();
    ASSERT_FALSE(both.isNull()) << window->statusLine().message().toStdString();
    find<QCheckBox>("hair")->click();
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    const QImage bald = viewport().picture();
    ASSERT_EQ(bald.size(), both.size());
    int different = 0;
    for (int y = 0; y < bald.height(); y += 4) {
        for (int x = 0; x < bald.width(); x += 4) {
            different += std::abs(qGray(both.pixel(x, y)) - qGray(bald.pixel(x, y))) > 8 ? 1 : 0;
        }
    }
    // The head fills the shorter side of the view, whatever the screen leaves of it.
    const int side_px = std::min(bald.width(), bald.height());
    EXPECT_GT(different, side_px * side_px / 3200) << "thin dark hair over skin, " << side_px;
}

TEST_F(ViewportTest, BothOrbitStylesTurnMoveAndZoom) {
    openBust();
    const auto eye = [this] { return viewport().camera().camera().eye_ws; };
    const auto target = [this] { return viewport().camera().target_ws(); };
    const QPoint a(300, 300), b(360, 320);
    for (const OrbitStyle style : {OrbitStyle::Maya, OrbitStyle::Blender}) {
        parts().preferences.setOrbitStyle(style);
        const bool maya = style == OrbitStyle::Maya;
        Vec3f eyeBefore = eye(), targetBefore = target();
        drag({a, b}, maya ? Qt::AltModifier : Qt::NoModifier, maya ? Qt::LeftButton : Qt::MiddleButton);
        EXPECT_GT((eye() - eyeBefore).norm(), 0.01f);
        EXPECT_LT((target() - targetBefore).norm(), 1e-6f);
        targetBefore = target();
        drag({a, b}, maya ? Qt::AltModifier : Qt::ShiftModifier, Qt::MiddleButton);
        EXPECT_GT((target() - targetBefore).norm(), 0.001f);
        const float far = (eye() - target()).norm();
        drag({a, b}, maya ? Qt::AltModifier : Qt::ControlModifier, maya ? Qt::RightButton : Qt::MiddleButton);
        EXPECT_NE((eye() - target()).norm(), far);
    }
}

/// A stroke hands the renderer what it moves; the groom is handed over whole when the comparison changes.
TEST_F(PictureTest, PartialUpdateRendersLikeAFullUpload) {
    if (viewport().presents()) GTEST_SKIP() << "pictures are not read back";
    window->resize(640, 400);
    openGuides();
    viewport().look(render::View::Front);
    viewport().frameAll();
    trigger("tool.comb");
    auto& comb = dynamic_cast<BrushTool&>(*parts().tools.find("comb"));
    comb.setRadius(0.05f);
    comb.setStrength(1);
    Box3f roots;
    for (std::size_t s = 0; s < groom().strandCount(); ++s) roots.extend(groom().strand(s).front());
    const QPoint crown = at(Vec3f(0, roots.max().y() - 0.03f, roots.max().z()));
    const QPoint end = crown + QPoint(90, 30);
    const auto settled = [this] {
        EXPECT_TRUE(viewport().waitForPicture(kPatience));
        return viewport().picture();
    };
    moveTo(end);
    const QImage before = settled();
    press(crown);
    moveTo(crown + QPoint(50, 10));
    moveTo(end);
    EXPECT_NE(settled(), before) << "the stroke shows while it is drawn";
    release(end);
    const QImage combed = settled();
    viewport().setComparison(std::nullopt);
    EXPECT_EQ(settled(), combed);
    // Several steps before the renderer is asked again.
    trigger("edit.undo");
    trigger("edit.redo");
    trigger("edit.undo");
    // The ring lies on the hair that is there when the pointer moves.
    moveTo(end + QPoint(3, 0));
    moveTo(end);
    const QImage undone = settled();
    EXPECT_NE(undone, combed);
    EXPECT_EQ(undone, before);
    viewport().setComparison(std::nullopt);
    EXPECT_EQ(settled(), undone);
}

/// However near the eye is: without perspective, what is behind it is seen, so the nose is hit first.
TEST_F(ViewportTest, PicksHitWhatAnOrthographicViewShows) {
    openBust();
    viewport().look(render::View::Front);
    viewport().frameAll();
    Vec3f nose = groom().scalp->positions().front();
    for (const Vec3f& at : groom().scalp->positions()) {
        if (at.z() > nose.z() && at.y() > viewport().camera().target_ws().y()) nose = at;
    }
    for (const bool orthographic : {false, true}) {
        viewport().setOrthographic(orthographic);
        for (const float nearer : {1.0f, 3.0f, 12.0f}) {
            viewport().camera().zoom(orthographic ? nearer : 1.0f);
            const auto px = viewport().camera().project(nose, viewport().viewSize_px());
            ASSERT_TRUE(px);
            const BrushPlace place = skinUnder(document(), viewport(), *px);
            ASSERT_TRUE(place.skin) << orthographic << ", " << nearer;
            EXPECT_LT((place.position_ss - nose).norm(), 2e-4f) << orthographic << ", " << nearer;
        }
    }
    EXPECT_LT(viewport().camera().camera().eye_ws.z(), nose.z()) << "else it proves nothing";
}

/// The renderer's view and the pointer's are one.
TEST_F(PictureTest, MarkersStandWhereTheCameraProjectsThem) {
    if (viewport().presents()) GTEST_SKIP() << "pictures are not read back";
    openBust();
    const Vec3f middle = viewport().camera().target_ws();
    const std::array points{Vec3f(middle + Vec3f(0.1f, 0.08f, 0.2f)),
                            Vec3f(middle + Vec3f(-0.12f, -0.05f, -0.3f))};
    const std::array colours{QColor(255, 0, 255), QColor(0, 255, 255)};
    viewport().addMarks([&](Marks& marks) {
        for (std::size_t i = 0; i < 2; ++i) marks.point(points[i], colours[i], 9, Marks::Depth::OnTop);
    });
    for (const bool orthographic : {false, true}) {
        viewport().setOrthographic(orthographic);
        ASSERT_TRUE(viewport().waitForPicture(kPatience));
        const QImage picture = viewport().grab().toImage();
        for (std::size_t i = 0; i < 2; ++i) {
            QPointF sum;
            int count = 0;
            for (int y = 0; y < picture.height(); ++y) {
                for (int x = 0; x < picture.width(); ++x) {
                    if (picture.pixelColor(x, y).rgb() != colours[i].rgb()) continue;
                    sum += QPointF(x + 0.5, y + 0.5);
                    ++count;
                }
            }
            ASSERT_GT(count, 20) << orthographic;
            const QPointF off =
                sum / count - *viewport().camera().project(points[i], viewport().viewSize_px());
            EXPECT_LT(off.manhattanLength(), 1.5) << "orthographic " << orthographic << ", point " << i;
        }
    }
}

TEST_F(PictureTest, OfANewDocumentTheHeadIsSeenAtOnceAndTheOldOneNoMore) {
    if (viewport().presents()) GTEST_SKIP() << "pictures are not read back";
    openBust();
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    std::vector<std::uint64_t> hairs;
    QObject::connect(&viewport(), &Viewport::drawn, window.get(),
                     [&](const PictureReport& report) { hairs.push_back(report.hairs); });
    openGuides();
    EXPECT_TRUE(viewport().picture().isNull());
    const QImage shown = viewport().grab().toImage();
    EXPECT_EQ(skinPixels(shown), 0) << "the bust is gone";
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    ASSERT_GT(hairs.size(), 1u);
    EXPECT_EQ(hairs.front(), 0u);
    EXPECT_EQ(hairs.back(), groom().strandCount());
}

TEST_F(PictureTest, OverlaysAreDrawn) {
    if (viewport().presents()) GTEST_SKIP() << "pictures are not read back";
    openGuides();
    expectDrawn({"scalp", "roots", "guides", "triangulation", "spheres", "wireframe", "density", "wind"});
}

TEST_F(PictureTest, TheScalpIsTintedUntilHairGrows) {
    if (viewport().presents()) GTEST_SKIP() << "pictures are not read back";
    openBust();
    const auto shown = [&] {
        EXPECT_TRUE(viewport().waitForPicture(kPatience));
        return viewport().grab().toImage();
    };
    const QImage bare = shown();
    auto& groups = *find<QComboBox>("scalpGroup");
    groups.setCurrentIndex(groups.findData("material:scalp"));
    Q_EMIT groups.activated(groups.currentIndex());
    ASSERT_FALSE(groom().scalpSelection.empty());
    const QImage tinted = shown();
    EXPECT_NE(tinted, bare) << "what was chosen is seen without a tool in hand";
    // It is laid over the picture and goes with the first strand.
    trigger("edit.undo");
    EXPECT_EQ(shown(), bare);
    openGuides();
    const QImage hair = shown();
    trigger("overlay.scalp");
    EXPECT_NE(shown(), hair);
    trigger("overlay.scalp");
}

TEST_F(PictureTest, OverlaysOfMotionAreDrawn) {
    if (viewport().presents()) GTEST_SKIP() << "pictures are not read back";
    openGuides();
    Groom windy = groom();
    windy.simulation.windSpeed = 12;
    // A sphere that hair is in from the start shows as deep.
    windy.spheres.push_back({"deep", windy.strand(0).back(), 0.03f, {}});
    windy.simulation.lengthIterations = 0;
    change("Wind", windy);
    for (int i = 0; i < 3; ++i) trigger("play.step");
    ASSERT_TRUE(QTest::qWaitFor(
        [this] {
            const auto& frame = parts().player.frame();
            return frame && frame->time > 0.04;
        },
        kPatience));
    expectDrawn({"strain", "penetration", "effectCost"});
}

/// Paints at the crown with the tool in hand and undoes it: more than `least` pixels change while the button
/// is down, more when it is released, fewer than `most` after undo, by what tells a pixel from one before.
/// The painted picture stays as a file.
void PictureTest::paintAndUndo(const QString& file, int least, int most,
                               const std::function<bool(const QColor& now, const QColor& before)>& differs) {
    // Fine pictures only: fast ones differ from them.
    const auto settled = [this] {
        EXPECT_TRUE(viewport().waitForPicture(kPatience));
        return viewport().picture();
    };
    // The ring of the brush stays in one place. The display's own pointer may be there, or have stayed there
    // through the stroke, and only a way of its own is told.
    const auto parkPointer = [this] {
        moveTo(QPoint(30, 2));
        moveTo(QPoint(2, 2));
    };
    parkPointer();
    const QImage before = settled();
    const auto changed = [&](const QImage& picture) {
        int count = 0;
        for (int y = 0; y < picture.height(); ++y) {
            for (int x = 0; x < picture.width(); ++x)
                count += differs(picture.pixelColor(x, y), before.pixelColor(x, y)) ? 1 : 0;
        }
        return count;
    };
    Box3f roots;
    for (std::size_t s = 0; s < groom().strandCount(); ++s) roots.extend(groom().strand(s).front());
    const QPoint crown = at(Vec3f(0, roots.max().y() - 0.03f, roots.max().z()));
    press(crown);
    moveTo(crown + QPoint(20, 4));
    const int during = changed(settled());
    EXPECT_GT(during, least) << "while the button is down";
    moveTo(crown + QPoint(60, 10));
    release(crown + QPoint(60, 10));
    parkPointer();
    const QImage painted = settled();
    EXPECT_GT(changed(painted), during);
    QDir().mkpath(HAIRLOOM_SCREENSHOTS);
    EXPECT_TRUE(painted.save(QStringLiteral(HAIRLOOM_SCREENSHOTS "/") + file));
    trigger("edit.undo");
    EXPECT_LT(changed(settled()), most);
}

TEST_F(PictureTest, DyeShowsWhileItIsPainted) {
    if (viewport().presents()) GTEST_SKIP() << "pictures are not read back";
    openGuides();
    Groom red = groom();
    red.material.dyeColour = Vec3f(0.95f, 0.0f, 0.0f);
    change("Dye", red);
    viewport().look(render::View::Front);
    viewport().frameAll();
    trigger("tool.dye_paint");
    paintAndUndo("dye.png", 30, 5, [](const QColor& now, const QColor& before) {
        return now.red() - now.green() > before.red() - before.green() + 12;
    });
}

TEST_F(PictureTest, WidthShowsWhileItIsPainted) {
    if (viewport().presents()) GTEST_SKIP() << "pictures are not read back";
    openGuides();
    viewport().look(render::View::Front);
    viewport().frameAll();
    trigger("tool.width_paint");
    dynamic_cast<BrushTool&>(*viewport().tool()).setParameter("width", 10);
    paintAndUndo("width.png", 100, 20, [](const QColor& now, const QColor& before) {
        return std::abs(now.lightness() - before.lightness()) > 8;
    });
}

TEST_F(PictureTest, AWindowOfTheDeviceShowsTheHead) {
    const QByteArray wish = qgetenv("HAIRLOOM_VIEWPORT");
    if (wish != "window" && wish != "apart") GTEST_SKIP() << "pictures are read back";
    openBust();
    ASSERT_TRUE(QTest::qWaitFor([this] { return viewport().presents(); }, kPatience));
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    EXPECT_TRUE(QTest::qWaitFor([this] { return skinPixels(viewportOnScreen()) > 300; }, kPatience));
    // Events reach the window that the device draws to.
    const Vec3f eye = viewport().camera().camera().eye_ws;
    drag({QPoint(200, 200), QPoint(260, 200)});
    EXPECT_GT((viewport().camera().camera().eye_ws - eye).norm(), 0.01f);
}

TEST_F(ViewportTest, PlayingMovesTheHairAndResettingRestoresIt) {
    openSampleHair("short");
    const auto authored = hash();
    Groom windy = groom();
    windy.simulation.windSpeed = 8;
    change("Wind", windy);
    trigger("play.toggle");
    ASSERT_TRUE(QTest::qWaitFor(
        [this] {
            const auto& f = parts().player.frame();
            return f && f->time > 0.2;
        },
        kPatience));
    const auto pose = viewport().pose();
    ASSERT_TRUE(pose);
    float farthest = 0;
    for (std::size_t p = 0; p < groom().pointCount(); ++p) {
        farthest = std::max(farthest, (pose->positions_ws[p] - groom().positions()[p]).norm());
    }
    EXPECT_GT(farthest, 0.002f);
    EXPECT_EQ(parts().player.frame()->stats.nanCount, 0u);
    trigger("play.reset");
    EXPECT_FALSE(viewport().pose());
    document().undo();
    EXPECT_EQ(hash(), authored) << "playing changes no document";
}

TEST_F(ViewportTest, SettingsTakeEffectWhileItPlays) {
    openSampleHair("short");
    trigger("play.toggle");
    ASSERT_TRUE(played(0.05));
    const auto windIsOn = [this] {
        for (const EffectReport& effect : parts().player.frame()->stats.effects) {
            if (effect.name == "wind") return effect.on;
        }
        return false;
    };
    EXPECT_FALSE(windIsOn());
    Groom windy = groom();
    windy.simulation.windSpeed = 8;
    change("Wind", windy);
    const double now = parts().player.frame()->time;
    ASSERT_TRUE(played(now + 0.1)) << "it went on from where it was";
    EXPECT_TRUE(windIsOn());
}

TEST_F(ViewportTest, ClipsOfTheCharacterPlay) {
    openSampleHair("short");
    ASSERT_TRUE(parts().player.setMotion("clip:nod_and_turn"));
    EXPECT_FALSE(parts().player.setMotion("clip:no_such"));
    trigger("play.step");
    ASSERT_TRUE(QTest::qWaitFor([this] { return parts().player.frame() != nullptr; }, kPatience));
    EXPECT_EQ(parts().player.frame()->pose->head.scalpPositions_ws.size(), groom().scalp->vertexCount());
}

}  // namespace
}  // namespace hairloom::editor
