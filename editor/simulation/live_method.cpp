// SPDX-License-Identifier: GPL-3.0-or-later
#include "editor/simulation/live_method.h"

namespace hairloom::editor {
namespace {

class LiveMethod : public StrandMethod {
  public:
    LiveMethod(std::unique_ptr<StrandMethod> engine, std::shared_ptr<LiveParameters> parameters)
        : engine_(std::move(engine)), parameters_(std::move(parameters)) {}

    void reset(const SceneInput& scene, const HeadPose& pose) override { engine_->reset(scene, pose); }
    void step(const SceneInput& scene, const HeadPose& pose, const runtime::FrameInput& input) override {
        const std::vector<runtime::Sphere> spheres = spheresAt(parameters_->spheres, pose);
        runtime::FrameInput live = input;
        live.spheres = spheres;
        engine_->step(scene, pose, live);
    }
    void readPositions(std::span<runtime::Float3> positions_ws) const override {
        engine_->readPositions(positions_ws);
    }
    bool readVelocities(std::span<runtime::Float3> velocities_ws) const override {
        return engine_->readVelocities(velocities_ws);
    }
    std::shared_ptr<const runtime::State> state() const override { return engine_->state(); }
    bool setState(const runtime::State& state) override { return engine_->setState(state); }
    double stepMilliseconds() const override { return engine_->stepMilliseconds(); }
    Status status() const override { return engine_->status(); }
    std::uint32_t restoredStrands() const override { return engine_->restoredStrands(); }
    runtime::Measurements measure() const override { return engine_->measure(); }
    std::uint64_t stateHash() const override { return engine_->stateHash(); }
    std::vector<EffectReport> effects() const override { return engine_->effects(); }

  private:
    std::unique_ptr<StrandMethod> engine_;
    std::shared_ptr<LiveParameters> parameters_;
};

}  // namespace

MethodMaker liveMethod(std::shared_ptr<LiveParameters> parameters) {
    return [parameters = std::move(parameters)](const SceneInput& scene,
                                                const std::optional<runtime::HairVolumeSettings>& hairHair)
               -> Result<std::unique_ptr<StrandMethod>> {
        auto engine = makeEngineMethod(scene, hairHair);
        if (!engine) return tl::unexpected(engine.error());
        parameters->engine = engine->get();
        parameters->spheres = scene.groom().spheres;
        return std::make_unique<LiveMethod>(std::move(*engine), parameters);
    };
}

}  // namespace hairloom::editor
