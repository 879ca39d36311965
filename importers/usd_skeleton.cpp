// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/usd_skeleton.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>

namespace hairloom {
namespace {

constexpr std::size_t kMaxJoints = 65'536;

std::string_view withoutSlash(std::string_view path) {
    return path.starts_with('/') ? path.substr(1) : path;
}

/// One matrix for each joint; nothing where there are more or fewer, or some are no numbers.
std::optional<std::vector<Eigen::Affine3d>> matricesOf(const UsdPrim& prim, std::string_view name,
                                                       std::size_t count, double time) {
    const UsdAttribute* const attribute = prim.find(name);
    if (attribute == nullptr) return std::nullopt;
    const UsdValue value = valueAt(*attribute, time);
    constexpr std::size_t kNumbers = 16;
    if (value.components != kNumbers || value.numbers.size() != kNumbers * count) return std::nullopt;
    std::vector<Eigen::Affine3d> matrices(count);
    for (std::size_t m = 0; m < count; ++m) {
        // Points are rows there: the matrix is the transpose of ours.
        Eigen::Matrix4d matrix;
        for (std::size_t i = 0; i < kNumbers; ++i) matrix.data()[i] = value.numbers[m * kNumbers + i];
        matrices[m] = Eigen::Affine3d::Identity();
        matrices[m].matrix().topRows<3>() = matrix.topRows<3>();
        if (!matrices[m].matrix().allFinite()) return std::nullopt;
    }
    return matrices;
}

/// The parts of paths as a tree, so that each is looked at once however deep they are.
class PathTree {
  public:
    /// The joint above a path, which is `joint`'s from here on where it has none yet. Paths above come first.
    std::size_t add(std::string_view path, std::size_t joint) {
        std::size_t node = 0, above = kNoJoint;
        while (true) {
            const std::size_t end = std::min(path.find('/'), path.size());
            const auto [next, isNew] =
                children_.try_emplace({node, std::string(path.substr(0, end))}, joints_.size());
            if (isNew) joints_.push_back(kNoJoint);
            node = next->second;
            if (end == path.size()) break;
            if (joints_[node] != kNoJoint) above = joints_[node];
            path.remove_prefix(end + 1);
        }
        if (joints_[node] == kNoJoint) joints_[node] = joint;
        return above;
    }

  private:
    std::map<std::pair<std::size_t, std::string>, std::size_t> children_;
    std::vector<std::size_t> joints_{kNoJoint};
};

bool isInvertible(const Eigen::Affine3d& transform) {
    return transform.inverse().matrix().allFinite() && transform.linear().determinant() != 0;
}

}  // namespace

Result<std::vector<UsdJoint>> readJoints(const UsdPrim& skeleton, double time,
                                         std::vector<std::string>& words) {
    const UsdAttribute* const names = skeleton.find("joints");
    const std::vector<std::string> paths = names == nullptr ? std::vector<std::string>() : names->value.texts;
    if (paths.empty()) return fail("has no joints", "expected joints by their paths");
    if (paths.size() > kMaxJoints)
        return fail(fmt::format("has {} joints", paths.size()),
                    fmt::format("expected at most {}", kMaxJoints));
    auto rest = matricesOf(skeleton, "restTransforms", paths.size(), time);
    auto bind = matricesOf(skeleton, "bindTransforms", paths.size(), time);
    if (!rest && !bind)
        return fail("has neither rest nor bind transforms of its joints",
                    fmt::format("expected {} matrices of numbers", paths.size()));
    if (!rest) words.emplace_back("has no rest transforms of its joints: they rest where meshes were bound");
    if (!bind) words.emplace_back("has no bind transforms of its joints: meshes were bound where they rest");

    std::vector<UsdJoint> joints(paths.size());
    std::unordered_map<std::string_view, std::size_t> ofName;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        joints[j].path = withoutSlash(paths[j]);
        ++ofName[std::string_view(joints[j].path).substr(joints[j].path.rfind('/') + 1)];
    }
    // Paths above are shorter.
    std::vector<std::size_t> order(joints.size());
    for (std::size_t j = 0; j < order.size(); ++j) order[j] = j;
    std::ranges::stable_sort(order, {}, [&](std::size_t j) { return joints[j].path.size(); });
    PathTree tree;
    for (const std::size_t j : order) {
        UsdJoint& joint = joints[j];
        const std::string last = joint.path.substr(joint.path.rfind('/') + 1);
        joint.name = ofName[last] > 1 ? joint.path : last;
        if (joint.name.empty()) joint.name = fmt::format("joint {}", j);
        joint.parent = tree.add(joint.path, j);
        const bool isRoot = joint.parent == kNoJoint;
        if (bind) joint.bind = (*bind)[j];
        if (rest) {
            joint.rest = (*rest)[j];
        } else {
            joint.rest =
                isRoot ? joint.bind : Eigen::Affine3d(joints[joint.parent].bind.inverse() * joint.bind);
            if (!joint.rest.matrix().allFinite()) joint.rest = Eigen::Affine3d::Identity();
        }
        joint.world = isRoot ? joint.rest : joints[joint.parent].world * joint.rest;
        if (!bind) joint.bind = joint.world;
        joint.isBound = isInvertible(joint.bind);
    }
    const auto unbound = std::ranges::count(joints, false, &UsdJoint::isBound);
    if (unbound > 0)
        words.push_back(
            fmt::format("has {} joints whose bind transforms flatten: they move nothing", unbound));
    return joints;
}

std::vector<std::size_t> jointsNamed(const std::vector<UsdJoint>& joints,
                                     const std::vector<std::string>& paths) {
    std::unordered_map<std::string_view, std::size_t> places;
    for (std::size_t j = 0; j < joints.size(); ++j) places.try_emplace(joints[j].path, j);
    std::vector<std::size_t> found;
    for (const std::string& path : paths) {
        const auto place = places.find(withoutSlash(path));
        found.push_back(place == places.end() ? kNoJoint : place->second);
    }
    return found;
}

std::vector<const UsdPrim*> primsTo(const UsdPrim& root, std::string_view path) {
    std::vector<const UsdPrim*> prims;
    const UsdPrim* prim = &root;
    path = withoutSlash(path);
    while (!path.empty()) {
        const std::size_t end = std::min(path.find('/'), path.size());
        prim = prim->child(path.substr(0, end));
        if (prim == nullptr) return {};
        prims.push_back(prim);
        path.remove_prefix(std::min(end + 1, path.size()));
    }
    return prims;
}

std::optional<std::string> targetOf(std::span<const UsdLevel> levels, std::string_view relationship) {
    for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
        const UsdAttribute* const found = level->isInstance ? nullptr : level->prim->find(relationship);
        if (found == nullptr || !found->value.isThere()) continue;
        if (found->value.texts.empty()) return std::nullopt;
        return found->value.texts.front();
    }
    return std::nullopt;
}

const UsdAttribute* inheritedOf(std::span<const UsdLevel> levels, std::string_view attribute) {
    for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
        const UsdAttribute* const found = level->isInstance ? nullptr : level->prim->find(attribute);
        if (found != nullptr && found->hasValue()) return found;
    }
    return nullptr;
}

}  // namespace hairloom
