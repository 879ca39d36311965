// SPDX-License-Identifier: GPL-3.0-or-later
// The window on a computer without a GPU: no driver, or none but one that runs on the processor.
#include <QLabel>
#include <algorithm>
#include <cmath>

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
        QObject::connect(&viewport(), &Viewport::drawn, window.get(), [this](const PictureReport& report) {
            reports_.push_back(report);
            at_.push_back(clock_.elapsed());
            cpu_.push_back(static_cast<double>(clock()) / CLOCKS_PER_SEC);
        });
        clock_.start();
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
    bool drawnWithin(int milliseconds, const std::function<bool(const PictureReport&)>& wanted) {
        const std::size_t from = reports_.size();
        return QTest::qWaitFor(
            [&] {
                return std::any_of(reports_.begin() + static_cast<std::ptrdiff_t>(from), reports_.end(),
                                   wanted);
            },
            milliseconds);
    }
    static bool hasHair(const PictureReport& report) { return report.hairs > 0; }
    static bool isStill(const PictureReport& report) { return report.hairs > 0 && report.frames > 1; }

    std::vector<PictureReport> reports_;
    std::vector<qint64> at_;
    std::vector<double> cpu_;
    QElapsedTimer clock_;

  private:
    std::vector<std::pair<const char*, QByteArray>> variables_{{"VK_DRIVER_FILES", {}},
                                                               {"VK_ICD_FILENAMES", {}}};
    QByteArray renderer_ = qgetenv("HAIRLOOM_RENDERER"), surface_ = qgetenv("HAIRLOOM_VIEWPORT");
};

TEST_F(SoftwareWindowTest, SaysSoAndShowsHairAtOnce) {
    ASSERT_TRUE(QTest::qWaitFor(
        [this] { return window->statusLine().message().contains("software renderer"); }, 20'000))
        << window->statusLine().message().toStdString();
    openSampleHair("short");
    clock_.restart();
    viewport().redraw();
    ASSERT_TRUE(drawnWithin(60'000, hasHair));
    ASSERT_FALSE(viewport().presents());
    EXPECT_GT(skinPixels(viewport().picture()), 300);
    ASSERT_TRUE(drawnWithin(60'000, isStill));
    for (std::size_t i = 0; i < reports_.size(); ++i)
        printf("%lld ms: cpu %.3f: %.1f ms, %llu hairs, %u frames\n", static_cast<long long>(at_[i]), i ? cpu_[i] - cpu_[i-1] : cpu_[i],
               reports_[i].milliseconds, static_cast<unsigned long long>(reports_[i].hairs),
               reports_[i].frames);
    QDir().mkpath(HAIRLOOM_SCREENSHOTS);
    EXPECT_TRUE(onScreen().save(HAIRLOOM_SCREENSHOTS "/software.png"));
    const std::size_t still = reports_.size();
    press({300, 300}, {}, Qt::MiddleButton);
    clock_.restart();
    std::vector<double> answers;
    for (int i = 0; i < 60; ++i) {
        QElapsedTimer answer;
        answer.start();
        QTest::mouseMove(static_cast<QWidget*>(viewport().input()), QPoint(300 + 4 * i, 300 + i));
        QCoreApplication::processEvents();
        answers.push_back(static_cast<double>(answer.nsecsElapsed()) * 1e-6);
        QTest::qWait(40);
    }
    release({540, 360}, {}, Qt::MiddleButton);
    const double seconds = static_cast<double>(clock_.elapsed()) * 1e-3;
    const std::size_t moving = reports_.size() - still;
    printf("%.1f frames/s, slowest answer %.1f ms\n", static_cast<double>(moving) / seconds,
           *std::max_element(answers.begin(), answers.end()));
    for (std::size_t i = still; i < reports_.size(); ++i)
        printf("cpu %.3f: %.1f ms, %llu hairs, %u frames\n", cpu_[i] - cpu_[i-1], reports_[i].milliseconds,
               static_cast<unsigned long long>(reports_[i].hairs), reports_[i].frames);
    viewport().picture().save(HAIRLOOM_SCREENSHOTS "/software-moving.png");
    ASSERT_TRUE(viewport().waitForPicture(120'000));
    viewport().picture().save(HAIRLOOM_SCREENSHOTS "/software-still.png");
}

}  // namespace
}  // namespace hairloom::editor
