// SPDX-License-Identifier: GPL-3.0-or-later
// What colliders do to hair that nothing moves: beside the same hair without them.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "benchmarks/contact_rows.h"
#include "core/live/groom_scene.h"
#include "core/render/flip.h"
#include "core/render/picture.h"
#include "core/simulation/simulation.h"
#include "core/software/device.h"
#include "hairloom/body_field.h"

namespace hairloom::benchmarks {
namespace {

constexpr double kMmPerMetre = 1000;
constexpr float kRootLength = 0.005f;  ///< metres of each strand that do not count

/// A groom that has come to rest.
struct Rested {
    std::vector<Vec3f> points;
    render::Image picture;
};

Result<render::Image> pictureOf(const Groom& groom, const Simulation& simulation, std::uint32_t side) {
    auto scene = GroomScene::make(groom, {}, {});
    if (!scene) return tl::unexpected(scene.error());
    // All pictures show the same part of the world.
    const Box3f subject = scene->subject();
    scene->pose(simulation.positions_ws(), simulation.velocities_ws(), {});
    render::RenderScene drawn = scene->scene();
    drawn.camera = render::frame(render::View::ThreeQuarter, subject, 1.0f);
    drawn.lights = render::studioLights(drawn.camera);
    render::RenderOptions options;
    options.width = options.height = side;
    const std::unique_ptr<gpu::Device> device = software::makeDevice();
    auto picture = render::renderPicture(*device, drawn, options);
    if (!picture) return tl::unexpected(picture.error());
    return std::move(picture->image);
}

Result<Rested> rest(const Groom& groom, int frames, std::uint32_t side) {
    auto simulation = Simulation::make(groom, {});
    if (!simulation) return tl::unexpected(simulation.error());
    for (int f = 0; f < frames; ++f) simulation->step(runtime::kUsualFrame, HeadPose{});
    const auto points = simulation->positions_ws();
    auto picture = pictureOf(groom, *simulation, side);
    if (!picture) return tl::unexpected(picture.error());
    return Rested{{points.begin(), points.end()}, std::move(*picture)};
}

float collisionRadiusOf(const Groom& groom, std::size_t strand, std::uint32_t point) {
    const std::uint32_t first = groom.offsets[strand], last = groom.offsets[strand + 1] - 1;
    const float along = static_cast<float>(point - first) / static_cast<float>(last - first);
    const runtime::SimulationSettings& s = groom.simulation;
    return s.collisionRadiusRoot + along * (s.collisionRadiusTip - s.collisionRadiusRoot);
}

}  // namespace

Status contactsAtRest(const std::string& name, const Groom& groom, bool quick,
                      std::vector<ContactRow>& rows) {
    const int frames = quick ? 20 : 600;
    const std::uint32_t side = quick ? 48 : 400;
    Groom without = groom;
    without.spheres.clear();
    without.body.reset();
    const auto met = rest(groom, frames, side);
    if (!met) return tl::unexpected(met.error());
    const auto free = rest(without, frames, side);
    if (!free) return tl::unexpected(free.error());

    const auto distanceAt = [&](const Vec3f& p) { return groom.body->at({p.x(), p.y(), p.z()}).distance; };
    float moved = 0, standsOff = 0;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const std::uint32_t first = groom.offsets[s], end = groom.offsets[s + 1];
        float along = 0, nearest = std::numeric_limits<float>::infinity(), farthest = 0;
        for (std::uint32_t p = first; p < end; ++p) {
            if (p > first) along += (groom.positions()[p] - groom.positions()[p - 1]).norm();
            farthest = std::max(farthest, (met->points[p] - free->points[p]).norm());
            if (along < kRootLength) continue;
            const float authored = distanceAt(groom.positions()[p]);
            nearest = std::min(nearest, authored);
            const float radius = collisionRadiusOf(groom, s, p);
            if (authored >= 0 && authored <= radius)
                standsOff = std::max(standsOff, distanceAt(met->points[p]) - radius);
        }
        if (nearest > 0) moved = std::max(moved, farthest);
    }
    rows.push_back({fmt::format("{} at rest, farthest that hair outside is moved by colliders", name),
                    kMmPerMetre * static_cast<double>(moved), "mm", 0.5,
                    "spheres that bulge out of the skin"});
    rows.push_back({fmt::format("{} at rest, farthest beyond its radius that hair on skin is off it", name),
                    kMmPerMetre * static_cast<double>(standsOff), "mm", 0.5,
                    "spheres that bulge out of the skin"});
    const auto difference = render::flipDifference(free->picture, met->picture);
    if (!difference) return tl::unexpected(difference.error());
    rows.push_back({fmt::format("{} at rest, pictures with and without colliders, FLIP", name),
                    difference->mean, "", 0.02, "hair that was authored inside comes out"});
    return {};
}

}  // namespace hairloom::benchmarks
