// SPDX-License-Identifier: GPL-3.0-or-later
// The window on a computer without a GPU: no driver, or none but one that runs on the processor.
#include <algorithm>
#include <future>

#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class SoftwareWindowTest : public WindowTest {
  protected:
    SoftwareWindowTest() : WindowTest(true) {}
    void SetUp() override {
        for (auto& [name, before] : variables_) {
            before = qgetenv(name);
            qputenv(name, "/nonexistent.json");
        }
        qunsetenv("HAIRLOOM_RENDERER");
        qputenv("HAIRLOOM_VIEWPORT", "readback");
        WindowTest::SetUp();
        QObject::connect(&viewport(), &Viewport::drawn, window.get(),
                         [this](const PictureReport& report) { reports_.push_back(report); });
    }
    void TearDown() override {
        WindowTest::TearDown();
        const auto restore = [](const char* name, const QByteArray& before) {
            before.isEmpty() ? qunsetenv(name) : qputenv(name, before);
        };
        for (const auto& [name, before] : variables_) restore(name, before);
        restore("HAIRLOOM_RENDERER", renderer_);
        restore("HAIRLOOM_VIEWPORT", surface_);
    }
    bool drawn(const std::function<bool(const PictureReport&)>& wanted) {
        const std::size_t from = reports_.size();
        return QTest::qWaitFor(
            [&] {
                return std::any_of(reports_.begin() + static_cast<std::ptrdiff_t>(from), reports_.end(),
                                   wanted);
            },
            kPatience);
    }
    QString message() { return window->statusLine().message(); }
    /// Guides of a sample, in a small window.
    void openFewHairs() {
        window->resize(900, 560);
        drawQuickly();
        openSampleHair("short");
        Groom few = groom();
        few.interpolation.followPerGuide = 0;
        document().open(std::move(few), {}, "guides");
    }
    static bool hasHair(const PictureReport& report) { return report.hairs > 0; }
    static bool isStill(const PictureReport& report) { return report.hairs > 0 && report.frames > 1; }

    std::vector<PictureReport> reports_;

  private:
    std::vector<std::pair<const char*, QByteArray>> variables_{{"VK_DRIVER_FILES", {}},
                                                               {"VK_ICD_FILENAMES", {}}};
    QByteArray renderer_ = qgetenv("HAIRLOOM_RENDERER"), surface_ = qgetenv("HAIRLOOM_VIEWPORT");
};

TEST_F(SoftwareWindowTest, ShowsHairAndFollowsTheMouseAndSaysWhoDraws) {
    ASSERT_TRUE(QTest::qWaitFor([this] { return message().contains("software renderer draws"); }, kPatience))
        << message().toStdString();
    openSampleHair("short");
    reports_.clear();
    // The head, quick hair, then frames of the still.
    ASSERT_TRUE(drawn(isStill)) << message().toStdString();
    EXPECT_FALSE(viewport().presents());
    EXPECT_GT(skinPixels(viewport().picture()), 300);
    const auto firstHair = std::find_if(reports_.begin(), reports_.end(), hasHair);
    EXPECT_EQ(firstHair->frames, 1u);
    EXPECT_LT(firstHair->hairs, reports_.back().hairs)
        << "a share of them stands for all while it must be quick";
    // All of it is dropped by a drag, which quick pictures follow; inputs never wait for them.
    const Vec3f eye = viewport().camera().camera().eye_ws;
    const std::size_t before = reports_.size();
    press({300, 300});
    int moves = 0;
    const auto move = [&] {
        QTest::mouseMove(static_cast<QWidget*>(viewport().input()),
                         QPoint(300 + 2 * (moves % 60), 300 + moves % 40));
        ++moves;
    };
    // The thread that draws is busy until this is let go: nothing can wait for a picture.
    std::promise<void> go;
    viewport().renderJobs()->post([gone = go.get_future().share()](PlayedHair*) {
        gone.wait();
        return true;
    });
    const auto turned = [&] {
        move();
        return (viewport().camera().camera().eye_ws - eye).norm() > 0.01f;
    };
    EXPECT_TRUE(QTest::qWaitFor(turned, kPatience)) << "an input waits for a picture";
    go.set_value();
    const auto followed = [&] {
        move();
        return reports_.size() >= before + 5;
    };
    EXPECT_TRUE(QTest::qWaitFor(followed, kPatience));
    release({420, 340});
    EXPECT_GT((viewport().camera().camera().eye_ws - eye).norm(), 0.01f);
    EXPECT_TRUE(reports_.back().moving);
    EXPECT_TRUE(hasHair(reports_.back()));
}

TEST_F(SoftwareWindowTest, AStillThatWasDroppedIsThatOfAnUndisturbedOne) {
    openFewHairs();
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    const QImage undisturbed = viewport().picture();
    EXPECT_EQ(reports_.back().frames, viewport().quality().frames);
    // Marks alone take nothing back, nor draw anything anew.
    const std::size_t before = reports_.size();
    for (int i = 0; i < 4; ++i) {
        viewport().redraw();
        ASSERT_TRUE(viewport().waitForPicture(kPatience));
    }
    EXPECT_EQ(reports_.size(), before);
    EXPECT_EQ(viewport().picture(), undisturbed);
    // There and back, while stills are begun and dropped.
    for (int i = 0; i < 12; ++i) {
        viewport().camera().spin(i % 2 == 0 ? 5.0f : -5.0f);
        viewport().redraw(i < 6);
        QTest::qWait(17 * i);
    }
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    EXPECT_EQ(viewport().picture(), undisturbed);
}

TEST_F(SoftwareWindowTest, MarksAndTubesAreDrawn) {
    openFewHairs();
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    const QImage without = viewport().grab().toImage();
    trigger("overlay.guides");
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    EXPECT_NE(viewport().grab().toImage(), without);
    trigger("overlay.guides");
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    EXPECT_EQ(viewport().grab().toImage(), without);
    Groom tubes = groom();
    tubes.material.tubes = true;
    reports_.clear();
    document().open(std::move(tubes), {}, "tubes");
    ASSERT_TRUE(viewport().waitForPicture(kPatience));
    EXPECT_TRUE(hasHair(reports_.back())) << message().toStdString();
}

}  // namespace
}  // namespace hairloom::editor
