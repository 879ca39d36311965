// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/frame_vectors.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/simulation/scene_input.h"
#include "hairloom/body_field.h"

namespace hairloom {
namespace {

void appendMoved(std::vector<Vec3f>& values, std::span<const Vec3f> posed_ws, std::span<const Vec3f> rest,
                 const Eigen::Isometry3f& head_ws) {
    if (!posed_ws.empty()) {
        values.insert(values.end(), posed_ws.begin(), posed_ws.end());
        return;
    }
    for (const Vec3f& position : rest) values.push_back(head_ws * position);
}

/// What appendBody() wrote.
std::vector<Eigen::Affine3f> bodyOf(std::span<const Vec3f> values) {
    std::vector<Eigen::Affine3f> bones;
    if (std::ranges::all_of(values, [](const Vec3f& v) { return v == Vec3f::Zero(); })) return bones;
    for (std::size_t i = 0; i < values.size(); i += kVectorsPerBone) {
        Eigen::Affine3f bone = Eigen::Affine3f::Identity();
        for (std::size_t column = 0; column < kVectorsPerBone; ++column)
            bone.matrix().col(static_cast<Eigen::Index>(column)).head<3>() = values[i + column];
        bones.push_back(bone);
    }
    return bones;
}

}  // namespace

FrameCounts frameCounts(const Groom& groom) {
    return {groom.pointCount(), groom.scalp ? groom.scalp->vertexCount() : 0, groom.spheres.size(),
            groom.body ? std::max<std::size_t>(groom.body->bones.size(), 1) : 0};
}

Status checkCounts(const FrameCounts& counts, const Groom& groom, const std::string& file, Byte place) {
    const FrameCounts wanted = frameCounts(groom);
    if (counts.points == wanted.points && counts.vertices == wanted.vertices &&
        counts.spheres == wanted.spheres)
        return {};
    return failIn(
        file, place,
        fmt::format("has {} points, {} vertices and {} spheres a frame", counts.points, counts.vertices,
                    counts.spheres),
        fmt::format("this groom has {}, {} and {}", wanted.points, wanted.vertices, wanted.spheres));
}

FrameVectors::FrameVectors(const Groom& groom) : bones_(frameCounts(groom).bones) {
    if (groom.scalp) scalpRest_.assign(groom.scalp->positions().begin(), groom.scalp->positions().end());
    for (const CollisionSphere& sphere : groom.spheres) sphereRest_.push_back(sphere.centre);
    bodyOnly_.body = groom.body;
}

void FrameVectors::appendHead(std::vector<Vec3f>& values, const HeadPose& pose) const {
    appendMoved(values, pose.scalpPositions_ws, scalpRest_, pose.head_ws);
    appendMoved(values, pose.sphereCentres_ws, sphereRest_, pose.head_ws);
}

void FrameVectors::appendBody(std::vector<Vec3f>& values, const HeadPose& pose) const {
    const auto toVec3 = [](runtime::Float3 v) { return Vec3f(v.x, v.y, v.z); };
    const auto poses = bodyAt(bodyOnly_, pose);
    for (std::uint64_t b = 0; b < bones_; ++b) {
        if (poses.empty()) {
            values.insert(values.end(), kVectorsPerBone, Vec3f::Zero());
            continue;
        }
        const runtime::BonePose& one = poses[poses.size() == 1 ? 0 : b];
        for (const runtime::Float3& column : {one.x, one.y, one.z, one.origin})
            values.push_back(toVec3(column));
    }
}

RecordedFrame frameFrom(std::span<const Vec3f> values, const FrameCounts& counts, const Groom& groom) {
    const auto take = [&](std::uint64_t count) {
        const auto part = values.first(static_cast<std::size_t>(count));
        values = values.subspan(part.size());
        return std::vector<Vec3f>(part.begin(), part.end());
    };
    RecordedFrame frame;
    frame.positions_ws = take(counts.points);
    frame.pose.scalpPositions_ws = take(counts.vertices);
    frame.pose.sphereCentres_ws = take(counts.spheres);
    if (counts.bones == frameCounts(groom).bones) frame.pose.body_ws = bodyOf(values);
    return frame;
}

}  // namespace hairloom
