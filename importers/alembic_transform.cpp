// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/alembic_transform.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>

namespace hairloom {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

enum Kind : std::uint8_t { kScale, kTranslate, kRotate, kMatrix };  // then about X, Y and Z
constexpr std::array<std::size_t, 7> kNumbers{3, 3, 4, 16, 1, 1, 1};
constexpr double kRadians = M_PI / 180;

/// One operation of a transform: its kind, and its numbers.
Eigen::Affine3d operation(std::size_t kind, std::span<const double> values) {
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    const auto axis = [&](const Vector3d& direction, double degrees) {
        if (direction.norm() > 0) result.rotate(AngleAxisd(degrees * kRadians, direction.normalized()));
    };
    switch (kind) {
        case kScale:
            result.scale(Vector3d(values[0], values[1], values[2]));
            break;
        case kTranslate:
            result.translate(Vector3d(values[0], values[1], values[2]));
            break;
        case kRotate:
            axis(Vector3d(values[0], values[1], values[2]), values[3]);
            break;
        // Points are rows there: the matrix is the transpose of ours.
        case kMatrix:
            result.matrix() = Eigen::Map<const Eigen::Matrix4d>(values.data());
            break;
        default:
            axis(Vector3d::Unit(static_cast<Eigen::Index>(kind) - 4), values[0]);
            break;
    }
    return result;
}

/// Between two transforms that have nothing but a matrix.
Eigen::Affine3d between(const Eigen::Affine3d& a, const Eigen::Affine3d& b, double share) {
    Eigen::Matrix3d turnA, scaleA, turnB, scaleB;
    a.computeRotationScaling(&turnA, &scaleA);
    b.computeRotationScaling(&turnB, &scaleB);
    const Eigen::Quaterniond turn = Eigen::Quaterniond(turnA).slerp(share, Eigen::Quaterniond(turnB));
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    result.linear() = turn.toRotationMatrix() * ((1 - share) * scaleA + share * scaleB);
    result.translation() = (1 - share) * a.translation() + share * b.translation();
    return result;
}

Eigen::Affine3d operationAt(std::size_t kind, std::span<const double> before, std::span<const double> after,
                            double share) {
    if (share == 0) return operation(kind, before);
    const bool otherAxis = kind == kRotate && !std::equal(before.begin(), before.begin() + 3, after.begin());
    if (kind == kMatrix || otherAxis) return between(operation(kind, before), operation(kind, after), share);
    std::vector<double> values;
    for (std::size_t i = 0; i < before.size(); ++i)
        values.push_back((1 - share) * before[i] + share * after[i]);
    return operation(kind, values);
}

Result<Eigen::Affine3d> transformAt(const AlembicArchive& archive, const AlembicLevel& level,
                                    double seconds) {
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    const AlembicProperty* const ops = findProperty(level.xform, ".ops");
    const AlembicProperty* const vals = valuesOf(level);
    if (ops == nullptr || vals == nullptr || vals->samples == 0) return result;
    const auto kinds = archive.integers(*ops, 0);
    if (!kinds) return tl::unexpected(kinds.error());
    const SampleMoment moment = archive.momentOf(*vals, seconds);
    const auto before = archive.doubles(*vals, moment.before);
    if (!before) return tl::unexpected(before.error());
    const auto after = moment.share == 0 ? before : archive.doubles(*vals, moment.after);
    if (!after) return tl::unexpected(after.error());
    std::size_t at = 0;
    for (const std::int64_t op : *kinds) {
        const auto kind = static_cast<std::size_t>(op >> 4);
        if (op < 0 || kind >= kNumbers.size())
            return fail(fmt::format("{}: a transform has an operation {}", level.path, op),
                        "expected kinds 0 to 6");
        const std::size_t end = at + kNumbers[kind];
        if (end > before->size() || end > after->size())
            return fail(fmt::format("{}: a transform has {} numbers", level.path,
                                    std::min(before->size(), after->size())),
                        "expected as many as its operations take");
        const auto numbers = [&](const std::vector<double>& values) {
            return std::span(values).subspan(at, kNumbers[kind]);
        };
        result = result * operationAt(kind, numbers(*before), numbers(*after), moment.share);
        at = end;
    }
    if (!result.matrix().allFinite())
        return fail(level.path + ": a transform is not finite", "expected numbers");
    return result;
}

}  // namespace

Status addLevel(const AlembicArchive& archive, const AlembicObject& object, const AlembicProperty& xform,
                std::vector<AlembicLevel>& levels) {
    auto properties = archive.properties(xform);
    if (!properties) return tl::unexpected(properties.error());
    if (const AlembicProperty* const inherits = findProperty(*properties, ".inherits")) {
        const auto value = archive.integers(*inherits, 0);
        if (!value) return tl::unexpected(value.error());
        if (!value->empty() && value->front() == 0) levels.clear();
    }
    levels.push_back({object.path, std::move(*properties)});
    return {};
}

const AlembicProperty* valuesOf(const AlembicLevel& level) {
    return findProperty(level.xform, ".vals");
}

Result<Eigen::Affine3d> toFileAt(const AlembicArchive& archive, const std::vector<AlembicLevel>& levels,
                                 double seconds) {
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    for (const AlembicLevel& level : levels) {
        const auto one = transformAt(archive, level, seconds);
        if (!one) return one;
        result = result * *one;
    }
    return result;
}

}  // namespace hairloom
