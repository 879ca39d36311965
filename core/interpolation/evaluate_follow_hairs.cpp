// SPDX-License-Identifier: GPL-3.0-or-later
#include <cassert>
#include <cmath>

#include "core/base/parallel.h"
#include "core/geometry/curve.h"
#include "core/interpolation/follow_hairs.h"

namespace hairloom {
namespace {

/// One guide's wisp: centre and the two axes of the cross-section (scaled by its radius) at every point.
struct Wisp {
    std::vector<float> centres;
    std::vector<float> xAxes;
    std::vector<float> yAxes;

    explicit Wisp(std::size_t points) : centres(points * 3), xAxes(points * 3), yAxes(points * 3) {}
};

void store(std::vector<float>& target, std::size_t point, const Vec3f& value) {
    for (int axis = 0; axis < 3; ++axis) target[point * 3 + static_cast<std::size_t>(axis)] = value[axis];
}

Mat3f rootFrame(const FollowBindings& bindings, const GuideState& state, std::size_t guide) {
    const Mat3f& rest = bindings.rootFrames[guide];
    return state.rotations.empty() ? rest : Mat3f(state.rotations[guide] * rest);
}

/// The frame at the root lies in the scalp (its third axis is the scalp normal); along the strand it is
/// turned the shortest way onto the first segment and then carried without twist.
void fillWisp(const FollowBindings& bindings, const GuideState& state, const WispMotion& motion,
              std::size_t guide, Wisp& wisp) {
    const std::size_t points = bindings.pointsPerHair;
    const auto positions = state.positions.subspan(guide * points, points);
    const Mat3f root = rootFrame(bindings, state, guide);
    Vec3f tangent = positions[1] - positions[0];
    tangent = tangent.norm() > 0 ? Vec3f(tangent.normalized()) : Vec3f(root.col(2));
    const Vec3f firstNormal = shortestArc(root.col(2), tangent) * Vec3f(root.col(0));
    const auto frames = parallelTransportFrames(positions, firstNormal);
    for (std::size_t i = 0; i < points; ++i) {
        const Mat3f& frame = i == 0 ? root : frames[i];
        const float radius = bindings.radii[i];
        float xi = 1.0f;
        Vec3f centre = positions[i];
        if (!state.velocities.empty()) {
            const Vec3f& velocity = state.velocities[guide * points + i];
            const float sigma = motion.spread * static_cast<float>(i) / static_cast<float>(points - 1);
            xi += sigma * velocity.norm();        // Eq. 22
            centre -= radius * sigma * velocity;  // Eq. 23, where (ξ − 1) v/|v| = σ v is smooth at rest
        }
        store(wisp.centres, i, centre);
        store(wisp.xAxes, i, frame.col(0) * (radius * xi));
        store(wisp.yAxes, i, frame.col(1) * (radius * xi));
    }
}

/// x y z x y z …, one such row for each axis, so that a constant vector can be added over whole rows.
struct AxisRows {
    std::array<std::vector<float>, 3> rows;
    explicit AxisRows(std::size_t points) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            rows[axis].assign(points * 3, 0.0f);
            for (std::size_t point = 0; point < points; ++point) rows[axis][point * 3 + axis] = 1.0f;
        }
    }
};

/// A hair is a weighted sum of nine rows of 3 · points numbers.
struct Row {
    const float* values;
    float weight;
};

void sumRows(const std::array<Row, 9>& rows, std::size_t count, float* target) {
    for (std::size_t j = 0; j < count; ++j) {
        target[j] = ((rows[0].weight * rows[0].values[j] + rows[1].weight * rows[1].values[j]) +
                     (rows[2].weight * rows[2].values[j] + rows[3].weight * rows[3].values[j])) +
                    ((rows[4].weight * rows[4].values[j] + rows[5].weight * rows[5].values[j]) +
                     (rows[6].weight * rows[6].values[j] + rows[7].weight * rows[7].values[j])) +
                    rows[8].weight * rows[8].values[j];
    }
}

/// A constant over the whole hair: the shift onto the scalp, and what moves the shape's root (by `weights`)
/// to the place in the root triangle (by `rootWeights`).
Vec3f hairShift(const FollowBindings& bindings, const GuideState& state, std::size_t hair,
                const Mat3f& root) {
    const std::size_t points = bindings.pointsPerHair;
    Vec3f shift = root * bindings.rootShifts[hair];
    const Vec3f moved = bindings.blends[hair] * (bindings.rootWeights[hair] - bindings.weights[hair]);
    for (int k = 0; k < 3; ++k) {
        if (moved[k] == 0.0f) continue;
        shift += moved[k] * state.positions[bindings.guides[hair][static_cast<std::size_t>(k)] * points];
    }
    return shift;
}

}  // namespace

void evaluateFollowHairs(const FollowBindings& bindings, const GuideState& state, const WispMotion& motion,
                         std::span<Vec3f> positions) {
    const std::size_t points = bindings.pointsPerHair;
    assert(positions.size() == bindings.hairCount() * points);
    assert(state.positions.size() == bindings.guideCount() * points);
    assert(state.velocities.empty() || state.velocities.size() == state.positions.size());
    assert(state.rotations.empty() || state.rotations.size() == bindings.guideCount());
    if (bindings.hairCount() == 0) return;
    static_assert(sizeof(Vec3f) == 3 * sizeof(float));
    const AxisRows axes(points);
    const auto guideRow = [&](std::uint32_t guide) { return state.positions[guide * points].data(); };
    parallelFor(bindings.guideCount(), 16, [&](std::size_t begin, std::size_t end) {
        Wisp wisp(points);
        for (std::size_t guide = begin; guide < end; ++guide) {
            fillWisp(bindings, state, motion, guide, wisp);
            const Mat3f root = rootFrame(bindings, state, guide);
            for (std::uint32_t number = 0; number < bindings.followPerGuide; ++number) {
                const std::size_t hair = guide * bindings.followPerGuide + number;
                const auto& guides = bindings.guides[hair];
                const Vec3f weights = bindings.blends[hair] * bindings.weights[hair];
                const float single = 1.0f - bindings.blends[hair];
                const Vec2f offset = single * bindings.wispOffsets[hair];
                const Vec3f shift = hairShift(bindings, state, hair, root);
                sumRows({Row{wisp.centres.data(), single}, Row{wisp.xAxes.data(), offset.x()},
                         Row{wisp.yAxes.data(), offset.y()}, Row{guideRow(guides[0]), weights[0]},
                         Row{guideRow(guides[1]), weights[1]}, Row{guideRow(guides[2]), weights[2]},
                         Row{axes.rows[0].data(), shift.x()}, Row{axes.rows[1].data(), shift.y()},
                         Row{axes.rows[2].data(), shift.z()}},
                        points * 3, positions[hair * points].data());
            }
        }
    });
}

Groom bakeFollowHairs(const Groom& groom, const FollowBindings& bindings) {
    const std::size_t hairs = bindings.hairCount();
    const auto guides = guidePositions(groom, bindings);
    std::vector<Vec3f> positions(hairs * bindings.pointsPerHair);
    evaluateFollowHairs(bindings, {guides, {}, {}}, {}, positions);
    std::vector<std::uint32_t> offsets(hairs + 1);
    for (std::size_t hair = 0; hair <= hairs; ++hair) {
        offsets[hair] = static_cast<std::uint32_t>(hair * bindings.pointsPerHair);
    }
    Groom baked = makeGroom(std::move(offsets), std::move(positions));
    baked.material = groom.material;
    baked.scalp = groom.scalp;
    baked.scalpSelection = groom.scalpSelection;
    baked.scalpExpression = groom.scalpExpression;
    baked.characterFile = groom.characterFile;
    if (!bindings.roots.empty()) baked.setRootBindings(bindings.roots);
    return baked;
}

}  // namespace hairloom
