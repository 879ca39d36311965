// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/mesh_reader/gltf_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "importers/mesh_reader/gltf_keys.h"
#include "importers/mesh_reader/tinygltf.h"
#include "importers/scene_parts.h"

namespace hairloom {
namespace {

Eigen::Affine3f localOf(const tinygltf::Node& node) {
    Eigen::Affine3f local = Eigen::Affine3f::Identity();
    if (node.matrix.size() == 16) {
        local.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data()).cast<float>();
        return local;
    }
    if (node.translation.size() == 3)
        local.translate(Eigen::Map<const Eigen::Vector3d>(node.translation.data()).cast<float>());
    if (node.rotation.size() == 4) {
        const Eigen::Quaterniond rotation(node.rotation[3], node.rotation[0], node.rotation[1],
                                          node.rotation[2]);
        if (rotation.norm() > 0) local.rotate(rotation.normalized().cast<float>());
    }
    if (node.scale.size() == 3)
        local.scale(Eigen::Map<const Eigen::Vector3d>(node.scale.data()).cast<float>());
    return local;
}

tl::unexpected<Error> noNode(const char* what, int node) {
    return fail(fmt::format("{} refers to node {}", what, node), "expected a node of the file");
}

}  // namespace

Result<GltfNodes> GltfNodes::make(const GltfFile& file, RawScene& scene) {
    GltfNodes nodes(file, scene);
    for (const auto step : {&GltfNodes::findParents, &GltfNodes::findShown, &GltfNodes::readSkins}) {
        if (auto status = (nodes.*step)(); !status) return tl::unexpected(status.error());
    }
    nodes.addBones();
    return nodes;
}

Status GltfNodes::findParents() {
    const auto& nodes = file_->model().nodes;
    parents_.assign(nodes.size(), kNoBone);
    for (std::uint32_t node = 0; node < nodes.size(); ++node) {
        for (const int child : nodes[node].children) {
            if (child < 0 || static_cast<std::size_t>(child) >= nodes.size())
                return noNode("a node's child", child);
            auto& parent = parents_[static_cast<std::size_t>(child)];
            if (parent != kNoBone) return fail(fmt::format("node {} has two parents", child));
            parent = node;
        }
    }
    // Each has one parent at most: what no root reaches goes round in a circle.
    if (inOrder().size() != nodes.size()) return fail("nodes form a cycle", "expected a tree");
    return {};
}

std::vector<std::uint32_t> GltfNodes::inOrder() const {
    const auto& nodes = file_->model().nodes;
    std::vector<std::uint32_t> waiting, order;
    for (auto node = static_cast<std::uint32_t>(nodes.size()); node-- > 0;) {
        if (parents_[node] == kNoBone) waiting.push_back(node);
    }
    while (!waiting.empty()) {
        const std::uint32_t node = waiting.back();
        waiting.pop_back();
        order.push_back(node);
        const auto& children = nodes[node].children;
        for (std::size_t child = children.size(); child-- > 0;)
            waiting.push_back(static_cast<std::uint32_t>(children[child]));
    }
    return order;
}

Status GltfNodes::findShown() {
    const tinygltf::Model& model = file_->model();
    if (model.scenes.empty()) {
        shown_ = inOrder();
        return {};
    }
    const auto asked = static_cast<std::size_t>(std::max(model.defaultScene, 0));
    const auto& roots = model.scenes[std::min(asked, model.scenes.size() - 1)].nodes;
    std::vector<bool> isShown(model.nodes.size(), false);
    for (const int root : roots) {
        if (root < 0 || static_cast<std::size_t>(root) >= isShown.size()) return noNode("the scene", root);
        isShown[static_cast<std::size_t>(root)] = true;
    }
    for (const std::uint32_t node : inOrder()) {
        if (parents_[node] != kNoBone && isShown[parents_[node]]) isShown[node] = true;
        if (isShown[node]) shown_.push_back(node);
    }
    return {};
}

Status GltfNodes::readSkins() {
    const tinygltf::Model& model = file_->model();
    for (const tinygltf::Skin& source : model.skins) {
        Skin skin;
        for (const int joint : source.joints) {
            if (joint < 0 || static_cast<std::size_t>(joint) >= model.nodes.size())
                return noNode("a skin", joint);
            skin.joints.push_back(static_cast<std::uint32_t>(joint));
        }
        skin.inverseBind.resize(skin.joints.size(), Eigen::Affine3f::Identity());
        if (source.inverseBindMatrices >= 0) {
            const auto matrices = file_->numbers(source.inverseBindMatrices, 16, "inverse bind matrices");
            if (!matrices) return tl::unexpected(matrices.error());
            if (matrices->size() / 16 < skin.joints.size())
                return fail(fmt::format("a skin has {} inverse bind matrices", matrices->size() / 16),
                            fmt::format("expected {}", skin.joints.size()));
            for (std::size_t joint = 0; joint < skin.joints.size(); ++joint)
                skin.inverseBind[joint].matrix() =
                    Eigen::Map<const Eigen::Matrix4f>(&(*matrices)[joint * 16]);
        }
        skins_.push_back(std::move(skin));
    }
    for (const tinygltf::Node& node : model.nodes) {
        if (node.skin >= 0 && static_cast<std::size_t>(node.skin) >= skins_.size())
            return fail(fmt::format("a node refers to skin {}", node.skin),
                        fmt::format("there are {}", skins_.size()));
    }
    return {};
}

void GltfNodes::addBones() {
    const tinygltf::Model& model = file_->model();
    std::vector<bool> isNeeded(model.nodes.size(), false);
    for (const Skin& skin : skins_) {
        for (const std::uint32_t joint : skin.joints) isNeeded[joint] = true;
    }
    for (const tinygltf::Animation& animation : model.animations) {
        for (const tinygltf::AnimationChannel& channel : animation.channels) {
            const auto node = static_cast<std::size_t>(std::max(channel.target_node, 0));
            if (channel.target_node < 0 || node >= isNeeded.size()) continue;
            // What morphs is carried by something, so that it goes where the character is placed.
            const bool isCarrier = model.nodes[node].mesh >= 0 && model.nodes[node].skin < 0;
            if (channel.target_path != "weights" || isCarrier) isNeeded[node] = true;
        }
    }
    const std::vector<std::uint32_t> order = inOrder();
    for (auto node = order.rbegin(); node != order.rend(); ++node) {
        if (isNeeded[*node] && parents_[*node] != kNoBone) isNeeded[parents_[*node]] = true;
    }
    boneOfNode_.assign(model.nodes.size(), kNoBone);
    for (const std::uint32_t node : order) {
        if (!isNeeded[node]) continue;
        boneOfNode_[node] = static_cast<std::uint32_t>(scene_->bones.size());
        Bone bone;
        bone.name = nameOf(node);
        bone.parent = parents_[node] == kNoBone ? kNoBone : boneOfNode_[parents_[node]];
        bone.rest = localOf(model.nodes[node]);
        bone.inverseBind = worldOf(node).inverse();
        // A bone that is scaled to nothing carries nothing.
        if (!bone.inverseBind.matrix().allFinite()) bone.inverseBind.setIdentity();
        scene_->bones.push_back(std::move(bone));
        bound_.push_back(false);
        duplicates_.emplace_back();
    }
}

std::string GltfNodes::nameOf(std::uint32_t node) const {
    const std::string& name = file_->model().nodes[node].name;
    return name.empty() ? fmt::format("node {}", node) : name;
}

Eigen::Affine3f GltfNodes::worldOf(std::uint32_t node) const {
    const auto& nodes = file_->model().nodes;
    Eigen::Affine3f world = localOf(nodes[node]);
    for (std::uint32_t above = parents_[node]; above != kNoBone; above = parents_[above])
        world = localOf(nodes[above]) * world;
    return world;
}

Eigen::Affine3f GltfNodes::meshToWorld(std::uint32_t node) const {
    const int number = file_->model().nodes[node].skin;
    if (number < 0) return worldOf(node);
    const Skin& skin = skins_[static_cast<std::size_t>(number)];
    std::size_t topmost = skin.joints.size();
    std::uint32_t fewest = kNoBone;
    for (std::size_t joint = 0; joint < skin.joints.size(); ++joint) {
        std::uint32_t depth = 0;
        for (std::uint32_t above = skin.joints[joint]; above != kNoBone; above = parents_[above]) ++depth;
        if (depth >= fewest) continue;
        fewest = depth;
        topmost = joint;
    }
    if (topmost == skin.joints.size()) return worldOf(node);
    return worldOf(skin.joints[topmost]) * skin.inverseBind[topmost];
}

std::uint32_t GltfNodes::boneFor(std::uint32_t bone, const Eigen::Affine3f& inverseBind) {
    auto& bones = scene_->bones;
    if (!bound_[bone]) {
        bound_[bone] = true;
        bones[bone].inverseBind = inverseBind;
        return bone;
    }
    const auto same = [&](std::uint32_t other) {
        return bones[other].inverseBind.isApprox(inverseBind, 1e-4f);
    };
    if (same(bone)) return bone;
    const auto found = std::ranges::find_if(duplicates_[bone], same);
    if (found != duplicates_[bone].end()) return *found;
    const auto added = static_cast<std::uint32_t>(bones.size());
    duplicates_[bone].push_back(added);
    Bone duplicate;
    duplicate.name = fmt::format("{} (bind {})", bones[bone].name, duplicates_[bone].size() + 1);
    duplicate.parent = bone;
    duplicate.inverseBind = inverseBind;
    bones.push_back(std::move(duplicate));
    bound_.push_back(true);
    duplicates_.emplace_back();
    return added;
}

std::uint32_t GltfNodes::carrierOf(std::uint32_t node) {
    for (std::uint32_t above = node; above != kNoBone; above = parents_[above]) {
        if (boneOfNode_[above] == kNoBone) continue;
        const Eigen::Affine3f worldToBone = worldOf(above).inverse();
        return worldToBone.matrix().allFinite() ? boneFor(boneOfNode_[above], worldToBone) : kNoBone;
    }
    return kNoBone;
}

Status GltfNodes::addWeights(std::uint32_t node, std::size_t count,
                             std::vector<std::vector<std::pair<std::uint32_t, float>>> influences) {
    SkinWeights& skin = scene_->skin;
    const std::size_t first = skin.weights.size();
    skin.bones.resize(first + count);
    skin.weights.resize(first + count);
    const int number = file_->model().nodes[node].skin;
    if (influences.empty() || number < 0) {
        const std::uint32_t carrier = carrierOf(node);
        if (carrier == kNoBone) return {};
        for (std::size_t vertex = 0; vertex < count; ++vertex)
            setStrongest(skin, first + vertex, {{carrier, 1.0f}});
        return {};
    }
    const Skin& source = skins_[static_cast<std::size_t>(number)];
    const Eigen::Affine3f worldToMesh = meshToWorld(node).inverse();
    std::vector<std::uint32_t> bones(source.joints.size(), kNoBone);
    for (std::size_t vertex = 0; vertex < count; ++vertex) {
        for (auto& [joint, weight] : influences[vertex]) {
            if (joint >= bones.size())
                return fail(fmt::format("a vertex refers to joint {}", joint),
                            fmt::format("there are {}", bones.size()));
            if (bones[joint] == kNoBone)
                bones[joint] =
                    boneFor(boneOfNode_[source.joints[joint]], source.inverseBind[joint] * worldToMesh);
            joint = bones[joint];
        }
        setStrongest(skin, first + vertex, std::move(influences[vertex]));
    }
    return {};
}

Result<Clip> GltfNodes::convertClip(std::size_t number, GltfMorphs& morphs) const {
    const tinygltf::Animation& animation = file_->model().animations[number];
    Clip clip;
    clip.name = animation.name.empty() ? fmt::format("clip {}", number + 1) : animation.name;
    std::vector<std::size_t> channelOfNode(boneOfNode_.size(), SIZE_MAX);
    for (const tinygltf::AnimationChannel& source : animation.channels) {
        const auto node = static_cast<std::size_t>(std::max(source.target_node, 0));
        if (source.target_node < 0 || source.target_path == "weights") continue;
        if (node >= boneOfNode_.size()) return noNode("a channel", source.target_node);
        if (channelOfNode[node] == SIZE_MAX) {
            channelOfNode[node] = clip.channels.size();
            clip.channels.emplace_back();
            clip.channels.back().bone = boneOfNode_[node];
        }
        if (auto status = readKeys(*file_, animation, source, clip.channels[channelOfNode[node]]); !status)
            return tl::unexpected(status.error());
    }
    for (std::size_t node = 0; node < channelOfNode.size(); ++node) {
        if (channelOfNode[node] == SIZE_MAX) continue;
        Channel& channel = clip.channels[channelOfNode[node]];
        clip.duration = std::max(clip.duration, lastTime(channel));
        fillFromRest(channel, localOf(file_->model().nodes[node]));
    }
    morphs.addChannels(animation, clip);
    return clip;
}

Status GltfNodes::addClips(GltfMorphs& morphs) {
    for (std::size_t number = 0; number < file_->model().animations.size(); ++number) {
        auto clip = convertClip(number, morphs);
        if (!clip) return tl::unexpected(clip.error());
        if (!clip->channels.empty() || !clip->morphs.empty()) scene_->clips.push_back(std::move(*clip));
    }
    return {};
}

}  // namespace hairloom
