// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/close_maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/smooth_step.h"
#include "core/render/passes.h"
#include "shaders/shared/render_types.h"

namespace hairloom::render {
namespace {

// Pixels that a hair is wide, from which shadows of single hairs show, and light over its width; and where
// all of it does.
constexpr std::array<float, 2> kMaps{0.4f, 0.6f}, kAcross{1, 1.5f};
constexpr float kSteps = 8;         // along the side of a map, by which it moves
constexpr float kTexelsOfHair = 4;  // that a hair is wide in the finest map
constexpr float kMostHalvings = 8;
constexpr std::size_t kFewPoints = 8;

/// Half of what a camera sees, metres at a distance of 1 (or anywhere without perspective), and its
/// distances.
struct Frustum {
    Mat4f viewFromWorld;
    float halfWidth, halfHeight;
    bool perspective;

    explicit Frustum(const RendererState& state) : viewFromWorld(viewMatrix(state.camera)) {
        const Camera& camera = state.camera;
        perspective = !camera.isOrthographic();
        halfHeight = perspective ? std::tan(radians(camera.verticalFov) / 2) : camera.orthographicHeight / 2;
        halfWidth =
            halfHeight * static_cast<float>(state.options.width) / static_cast<float>(state.options.height);
    }
    float scale(float distance) const { return perspective ? distance : 1; }
    float diagonal(float distance) const { return 2 * std::hypot(halfWidth, halfHeight) * scale(distance); }
};

/// Metres in front of the eye where hair in view begins, but for its nearest twentieth; nothing: there is
/// none. Without perspective hair behind the eye is seen as well.
std::optional<float> distanceOfHair(const RendererState& state, const Frustum& frustum) {
    constexpr std::size_t kMostPoints = 1u << 14u;
    struct Point {
        float outside;  ///< from the middle of the view, 1 at its border
        float distance;
    };
    std::size_t all = 0;
    for (const StrandGroup& group : state.scene.groups) all += group.sample_ws.size();
    const std::size_t stride = all / kMostPoints | 1u;
    std::vector<Point> points;
    const auto add = [&](const Vec3f& p_ws) {
        const Vec4f v = frustum.viewFromWorld * p_ws.homogeneous();
        if (frustum.perspective && !(v.z() < 0)) return;
        const float scale = frustum.scale(-v.z());
        points.push_back(
            {std::max(std::abs(v.x()) / frustum.halfWidth, std::abs(v.y()) / frustum.halfHeight) / scale,
             -v.z()});
    };
    for (const StrandGroup& group : state.scene.groups) {
        for (std::size_t i = 0; i < group.sample_ws.size(); i += stride) add(group.sample_ws[i]);
        // Of hair on a GPU only this may be known.
        if (group.sample_ws.empty() && !group.bounds_ws.isEmpty())
            add(state.camera.eye_ws.cwiseMax(group.bounds_ws.min()).cwiseMin(group.bounds_ws.max()));
    }
    if (points.empty()) return {};
    // A narrow view may have none of the sample: then what is nearest to it tells.
    const std::size_t few = std::min(points.size(), kFewPoints);
    std::ranges::nth_element(points, points.begin() + static_cast<std::ptrdiff_t>(few - 1), {},
                             &Point::outside);
    const float reach = std::max(points[few - 1].outside, 1.0f);
    std::erase_if(points, [&](const Point& point) { return point.outside > reach; });
    const auto nth = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 20);
    std::ranges::nth_element(points, nth, {}, &Point::distance);
    return nth->distance;
}

/// What the camera sees from a little before that distance to as far behind it as it sees across.
std::array<Vec4f, 8> seenAround(const Frustum& frustum, float distance) {
    const float across = frustum.diagonal(distance);
    const Mat4f worldFromView = frustum.viewFromWorld.inverse();
    std::array<Vec4f, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const float before = distance - 0.25f * across;
        const float d = i % 2 != 0            ? distance + across
                        : frustum.perspective ? std::max(before, 0.5f * distance)
                                              : before;
        const float x = (i & 2u) != 0 ? frustum.halfWidth : -frustum.halfWidth;
        const float y = (i & 4u) != 0 ? frustum.halfHeight : -frustum.halfHeight;
        corners[i] = worldFromView * Vec4f(x * frustum.scale(d), y * frustum.scale(d), -d, 1);
    }
    return corners;
}

/// The part of a light's view that has the corners, as a view of its own; all of it where that is no smaller.
LightView partOf(const LightView& whole, const std::array<Vec4f, 8>& corners, float finestTexel, float side) {
    Eigen::AlignedBox2f box;
    for (const Vec4f& corner : corners) {
        const Vec4f clip = whole.clipFromWorld * corner;
        if (clip.w() <= 0) return whole;
        box.extend(Vec2f(clip.head<2>() / clip.w()));
    }
    box = box.intersection(Eigen::AlignedBox2f(Vec2f(-1, -1), Vec2f(1, 1)));
    if (box.isEmpty()) return whole;
    // It lies on a grid, by up to a step before the corners, and ends gradually, over half a step on each
    // side (shadows.hlsli).
    const float wanted = std::max(box.sizes().maxCoeff(), 1e-6f) * kSteps / (kSteps - 2);
    const float distance =
        whole.eye_ws.w() > 0 ? whole.nearPlane + whole.hairStart + 0.5f * whole.hairRange : 1.0f;
    const float finest = std::log2(std::max(whole.spread * distance / side / finestTexel, 1.0f));
    const float halvings =
        std::clamp(std::floor(std::min(std::log2(2 / wanted), std::ceil(finest))), 0.0f, kMostHalvings);
    if (halvings == 0) return whole;
    const float finer = std::exp2(halvings);
    const float step = 2 / finer / kSteps;
    LightView part = whole;
    for (int axis = 0; axis < 2; ++axis) {
        const float begins =
            std::clamp(std::floor(box.min()[axis] / step - 0.5f) * step, -1.0f, 1.0f - kSteps * step);
        const float middle = begins + 0.5f * kSteps * step;
        part.clipFromWorld.row(axis) =
            finer * (whole.clipFromWorld.row(axis) - middle * whole.clipFromWorld.row(3));
    }
    part.spread = whole.spread / finer;
    return part;
}

bool same(const std::vector<LightView>& a, const std::vector<LightView>& b) {
    return std::ranges::equal(a, b, [](const LightView& x, const LightView& y) {
        return x.clipFromWorld == y.clipFromWorld && x.spread == y.spread;
    });
}

}  // namespace

std::uint32_t closeMapsThatFit(const RenderOptions& options, const gpu::DeviceInfo& device,
                               std::uint32_t lights) {
    if (options.shadows != Shadows::deepOpacity && options.shadows != Shadows::adaptive) return 0;
    const std::uint32_t room = mapsThatFit(options, device);
    return std::min<std::uint32_t>({room - std::min(room, lights), lights, HAIRLOOM_CLOSE_MAPS});
}

CloseHair closeHairOf(const RendererState& state) {
    if (state.scene.batches.empty() || state.scene.hasTubes()) return {};
    const float all =
        std::clamp(1 - 4 * (state.detail.widening() - 1), 0.0f, 1.0f);  // hairs stand for themselves
    if (all == 0) return {};
    const Frustum frustum(state);
    const float hair = state.scene.measure().diameter;
    const auto pixelsOf = [&](float distance) {
        return hair * static_cast<float>(state.options.height) /
               (2 * frustum.halfHeight * frustum.scale(std::max(distance, 1e-6f)));
    };
    if (pixelsOf(state.scene.hairBounds().exteriorDistance(state.camera.eye_ws)) <= kMaps[0]) return {};
    const std::optional<float> distance = distanceOfHair(state, frustum);
    if (!distance) return {};
    const auto shareOf = [&](const std::array<float, 2>& fade) {
        return all * smoothStep(fade[0], fade[1], pixelsOf(*distance));
    };
    return {shareOf(kMaps), shareOf(kAcross), *distance};
}

bool placeCloseMaps(RendererState& state) {
    std::vector<LightView> views;
    if (state.plan.closeMaps > 0) {
        const auto corners = seenAround(Frustum(state), state.closeHair.distance);
        const float finestTexel = state.scene.measure().diameter / kTexelsOfHair;
        const auto side = static_cast<float>(state.options.shadowResolution);
        for (std::size_t i = 0; i < state.lights.size() && views.size() < state.plan.closeMaps; ++i) {
            if (state.lights[i].castsShadow)
                views.push_back(partOf(state.lightViews[i], corners, finestTexel, side));
        }
    }
    const bool moved = !same(views, state.closeViews);
    state.closeViews = std::move(views);
    return moved;
}

}  // namespace hairloom::render
