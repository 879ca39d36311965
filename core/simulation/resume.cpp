// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/resume.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/simulation/scene_input.h"
#include "core/simulation/strand_method.h"

namespace hairloom {

struct RecordedStates::Impl {
    SceneInput scene;
    runtime::Engine engine;
};

RecordedStates::RecordedStates(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RecordedStates::RecordedStates(RecordedStates&&) noexcept = default;
RecordedStates& RecordedStates::operator=(RecordedStates&&) noexcept = default;
RecordedStates::~RecordedStates() = default;

Result<RecordedStates> RecordedStates::make(const Groom& groom) {
    auto scene = SceneInput::make(groom);
    if (!scene) return tl::unexpected(scene.error());
    auto made = runtime::Engine::make(scene->strands(), groom.simulation, applicationHost());
    if (!made.engine) return tl::unexpected(errorOfWords(made.error));
    return RecordedStates(std::unique_ptr<Impl>(new Impl{std::move(*scene), std::move(*made.engine)}));
}

Result<std::shared_ptr<const runtime::State>> RecordedStates::at(const RecordedFrame& frame,
                                                                 const RecordedFrame& before,
                                                                 const RecordedFrame& after, float seconds) {
    std::vector<runtime::Float3> positions, velocities;
    const auto points =
        std::min({before.positions_ws.size(), after.positions_ws.size(), frame.positions_ws.size()});
    for (std::size_t p = 0; p < points; ++p) {
        const Vec3f& at = frame.positions_ws[p];
        const Vec3f velocity = (after.positions_ws[p] - before.positions_ws[p]) / seconds;
        positions.push_back({at.x(), at.y(), at.z()});
        velocities.push_back({velocity.x(), velocity.y(), velocity.z()});
    }
    // Frames are recorded in the world.
    const std::array<double, 3> origin{};
    if (!impl_->engine.place(impl_->scene.rootsAt(inWorld(frame.pose)), positions, velocities, origin))
        return fail(fmt::format("the frame has {} points", points),
                    fmt::format("the hair has {}", impl_->scene.groom().pointCount()));
    return impl_->engine.state();
}

std::shared_ptr<const runtime::State> RecordedStates::pulled(const Simulation& simulation,
                                                             std::span<const Vec3f> wanted_ws,
                                                             float seconds) {
    const auto state = simulation.state();
    if (!state || !impl_->engine.setState(*state)) return nullptr;
    const auto positions = simulation.positions_ws();
    std::vector<runtime::Float3> changes;
    for (std::size_t p = 0; p < std::min(positions.size(), wanted_ws.size()); ++p) {
        const Vec3f change = (wanted_ws[p] - positions[p]) / seconds;
        changes.push_back({change.x(), change.y(), change.z()});
    }
    if (!impl_->engine.addVelocities(changes)) return nullptr;
    return impl_->engine.state();
}

}  // namespace hairloom
