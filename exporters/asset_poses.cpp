// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/asset_poses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "asset/pose_directions.h"
#include "core/groom/poses.h"

namespace hairloom {
namespace {

/// Metres: as the engine has it, a segment of a pose that is shorter has no direction of its own.
constexpr float kNoDirection = 1e-9f;

/// A value of each point of the groom, of those that are written.
template <class T>
std::vector<T> written(std::span<const T> values, const Groom& groom, const PreparedStrands& strands,
                       std::size_t strand) {
    const auto points = groom.strand(strands.sources[strand]);
    const auto own = values.subspan(groom.offsets[strands.sources[strand]], points.size());
    const std::size_t count = strands.offsets[strand + 1] - strands.offsets[strand];
    if (count != points.size()) return resampleValues(points, own, count);
    return {own.begin(), own.end()};
}

/// Of each segment, of length 1; that of the one before where it has none.
std::vector<Vec3f> directionsOf(std::span<const Vec3f> posed) {
    std::vector<Vec3f> directions;
    Vec3f direction = Vec3f::UnitY();
    for (std::size_t p = 1; p < posed.size(); ++p) {
        const Vec3f segment = posed[p] - posed[p - 1];
        if (segment.norm() > kNoDirection) direction = segment.normalized();
        directions.push_back(direction);
    }
    return directions;
}

std::span<const Vec3f> shapeOf(const Groom& groom, const GroomPose& pose) {
    const auto shape = groom.pointAttributes.view<Vec3f>(poseAttribute(pose.name));
    return shape.size() == groom.pointCount() ? shape : std::span<const Vec3f>();
}

}  // namespace

AssetPoses encodePoses(const Groom& groom, const PreparedStrands& strands) {
    AssetPoses encoded;
    for (const GroomPose& pose : groom.poses) {
        const auto shape = shapeOf(groom, pose);
        const std::string where = fmt::format("pose '{}'", pose.name);
        if (shape.empty()) {
            encoded.findings.push_back({Severity::Warning, "has no shape, so it was left out", where,
                                        "make the pose again, or remove it"});
            continue;
        }
        std::vector<std::uint8_t> shares;
        const std::vector<float> weights = poseWeights(groom, pose);
        for (std::size_t s = 0; s < strands.strandCount(); ++s) {
            for (const Vec3f& d : directionsOf(written<Vec3f>(shape, groom, strands, s)))
                encoded.directions.push_back(runtime::packedDirection({d.x(), d.y(), d.z()}));
            for (const float weight : written<float>(weights, groom, strands, s))
                shares.push_back(static_cast<std::uint8_t>(std::lround(255.0f * weight)));
        }
        asset::Pose record{};
        record.amount = pose.amount;
        const auto followed = std::ranges::count_if(shares, [](std::uint8_t share) { return share > 0; });
        if (followed == 0)
            encoded.findings.push_back({Severity::Warning, "no strand follows it", where,
                                        "paint its mask, raise its ramp, or remove it"});
        if (!std::ranges::all_of(shares, [](std::uint8_t share) { return share == 255; })) {
            encoded.weights.insert(encoded.weights.end(), shares.begin(), shares.end());
            record.weights = static_cast<std::uint32_t>(encoded.weights.size() / shares.size());
        }
        encoded.records.push_back(record);
        encoded.names.push_back(pose.name);
    }
    if (!encoded.records.empty() && groom.simulation.strandModel == runtime::StrandModel::springs)
        encoded.findings.push_back({Severity::Warning, "springs follow no pose", "poses",
                                    "set simulation.strandModel to rods, or choose it in the game"});
    return encoded;
}

double poseError(const Groom& groom, const PreparedStrands& strands, const runtime::Asset& file) {
    const runtime::Asset::Strands rest = file.strandsAtRest();
    double largest = 0;
    std::size_t number = 0;
    for (const GroomPose& pose : groom.poses) {
        const auto shape = shapeOf(groom, pose);
        if (shape.empty()) continue;
        const auto read = file.poseArrays(number++, rest);
        for (std::size_t s = 0; s < strands.strandCount(); ++s) {
            const auto posed = written<Vec3f>(shape, groom, strands, s);
            if (!knowsStrand(posed)) continue;
            const std::vector<Vec3f> directions = directionsOf(posed);
            Vec3d at = Vec3d::Zero();
            for (std::size_t p = 1; p < posed.size(); ++p) {
                const std::size_t point = strands.offsets[s] + p;
                const double length{(strands.positions[point] - strands.positions[point - 1]).norm()};
                at += directions[p - 1].cast<double>() * length;
                const runtime::Float3& played = read.positions_ss[point];
                largest = std::max(largest, (Vec3f(played.x, played.y, played.z).cast<double>() - at).norm());
            }
        }
    }
    return largest;
}

}  // namespace hairloom
