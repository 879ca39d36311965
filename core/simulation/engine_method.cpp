// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>

#include "core/base/parallel.h"
#include "core/groom/poses.h"
#include "core/simulation/effect_switch.h"
#include "core/simulation/strand_method.h"
#include "hairloom/alternatives/hair_flow.h"
#include "hairloom/alternatives/hair_particles.h"

namespace hairloom {
namespace {

using runtime::Effect;
using runtime::StageId;

/// Hair-hair collision between the frames of the engine.
struct Between {
    std::string name, why;
    std::function<void(runtime::Engine& engine, float dt)> push;
    std::function<std::size_t()> bytes;
    bool keepsSettings = false;  ///< it was made for those of the start
};

/// `Medium`: HairVolume, HairParticles, HairFlow.
template <class Medium>
Between between(std::string name, std::string why, Medium made) {
    auto medium = std::make_shared<Medium>(std::move(made));
    // Without velocities from outside, makeEngineMethod() refuses.
    return {std::move(name), std::move(why),
            [medium](runtime::Engine& engine, float dt) {
                if constexpr (TakesVelocities<runtime::Engine>) pushHairApart(engine, *medium, dt);
            },
            [medium] { return medium->bytes(); }};
}

class EngineMethod : public StrandMethod {
  public:
    EngineMethod(runtime::Engine engine, std::optional<Between> between)
        : engine_(std::move(engine)), between_(std::move(between)), host_(applicationHost()) {}

    void reset(const SceneInput& scene, const HeadPose& pose) override { engine_.reset(scene.rootsAt(pose)); }

    void step(const SceneInput& scene, const HeadPose&, const runtime::FrameInput& input) override {
        engine_.setSkinSpheres(scene.skinSpheres());
        engine_.step(input);
        const runtime::StepReport& report = engine_.lastStep();
        milliseconds_ = report.milliseconds;
        ++frames_;
        for (std::uint32_t stage = 0; stage < runtime::kStageCount; ++stage) {
            const auto effect = runtime::stageEffect(static_cast<StageId>(stage));
            (effect ? effectMilliseconds_[static_cast<std::size_t>(*effect)] : solveMilliseconds_) +=
                report.stageMilliseconds[stage];
        }
        if (!between_) return;
        const std::uint64_t begin = host_.nanoseconds();
        between_->push(engine_, input.dt);
        const double spent = 1e-6 * static_cast<double>(host_.nanoseconds() - begin);
        milliseconds_ += spent;
        betweenMilliseconds_ += spent;
    }

    Status setSettings(const runtime::SimulationSettings& settings) override {
        if (between_ && between_->keepsSettings) return StrandMethod::setSettings(settings);
        if (const std::string problem = engine_.setSettings(settings); !problem.empty())
            return tl::unexpected(errorOfWords(problem));
        return {};
    }

    Status setPoseAmounts(std::span<const float> amounts) override {
        if (engine_.setPoseAmounts(amounts)) return {};
        return fail(fmt::format("there are {} amounts", amounts.size()),
                    fmt::format("expected one for each pose, {}", engine_.poseAmounts().size()));
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
        if (between_) {
            effects.push_back(
                {between_->name, true, between_->why, betweenMilliseconds_ / frames, between_->bytes()});
        }
        return effects;
    }

  private:
    runtime::Engine engine_;
    std::optional<Between> between_;
    runtime::Host host_;
    std::uint64_t frames_ = 0;
    double milliseconds_ = 0, betweenMilliseconds_ = 0, solveMilliseconds_ = 0;
    std::array<double, runtime::kEffectCount> effectMilliseconds_{};
};

/// With their authored amounts.
Status givePoses(const Groom& groom, runtime::Engine& engine) {
    const PoseViews poses = poseViews(groom);
    if (const std::string problem = engine.setPoses(poses.views); !problem.empty())
        return tl::unexpected(errorOfWords(problem));
    engine.setPoseAmounts(poseAmounts(groom));
    return {};
}

Result<std::unique_ptr<StrandMethod>> makeMethod(const SceneInput& scene,
                                                 const runtime::SimulationSettings& settings,
                                                 std::optional<Between> between) {
    if (between && !TakesVelocities<runtime::Engine>) {
        return fail("the strand engine does not take external velocities, which hair-hair collision needs",
                    "expected a run without it");
    }
    auto made = runtime::Engine::make(scene.strands(), settings, applicationHost());
    if (!made.engine) return tl::unexpected(errorOfWords(made.error));
    const auto& body = scene.groom().body;
    if (body) {
        if (const std::string problem = made.engine->setBody(body); !problem.empty())
            return tl::unexpected(errorOfWords(problem));
    }
    if (auto given = givePoses(scene.groom(), *made.engine); !given) return tl::unexpected(given.error());
    return std::make_unique<EngineMethod>(std::move(*made.engine), std::move(between));
}

/// A continuum in place of the engine's own hair-hair collision.
Result<std::unique_ptr<StrandMethod>> makeContinuum(const SceneInput& scene, Between between) {
    runtime::SimulationSettings settings = scene.groom().simulation;
    settings.hairHair = false;
    between.keepsSettings = true;
    return makeMethod(scene, settings, std::move(between));
}

/// Of `simulation.hairHairStrength`: m²/s² of particles, and 1/s of the grid's spreading, at 1.
constexpr float kStiffest = 2.0f, kFastestSpreading = 4.0f;

}  // namespace

Status StrandMethod::setPoseAmounts(std::span<const float> amounts) {
    if (std::ranges::none_of(amounts, [](float amount) { return amount > 0; })) return {};
    return fail("this method follows no pose", "expected the strand engine, or amounts of 0");
}

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
    std::optional<Between> volume;
    if (hairVolume) {
        auto grid = runtime::HairVolume::make(*hairVolume, applicationHost());
        if (!grid.volume) return tl::unexpected(errorOfWords(grid.error));
        volume = between("hair-hair", "on, asked for", std::move(*grid.volume));
    }
    return makeMethod(scene, scene.groom().simulation, std::move(volume));
}

Result<std::unique_ptr<StrandMethod>> makeParticleMethod(const SceneInput& scene) {
    const runtime::SimulationSettings& settings = scene.groom().simulation;
    runtime::HairParticleSettings wanted;
    wanted.radius = settings.hairHairCell;
    wanted.stiffness = settings.hairHairStrength * kStiffest;
    wanted.friction = settings.hairHairCohesion;
    auto made = runtime::HairParticles::make(scene.strands(), wanted, applicationHost());
    if (!made.particles) return tl::unexpected(errorOfWords(made.error));
    const std::string why = fmt::format("on, a reach of {:.1f} mm", made.particles->radius() * 1e3f);
    return makeContinuum(scene, between("particles", why, std::move(*made.particles)));
}

Result<std::unique_ptr<StrandMethod>> makeHybridMethod(const SceneInput& scene) {
    const runtime::SimulationSettings& settings = scene.groom().simulation;
    runtime::HairFlowSettings wanted;
    wanted.cellSize = settings.hairHairCell;
    wanted.spreading = settings.hairHairStrength * kFastestSpreading;
    wanted.friction = settings.hairHairCohesion;
    auto made = runtime::HairFlow::make(scene.strands(), wanted, applicationHost());
    if (!made.flow) return tl::unexpected(errorOfWords(made.error));
    return makeContinuum(scene, between("hybrid", "on, a grid between the frames", std::move(*made.flow)));
}

}  // namespace hairloom
