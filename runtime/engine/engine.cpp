// SPDX-License-Identifier: MIT
// The public face: sizes are checked here, and nowhere behind it.
#include "hairloom/engine.h"

#include <algorithm>
#include <utility>

#include "engine/checks.h"
#include "engine/engine_impl.h"

namespace hairloom::runtime {

Engine::Engine(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Engine::Engine(const Engine& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
Engine::Engine(Engine&& other) noexcept = default;
Engine::~Engine() = default;

Engine& Engine::operator=(Engine other) noexcept {
    impl_ = std::move(other.impl_);
    return *this;
}

Engine::Result Engine::make(const StrandsView& strands, const SimulationSettings& settings, Host host) {
    if (std::string error = validationError(settings); !error.empty())
        return {std::nullopt, std::move(error)};
    if (std::string error = validationError(strands); !error.empty()) return {std::nullopt, std::move(error)};
    return {Engine(std::make_unique<Impl>(strands, settings, std::move(host))), {}};
}

bool Engine::reset(std::span<const RootFrame> roots_ws) {
    if (roots_ws.size() != strandCount()) return false;
    impl_->reset(roots_ws);
    return true;
}

bool Engine::place(std::span<const RootFrame> roots_ws, std::span<const Float3> positions_ws,
                   std::span<const Float3> velocities_ws,
                   const std::optional<std::array<double, 3>>& origin_ws) {
    if (roots_ws.size() != strandCount() || positions_ws.size() != pointCount() ||
        velocities_ws.size() != pointCount())
        return false;
    impl_->place(roots_ws, positions_ws, velocities_ws, origin_ws);
    return true;
}

std::string Engine::setSettings(const SimulationSettings& settings) {
    return impl_->setSettings(settings);
}

const SimulationSettings& Engine::settings() const {
    return impl_->settings_;
}

std::string Engine::setBody(std::shared_ptr<const BodyField> body) {
    if (body) {
        if (std::string problem = body->problem(); !problem.empty()) return problem;
    }
    impl_->setBody(std::move(body));
    return {};
}

std::string Engine::setPoses(std::span<const PoseView> poses) {
    return impl_->setPoses(poses);
}

bool Engine::setPoseAmounts(std::span<const float> amounts) {
    if (amounts.size() != impl_->poseAmounts_.size()) return false;
    impl_->setPoseAmounts(amounts);
    return true;
}

std::span<const float> Engine::poseAmounts() const {
    return impl_->poseAmounts_;
}

std::shared_ptr<const PoseSet> Engine::poses() const {
    return impl_->poses_;
}

void Engine::setSkinSpheres(std::span<const std::uint8_t> ofSkin) {
    if (std::equal(ofSkin.begin(), ofSkin.end(), impl_->skinSpheres_.begin(), impl_->skinSpheres_.end()))
        return;
    impl_->skinSpheres_.assign(ofSkin.begin(), ofSkin.end());
    impl_->skinSpheresChanged_ = true;
}

std::size_t Engine::bodyBytes() const {
    if (!impl_->meetsBody()) return 0;
    const std::size_t loads = impl_->plan_.on(Effect::collision)
                                  ? 0
                                  : impl_->strands_->effectBytes(Effect::collision, impl_->state_);
    return impl_->body_->bytes() + impl_->bodyTable_.bytes() + loads +
           impl_->strands_->bodyBytes(impl_->state_) +
           (impl_->clearances_.size() + impl_->bodySeen_.size()) * sizeof(float);
}

void Engine::setClock(std::function<std::uint64_t()> nanoseconds) {
    impl_->host_.nanoseconds = std::move(nanoseconds);
}

bool Engine::step(const FrameInput& input) {
    if (input.roots_ws.size() != strandCount() || input.inner.size() > kMaxInnerPoses) return false;
    for (const InnerPose& pose : input.inner)
        if (pose.roots_ws.size() != strandCount()) return false;
    impl_->step(input);
    return true;
}

bool Engine::addVelocities(std::span<const Float3> changes_ws) {
    if (changes_ws.size() != pointCount()) return false;
    impl_->addVelocities(changes_ws);
    return true;
}

std::shared_ptr<const RestShape> Engine::restShape() const {
    return impl_->shape_;
}

std::shared_ptr<const State> Engine::state() const {
    return makeShared<const State>(impl_->state_);
}

void Engine::keepMemory() {
    impl_->keepsMemory_ = true;
    const std::size_t bones = impl_->meetsBody() ? std::max<std::size_t>(impl_->body_->bones.size(), 1) : 0;
    impl_->state_.body.reserve(bones);
    impl_->pieces_.reserve(strandCount(), bones);
    impl_->rootsNow_.reserve(strandCount());
}

bool Engine::setState(const State& state) {
    return impl_->setState(state);
}

std::uint32_t Engine::strandCount() const {
    return impl_->strandCount();
}

std::uint32_t Engine::pointCount() const {
    return impl_->pointCount();
}

bool Engine::readPositions(std::span<Float3> positions_ws) const {
    if (positions_ws.size() != pointCount()) return false;
    runtime::readPositions(*impl_->shape_, impl_->state_, positions_ws);
    return true;
}

bool Engine::readVelocities(std::span<Float3> velocities_ws) const {
    if (velocities_ws.size() != pointCount()) return false;
    runtime::readVelocities(*impl_->shape_, impl_->state_, velocities_ws);
    return true;
}

const EffectPlan& Engine::plan() const {
    return impl_->plan_;
}

const StepReport& Engine::lastStep() const {
    return impl_->report_;
}

Measurements Engine::measure() const {
    return measureState(*impl_->shape_, impl_->state_, impl_->settings_, impl_->spheres_.ofSkin);
}

std::size_t Engine::effectBytes(Effect effect) const {
    return impl_->effectBytes(effect);
}

std::size_t Engine::baseBytes() const {
    return impl_->baseBytes();
}

std::uint64_t Engine::stateHash() const {
    return impl_->state_.hash();
}

const char* Engine::instructionSet() {
    return kernels().target;
}

}  // namespace hairloom::runtime
