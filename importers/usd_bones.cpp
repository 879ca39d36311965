// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/usd_bones.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace hairloom {
namespace {

constexpr std::size_t kMaxBones = 1u << 17u;
constexpr std::string_view kReset = "!resetXformStack!";

bool resets(const UsdLevel& level) {
    const UsdAttribute* const order = level.isInstance ? nullptr : level.prim->find("xformOpOrder");
    return order != nullptr && std::ranges::find(order->value.texts, kReset) != order->value.texts.end();
}

bool isMoving(const UsdLevel& level) {
    std::set<double> times;
    addTimes(std::span(&level, 1), times);
    return times.size() > 1;
}

/// A rotation and one factor, which bones can have before their own transform.
bool isSimilarity(const Eigen::Affine3d& transform) {
    const Eigen::Matrix3d squares = transform.linear().transpose() * transform.linear();
    const double factor = squares.trace() / 3;
    return factor > 0 && transform.linear().determinant() > 0 &&
           (squares - factor * Eigen::Matrix3d::Identity()).norm() < 1e-5 * factor;
}

Eigen::Affine3d matrixOf(const UsdAttribute* attribute, double time) {
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    if (attribute == nullptr) return result;
    const UsdValue value = valueAt(*attribute, time);
    if (value.components != 16 || value.numbers.size() != 16) return result;
    Eigen::Matrix4d matrix;
    for (std::size_t i = 0; i < 16; ++i) matrix.data()[i] = value.numbers[i];
    result.matrix().topRows<3>() = matrix.topRows<3>();
    return result.matrix().allFinite() ? result : Eigen::Affine3d::Identity();
}

/// A bone that is named twice has the sum of its weights.
void mergeRepeated(std::vector<std::pair<std::uint32_t, float>>& influences) {
    std::ranges::stable_sort(influences, {}, &std::pair<std::uint32_t, float>::first);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < influences.size(); ++i) {
        if (kept > 0 && influences[kept - 1].first == influences[i].first)
            influences[kept - 1].second += influences[i].second;
        else
            influences[kept++] = influences[i];
    }
    influences.resize(kept);
}

void takeTimes(const UsdAttribute& attribute, double& first, double& last) {
    if (attribute.samples.empty()) return;
    first = std::min(first, attribute.samples.begin()->first);
    last = std::max(last, attribute.samples.rbegin()->first);
}

void takeTimes(const UsdPrim& prim, double& first, double& last) {
    const bool isAnimation = prim.type == "SkelAnimation";
    for (const UsdAttribute& attribute : prim.attributes) {
        const bool isOfMesh = prim.type == "Mesh" && attribute.name == "points";
        if (isAnimation || isOfMesh || attribute.name.starts_with("xformOp:"))
            takeTimes(attribute, first, last);
    }
    for (const UsdPrim& child : prim.children) takeTimes(child, first, last);
}

}  // namespace

UsdRange rangeOf(const UsdStage& stage) {
    UsdRange range;
    const double rate = usdNumber(stage.metadata, "timeCodesPerSecond",
                                  usdNumber(stage.metadata, "framesPerSecond", range.codesPerSecond));
    if (rate > 0 && std::isfinite(rate)) range.codesPerSecond = rate;
    double first = std::numeric_limits<double>::infinity(), last = -first;
    takeTimes(stage.root, first, last);
    const double start = usdNumber(stage.metadata, "startTimeCode", first),
                 end = usdNumber(stage.metadata, "endTimeCode", last);
    range.isAuthored =
        std::isfinite(start) && std::isfinite(end) && start < end && start < last && end > first;
    if (range.isAuthored) {
        range.start = start;
        range.end = end;
    } else if (std::isfinite(first) && std::isfinite(last)) {
        range.start = first;
        range.end = last;
    }
    return range;
}

void UsdBones::say(std::string words) {
    constexpr std::size_t kMost = 64;
    std::vector<std::string>& all = scene_.warnings;
    if (all.size() < kMost && std::ranges::find(all, words) == all.end()) all.push_back(std::move(words));
}

Result<std::uint32_t> UsdBones::addBone(std::string name, std::uint32_t parent, const Eigen::Affine3d& rest) {
    if (scene_.bones.size() >= kMaxBones)
        return fail("its skeletons and their instances have more joints than are read",
                    fmt::format("expected at most {}", kMaxBones));
    Bone bone;
    bone.name = std::move(name);
    bone.parent = parent;
    bone.rest = rest.cast<float>();
    scene_.bones.push_back(std::move(bone));
    world_.push_back(parent == kNoBone ? rest : world_[parent] * rest);
    return static_cast<std::uint32_t>(scene_.bones.size() - 1);
}

void UsdBones::setBind(std::uint32_t bone, const Eigen::Affine3d& inverseBind) {
    // A bone that flattens carries nothing.
    if (inverseBind.matrix().cast<float>().allFinite())
        scene_.bones[bone].inverseBind = inverseBind.cast<float>();
}

Result<UsdBones::Carried> UsdBones::carriedBy(std::span<const UsdLevel> levels) {
    // What a prim that resets its transforms has above it does not reach it.
    for (std::size_t i = levels.size(); i-- > 0;) {
        if (!resets(levels[i])) continue;
        levels = levels.subspan(i);
        break;
    }
    Carried carried;
    Place place;
    std::size_t behind = 0;
    for (std::size_t i = 0; i < levels.size(); ++i) {
        place.emplace_back(levels[i].prim, levels[i].isInstance ? levels[i].instance + 1 : 0);
        if (!isMoving(levels[i])) continue;
        const auto own = levels.subspan(behind, i + 1 - behind);
        behind = i + 1;
        if (const auto known = movingPlaces_.find(place); known != movingPlaces_.end()) {
            carried.bone = known->second;
            continue;
        }
        auto rest = toFile(own, range_.start);
        if (!rest) return tl::unexpected(rest.error());
        const bool isTop = carried.bone == kNoBone;
        const auto bone =
            addBone(levels[i].prim->name, carried.bone, isTop ? Eigen::Affine3d(turn_ * *rest) : *rest);
        if (!bone) return tl::unexpected(bone.error());
        setBind(*bone, world_[*bone].inverse());
        moving_.push_back({*bone, {own.begin(), own.end()}, isTop});
        movingPlaces_.emplace(place, *bone);
        carried.bone = *bone;
    }
    const auto rest = toFile(levels.subspan(behind), range_.start);
    if (!rest) return tl::unexpected(rest.error());
    carried.rest = carried.bone == kNoBone ? Eigen::Affine3d(turn_ * *rest) : *rest;
    return carried;
}

Result<std::size_t> UsdBones::skeletonAt(const std::string& path, const UsdShownPrim& mesh) {
    std::vector<const UsdPrim*> prims{&stage_.root};
    const std::vector<const UsdPrim*> below = primsTo(stage_.root, path);
    prims.insert(prims.end(), below.begin(), below.end());
    if (below.empty() || prims.back()->type != "Skeleton") {
        say(fmt::format("{} is bound to the skeleton {}, which there is not: it is not skinned", mesh.path,
                        path));
        return SIZE_MAX;
    }
    // An instance's skeleton lies in the instance, too: both share the levels down to the prim that is above
    // both of them.
    std::vector<UsdLevel> levels;
    for (std::size_t l = mesh.levels.size(); l-- > 0 && levels.empty();) {
        if (mesh.levels[l].isInstance) continue;
        const auto common = std::ranges::find(prims, mesh.levels[l].prim);
        if (common == prims.end()) continue;
        levels.assign(mesh.levels.begin(), mesh.levels.begin() + static_cast<std::ptrdiff_t>(l) + 1);
        for (auto prim = common + 1; prim != prims.end(); ++prim) levels.push_back({*prim, false, 0});
    }
    Place place;
    for (const UsdLevel& level : levels)
        place.emplace_back(level.prim, level.isInstance ? level.instance + 1 : 0);
    if (const auto known = skeletonPlaces_.find(place); known != skeletonPlaces_.end()) return known->second;
    return addSkeleton(std::move(levels), std::move(place));
}

Result<std::size_t> UsdBones::addSkeleton(std::vector<UsdLevel> levels, Place place) {
    UsdSkeletonBones skeleton;
    skeleton.prim = levels.back().prim;
    std::vector<std::string> words;
    auto joints = readJoints(*skeleton.prim, range_.start, words);
    for (const std::string& word : words) say(fmt::format("the skeleton {} {}", skeleton.prim->name, word));
    if (!joints) {
        say(fmt::format("the skeleton {} {}: it moves nothing", skeleton.prim->name, joints.error().problem));
        skeletonPlaces_.emplace(std::move(place), SIZE_MAX);
        return SIZE_MAX;
    }
    skeleton.joints = std::move(*joints);
    const auto carried = carriedBy(levels);
    if (!carried) return tl::unexpected(carried.error());
    skeleton.levels = std::move(levels);
    skeleton.above = carried->bone;
    skeleton.base = carried->rest;
    if (auto status = addJoints(skeleton); !status) return tl::unexpected(status.error());
    skeletonPlaces_.emplace(std::move(place), skeletons_.size());
    skeletons_.push_back(std::move(skeleton));
    return skeletons_.size() - 1;
}

Status UsdBones::addJoints(UsdSkeletonBones& skeleton) {
    Eigen::Affine3d toWorld = skeleton.base;
    if (skeleton.above != kNoBone) toWorld = world_[skeleton.above] * skeleton.base;
    if (!isSimilarity(skeleton.base)) {
        // Joints cannot be sheared: what does so is a bone of its own.
        const auto bone = addBone(skeleton.prim->name, skeleton.above, skeleton.base);
        if (!bone) return tl::unexpected(bone.error());
        skeleton.above = skeleton.space = *bone;
        skeleton.base = Eigen::Affine3d::Identity();
    }
    const std::vector<UsdJoint>& joints = skeleton.joints;
    std::vector<std::size_t> order(joints.size());
    for (std::size_t j = 0; j < order.size(); ++j) order[j] = j;
    std::ranges::stable_sort(order, {}, [&](std::size_t j) { return joints[j].path.size(); });
    skeleton.bones.resize(joints.size());
    // Meshes stand where the topmost joint carries what was bound to it, as in glTF.
    const auto top = std::ranges::find_if(
        order, [&](std::size_t j) { return joints[j].parent == kNoJoint && joints[j].isBound; });
    skeleton.carried = toWorld;
    if (top != order.end()) skeleton.carried = toWorld * joints[*top].world * joints[*top].bind.inverse();
    const Eigen::Affine3d fromWorld = skeleton.carried.inverse();
    for (const std::size_t j : order) {
        const bool isTop = joints[j].parent == kNoJoint;
        const auto bone = addBone(joints[j].name, isTop ? skeleton.above : skeleton.bones[joints[j].parent],
                                  isTop ? Eigen::Affine3d(skeleton.base * joints[j].rest) : joints[j].rest);
        if (!bone) return tl::unexpected(bone.error());
        skeleton.bones[j] = *bone;
        if (joints[j].isBound) setBind(*bone, joints[j].bind.inverse() * fromWorld);
    }
    if (skeleton.space != kNoBone) setBind(skeleton.space, fromWorld);
    return {};
}

std::uint32_t UsdBones::spaceOf(UsdSkeletonBones& skeleton) {
    if (skeleton.space != kNoBone) return skeleton.space;
    const auto bone = addBone(skeleton.prim->name, skeleton.above, skeleton.base);
    if (!bone) return kNoBone;
    setBind(*bone, skeleton.carried.inverse());
    return skeleton.space = *bone;
}

Result<bool> UsdBones::skin(const UsdShownPrim& mesh, std::size_t points, UsdBinding& binding) {
    const UsdAttribute* const joints = inheritedOf(mesh.levels, "primvars:skel:jointIndices");
    const UsdAttribute* const shares = inheritedOf(mesh.levels, "primvars:skel:jointWeights");
    const auto path = targetOf(mesh.levels, "skel:skeleton");
    if (joints == nullptr || shares == nullptr || !path) return false;
    const auto isRoot = [](const UsdLevel& level) { return level.prim->type == "SkelRoot"; };
    if (std::ranges::none_of(mesh.levels, isRoot)) {
        say(fmt::format("{} has weights, but lies in no SkelRoot, outside of which USD skins nothing",
                        mesh.path));
        return false;
    }
    const UsdNumbers indices = valueAt(*joints, range_.start).numbers,
                     weights = valueAt(*shares, range_.start).numbers;
    const bool isConstant =
        joints->interpolation == "constant" ||
        (joints->interpolation.empty() && static_cast<double>(indices.size()) == joints->elementSize);
    const std::size_t owners = isConstant ? 1 : points;
    if (indices.size() != weights.size() || indices.empty() || owners == 0 || indices.size() % owners != 0) {
        say(fmt::format("{} has {} joint indices and {} weights for {} points: it is not skinned", mesh.path,
                        indices.size(), weights.size(), points));
        return false;
    }
    const auto number = skeletonAt(*path, mesh);
    if (!number) return tl::unexpected(number.error());
    if (*number == SIZE_MAX) return false;
    UsdSkeletonBones& skeleton = skeletons_[*number];
    readWeights(mesh, indices, weights, owners, skeleton, binding.skin);
    if (isConstant) {
        const auto bones = binding.skin.bones.front();
        const auto strengths = binding.skin.weights.front();
        binding.skin.bones.assign(points, bones);
        binding.skin.weights.assign(points, strengths);
    }
    binding.toWorld = skeleton.carried *
                      matrixOf(inheritedOf(mesh.levels, "primvars:skel:geomBindTransform"), range_.start);
    const UsdAttribute* const method = inheritedOf(mesh.levels, "primvars:skel:skinningMethod");
    if (method != nullptr && !method->value.texts.empty() && method->value.texts.front() == "dualQuaternion")
        say("skinning by dual quaternions is done linearly");
    return true;
}

void UsdBones::readWeights(const UsdShownPrim& mesh, const UsdNumbers& indices, const UsdNumbers& weights,
                           std::size_t owners, UsdSkeletonBones& skeleton, SkinWeights& skin) {
    std::vector<std::size_t> ofMesh(skeleton.joints.size());
    for (std::size_t j = 0; j < ofMesh.size(); ++j) ofMesh[j] = j;
    if (const UsdAttribute* const own = inheritedOf(mesh.levels, "skel:joints");
        own != nullptr && !own->value.texts.empty())
        ofMesh = jointsNamed(skeleton.joints, own->value.texts);
    std::size_t beyond = 0, bad = 0, tooMany = 0, unmoved = 0;
    std::vector<std::pair<std::uint32_t, float>> influences;
    const auto add = [&](std::size_t i) {
        const auto weight = static_cast<float>(weights[i]);
        const std::int64_t index = indices.whole(i);
        if (weight == 0) return;
        if (!(weight > 0) || !std::isfinite(weight)) {
            ++bad;
            return;
        }
        if (index < 0 || static_cast<std::size_t>(index) >= ofMesh.size()) {
            ++beyond;
            return;
        }
        const std::size_t joint = ofMesh[static_cast<std::size_t>(index)];
        if (joint != kNoJoint && !skeleton.joints[joint].isBound) return;
        // What is bound to a joint that the skeleton does not have stays in the skeleton's space.
        const std::uint32_t bone = joint == kNoJoint ? spaceOf(skeleton) : skeleton.bones[joint];
        if (bone != kNoBone) influences.emplace_back(bone, weight);
    };
    const std::size_t each = indices.size() / owners;
    skin.bones.resize(owners);
    skin.weights.resize(owners);
    for (std::size_t owner = 0; owner < owners; ++owner) {
        influences.clear();
        for (std::size_t i = owner * each; i < (owner + 1) * each; ++i) add(i);
        mergeRepeated(influences);
        tooMany += influences.size() > kBonesOfVertex;
        unmoved += influences.empty();
        if (influences.empty() && skeleton.above != kNoBone) {
            if (const std::uint32_t bone = spaceOf(skeleton); bone != kNoBone)
                influences.emplace_back(bone, 1.0f);
        }
        setStrongest(skin, owner, influences);
    }
    const auto tell = [&](std::size_t count, const char* what) {
        if (count > 0) say(fmt::format("{}: {} {}", mesh.path, count, what));
    };
    tell(beyond, "weights name joints that there are not; they were left out");
    tell(bad, "weights are negative or no numbers; they were left out");
    tell(tooMany, "points have more than eight joints; the strongest eight were taken");
    tell(unmoved, "points have no weights; they stay where they rest");
}

Result<UsdBinding> UsdBones::bind(const UsdShownPrim& mesh, std::size_t points) {
    UsdBinding binding;
    const auto isSkinned = skin(mesh, points, binding);
    if (!isSkinned) return tl::unexpected(isSkinned.error());
    if (*isSkinned) return binding;
    const auto carried = carriedBy(mesh.levels);
    if (!carried) return tl::unexpected(carried.error());
    const bool isCarried = carried->bone != kNoBone;
    binding.toWorld = isCarried ? world_[carried->bone] * carried->rest : carried->rest;
    binding.skin.bones.assign(points, {isCarried ? carried->bone : 0});
    binding.skin.weights.assign(points, {isCarried ? 1.0f : 0.0f});
    return binding;
}

Status UsdBones::addShapes(const UsdShownPrim& mesh, std::uint32_t first, std::size_t points,
                           const Eigen::Affine3d& toWorld) {
    const UsdAttribute* const names = inheritedOf(mesh.levels, "skel:blendShapes");
    if (names == nullptr || names->value.texts.empty()) return {};
    const UsdAttribute* const targets = mesh.prim->find("skel:blendShapeTargets");
    const std::size_t count = targets == nullptr ? 0 : targets->value.texts.size();
    if (count != names->value.texts.size()) {
        say(fmt::format("{} has {} blend shapes and {} targets of them: they stay at 0", mesh.path,
                        names->value.texts.size(), count));
        return {};
    }
    const auto path = targetOf(mesh.levels, "skel:skeleton");
    const auto number = path ? skeletonAt(*path, mesh) : Result<std::size_t>(SIZE_MAX);
    if (!number) return tl::unexpected(number.error());
    if (*number == SIZE_MAX) {
        say(fmt::format("{} has blend shapes and no skeleton whose animation moves them: they stay at 0",
                        mesh.path));
        return {};
    }
    for (std::size_t s = 0; s < count; ++s) {
        const std::vector<const UsdPrim*> prims = primsTo(stage_.root, targets->value.texts[s]);
        const std::string& name = names->value.texts[s];
        if (prims.empty() || prims.back()->type != "BlendShape") {
            say(fmt::format("{} has the blend shape {}, which there is not: it stays at 0", mesh.path, name));
            continue;
        }
        skeletons_[*number].shapes.push_back(
            {name, prims.back(), mesh.path, first, static_cast<std::uint32_t>(points), toWorld});
    }
    return {};
}

Status UsdBones::addClips(Clip clip) {
    return addUsdClips(stage_, range_, turn_, moving_, skeletons_, std::move(clip), scene_);
}

}  // namespace hairloom
