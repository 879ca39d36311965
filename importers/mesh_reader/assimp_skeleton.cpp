// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/mesh_reader/assimp_skeleton.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "importers/scene_parts.h"

namespace hairloom {
namespace {

constexpr double kDefaultTicksPerSecond = 25.0;  // what assimp means by a rate of 0

Vec3f toVec(const aiVector3D& v) {
    return {v.x, v.y, v.z};
}
Quatf toVec(const aiQuaternion& q) {
    return Quatf(q.w, q.x, q.y, q.z);
}

/// Keys in seconds without those that do not come later than the one before.
template <class T, class Key>
Track<T> toTrack(const Key* keys, unsigned count, double ticksPerSecond) {
    Track<T> track;
    for (unsigned index = 0; index < count; ++index) {
        const auto time = static_cast<float>(keys[index].mTime / ticksPerSecond);
        if (!std::isfinite(time) || (!track.times.empty() && time <= track.times.back())) continue;
        track.times.push_back(time);
        track.values.push_back(toVec(keys[index].mValue));
    }
    return track;
}

unsigned depth(const aiNode* node) {
    unsigned levels = 0;
    for (; node->mParent; node = node->mParent) ++levels;
    return levels;
}

}  // namespace

Eigen::Affine3f toAffine(const aiMatrix4x4& m) {
    Eigen::Affine3f matrix = Eigen::Affine3f::Identity();
    matrix.matrix().topRows<3>() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4;
    return matrix;
}

SkeletonBuilder::SkeletonBuilder(const aiScene& source, const Eigen::Affine3f& toWorld,
                                 bool ignoreSkinnedNodes, const AssimpMorphs& morphs, RawScene& scene)
    : source_(source), toWorld_(toWorld), ignoreSkinnedNodes_(ignoreSkinnedNodes), scene_(scene) {
    std::vector<const aiNode*> waiting{source.mRootNode};
    while (!waiting.empty()) {
        const aiNode* node = waiting.back();
        waiting.pop_back();
        nodeOfName_.try_emplace(node->mName.C_Str(), node);
        for (unsigned child = 0; child < node->mNumChildren; ++child)
            waiting.push_back(node->mChildren[child]);
    }
    const auto need = [&](const aiString& name) {
        const auto found = nodeOfName_.find(name.C_Str());
        if (found == nodeOfName_.end()) return;
        for (const aiNode* node = found->second; node && needed_.insert(node).second;) node = node->mParent;
    };
    for (unsigned mesh = 0; mesh < source.mNumMeshes; ++mesh) {
        for (unsigned bone = 0; bone < source.mMeshes[mesh]->mNumBones; ++bone) {
            need(source.mMeshes[mesh]->mBones[bone]->mName);
        }
    }
    for (unsigned animation = 0; animation < source.mNumAnimations; ++animation) {
        for (unsigned channel = 0; channel < source.mAnimations[animation]->mNumChannels; ++channel) {
            need(source.mAnimations[animation]->mChannels[channel]->mNodeName);
        }
    }
    for (const auto& [name, node] : nodeOfName_) {
        const bool isSkinned =
            std::any_of(node->mMeshes, node->mMeshes + node->mNumMeshes,
                        [&](unsigned mesh) { return source.mMeshes[mesh]->mNumBones > 0; });
        // What morphs is carried by something, so that it goes where the character is placed.
        if (node->mNumMeshes > 0 && !isSkinned && morphs.isMoved(*node)) need(node->mName);
    }
    if (isNeeded(*source.mRootNode)) addBones(*source.mRootNode, kNoBone);
}

bool SkeletonBuilder::isNeeded(const aiNode& node) const {
    return needed_.contains(&node);
}

void SkeletonBuilder::addBones(const aiNode& node, std::uint32_t parent) {
    const auto index = static_cast<std::uint32_t>(scene_.bones.size());
    Bone bone;
    bone.name = node.mName.C_Str();
    bone.parent = parent;
    bone.rest = toAffine(node.mTransformation);
    if (parent == kNoBone) bone.rest = toWorld_ * bone.rest;
    bone.inverseBind = worldOf(node).inverse();
    // A bone that is scaled to nothing carries nothing.
    if (!bone.inverseBind.matrix().allFinite()) bone.inverseBind.setIdentity();
    scene_.bones.push_back(std::move(bone));
    boneOfNode_[&node] = index;
    bound_.push_back(false);
    duplicates_.emplace_back();
    for (unsigned child = 0; child < node.mNumChildren; ++child) {
        if (isNeeded(*node.mChildren[child])) addBones(*node.mChildren[child], index);
    }
}

Eigen::Affine3f SkeletonBuilder::worldOf(const aiNode& node) const {
    Eigen::Affine3f world = toAffine(node.mTransformation);
    for (const aiNode* above = node.mParent; above; above = above->mParent) {
        world = toAffine(above->mTransformation) * world;
    }
    return toWorld_ * world;
}

Eigen::Affine3f SkeletonBuilder::meshToWorld(const aiMesh& mesh, const aiNode& node) const {
    if (!ignoreSkinnedNodes_) return worldOf(node);
    const aiNode* topmost = nullptr;
    const aiBone* joint = nullptr;
    unsigned minimum = std::numeric_limits<unsigned>::max();
    for (unsigned index = 0; index < mesh.mNumBones; ++index) {
        const auto found = nodeOfName_.find(mesh.mBones[index]->mName.C_Str());
        if (found == nodeOfName_.end() || depth(found->second) >= minimum) continue;
        minimum = depth(found->second);
        topmost = found->second;
        joint = mesh.mBones[index];
    }
    if (!topmost) return worldOf(node);
    return worldOf(*topmost) * toAffine(joint->mOffsetMatrix);
}

std::uint32_t SkeletonBuilder::boneFor(std::uint32_t bone, const Eigen::Affine3f& inverseBind) {
    if (!bound_[bone]) {
        bound_[bone] = true;
        scene_.bones[bone].inverseBind = inverseBind;
        return bone;
    }
    const auto same = [&](std::uint32_t other) {
        return scene_.bones[other].inverseBind.isApprox(inverseBind, 1e-4f);
    };
    if (same(bone)) return bone;
    const auto found = std::ranges::find_if(duplicates_[bone], same);
    if (found != duplicates_[bone].end()) return *found;
    const auto added = static_cast<std::uint32_t>(scene_.bones.size());
    duplicates_[bone].push_back(added);
    Bone duplicate;
    duplicate.name = fmt::format("{} (bind {})", scene_.bones[bone].name, duplicates_[bone].size() + 1);
    duplicate.parent = bone;
    duplicate.inverseBind = inverseBind;
    scene_.bones.push_back(std::move(duplicate));
    bound_.push_back(true);
    duplicates_.emplace_back();
    return added;
}

std::uint32_t SkeletonBuilder::carrierOf(const aiNode& node) {
    for (const aiNode* above = &node; above; above = above->mParent) {
        const auto found = boneOfNode_.find(above);
        if (found == boneOfNode_.end()) continue;
        const Eigen::Affine3f worldToBone = worldOf(*above).inverse();
        return worldToBone.matrix().allFinite() ? boneFor(found->second, worldToBone) : kNoBone;
    }
    return kNoBone;
}

void SkeletonBuilder::addWeights(const aiMesh& mesh, const aiNode& node, const Eigen::Affine3f& meshToWorld) {
    const std::size_t first = scene_.skin.weights.size();
    scene_.skin.bones.resize(first + mesh.mNumVertices);
    scene_.skin.weights.resize(first + mesh.mNumVertices);
    std::vector<std::vector<std::pair<std::uint32_t, float>>> influences(mesh.mNumVertices);
    const Eigen::Affine3f worldToMesh = meshToWorld.inverse();
    for (unsigned index = 0; index < mesh.mNumBones; ++index) {
        const aiBone& joint = *mesh.mBones[index];
        const auto found = nodeOfName_.find(joint.mName.C_Str());
        if (found == nodeOfName_.end()) continue;
        const std::uint32_t bone =
            boneFor(boneOfNode_.at(found->second), toAffine(joint.mOffsetMatrix) * worldToMesh);
        for (unsigned weight = 0; weight < joint.mNumWeights; ++weight) {
            const aiVertexWeight& entry = joint.mWeights[weight];
            if (entry.mVertexId >= mesh.mNumVertices || !(entry.mWeight > 0)) continue;
            influences[entry.mVertexId].emplace_back(bone, entry.mWeight);
        }
    }
    if (mesh.mNumBones == 0) {
        const std::uint32_t carrier = carrierOf(node);
        if (carrier == kNoBone) return;
        for (auto& influence : influences) influence.emplace_back(carrier, 1.0f);
    }
    for (std::size_t vertex = 0; vertex < influences.size(); ++vertex) {
        setStrongest(scene_.skin, first + vertex, std::move(influences[vertex]));
    }
}

Clip SkeletonBuilder::convertClip(const aiAnimation& animation, AssimpMorphs& morphs) const {
    const double rate = animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : kDefaultTicksPerSecond;
    Clip clip;
    clip.name = animation.mName.C_Str();
    for (unsigned index = 0; index < animation.mNumChannels; ++index) {
        const aiNodeAnim& source = *animation.mChannels[index];
        const auto found = nodeOfName_.find(source.mNodeName.C_Str());
        if (found == nodeOfName_.end()) continue;
        const Eigen::Affine3f local = toAffine(found->second->mTransformation);
        Channel channel;
        channel.bone = boneOfNode_.at(found->second);
        channel.translation = toTrack<Vec3f>(source.mPositionKeys, source.mNumPositionKeys, rate);
        channel.rotation = toTrack<Quatf>(source.mRotationKeys, source.mNumRotationKeys, rate);
        channel.scale = toTrack<Vec3f>(source.mScalingKeys, source.mNumScalingKeys, rate);
        clip.duration = std::max(clip.duration, lastTime(channel));
        fillFromRest(channel, local);
        if (found->second == source_.mRootNode) {
            for (Vec3f& value : channel.translation.values) value = toWorld_ * value;
            for (Quatf& value : channel.rotation.values) value = Quatf(toWorld_.linear()) * value;
        }
        for (Quatf& value : channel.rotation.values) value.normalize();
        clip.channels.push_back(std::move(channel));
    }
    morphs.addChannels(animation, rate, clip);
    return clip;
}

void SkeletonBuilder::addClips(AssimpMorphs& morphs) {
    for (unsigned index = 0; index < source_.mNumAnimations; ++index) {
        Clip clip = convertClip(*source_.mAnimations[index], morphs);
        if (clip.name.empty()) clip.name = fmt::format("clip {}", index + 1);
        if (!clip.channels.empty() || !clip.morphs.empty()) scene_.clips.push_back(std::move(clip));
    }
}

}  // namespace hairloom
