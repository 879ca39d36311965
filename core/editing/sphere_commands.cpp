// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/sphere_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/editing/settings_commands.h"
#include "core/groom/spheres.h"

namespace hairloom::editing {
namespace {

using Spheres = std::vector<CollisionSphere>;

std::string freshName(const Spheres& spheres) {
    for (std::size_t number = spheres.size() + 1;; ++number) {
        std::string name = fmt::format("Sphere {}", number);
        const auto same = [&](const CollisionSphere& sphere) { return sphere.name == name; };
        if (std::none_of(spheres.begin(), spheres.end(), same)) return name;
    }
}

template <class Edit>
std::unique_ptr<Command> edited(const Model& model, std::string name, Edit edit) {
    Spheres spheres = model.groom.spheres;
    edit(spheres);
    return setSpheres(model, std::move(spheres), std::move(name));
}

/// Replaces `from` by `to` at the end of the text, or at its beginning.
bool swapSide(std::string& text, std::string_view from, std::string_view to) {
    if (text.ends_with(from)) {
        text.replace(text.size() - from.size(), from.size(), to);
        return true;
    }
    if (from.size() > 2 && text.starts_with(from)) {
        text.replace(0, from.size(), to);
        return true;
    }
    return false;
}

}  // namespace

std::unique_ptr<Command> placeSphere(const Model& model, const SurfacePoint& place, float radius,
                                     std::string bone) {
    if (!model.groom.scalp) return nullptr;
    const float bounded = std::clamp(radius, kSmallestSphere, kLargestSphere);
    const ScalpMesh& head = *model.groom.scalp;
    const Vec3f centre = head.pointAt(place.triangle, place.barycentric) -
                         bounded * head.normalAt(place.triangle, place.barycentric);
    return edited(model, "Place sphere", [&](Spheres& spheres) {
        spheres.push_back({freshName(spheres), centre, bounded, std::move(bone), -1});
    });
}

std::unique_ptr<Command> moveSphere(const Model& model, std::size_t index, const Vec3f& centre_ss) {
    if (!centre_ss.allFinite()) return nullptr;
    return edited(model, "Move sphere", [&](Spheres& spheres) { spheres[index].centre = centre_ss; });
}

std::unique_ptr<Command> resizeSphere(const Model& model, std::size_t index, float radius) {
    if (std::isnan(radius)) return nullptr;
    return edited(model, "Resize sphere", [&](Spheres& spheres) {
        spheres[index].radius = std::clamp(radius, kSmallestSphere, kLargestSphere);
    });
}

std::unique_ptr<Command> attachSphere(const Model& model, std::size_t index, std::string bone) {
    return edited(model, "Attach sphere", [&](Spheres& spheres) { spheres[index].bone = std::move(bone); });
}

std::unique_ptr<Command> renameSphere(const Model& model, std::size_t index, std::string name) {
    return edited(model, "Rename sphere", [&](Spheres& spheres) { spheres[index].name = std::move(name); });
}

std::unique_ptr<Command> removeSphere(const Model& model, std::size_t index) {
    return edited(model, "Remove sphere", [&](Spheres& spheres) {
        spheres = keptSpheres(spheres, [&](std::size_t s) { return s != index; });
    });
}

std::unique_ptr<Command> joinSphere(const Model& model, std::size_t index, std::int32_t other) {
    const bool isOther = other >= 0 && static_cast<std::size_t>(other) != index &&
                         static_cast<std::size_t>(other) < model.groom.spheres.size();
    return edited(model, isOther ? "Join spheres" : "Unjoin sphere", [&](Spheres& spheres) {
        spheres[index].joined = isOther ? other : -1;
        // One capsule between two spheres is enough.
        if (isOther && spheres[static_cast<std::size_t>(other)].joined == static_cast<std::int32_t>(index))
            spheres[static_cast<std::size_t>(other)].joined = -1;
    });
}

std::unique_ptr<Command> mirrorSphere(const Model& model, std::size_t index, const Vec3f& planePoint,
                                      const Vec3f& planeNormal) {
    const Vec3f normal = planeNormal.normalized();
    return edited(model, "Mirror sphere", [&](Spheres& spheres) {
        const auto mirrored = [&](std::size_t of) {
            CollisionSphere mirror = spheres[of];
            mirror.centre -= 2 * (mirror.centre - planePoint).dot(normal) * normal;
            std::string name = otherSide(mirror.name);
            const auto same = [&](const CollisionSphere& sphere) { return sphere.name == name; };
            const bool isTaken = std::any_of(spheres.begin(), spheres.end(), same);
            mirror.name = isTaken ? freshName(spheres) : std::move(name);
            mirror.bone = otherSide(mirror.bone);
            mirror.joined = -1;
            spheres.push_back(std::move(mirror));
        };
        const std::int32_t joined = spheres[index].joined;
        mirrored(index);
        if (joined < 0) return;
        // One that lies on the plane is its own mirror image.
        constexpr float kOnPlane = 1e-4f;  // metres
        const auto other = static_cast<std::size_t>(joined);
        const std::size_t made = spheres.size() - 1;
        const bool isOnPlane = std::abs((spheres[other].centre - planePoint).dot(normal)) < kOnPlane;
        if (!isOnPlane) mirrored(other);
        spheres[made].joined = isOnPlane ? joined : static_cast<std::int32_t>(made + 1);
    });
}

std::string otherSide(const std::string& name) {
    constexpr std::pair<std::string_view, std::string_view> kSides[] = {
        {"_L", "_R"}, {"_l", "_r"}, {".L", ".R"}, {".l", ".r"}, {"Left", "Right"}, {"left", "right"}};
    std::string other = name;
    for (const auto& [left, right] : kSides) {
        if (swapSide(other, left, right) || swapSide(other, right, left)) return other;
    }
    return other;
}

std::optional<std::size_t> pickSphere(std::span<const CollisionSphere> spheres, const View& view,
                                      const Vec2f& px) {
    const Ray ray = view.rayAt(px);
    std::optional<std::size_t> best;
    float nearest = 0;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const Vec3f toCentre = spheres[i].centre - ray.origin_ss;
        const float along = toCentre.dot(ray.direction_ss);
        const float inside = spheres[i].radius * spheres[i].radius - (toCentre.squaredNorm() - along * along);
        if (inside < 0 || along + spheres[i].radius < 0) continue;
        const float entry = along - std::sqrt(inside);
        if (best && entry >= nearest) continue;
        best = i;
        nearest = entry;
    }
    return best;
}

}  // namespace hairloom::editing
