// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/poses.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/utf8.h"
#include "core/groom/file/fields.h"
#include "core/groom/groom.h"
#include "core/groom/strand_pairs.h"
#include "core/groom/time_line.h"
#include "core/groom/validate.h"

namespace hairloom {
namespace {

// clang-format off
constexpr Field<GroomPose> kPoseFields[] = {
    field<&GroomPose::amount>("amount", "", 0, 1, "how far hair follows the pose: 0 simulates it alone, 1 holds it there, except for collisions"),
    field<&GroomPose::mask>("mask", "", 0, kPaintedMasks, "painted mask of the strands that follow: 0 is all of them"),
    boolField<&GroomPose::invert>("invert", "uses one minus the mask"),
    rampField<&GroomPose::ramp>("ramp", "share of the amount from root to tip"),
};
// clang-format on

Status checkShape(std::span<const Vec3f> positions, std::size_t points) {
    if (positions.size() != points)
        return fail(fmt::format("the pose has {} points", positions.size()),
                    fmt::format("expected those of the groom, {}", points));
    const auto broken = std::ranges::find_if(positions, [](const Vec3f& position) {
        return !(position.cwiseAbs().maxCoeff() <= kFarthestPosed) || !position.allFinite();
    });
    if (broken == positions.end()) return {};
    const std::string point = fmt::format("point {} of the pose", broken - positions.begin());
    if (!broken->allFinite()) return fail(point + " is not finite", "expected a position in metres");
    return fail(point + " is far away", fmt::format("expected at most {} m from the origin", kFarthestPosed));
}

/// Metres from root to tip along the strand.
float lengthOf(std::span<const Vec3f> strand) {
    float length = 0;
    for (std::size_t p = 1; p < strand.size(); ++p) length += (strand[p] - strand[p - 1]).norm();
    return length;
}

}  // namespace

std::span<const runtime::Field<GroomPose>> fieldsOf(const GroomPose&) {
    return kPoseFields;
}

std::string poseAttribute(std::string_view name) {
    return std::string(kPosePrefix) + std::string(name);
}

std::optional<std::size_t> findPose(const Groom& groom, std::string_view name) {
    const auto found = std::ranges::find(groom.poses, name, &GroomPose::name);
    if (found == groom.poses.end()) return std::nullopt;
    return static_cast<std::size_t>(found - groom.poses.begin());
}

Result<std::size_t> placeOfPose(const Groom& groom, std::string_view name) {
    if (const auto found = findPose(groom, name)) return *found;
    std::vector<std::string> names;
    for (const GroomPose& pose : groom.poses) names.push_back(pose.name);
    return fail(
        fmt::format("no pose is called '{}'", name),
        names.empty() ? "the groom has none" : fmt::format("expected one of {}", fmt::join(names, ", ")));
}

bool knowsStrand(std::span<const Vec3f> posed) {
    return lengthOf(posed) > 0;
}

std::string freshPoseName(const Groom& groom) {
    for (std::size_t number = 1;; ++number) {
        std::string name = fmt::format("Pose {}", number);
        if (!findPose(groom, name)) return name;
    }
}

Status checkPoseName(std::string_view name) {
    const bool isPlain = std::ranges::none_of(name, [](char c) {
        return static_cast<unsigned char>(c) < 0x20 || c == '/' || c == ',' || c == '=';
    });
    const bool isText = cleanUtf8(std::string(name)) == name;
    if (!name.empty() && name.size() <= kMaxPoseName && isPlain && isText) return {};
    return fail(
        fmt::format("'{}' is no name of a pose", cleanUtf8(std::string(name))),
        fmt::format("expected 1 to {} bytes of UTF-8 without / , = and control characters", kMaxPoseName));
}

Status putPose(Groom& groom, const std::string& name, std::span<const Vec3f> positions) {
    if (auto status = checkPoseName(name); !status) return status;
    if (auto status = checkShape(positions, groom.pointCount()); !status) return status;
    if (!findPose(groom, name)) {
        if (groom.poses.size() >= kMaxGroomPoses)
            return fail(fmt::format("the groom has {} poses", groom.poses.size()),
                        fmt::format("expected at most {}: remove one", kMaxGroomPoses));
        groom.poses.emplace_back().name = name;
    }
    groom.pointAttributes.set(poseAttribute(name), std::vector<Vec3f>(positions.begin(), positions.end()));
    return {};
}

Status putPoseOf(Groom& groom, const std::string& name, const Groom& other) {
    const StrandPairs strands = pairStrands(groom, other);
    if (strands.removed > 0 || strands.added > 0)
        return fail(fmt::format("the strands of the pose are others: {} of {} are not there, and {} are new",
                                strands.removed, groom.strandCount(), strands.added),
                    "expected a groom of the same strands");
    std::vector<Vec3f> positions(groom.pointCount());
    for (const auto& [mine, theirs] : strands.pairs) {
        const auto points = other.strand(theirs);
        const std::size_t expected = groom.strand(mine).size();
        if (points.size() != expected)
            return fail(fmt::format("strand {} of the pose has {} points", theirs, points.size()),
                        fmt::format("expected {}, as it has here", expected));
        std::ranges::copy(points, positions.begin() + groom.offsets[mine]);
    }
    return putPose(groom, name, positions);
}

Status swapPose(Groom& groom, const std::string& name) {
    if (const auto found = placeOfPose(groom, name); !found) return tl::unexpected(found.error());
    if (!groom.operators.empty())
        return fail("operators make the shape of this hair", "bake or remove them, then swap");
    std::vector<Vec3f>& shape = groom.pointAttributes.edit<Vec3f>(poseAttribute(name));
    std::vector<Vec3f>& positions = groom.pointAttributes.edit<Vec3f>(attribute::kPosition);
    if (shape.size() != positions.size())
        return fail(fmt::format("the pose '{}' has no shape", name), "make it again, or remove it");
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const std::uint32_t begin = groom.offsets[s], end = groom.offsets[s + 1];
        if (!knowsStrand(std::span<const Vec3f>(shape).subspan(begin, end - begin))) continue;
        const Vec3f toRoot = positions[begin] - shape[begin];
        for (std::uint32_t p = begin; p < end; ++p) {
            const Vec3f posed = p == begin ? positions[p] : Vec3f(shape[p] + toRoot);
            shape[p] = positions[p];
            positions[p] = posed;
        }
    }
    return {};
}

Status removePose(Groom& groom, const std::string& name) {
    const auto found = placeOfPose(groom, name);
    if (!found) return tl::unexpected(found.error());
    groom.poses.erase(groom.poses.begin() + static_cast<std::ptrdiff_t>(*found));
    groom.pointAttributes.erase(poseAttribute(name));
    return {};
}

std::vector<float> poseWeights(const Groom& groom, const GroomPose& pose) {
    const auto shape = groom.pointAttributes.view<Vec3f>(poseAttribute(pose.name));
    const auto painted = pose.mask > 0 ? groom.strandAttributes.view<float>(maskAttribute(pose.mask))
                                       : std::span<const float>();
    std::vector<float> weights(groom.pointCount(), 0.0f);
    if (shape.size() != weights.size()) return weights;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const std::uint32_t begin = groom.offsets[s], end = groom.offsets[s + 1];
        if (!knowsStrand(shape.subspan(begin, end - begin))) continue;
        float share = pose.mask == 0 ? 1.0f : s < painted.size() ? painted[s] : 0.0f;
        if (pose.mask > 0 && pose.invert) share = 1 - share;
        const auto points = groom.strand(s);
        const float whole = lengthOf(points);
        float along = 0;
        for (std::uint32_t p = begin; p < end; ++p) {
            if (p > begin) along += (points[p - begin] - points[p - begin - 1]).norm();
            weights[p] = std::clamp(share * pose.ramp.at(whole > 0 ? std::min(along / whole, 1.0f) : 0.0f),
                                    0.0f, 1.0f);
        }
    }
    return weights;
}

PoseViews poseViews(const Groom& groom) {
    PoseViews poses;
    for (const GroomPose& pose : groom.poses) poses.weights.push_back(poseWeights(groom, pose));
    for (std::size_t k = 0; k < groom.poses.size(); ++k) {
        auto shape = groom.pointAttributes.view<Vec3f>(poseAttribute(groom.poses[k].name));
        if (shape.empty()) shape = groom.positions();  // nothing follows it
        poses.views.push_back(
            {{reinterpret_cast<const runtime::Float3*>(shape.data()), shape.size()}, poses.weights[k]});
    }
    return poses;
}

std::vector<float> poseAmounts(const Groom& groom) {
    std::vector<float> amounts;
    for (const GroomPose& pose : groom.poses) amounts.push_back(pose.amount);
    return amounts;
}

bool followsPoses(const Groom& groom) {
    const std::vector<SettingTrack>& tracks = timeLineOf(groom).settings;
    return std::ranges::any_of(groom.poses, [&](const GroomPose& pose) {
        return pose.amount > 0 ||
               std::ranges::find(tracks, poseAttribute(pose.name), &SettingTrack::name) != tracks.end();
    });
}

std::vector<Finding> findPoseProblems(const Groom& groom) {
    std::vector<Finding> problems;
    const auto add = [&](std::string what, const std::string& name, std::string fix) {
        problems.push_back(
            {Severity::Error, std::move(what), fmt::format("pose '{}'", name), std::move(fix)});
    };
    if (groom.poses.size() > kMaxGroomPoses)
        problems.push_back({Severity::Error, fmt::format("there are {} poses", groom.poses.size()), "poses",
                            fmt::format("keep at most {}", kMaxGroomPoses)});
    for (std::size_t k = 0; k < groom.poses.size(); ++k) {
        const GroomPose& pose = groom.poses[k];
        if (const auto named = checkPoseName(pose.name); !named)
            add(named.error().problem, pose.name, named.error().expected);
        if (findPose(groom, pose.name) != k) add("two poses have one name", pose.name, "rename one of them");
        for (const std::string& problem : fieldsOutOfRange(pose))
            add(problem, pose.name, "set it within its range");
        const auto shape = groom.pointAttributes.view<Vec3f>(poseAttribute(pose.name));
        const auto sound = checkShape(shape, groom.pointCount());
        if (shape.empty() && groom.pointCount() > 0)
            problems.push_back({Severity::Warning, "has no shape, so nothing follows it",
                                fmt::format("pose '{}'", pose.name), "make the pose again, or remove it"});
        else if (!sound)
            add(sound.error().problem, pose.name, "make the pose again, or remove it");
    }
    return problems;
}

}  // namespace hairloom
