// SPDX-License-Identifier: GPL-3.0-or-later
// Marks over the picture, and pictures beside it, while the thread that draws is busy.
#include <cmath>
#include <future>

#include "editor/fields/number_box.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class MarksTest : public WindowTest {
  protected:
    MarksTest() : WindowTest(true) {}
    void SetUp() override {
        WindowTest::SetUp();
        window->resize(900, 560);
        drawQuickly();
    }
};

/// While the device draws something that takes long, marks are there at once, and hidden by the head.
TEST_F(MarksTest, MarksNeverWaitForAPicture) {
    if (viewport().presents()) GTEST_SKIP() << "pictures are not read back";
    openBust();
    viewport().look(render::View::Front);
    viewport().frameAll();
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    const QImage before = viewport().grab().toImage();
    const Vec3f middle = groom().scalp->bounds().center();
    bool shown = false;
    viewport().addMarks([&](Marks& marks) {
        if (!shown) return;
        marks.point(middle + Vec3f(0, 0, 1), QColor(255, 0, 255), 15);
        marks.point(middle - Vec3f(0, 0, 1), QColor(0, 255, 255), 15);
    });
    // The thread that draws is busy until this is let go.
    std::promise<void> go;
    const auto busy = viewport().renderJobs()->post([gone = go.get_future().share()](PlayedHair*) {
        gone.wait();
        return true;
    });
    shown = true;
    int reports = 0;
    QObject::connect(&viewport(), &Viewport::drawn, window.get(), [&] { ++reports; });
    viewport().redraw();
    const auto pixelsOf = [&](const QColor& colour) {
        const QImage marked = viewport().grab().toImage();
        int pixels = 0;
        for (int y = 0; y < marked.height(); ++y) {
            for (int x = 0; x < marked.width(); ++x)
                pixels += marked.pixelColor(x, y).rgb() == colour.rgb() ? 1 : 0;
        }
        return pixels;
    };
    EXPECT_TRUE(QTest::qWaitFor([&] { return pixelsOf(QColor(255, 0, 255)) > 50; }, kPatience));
    EXPECT_EQ(reports, 0) << "no picture was made for it";
    EXPECT_EQ(pixelsOf(QColor(0, 255, 255)), 0) << "the head hides it";
    // And go as they came.
    shown = false;
    viewport().redraw();
    EXPECT_TRUE(QTest::qWaitFor([&] { return viewport().grab().toImage() == before; }, kPatience));
    EXPECT_EQ(reports, 0);
    go.set_value();
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
}

/// Each of several who wait gets its own, and who gives up takes nobody's else.
TEST_F(MarksTest, PicturesAsideAreOfWhoAskedForThem) {
    openBust();
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    const PictureRequest of = viewport().requestOfView();
    std::vector<std::future<Result<QImage>>> made;
    for (std::uint32_t i = 0; i < 4; ++i) {
        PictureRequest request = of;
        request.width = request.height = 32 + 16 * i;
        const bool givesUp = i == 2;
        made.push_back(std::async(std::launch::async, [this, request, givesUp] {
            return viewport().drawAside(request, [givesUp] { return givesUp; });
        }));
    }
    for (std::uint32_t i = 0; i < 4; ++i) {
        const auto picture = made[i].get();
        if (i == 2 && !picture) continue;  // unless it was sooner than the first look
        ASSERT_TRUE(picture) << picture.error().message();
        EXPECT_EQ(picture->width(), static_cast<int>(32 + 16 * i));
    }
}

TEST_F(MarksTest, TheLampIsDraggedAroundTheHead) {
    openBust();
    viewport().look(render::View::Front);
    viewport().frameAll();
    const auto before = hash();
    trigger("tool.light");
    auto* angle = find<NumberBox>("lightTurn");
    EXPECT_EQ(angle->value(), 0);
    // To the right by a tenth of the view: towards the right of the head, and back.
    const QPoint middle(viewport().width() / 2, viewport().height() / 2);
    const QPoint right = middle + QPoint(viewport().width() / 10, 0);
    drag({middle, right});
    EXPECT_GT(viewport().lightTurn(), 5);
    EXPECT_NEAR(angle->value(), static_cast<double>(viewport().lightTurn()), 1);
    drag({right, middle});
    EXPECT_NEAR(viewport().lightTurn(), 0, 1);
    press(middle);
    moveTo(right);
    EXPECT_GT(viewport().lightTurn(), 5);
    key(Qt::Key_Escape);
    EXPECT_NEAR(viewport().lightTurn(), 0, 1);
    // Once around stays within half a turn.
    for (int i = 0; i < 12; ++i) drag({middle, right});
    EXPECT_LE(std::abs(viewport().lightTurn()), 180);
    EXPECT_EQ(hash(), before);
}

/// A share of the follow hairs, in the viewport alone.
TEST_F(MarksTest, PreviewDensityThinsThePictureAndNothingElse) {
    openSampleHair("short");
    openFirstStrands(40);
    Groom followed = groom();
    followed.interpolation.followPerGuide = 10;
    change("Follow hairs", followed);
    std::uint64_t hairs = 0;
    QObject::connect(&viewport(), &Viewport::drawn, window.get(),
                     [&](const PictureReport& report) { hairs = report.hairs; });
    viewport().redraw();
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    const std::uint64_t all = hairs;
    const auto before = hash();
    auto* density = find<NumberBox>("previewDensity");
    Q_EMIT density->edited(20);
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    EXPECT_LT(hairs, all / 2);
    EXPECT_GT(hairs, 0u);
    EXPECT_EQ(viewport().requestOfView().groom->interpolation.followPerGuide, 10u) << "renders have all";
    EXPECT_EQ(hash(), before);
    Q_EMIT density->edited(100);
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    EXPECT_EQ(hairs, all);
}

}  // namespace
}  // namespace hairloom::editor
