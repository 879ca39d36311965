// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/usd_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace hairloom {
namespace {

/// A rotation about axes in turn, the first letter first: "XYZ".
Eigen::Matrix3d eulerRotation(std::string_view axes, const std::vector<double>& degrees) {
    Eigen::Matrix3d result = Eigen::Matrix3d::Identity();
    for (const char axis : axes) {
        const int index = axis - 'X';
        const double angle = degrees[static_cast<std::size_t>(index)] * M_PI / 180;
        result = Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(index)).toRotationMatrix() * result;
    }
    return result;
}

/// Numbers that an operation of the name takes; 0 for one that is not known.
std::size_t numbersOf(std::string_view kind) {
    if (kind == "transform") return 16;
    if (kind == "orient") return 4;
    if (kind == "rotateX" || kind == "rotateY" || kind == "rotateZ") return 1;
    if (kind == "translate" || kind == "scale") return 3;
    constexpr std::array<std::string_view, 6> kOrders{"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"};
    const bool euler =
        kind.starts_with("rotate") && std::ranges::find(kOrders, kind.substr(6)) != kOrders.end();
    return euler ? 3 : 0;
}

Eigen::Affine3d operation(std::string_view kind, const std::vector<double>& v) {
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    if (kind == "transform") {
        // Points are rows there: the matrix is the transpose of ours.
        result.matrix() = Eigen::Map<const Eigen::Matrix4d>(v.data());
    } else if (kind == "translate") {
        result.translate(Eigen::Vector3d(v[0], v[1], v[2]));
    } else if (kind == "scale") {
        result.scale(Eigen::Vector3d(v[0], v[1], v[2]));
    } else if (kind == "orient") {
        result.rotate(Eigen::Quaterniond(v[0], v[1], v[2], v[3]).normalized());
    } else if (v.size() == 1) {
        result.rotate(Eigen::AngleAxisd(v[0] * M_PI / 180, Eigen::Vector3d::Unit(kind.back() - 'X')));
    } else {
        result.rotate(eulerRotation(kind.substr(6), v));
    }
    return result;
}

Result<Eigen::Affine3d> transformOf(const UsdPrim& prim, std::string_view name, double time) {
    constexpr std::string_view kInvert = "!invert!", kPrefix = "xformOp:";
    const bool inverse = name.starts_with(kInvert);
    if (inverse) name.remove_prefix(kInvert.size());
    const UsdAttribute* const attribute = prim.find(name);
    if (attribute == nullptr || !name.starts_with(kPrefix)) return Eigen::Affine3d::Identity();
    std::string_view kind = name.substr(kPrefix.size());
    kind = kind.substr(0, kind.find(':'));
    const UsdValue value = valueAt(*attribute, time);
    // An operation without a value does nothing.
    if (value.numbers.empty()) return Eigen::Affine3d::Identity();
    const std::size_t wanted = numbersOf(kind);
    if (wanted == 0 || value.numbers.size() != wanted)
        return fail(fmt::format("{} of {} has {} numbers", name, prim.name, value.numbers.size()),
                    fmt::format("expected {} of a transform that is known", wanted));
    const Eigen::Affine3d result = operation(kind, value.numbers.doubles());
    return inverse ? Eigen::Affine3d(result.inverse()) : result;
}

/// Numbers of an instance at a time; nothing where there are too few. Those of all others are left alone.
std::vector<double> ofInstance(const UsdPrim& instancer, std::string_view name, std::size_t instance,
                               std::size_t components, double time) {
    const UsdAttribute* const attribute = instancer.find(name);
    if (attribute == nullptr) return {};
    const auto numbers = [&](const UsdValue& value) {
        std::vector<double> found;
        if (value.numbers.size() / components <= instance) return found;
        for (std::size_t c = 0; c < components; ++c)
            found.push_back(value.numbers[instance * components + c]);
        return found;
    };
    if (attribute->samples.empty()) return numbers(attribute->value);
    const auto after = attribute->samples.lower_bound(time);
    if (after == attribute->samples.begin()) return numbers(after->second);
    const auto before = std::prev(after);
    std::vector<double> value = numbers(before->second);
    if (after == attribute->samples.end()) return value;
    const std::vector<double> next = numbers(after->second);
    if (next.size() != value.size()) return value;
    const double t = (time - before->first) / (after->first - before->first);
    for (std::size_t c = 0; c < value.size(); ++c) value[c] = (1 - t) * value[c] + t * next[c];
    return value;
}

/// Scaled, turned, then moved.
Eigen::Affine3d instanceTransform(const UsdPrim& instancer, std::size_t instance, double time) {
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    if (const auto at = ofInstance(instancer, "positions", instance, 3, time); !at.empty())
        result.translate(Eigen::Vector3d(at[0], at[1], at[2]));
    for (const char* name : {"orientationsf", "orientations"}) {
        const auto turn = ofInstance(instancer, name, instance, 4, time);
        if (turn.empty()) continue;
        const Eigen::Quaterniond rotation(turn[0], turn[1], turn[2], turn[3]);
        if (rotation.norm() > 0) result.rotate(rotation.normalized());
        break;
    }
    if (const auto scale = ofInstance(instancer, "scales", instance, 3, time); !scale.empty())
        result.scale(Eigen::Vector3d(scale[0], scale[1], scale[2]));
    return result;
}

/// Quaternions from `numbers` towards `after`, the shorter way.
void turnBetween(UsdNumbers& numbers, const UsdNumbers& after, double share) {
    const auto at = [](const UsdNumbers& from, std::size_t i) {
        return Eigen::Quaterniond(from[i], from[i + 1], from[i + 2], from[i + 3]);
    };
    for (std::size_t i = 0; i + 3 < numbers.size(); i += 4) {
        const Eigen::Quaterniond turned = at(numbers, i).slerp(share, at(after, i));
        numbers.set(i, turned.w());
        for (int k = 0; k < 3; ++k) numbers.set(i + 1 + static_cast<std::size_t>(k), turned.vec()[k]);
    }
}

}  // namespace

UsdValue valueAt(const UsdAttribute& attribute, double time) {
    if (attribute.samples.empty()) return attribute.value;
    const auto after = attribute.samples.lower_bound(time);
    if (after == attribute.samples.begin()) return after->second;
    if (after == attribute.samples.end()) return std::prev(after)->second;
    if (after->first == time) return after->second;
    const auto before = std::prev(after);
    UsdValue value = before->second;
    if (value.numbers.size() != after->second.numbers.size() ||
        value.numbers.kind() == UsdNumbers::Kind::Whole)
        return value;
    const double t = (time - before->first) / (after->first - before->first);
    if (attribute.type.starts_with("quat")) {
        turnBetween(value.numbers, after->second.numbers, t);
        return value;
    }
    for (std::size_t i = 0; i < value.numbers.size(); ++i)
        value.numbers.set(i, (1 - t) * value.numbers[i] + t * after->second.numbers[i]);
    return value;
}

Result<Eigen::Affine3d> toFile(std::span<const UsdLevel> levels, double time) {
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    for (const UsdLevel& level : levels) {
        if (level.isInstance) {
            result = result * instanceTransform(*level.prim, level.instance, time);
            continue;
        }
        const UsdAttribute* const order = level.prim->find("xformOpOrder");
        if (order == nullptr) continue;
        for (const std::string& name : order->value.texts) {
            if (name == "!resetXformStack!") {
                result = Eigen::Affine3d::Identity();
                continue;
            }
            const auto one = transformOf(*level.prim, name, time);
            if (!one) return one;
            result = result * *one;
        }
    }
    if (!result.matrix().allFinite()) return fail("a transform is not finite", "expected numbers");
    return result;
}

void addTimes(std::span<const UsdLevel> levels, std::set<double>& times) {
    constexpr std::array<std::string_view, 4> kOfInstances{"positions", "orientations", "orientationsf",
                                                           "scales"};
    for (const UsdLevel& level : levels) {
        for (const UsdAttribute& attribute : level.prim->attributes) {
            const bool moves = level.isInstance
                                   ? std::ranges::find(kOfInstances, attribute.name) != kOfInstances.end()
                                   : attribute.name.starts_with("xformOp:");
            if (!moves) continue;
            for (const auto& [time, value] : attribute.samples) times.insert(time);
        }
    }
}

}  // namespace hairloom
