// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <chrono>

#include "core/base/parallel.h"
#include "core/simulation/effect_switch.h"
#include "core/simulation/strand_method.h"

namespace hairloom {
namespace {

using runtime::Effect;
using runtime::StageId;

/// False where the solver takes no velocities.
template <class Solver>
bool push(Solver& solver, runtime::HairVolume& volume, float dt) {
    if constexpr (TakesVelocities<Solver>) {
        pushHairApart(solver, volume, dt);
        return true;
    }
    return false;
}

class EngineMethod : public StrandMethod {
  public:
    EngineMethod(runtime::Engine engine, std::optional<runtime::HairVolume> volume)
        : engine_(std::move(engine)), volume_(std::move(volume)), host_(applicationHost()) {}

    void reset(const SceneInput& scene, const HeadPose& pose) override { engine_.reset(scene.rootsAt(pose)); }

    void step(const SceneInput&, const HeadPose&, const runtime::FrameInput& input) override {
        engine_.step(input);
        const runtime::StepReport& report = engine_.lastStep();
        milliseconds_ = report.milliseconds;
        ++frames_;
        for (std::uint32_t stage = 0; stage < runtime::kStageCount; ++stage) {
            const auto effect = runtime::stageEffect(static_cast<StageId>(stage));
            (effect ? effectMilliseconds_[static_cast<std::size_t>(*effect)] : solveMilliseconds_) +=
                report.stageMilliseconds[stage];
        }
        if (!volume_) return;
        const std::uint64_t begin = host_.nanoseconds();
        push(engine_, *volume_, input.dt);
        const double spent = 1e-6 * static_cast<double>(host_.nanoseconds() - begin);
        milliseconds_ += spent;
        volumeMilliseconds_ += spent;
    }

    Status setSettings(const runtime::SimulationSettings& settings) override {
        if (const std::string problem = engine_.setSettings(settings); !problem.empty()) return fail(problem);
        return {};
    }

    void readPositions(std::span<runtime::Float3> positions_ws) const override {
        engine_.readPositions(positions_ws);
    }
    bool readVelocities(std::span<runtime::Float3> velocities_ws) const override {
        return engine_.readVelocities(velocities_ws);
    }
    std::shared_ptr<const runtime::State> state() const override { return engine_.state(); }
    bool setState(const runtime::State& state) override { return engine_.setState(state); }
    bool measuresFromOrigin() const override { return true; }
    double stepMilliseconds() const override { return milliseconds_; }
    std::optional<std::uint32_t> substeps() const override { return engine_.lastStep().substeps; }
    std::uint32_t restoredStrands() const override { return engine_.lastStep().restoredStrands; }
    std::uint32_t guardedStrands() const override { return engine_.lastStep().guardedStrands; }
    runtime::Measurements measure() const override { return engine_.measure(); }
    std::uint64_t stateHash() const override { return engine_.stateHash(); }

    std::vector<EffectReport> effects() const override {
        const double frames = static_cast<double>(std::max<std::uint64_t>(frames_, 1));
        std::vector<EffectReport> effects;
        for (std::uint32_t index = 0; index < runtime::kEffectCount; ++index) {
            const auto effect = static_cast<Effect>(index);
            const bool on = engine_.plan().on(effect);
            std::optional<double> milliseconds = effectMilliseconds_[index] / frames;
            if (on && *milliseconds == 0) milliseconds.reset();
            effects.push_back({runtime::effectName(effect), on, reasonAlone(engine_.plan().why(effect)),
                               milliseconds, engine_.effectBytes(effect)});
        }
        effects.push_back({"solve", true,
                           "on, the shared strand solve, without the effects listed separately",
                           solveMilliseconds_ / frames, 0});
        if (const std::size_t bytes = engine_.bodyBytes(); bytes > 0)
            effects.push_back({std::string(kBodyEffect), true, "on, the skin of the head", {}, bytes});
        if (volume_) {
            effects.push_back(
                {"hair-hair", true, "on, asked for", volumeMilliseconds_ / frames, volume_->bytes()});
        }
        return effects;
    }

  private:
    runtime::Engine engine_;
    std::optional<runtime::HairVolume> volume_;
    runtime::Host host_;
    std::uint64_t frames_ = 0;
    double milliseconds_ = 0, volumeMilliseconds_ = 0, solveMilliseconds_ = 0;
    std::array<double, runtime::kEffectCount> effectMilliseconds_{};
};

}  // namespace

std::string reasonAlone(const std::string& why) {
    const std::size_t colon = why.find(": ");
    return colon == std::string::npos ? why : why.substr(colon + 2);
}

runtime::Host applicationHost() {
    runtime::Host host;
    host.parallelFor = parallelFor;
    host.nanoseconds = [] {
        const auto now = std::chrono::steady_clock::now().time_since_epoch();
        return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
    };
    return host;
}

Result<std::unique_ptr<StrandMethod>> makeEngineMethod(
    const SceneInput& scene, const std::optional<runtime::HairVolumeSettings>& hairVolume) {
    auto made = runtime::Engine::make(scene.strands(), scene.groom().simulation, applicationHost());
    if (!made.engine) return fail(made.error);
    std::optional<runtime::HairVolume> volume;
    if (hairVolume) {
        if (!TakesVelocities<runtime::Engine>) {
            return fail(
                "the strand engine does not take external velocities, which hair-hair collision needs",
                "expected a run without it");
        }
        auto grid = runtime::HairVolume::make(*hairVolume, applicationHost());
        if (!grid.volume) return fail(grid.error);
        volume.emplace(std::move(*grid.volume));
    }
    const auto& body = scene.groom().body;
    if (body) {
        if (const std::string problem = made.engine->setBody(body); !problem.empty()) return fail(problem);
    }
    return std::make_unique<EngineMethod>(std::move(*made.engine), std::move(volume));
}

}  // namespace hairloom
