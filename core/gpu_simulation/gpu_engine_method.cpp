// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu_simulation/gpu_engine_method.h"

#include "core/gpu_simulation/strand_engine.h"
#include "core/groom/poses.h"
#include "core/simulation/effect_switch.h"
#include "core/simulation/strand_method.h"

namespace hairloom::gpu_simulation {
namespace {

class GpuEngineMethod final : public StrandMethod {
  public:
    explicit GpuEngineMethod(StrandEngine engine) : engine_(std::move(engine)), host_(applicationHost()) {}

    void reset(const SceneInput& scene, const HeadPose& pose) override {
        keep(engine_.reset(scene.rootsAt(pose)));
    }

    void step(const SceneInput& scene, const HeadPose&, const runtime::FrameInput& input) override {
        engine_.setSkinSpheres(scene.skinSpheres());
        const std::uint64_t begin = host_.nanoseconds();
        keep(engine_.step(input));
        const auto report = engine_.report();
        milliseconds_ = 1e-6 * static_cast<double>(host_.nanoseconds() - begin);
        if (report) {
            restored_ = report->restoredStrands;
            guarded_ = report->guardedStrands;
            // Kernels are made once, not every frame.
            milliseconds_ -= report->kernelMilliseconds;
        } else {
            keep(tl::unexpected(report.error()));
        }
    }

    Status setPoseAmounts(std::span<const float> amounts) override { return engine_.setPoseAmounts(amounts); }

    void readPositions(std::span<runtime::Float3> positions_ws) const override {
        keep(engine_.readPositions(positions_ws));
    }
    bool readVelocities(std::span<runtime::Float3> velocities_ws) const override {
        const Status read = engine_.readVelocities(velocities_ws);
        keep(read);
        return read.has_value();
    }
    bool measuresFromOrigin() const override { return true; }
    double stepMilliseconds() const override { return milliseconds_; }
    std::uint32_t restoredStrands() const override { return restored_; }
    std::uint32_t guardedStrands() const override { return guarded_; }
    Status status() const override { return status_; }

    runtime::Measurements measure() const override {
        const auto measured = engine_.measure();
        if (measured) return *measured;
        keep(tl::unexpected(measured.error()));
        return {};
    }
    std::uint64_t stateHash() const override {
        const auto hash = engine_.stateHash();
        if (hash) return *hash;
        keep(tl::unexpected(hash.error()));
        return 0;
    }
    std::vector<EffectReport> effects() const override { return effectReports(engine_); }

  private:
    /// The first error stays.
    void keep(Status status) const {
        if (status_ && !status) status_ = std::move(status);
    }

    // Reading back is work of the device, not a change of what is seen here.
    mutable StrandEngine engine_;
    mutable Status status_;
    runtime::Host host_;
    double milliseconds_ = 0.0;
    std::uint32_t restored_ = 0;
    std::uint32_t guarded_ = 0;
};

}  // namespace

std::vector<EffectReport> effectReports(const StrandEngine& engine) {
    std::vector<EffectReport> effects;
    for (std::uint32_t index = 0; index < runtime::kEffectCount; ++index) {
        const auto effect = static_cast<runtime::Effect>(index);
        const bool on = engine.plan().on(effect);
        effects.push_back({runtime::effectName(effect), on, reasonAlone(engine.plan().why(effect)),
                           on ? std::nullopt : std::optional(0.0), engine.effectBytes(effect)});
    }
    if (engine.body() != nullptr)
        effects.push_back(
            {std::string(kBodyEffect), true, "on, the skin of the head", std::nullopt, engine.bodyBytes()});
    if (engine.volumeBytes() > 0)
        effects.push_back({"hair-hair", true, "on, asked for", std::nullopt, engine.volumeBytes()});
    return effects;
}

MethodMaker engineOn(gpu::Device& device, std::shared_ptr<KernelLibrary> kernels) {
    return [&device, kernels = std::move(kernels)](
               const SceneInput& scene, const std::optional<runtime::HairVolumeSettings>& hairVolume)
               -> Result<std::unique_ptr<StrandMethod>> {
        EngineOptions options;
        options.layout = layoutFor(device.info().type);
        options.hairVolume = hairVolume;
        options.body = scene.groom().body;
        auto engine = StrandEngine::make(device, kernels, scene.strands(), scene.groom().simulation, options);
        if (!engine) return tl::unexpected(engine.error());
        if (auto given = engine->setPoses(poseViews(scene.groom()).views); !given)
            return tl::unexpected(given.error());
        if (auto set = engine->setPoseAmounts(poseAmounts(scene.groom())); !set)
            return tl::unexpected(set.error());
        return std::make_unique<GpuEngineMethod>(std::move(*engine));
    };
}

}  // namespace hairloom::gpu_simulation
