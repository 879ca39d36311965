// SPDX-License-Identifier: GPL-3.0-or-later
// How long a person waits: printed, not judged, for a machine that does other things as well is no clock.
// Wall time, and the time of all processors that it took.
#include <QPushButton>
#include <ctime>
#include <filesystem>
#include <iostream>

#include "core/editing/document.h"
#include "core/editing/place.h"
#include "editor/tools/brush_tool.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class Stopwatch {
  public:
    Stopwatch() { wall_.start(); }
    void say(const std::string& what, int times = 1) const {
        const double processor = 1e3 * static_cast<double>(std::clock() - processor_) / CLOCKS_PER_SEC;
        const double wall = static_cast<double>(wall_.nsecsElapsed()) * 1e-6;
        std::cout << "[ SPEED    ] " << what << ": " << wall / times << " ms of wall clock, "
                  << processor / times << " ms of processors" << std::endl;
    }

  private:
    QElapsedTimer wall_;
    std::clock_t processor_ = std::clock();
};

class SpeedTest : public WindowTest {};

TEST_F(SpeedTest, AWindowStands) {
    TearDown();
    qputenv("HAIRLOOM_VIEWPORT", "none");
    const Stopwatch clock;
    open();
    clock.say("start of the window");
    EXPECT_TRUE(window->isVisible());
}

TEST_F(SpeedTest, TheSintelSetOpens) {
    const std::filesystem::path data = std::filesystem::path(HAIRLOOM_SOURCE_DIR) / "../shared/data";
    const auto head = data / "heads/sintel.obj", hair = data / "strands/sintel_16pt.tfx";
    if (!std::filesystem::exists(head) || !std::filesystem::exists(hair)) {
        GTEST_SKIP() << "no data beside this checkout";
    }
    const Stopwatch clock;
    window->open(QString::fromStdString(head.string()));
    finishWork();
    clock.say("the head");
    ASSERT_TRUE(groom().scalp);
    importStrandsInto(session(), QString::fromStdString(hair.string()), {});
    finishWork();
    clock.say("head and strands");
    EXPECT_EQ(groom().strandCount(), 11'400u);
    expectSound();
}

TEST_F(SpeedTest, DabsOnAHundredThousandStrands) {
    openSampleHair("short");
    Groom settings = groom();
    settings.placement.count = 100'000;
    settings.placement.darts = false;
    settings.placement.points = 16;
    settings.placement.length = 0.12f;
    document().change("Placement", Change::Placement, settings);
    find<QPushButton>("place")->click();
    finishWork();
    ASSERT_EQ(groom().strandCount(), 100'000u) << window->statusLine().message().toStdString();
    viewport().look(render::View::Front);
    viewport().frameAll();
    const Box3f box = groom().scalp->bounds();
    const QPoint from = at(Vec3f(-0.04f, box.max().y() + 0.02f, 0.06f));
    for (const char* name :
         {"comb", "brush", "grab", "smooth", "puff", "pinch", "length", "cut", "freeze", "delete"}) {
        trigger((std::string("tool.") + name).c_str());
        auto& tool = dynamic_cast<BrushTool&>(*session().tools.find(name));
        tool.settings().radius = 0.02f;
        constexpr int kMoves = 20;
        editing::Document& editing = document().editing();
        press(from);
        ASSERT_TRUE(editing.stroke()) << name;
        const Stopwatch clock;
        for (int i = 1; i <= kMoves; ++i) {
            const QPoint to = from + QPoint(4 * i, i);
            tool.drag({to, Qt::NoButton, {}, 1});
        }
        const auto dabs = static_cast<int>(editing.stroke()->stroke().dabs.size());
        clock.say(std::string("a dab of ") + name + " (" + std::to_string(dabs) + " dabs)",
                  std::max(1, dabs));
        release(from);
        const Stopwatch undoing;
        document().undo();
        undoing.say(std::string("undo of the stroke of ") + name);
    }
}

}  // namespace
}  // namespace hairloom::editor
