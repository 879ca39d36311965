// SPDX-License-Identifier: MIT
// What an instance holds at most, before it is made.

#include <algorithm>

#include "engine/body_table.h"
#include "engine/moving_body.h"
#include "engine/state.h"
#include "engine/strand_model.h"
#include "hairloom/capsules.h"
#include "play/instance.h"

namespace hairloom::runtime {
namespace {

/// More than a block's report takes.
constexpr std::size_t kReportBytes = 1024;

/// Of an engine at most, beside what threads work in; `strandsOf` counts strands by their points.
std::size_t engineBytes(const Map<std::uint32_t, std::size_t>& strandsOf, bool hasBody, std::size_t poses) {
    // Strands of one point count fill blocks; straight ones and others are apart, and the last of each has
    // room to spare.
    std::size_t planeFloats = 0, blocks = 0, strands = 0;
    for (const auto& [points, count] : strandsOf) {
        const std::size_t more = count / kBlockLanes + std::min<std::size_t>(count, 2);
        blocks += more;
        planeFloats += more * (std::size_t{points} * kBlockLanes + kPlanePadding);
        strands += count;
    }
    std::size_t most = 0, mostOfPoses = 0, laneRows = 0;
    for (const Model* const model : allModels()) {
        most = std::max(most, model->mostPlanes);
        if (model->posePlanes) mostOfPoses = std::max(mostOfPoses, model->posePlanes(poses));
        std::size_t rows = 0;
        for (const OwnArray& array : model->own) rows += array.laneRows;
        laneRows = std::max(laneRows, rows);
    }
    const std::size_t planes = kRestPlanes + kStatePlanes + most +
                               (hasBody ? kBodyPlanes + 1 + kFoldPlanes : 0) + mostOfPoses +
                               PoseSet::kPosePlanes * poses;
    const std::size_t lanes =
        (2 * kRootRows + laneRows) * kBlockLanes * sizeof(float) + sizeof(Block) + kReportBytes;
    return planeFloats * planes * sizeof(float) + blocks * lanes +
           strands * (sizeof(RootFrame) + sizeof(std::uint32_t));
}

/// Of spheres and capsules, at rest and in a frame.
std::size_t sphereBytes(const Asset& asset) {
    const auto capsules = static_cast<std::size_t>(std::count_if(
        asset.spheres.begin(), asset.spheres.end(), [](const auto& sphere) { return sphere.joined > 0; }));
    const std::size_t along = kMaxAlongCapsule * (sizeof(Sphere) + sizeof(Float3) + 2 * sizeof(MovingSphere));
    return asset.spheres.size() * (sizeof(asset::Sphere) + 4 * sizeof(MovingSphere) + 3) +
           capsules * (along + 4 * sizeof(Capsule) + 3 * sizeof(MovingCapsule));
}

/// What HL_LEVELS adds; strands of a level have at most the points of the longest.
std::size_t levelBytes(const Asset& asset, std::uint32_t longest, std::size_t thread, std::size_t bodyTable) {
    const std::size_t strands = asset.strandCount(), points = asset.pointCount();
    const std::size_t poses = asset.poses().size();
    std::size_t bytes = (poses > 0 ? 2 * points * sizeof(Float3) : 0) + 2 * points * sizeof(Float3) +
                        2 * strands * sizeof(RootFrame) +
                        (strands + 2 * asset.guides.size() + 4) * sizeof(std::uint32_t) + sizeof(LevelSet);
    for (std::uint32_t level = 1; level < HL_LEVEL_RIGID; ++level) {
        Map<std::uint32_t, std::size_t> strandsOf;
        const std::uint32_t guides = guidesOfLevel(level, asset.strandCount());
        // Whichever guides are taken, they have no more points than as many of the longest.
        strandsOf[pointsOfLevel(level, longest)] = guides;
        const std::size_t blocksMore = strandsByPoints(asset).size() * 2;
        const bool hasBody = bodyTable > 0;
        bytes += engineBytes(strandsOf, hasBody, poses) + bodyTable + thread +
                 blocksMore * engineBytes({{longest, 1}}, hasBody, poses) + strands * sizeof(Level::Sources) +
                 guides * 2 * sizeof(std::uint32_t) + 3 * std::size_t{guides} * longest * sizeof(Float3) +
                 sizeof(Level) + sizeof(Engine) + (poses > 0 ? sizeof(PoseSet) : 0);
        bytes += sphereBytes(asset);
    }
    return bytes;
}

}  // namespace

std::size_t ownBytes(std::size_t strands, std::size_t points, std::size_t velocities) {
    return strands * (sizeof(RootFrame) + sizeof(Quat) + sizeof(std::uint32_t)) +
           (points + velocities) * sizeof(Float3);
}

Map<std::uint32_t, std::size_t> strandsByPoints(const Asset& asset) {
    Map<std::uint32_t, std::size_t> strandsOf;
    for (const asset::Strand& strand : asset.strands) ++strandsOf[strand.points];
    return strandsOf;
}

bool hasMaterials(const Asset& asset) {
    return std::any_of(asset.layers.begin(), asset.layers.end(),
                       [](const asset::Layer& layer) { return layer.ownMaterial != 0; });
}

InstanceMemory instanceMemory(const Asset& asset) {
    const Map<std::uint32_t, std::size_t> strandsOf = strandsByPoints(asset);
    const std::uint32_t longest = strandsOf.empty() ? 0 : strandsOf.rbegin()->first;
    std::size_t work = 0;
    for (const Model* const model : allModels())
        work = std::max(work, model->laneFloats + model->mostSolverFloats() * std::size_t{longest});
    const std::size_t thread = sizeof(LaneFrame) + (work + kSolverPadding) * sizeof(float);
    const std::size_t strands = asset.strandCount(), points = asset.pointCount(), hairs = asset.hairCount();
    const BodyFieldRead body = asset.readBody();
    const std::size_t bodyTable = body.field ? BodyTable::bytesFor(*body.field) : 0;
    const std::size_t poses = asset.poses().size();
    const std::size_t ofPoses = poses > 0 ? sizeof(PoseSet) + poses * sizeof(float) : 0;
    const std::size_t guides = engineBytes(strandsOf, bodyTable > 0, poses) + ofPoses + bodyTable + thread +
                               (body.field ? body.field->bytes() : 0) + sphereBytes(asset) +
                               ownBytes(strands, points, 0) + asset.radii.size() * sizeof(float) +
                               RootPoses::bytesFor(asset);
    // Speeds are kept for follow hairs and for levels.
    const std::size_t levels = levelBytes(asset, longest, thread, bodyTable) + points * sizeof(Float3);
    if (hairs == 0) return {guides, 0, levels, thread};
    const std::uint32_t pointsPerHair = asset.recipe[0].pointsPerHair;
    return {guides,
            FollowHairs::bytesFor(strands, hairs, pointsPerHair) +
                (asset.guides.size() + 1) * sizeof(std::uint32_t) +
                (hasMaterials(asset) ? asset.guides.size() * 2 * sizeof(float) : 0) + points * sizeof(Float3),
            levels, thread};
}

}  // namespace hairloom::runtime
