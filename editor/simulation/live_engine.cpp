// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/simulation/live_engine.h"

#include "core/simulation/engine_control.h"
#include "core/simulation/simulation.h"
#include "editor/simulation/live_method.h"

namespace hairloom::editor {
namespace {

class CpuEngine final : public LiveEngine {
  public:
    CpuEngine(Simulation simulation, std::shared_ptr<LiveParameters> parameters)
        : simulation_(std::move(simulation)), parameters_(std::move(parameters)) {}

    Status step(float dt, double, LiveChanges changes, HairPose& pose, Status& refused) override {
        if (changes.settings && parameters_->engine)
            refused = setEngineSettings(*parameters_->engine, *changes.settings);
        if (changes.spheres) parameters_->spheres = std::move(*changes.spheres);
        simulation_.step(dt, pose.head);
        const auto points = simulation_.positions_ws();
        pose.positions_ws.assign(points.begin(), points.end());
        pose.velocities_ws = simulation_.velocities_ws();
        return simulation_.status();
    }
    SimulationStats stats() const override { return simulation_.stats(); }
    std::shared_ptr<const runtime::State> state() override { return simulation_.state(); }

  private:
    Simulation simulation_;
    std::shared_ptr<LiveParameters> parameters_;
};

class DeviceEngine final : public LiveEngine {
  public:
    explicit DeviceEngine(std::shared_ptr<LiveLink> link) : link_(std::move(link)) {}
    ~DeviceEngine() override {
        link_->post([](LiveWork* work) {
            if (work) work->stop();
        });
    }

    Status step(float dt, double time, LiveChanges changes, HairPose& pose, Status&) override {
        LiveStep step{dt,
                      time,
                      pose.head,
                      std::move(changes.settings),
                      std::move(changes.spheres),
                      link_->wantsPositions()};
        underWay_.push_back(link_->post([step = std::move(step)](LiveWork* work) -> Stepped {
            if (!work) return {fail("the device was lost"), {}};
            const Status stepped = work->step(step);
            return {stepped, work->report()};
        }));
        ++frames_;
        // The render thread draws one frame while the next one comes.
        while (underWay_.size() > 1 || isDone(underWay_.front())) {
            Stepped done = underWay_.front().get();
            underWay_.pop_front();
            if (!done.status) return done.status;
            report_ = std::move(done.report);
            if (underWay_.empty()) break;
        }
        pose.onDevice = true;
        pose.positions_ws = report_.frame.positions_ws;
        return {};
    }

    SimulationStats stats() const override {
        SimulationStats stats;
        const DeviceFrame& frame = report_.frame;
        stats.frames = frames_;
        stats.millisecondsPerFrame = report_.milliseconds;
        stats.maxStretch = frame.maxStretch;
        stats.maxPenetrationMm = 1e3 * frame.maxPenetration;
        stats.energy = frame.kineticEnergy;
        stats.nanCount = frame.nanCount;
        stats.restoredStrands = frame.restoredStrands;
        stats.guardedStrands = frame.guardedStrands;
        stats.restingStrands = frame.report.asleep;
        stats.fastestMmPerSecond = 1e3 * static_cast<double>(frame.report.fastest);
        stats.effects = report_.effects;
        return stats;
    }
    double milliseconds() const override { return report_.milliseconds; }

    std::shared_ptr<const runtime::State> state() override {
        auto read = link_->post([](LiveWork* work) -> Result<std::shared_ptr<const runtime::State>> {
            if (!work) return fail("the device was lost");
            return work->readState();
        });
        auto state = read.get();
        return state ? *state : nullptr;
    }

  private:
    struct Stepped {
        Status status;
        LiveReport report;
    };
    static bool isDone(const std::future<Stepped>& done) {
        return done.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    }

    std::shared_ptr<LiveLink> link_;
    std::deque<std::future<Stepped>> underWay_;
    LiveReport report_;
    std::uint64_t frames_ = 0;
};

}  // namespace

Result<std::unique_ptr<LiveEngine>> makeCpuEngine(const LiveStart& start, double time,
                                                  const PlayedMethod& played) {
    const auto parameters = std::make_shared<LiveParameters>();
    SimulationOptions options;
    options.method = played.method;
    if (played.hairHair) options.hairHair.emplace();
    if (played.method == SimulationMethod::strands) options.backend = liveMethod(parameters);
    auto made = Simulation::make(*start.groom, start.pose, options);
    if (!made) return tl::unexpected(made.error());
    if (start.state && played.method == SimulationMethod::strands && !made->setState(*start.state, time))
        return fail("the number of strands has changed");
    return std::make_unique<CpuEngine>(std::move(*made), parameters);
}

Result<std::unique_ptr<LiveEngine>> makeDeviceEngine(std::shared_ptr<LiveLink> link, const LiveStart& start) {
    auto made = link->post([start](LiveWork* work) {
        return work ? work->start(start) : Status(fail("there is no graphics device"));
    });
    if (auto status = made.get(); !status) return tl::unexpected(status.error());
    return std::make_unique<DeviceEngine>(std::move(link));
}

}  // namespace hairloom::editor
