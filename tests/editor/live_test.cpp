// SPDX-License-Identifier: GPL-3.0-or-later
// Hair that plays in the window, on either engine.
#include <QCheckBox>
#include <QComboBox>
#include <QDir>
#include <QLabel>
#include <algorithm>
#include <array>

#include "core/gpu/validation.h"
#include "editor/simulation/player.h"
#include "tests/documents/small_head.h"
#include "tests/editor/resident_memory.h"
#include "tests/editor/window_fixture.h"

namespace hairloom::editor {
namespace {

class LiveTest : public WindowTest {
  protected:
    LiveTest() : WindowTest(true) {}
    void SetUp() override {
        WindowTest::SetUp();
        window->resize(640, 420);
        drawQuickly();
        Groom small = smallHead();
        small.simulation.windSpeed = 4;
        document().open(small, {}, "small");
    }
    void simulateOn(SimulateOn where) { parts().preferences.setSimulateOn(where); }
    double now() { return parts().player.frame() ? parts().player.frame()->time : 0; }
    EngineKind engine() { return parts().player.engine()->kind; }
};

TEST_F(LiveTest, EnginesChangeWhileItPlays) {
    // It looks at two frames at once.
    window->actions().get("overlay.effectCost").setChecked(true);
    int unlike = 0;
    QObject::connect(&parts().player, &Player::frameReady, window.get(), [&] {
        const auto& frame = parts().player.frame();
        if (frame && frame->before)
            unlike += frame->before->positions_ws.size() != frame->pose->positions_ws.size();
    });
    ASSERT_TRUE(parts().player.setMotion("nod"));
    trigger("play.toggle");
    ASSERT_TRUE(played(0.1));
    EXPECT_EQ(engine(), EngineKind::cpu);
    // What tests draw with is a software device as a rule.
    EXPECT_FALSE(parts().player.engine()->why.empty());
    EXPECT_FALSE(parts().player.frame()->pose->onDevice);
    for (const auto& [where, kind] : {std::pair{SimulateOn::Gpu, EngineKind::gpu},
                                      {SimulateOn::Cpu, EngineKind::cpu},
                                      {SimulateOn::Gpu, EngineKind::gpu}}) {
        const double before = now();
        simulateOn(where);
        ASSERT_TRUE(played(before + 0.3)) << "it goes on from where it was";
        EXPECT_EQ(engine(), kind) << parts().player.engine()->why;
        EXPECT_EQ(parts().player.frame()->pose->onDevice, kind == EngineKind::gpu);
        auto* label = window->findChild<QLabel*>("engine");
        ASSERT_TRUE(label);
        EXPECT_EQ(label->text(), kind == EngineKind::gpu ? "hair on the GPU" : "hair on the CPU");
        QDir().mkpath(HAIRLOOM_SCREENSHOTS);
        if (kind == EngineKind::gpu) {
            EXPECT_TRUE(onScreen().save(HAIRLOOM_SCREENSHOTS "/live-gpu.png"));
        }
    }
    EXPECT_GT(parts().player.frame()->stats.fastestMmPerSecond, 10) << "told of a frame or two ago";
    EXPECT_EQ(parts().player.frame()->stats.nanCount, 0u);
    EXPECT_FALSE(parts().player.effects().empty());
    EXPECT_EQ(unlike, 0);
    trigger("play.reset");
    EXPECT_FALSE(viewport().pose());
}

TEST_F(LiveTest, OtherMethodsMoveTheHairAndSayWhatTheyCost) {
    ASSERT_TRUE(parts().player.setMotion("nod"));
    trigger("play.toggle");
    ASSERT_TRUE(played(0.1));
    auto* method = window->findChild<QComboBox*>("play-method");
    ASSERT_TRUE(method);
    const auto costs = [&](const std::string& effect) {
        return QTest::qWaitFor(
            [&] {
                const auto effects = parts().player.effects();
                const auto row = std::ranges::find(effects, effect, &EffectReport::name);
                return row != effects.end() && row->on && row->milliseconds > 0;
            },
            kPatience);
    };
    const auto goesOn = [&] {
        if (!played(now() + 0.2)) return false;
        const auto frame = parts().player.frame();
        return frame->stats.nanCount == 0 && frame->before &&
               !std::ranges::equal(frame->pose->positions_ws, frame->before->positions_ws);
    };
    method->setCurrentIndex(1);
    EXPECT_TRUE(costs("projective equations"));
    EXPECT_TRUE(goesOn());
    // Settings, spheres and strokes arrive there, too.
    Groom windy = document().groom();
    windy.simulation.windSpeed = 12;
    document().perform(editing::setPhysics(document().editing().model(), windy.simulation, "wind"));
    EXPECT_TRUE(goesOn());
    method->setCurrentIndex(2);
    EXPECT_TRUE(costs("rigid chains"));
    EXPECT_TRUE(goesOn());
    method->setCurrentIndex(3);
    EXPECT_TRUE(costs("lattice"));
    simulateOn(SimulateOn::Gpu);
    ASSERT_TRUE(played(now() + 0.2));
    EXPECT_EQ(engine(), EngineKind::cpu) << "lattices are of the CPU";
    method->setCurrentIndex(4);
    EXPECT_TRUE(costs("particles"));
    EXPECT_TRUE(goesOn());
    method->setCurrentIndex(5);
    EXPECT_TRUE(costs("hybrid"));
    EXPECT_TRUE(goesOn());
    method->setCurrentIndex(0);
    ASSERT_TRUE(played(now() + 0.3));
    EXPECT_EQ(engine(), EngineKind::gpu);
    simulateOn(SimulateOn::Cpu);
    trigger("play.reset");
}

TEST_F(LiveTest, EditsArriveWhileItPlays) {
    for (const SimulateOn where : {SimulateOn::Gpu, SimulateOn::Cpu}) {
        simulateOn(where);
        trigger("play.toggle");
        ASSERT_TRUE(played(0.1));
        double before = now();
        trigger("tool.comb");
        EXPECT_TRUE(parts().player.isPlaying()) << "a brush may be taken up";
        const std::uint64_t authored = hash();
        const QPoint middle(viewport().width() / 2, viewport().height() / 2);
        drag({middle, middle + QPoint(20, 5), middle + QPoint(60, 20)});
        EXPECT_NE(hash(), authored);
        ASSERT_TRUE(played(before + 0.2)) << "it goes on from where it was";
        before = now();
        document().undo();
        EXPECT_EQ(hash(), authored);
        ASSERT_TRUE(played(before + 0.2));
        before = now();
        Groom calm = groom();
        calm.simulation.windSpeed = 0;
        calm.spheres.clear();
        change("Calm", calm);
        ASSERT_TRUE(played(before + 0.2));
        EXPECT_TRUE(parts().player.isPlaying());
        trigger("play.reset");
        document().undo();
    }
}

/// Projective equations turn to what is brushed, so that no frame jumps back to the authored shape.
TEST_F(LiveTest, ABrushStylesHairThatMovesByProjectiveEquations) {
    ASSERT_TRUE(parts().player.setMotion("spin"));
    trigger("play.toggle");
    auto* method = window->findChild<QComboBox*>("play-method");
    ASSERT_TRUE(method);
    method->setCurrentIndex(1);
    ASSERT_TRUE(played(1.0));
    const std::size_t frames = parts().player.frame()->stats.frames;
    ASSERT_GT(frames, 2u);
    trigger("tool.comb");
    const std::uint64_t authored = hash();
    const QPoint middle(viewport().width() / 2, viewport().height() / 2);
    drag({middle, middle + QPoint(20, 5), middle + QPoint(60, 20)});
    ASSERT_NE(hash(), authored);
    ASSERT_TRUE(played(now() + 0.3));
    EXPECT_GT(parts().player.frame()->stats.frames, frames) << "the same simulation goes on";
    EXPECT_EQ(parts().player.frame()->stats.nanCount, 0u);
    trigger("play.reset");
}

TEST_F(LiveTest, WhatChangedWhileItPlaysStaysOnTheOtherDevice) {
    simulateOn(SimulateOn::Cpu);
    trigger("play.toggle");
    ASSERT_TRUE(played(0.1));
    const auto windIsOn = [&] {
        const auto effects = parts().player.effects();
        const auto row = std::ranges::find(effects, "wind", &EffectReport::name);
        return row != effects.end() && row->on;
    };
    EXPECT_TRUE(windIsOn());
    std::uint64_t drawn = 0;
    QObject::connect(&viewport(), &Viewport::drawn, window.get(),
                     [&drawn](const PictureReport& report) { drawn = report.hairs; });
    runtime::SimulationSettings calm = groom().simulation;
    calm.windSpeed = 0;
    document().perform(editing::setPhysics(document().editing().model(), calm, "Calm"));
    ASSERT_TRUE(played(now() + 0.1));
    EXPECT_FALSE(windIsOn());
    for (const auto& [where, kind] :
         {std::pair{SimulateOn::Gpu, EngineKind::gpu}, {SimulateOn::Cpu, EngineKind::cpu}}) {
        simulateOn(where);
        ASSERT_TRUE(played(now() + 0.2));
        EXPECT_EQ(engine(), kind);
        EXPECT_FALSE(windIsOn());
        // As many follow hairs as the document asks for go on with it, too.
        InterpolationSettings more = groom().interpolation;
        ++more.followPerGuide;
        const double before = now();
        document().perform(editing::setInterpolation(document().editing().model(), more, "Follow hairs"));
        ASSERT_TRUE(played(before + 0.2)) << "it goes on from where it was";
        EXPECT_EQ(engine(), kind);
        // Of hair that the CPU moves a software device draws the guides while it plays.
        std::uint64_t all = groom().strandCount();
        if (kind == EngineKind::gpu) all *= more.followPerGuide;
        ASSERT_TRUE(QTest::qWaitFor([&] { return drawn == all; }, kPatience)) << drawn << " of " << all;
    }
    trigger("play.reset");
}

TEST(RenderJobsTest, JobsThatFollowEachOtherLeaveTimeForPictures) {
    RenderJobs jobs([] {});
    int done = 0;
    std::function<void(PlayedHair*)> another = [&](PlayedHair* played) {
        if (++done < 100 && played == nullptr) jobs.post(another);
    };
    jobs.post(another);
    jobs.post(another);
    jobs.run(nullptr);
    EXPECT_EQ(done, 2);
    EXPECT_TRUE(jobs.hasJobs());
    jobs.run(nullptr);
    EXPECT_EQ(done, 4);
    jobs.close();
    EXPECT_GT(done, 100) << "nobody waits for ever";
}

TEST_F(LiveTest, ADeviceThatIsLostLeavesTheCpu) {
    gpu::DeviceOptions options;
    options.validation = true;
    auto device = gpu::createDevice(options);
    ASSERT_TRUE(device) << device.error().message();
    PlayedHair played(**device);
    const auto jobs = std::make_shared<RenderJobs>([] {});
    QTimer timer;
    QObject::connect(&timer, &QTimer::timeout, [&] { jobs->run(&played); });
    timer.start(1);
    {
        Player player(document());
        QString problem;
        QObject::connect(&player, &Player::failed, window.get(),
                         [&](const QString& said) { problem = said; });
        player.setRenderJobs(jobs);
        player.setEngine(EngineWish::gpu);
        player.play();
        const auto plays = [&](double seconds) {
            return QTest::qWaitFor([&] { return player.frame() && player.frame()->time > seconds; },
                                   kPatience);
        };
        ASSERT_TRUE(plays(0.1));
        EXPECT_EQ(player.engine()->kind, EngineKind::gpu);
        gpu::validationOf(**device)->loseDevice(2);
        const double before = player.frame()->time;
        ASSERT_TRUE(plays(before + 0.3));
        EXPECT_TRUE(problem.contains("The CPU continues")) << problem.toStdString();
        EXPECT_EQ(player.engine()->kind, EngineKind::cpu);
        EXPECT_FALSE(player.engine()->why.empty());
        EXPECT_TRUE(player.isPlaying());
        EXPECT_EQ(player.frame()->stats.nanCount, 0u);
        jobs->close();
    }
}

TEST_F(LiveTest, MemoryStaysFlat) {
    if (residentMegabytes() == 0) GTEST_SKIP() << "the system does not tell";
    int pictures = 0;
    QObject::connect(&viewport(), &Viewport::drawn, window.get(), [&pictures] { ++pictures; });
    for (const SimulateOn where : {SimulateOn::Cpu, SimulateOn::Gpu}) {
        simulateOn(where);
        ASSERT_TRUE(parts().player.setMotion("nod"));
        trigger("play.toggle");
        // Both count, as slow as a loaded machine with a software device may be.
        const auto goesOn = [&](int count, double seconds) {
            pictures = 0;
            const double begin = now();
            return QTest::qWaitFor([&] { return pictures >= count && now() > begin + seconds; }, kPatience);
        };
        // Shaders of what is new are compiled at first.
        ASSERT_TRUE(goesOn(30, 0.5));
        // What leaks grows in each hundred frames of the hair; what a driver's threads take on the way does
        // not.
        std::array<double, 3> grown_MB{};
        for (double& grown : grown_MB) {
            const double before = residentMegabytes();
            ASSERT_TRUE(goesOn(30, 100.0 / 60));
            grown = residentMegabytes() - before;
        }
        EXPECT_LT(*std::ranges::min_element(grown_MB), 3);
        trigger("play.reset");
    }
}

}  // namespace
}  // namespace hairloom::editor
