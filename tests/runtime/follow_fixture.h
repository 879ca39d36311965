// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Guides and hairs bound to them, and the definition of follow hairs (runtime/follow.h) once more, written
// plainly in double precision.

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "hairloom/follow.h"
#include "tests/runtime/strand_fixture.h"

namespace hairloom::runtime {

/// What a FollowView looks at, and the guides' motion.
struct FollowScene {
    std::vector<std::uint32_t> offsets{0};
    std::vector<Float3> rest, positions, velocities;
    std::vector<Quat> rotations;
    std::vector<RootPlane> planes;
    std::uint32_t points = 0;
    std::vector<float> radii;
    std::vector<std::array<std::uint32_t, 3>> guides;
    std::vector<Float3> weights, rootWeights, rootShifts;
    std::vector<std::array<float, 2>> wispOffsets;
    std::vector<float> blends;
    WispMotion wisps;

    explicit FollowScene(std::uint32_t pointsPerHair) : points(pointsPerHair) {
        for (std::uint32_t i = 0; i < points; ++i) radii.push_back(0.002f + 0.003f * share(i));
    }
    float share(std::uint32_t point) const {
        return static_cast<float>(point) / static_cast<float>(points - 1);
    }
    std::size_t hairs() const { return guides.size(); }

    /// At rest, its root in the plane across y.
    void addGuide(const std::vector<Float3>& strand) {
        rest.insert(rest.end(), strand.begin(), strand.end());
        positions = rest;
        velocities.assign(rest.size(), {});
        offsets.push_back(static_cast<std::uint32_t>(rest.size()));
        planes.push_back({{1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}, {0.0f, 1.0f, 0.0f}});
        rotations.push_back({});
    }
    void addHair(std::array<std::uint32_t, 3> of, Float3 shares, std::array<float, 2> offset, float blend) {
        guides.push_back(of);
        weights.push_back(shares);
        rootWeights.push_back(shares);
        wispOffsets.push_back(offset);
        blends.push_back(blend);
        rootShifts.push_back({});
    }
    FollowView view() const {
        return {offsets, rest,        planes,      points, radii,      guides,
                weights, rootWeights, wispOffsets, blends, rootShifts, wisps};
    }
    std::vector<Float3> evaluate(const Host& host = {}) const {
        FollowHairs::Result made = FollowHairs::make(view());
        EXPECT_EQ(made.error, "");
        std::vector<Float3> result(hairs() * points);
        made.hairs->evaluate({positions, velocities, rotations}, result, host);
        return result;
    }
};

/// Curved guides in all directions, moving, and hairs of all kinds.
inline FollowScene tangled(std::uint32_t points, std::uint32_t guideCount = 21, std::uint32_t hairs = 300) {
    FollowScene scene(points);
    std::mt19937 random(points);
    std::uniform_real_distribution<float> any(-1.0f, 1.0f);
    const auto direction = [&] {
        const Float3 v{any(random), any(random), any(random)};
        return v * (1.0f / (length(v) + 1e-3f));
    };
    for (std::uint32_t g = 0; g < guideCount; ++g) {
        Float3 at = direction() * 0.1f, heading{0.3f * any(random), 1.0f, 0.3f * any(random)};
        std::vector<Float3> strand;
        for (std::uint32_t i = 0; i < points; ++i) {
            strand.push_back(at);
            at = at + heading * (0.2f / static_cast<float>(points));
            heading = heading + direction() * 0.4f;
            heading = heading * (1.0f / length(heading));
        }
        scene.addGuide(strand);
        // Of about unit length, as is allowed.
        scene.rotations.back() = turnAbout(direction() * 0.99f, any(random));
    }
    for (Float3& v : scene.velocities) v = direction() * (3.0f * any(random));
    const auto shares = [&] {
        const Float3 w{std::abs(any(random)), std::abs(any(random)), std::abs(any(random)) + 0.01f};
        return w * (1.0f / (w.x + w.y + w.z));
    };
    for (std::uint32_t h = 0; h < hairs; ++h) {
        const std::array<std::uint32_t, 3> of{h % guideCount, (h * 7 + 1) % guideCount,
                                              (h * 11 + 5) % guideCount};
        scene.addHair(of, shares(), {any(random), any(random)}, h % 5 == 0 ? 0.0f : h % 5 == 1 ? 1.0f : 0.3f);
        scene.rootWeights.back() = shares();
        scene.rootShifts.back() = direction() * 0.001f;
    }
    return scene;
}

struct Double3 {
    double x = 0.0, y = 0.0, z = 0.0;

    Double3() = default;
    Double3(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
    explicit Double3(Float3 v) : x(v.x), y(v.y), z(v.z) {}
    Double3 operator+(const Double3& o) const { return {x + o.x, y + o.y, z + o.z}; }
    Double3 operator-(const Double3& o) const { return {x - o.x, y - o.y, z - o.z}; }
    Double3 operator*(double s) const { return {x * s, y * s, z * s}; }
    double dot(const Double3& o) const { return x * o.x + y * o.y + z * o.z; }
    Double3 cross(const Double3& o) const {
        return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x};
    }
    double norm() const { return std::sqrt(dot(*this)); }
    Double3 unit() const { return *this * (1.0 / norm()); }
};

/// v turned about the unit axis (Rodrigues).
inline Double3 turned(const Double3& v, const Double3& axis, double angle) {
    return v * std::cos(angle) + axis.cross(v) * std::sin(angle) +
           axis * (axis.dot(v) * (1.0 - std::cos(angle)));
}
inline Double3 turned(const Double3& v, Quat q) {
    const Double3 axis(q.x, q.y, q.z);
    return axis.norm() > 0.0 ? turned(v, axis.unit(), 2.0 * std::atan2(axis.norm(), double{q.w})) : v;
}

/// Hairs of a scene whose guides all have `points` points and no chord without length.
class PlainFollowHairs {
  public:
    explicit PlainFollowHairs(const FollowScene& scene) : scene_(scene) {}

    Double3 point(std::size_t hair, std::uint32_t i) const {
        const auto& of = scene_.guides[hair];
        const double weights[] = {scene_.weights[hair].x, scene_.weights[hair].y, scene_.weights[hair].z};
        const double roots[] = {scene_.rootWeights[hair].x, scene_.rootWeights[hair].y,
                                scene_.rootWeights[hair].z};
        Double3 triangle;
        for (std::size_t k = 0; k < 3; ++k) {
            triangle = triangle + at(of[k], i) * weights[k] + at(of[k], 0) * (roots[k] - weights[k]);
        }
        const double blend = scene_.blends[hair];
        const Double3 shift(scene_.rootShifts[hair]);
        const auto [x, y, normal] = plane(of[0]);
        return wisp(hair, i) * (1.0 - blend) + triangle * blend + x * shift.x + y * shift.y +
               normal * shift.z;
    }

  private:
    struct Frame {
        Double3 x, y, along;
    };

    Double3 at(std::uint32_t guide, std::uint32_t i) const {
        return Double3(scene_.positions[scene_.offsets[guide] + i]);
    }
    Frame plane(std::uint32_t guide) const {
        const RootPlane& p = scene_.planes[guide];
        const Quat turn = scene_.rotations[guide];
        return {turned(Double3(p.x), turn), turned(Double3(p.y), turn), turned(Double3(p.normal), turn)};
    }
    static Frame carried(const Frame& frame, const Double3& chord) {
        const Double3 axis = frame.along.cross(chord);
        if (axis.norm() < 1e-12) return frame;
        const double angle = std::atan2(axis.norm(), frame.along.dot(chord));
        return {turned(frame.x, axis.unit(), angle), turned(frame.y, axis.unit(), angle), chord.unit()};
    }
    Double3 wisp(std::size_t hair, std::uint32_t i) const {
        const std::uint32_t guide = scene_.guides[hair][0], last = scene_.points - 1;
        Frame frame = plane(guide);
        if (i > 0) frame = carried(frame, at(guide, 1) - at(guide, 0));
        for (std::uint32_t p = 1; p <= i; ++p) {
            frame = carried(frame, at(guide, p < last ? p + 1 : p) - at(guide, p - 1));
        }
        const Double3 velocity(scene_.velocities[scene_.offsets[guide] + i]);
        const double speed = velocity.norm(), sigma = double{scene_.wisps.spread} * i / last;
        const double xi = std::min(1.0 + sigma * speed, double{scene_.wisps.limit});  // Eq. 22
        const double radius = scene_.radii[i];
        Double3 centre = at(guide, i);
        if (speed > 0.0) centre = centre - velocity * (radius * (xi - 1.0) / speed);  // Eq. 23
        const auto& offset = scene_.wispOffsets[hair];
        return centre + (frame.x * offset[0] + frame.y * offset[1]) * (radius * xi);
    }

    const FollowScene& scene_;
};

}  // namespace hairloom::runtime
