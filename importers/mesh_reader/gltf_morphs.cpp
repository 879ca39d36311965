// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/mesh_reader/gltf_morphs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "importers/mesh_reader/gltf_keys.h"
#include "importers/mesh_reader/tinygltf.h"
#include "importers/scene_parts.h"

namespace hairloom {
namespace {

const tinygltf::Mesh* meshOf(const tinygltf::Model& model, const tinygltf::Node& node) {
    const bool exists = node.mesh >= 0 && static_cast<std::size_t>(node.mesh) < model.meshes.size();
    return exists ? &model.meshes[static_cast<std::size_t>(node.mesh)] : nullptr;
}

/// All primitives of a mesh have the same targets.
std::size_t targetCountOf(const tinygltf::Mesh& mesh) {
    std::size_t count = 0;
    for (const tinygltf::Primitive& primitive : mesh.primitives)
        count = std::max(count, primitive.targets.size());
    return count;
}

bool movesWeights(const tinygltf::AnimationChannel& channel) {
    return channel.target_path == "weights" && channel.target_node >= 0;
}

}  // namespace

const std::vector<double>& restWeightsOf(const tinygltf::Model& model, const tinygltf::Node& node) {
    const tinygltf::Mesh* const mesh = meshOf(model, node);
    return node.weights.empty() && mesh ? mesh->weights : node.weights;
}

GltfMorphs::GltfMorphs(const GltfFile& file, RawScene& scene) : file_(file), scene_(scene) {
    const tinygltf::Model& model = file.model();
    for (const tinygltf::Animation& animation : model.animations) {
        for (const tinygltf::AnimationChannel& channel : animation.channels) {
            const auto node = static_cast<std::size_t>(std::max(channel.target_node, 0));
            if (!movesWeights(channel) || node >= model.nodes.size()) continue;
            const tinygltf::Mesh* const mesh = meshOf(model, model.nodes[node]);
            if (!mesh) continue;
            OfNode& found = nodes_[static_cast<std::uint32_t>(node)];
            found.targets.assign(targetCountOf(*mesh), kNoMorph);
            found.isBroken.assign(found.targets.size(), false);
        }
    }
}

std::string GltfMorphs::nameOf(std::uint32_t node, std::size_t target) const {
    const tinygltf::Model& model = file_.model();
    const tinygltf::Mesh& mesh = *meshOf(model, model.nodes[node]);
    // Where exporters have agreed to put them.
    const tinygltf::Value& names = memberOf(mesh.extras, "targetNames");
    if (names.IsArray() && target < names.ArrayLen()) {
        const tinygltf::Value& name = names.Get(static_cast<int>(target));
        if (name.IsString() && !name.Get<std::string>().empty()) return name.Get<std::string>();
    }
    return fmt::format("{} {}", mesh.name.empty() ? "target" : mesh.name, target);
}

void GltfMorphs::leaveOut(std::uint32_t node, std::size_t target, const std::string& why) {
    OfNode& found = nodes_.at(node);
    if (found.isBroken[target]) return;
    found.isBroken[target] = true;
    leftOut_.push_back(fmt::format("'{}' ({})", nameOf(node, target), why));
    if (found.targets[target] == kNoMorph) return;
    MorphTarget& taken = scene_.morphs[found.targets[target]];
    moved_ -= taken.vertices.size();
    taken.vertices = {};
    taken.offsets = {};
}

void GltfMorphs::add(std::uint32_t node, const tinygltf::Primitive& primitive, std::uint32_t first,
                     std::size_t count, const Mat3f& toWorld) {
    const auto found = nodes_.find(node);
    if (found == nodes_.end()) return;
    const std::vector<double>& rest = restWeightsOf(file_.model(), file_.model().nodes[node]);
    for (std::size_t t = 0; t < primitive.targets.size(); ++t) {
        const auto positions = primitive.targets[t].find("POSITION");
        if (positions == primitive.targets[t].end() || found->second.isBroken[t]) continue;
        if (isFull_) {
            leaveOut(node, t, fmt::format("all targets move more than {} vertices", kMostMorphed));
            continue;
        }
        const auto offsets = file_.numbers(positions->second, 3, "a morph target's POSITION");
        if (!offsets) {
            leaveOut(node, t, offsets.error().message());
            continue;
        }
        if (offsets->size() != count * 3) {
            leaveOut(node, t, fmt::format("{} of {} vertices", offsets->size() / 3, count));
            continue;
        }
        std::uint32_t& index = found->second.targets[t];
        if (index == kNoMorph) {
            index = static_cast<std::uint32_t>(scene_.morphs.size());
            MorphTarget& made = scene_.morphs.emplace_back();
            made.name = nameOf(node, t);
            const float weight = t < rest.size() ? static_cast<float>(rest[t]) : 0.0f;
            made.restWeight = std::isfinite(weight) ? weight : 0.0f;
        }
        MorphTarget& target = scene_.morphs[index];
        bool isFinite = true;
        for (std::size_t v = 0; v < count && isFinite; ++v) {
            const Eigen::Map<const Vec3f> offset(&(*offsets)[v * 3]);
            if (offset == Vec3f::Zero()) continue;
            const Vec3f offset_ws = toWorld * offset;
            isFinite = offset_ws.allFinite();
            target.vertices.push_back(first + static_cast<std::uint32_t>(v));
            target.offsets.push_back(offset_ws);
            ++moved_;
        }
        if (!isFinite) leaveOut(node, t, "numbers that are not finite");
        if (moved_ <= kMostMorphed) continue;
        isFull_ = true;
        leaveOut(node, t, fmt::format("all targets move more than {} vertices", kMostMorphed));
    }
}

void GltfMorphs::finish() {
    if (!leftOut_.empty())
        scene_.warnings.push_back(fmt::format("{} morph targets are left out and stay at rest: {}",
                                              leftOut_.size(), firstOf(leftOut_)));
    std::vector<MorphTarget> kept;
    std::vector<std::uint32_t> indexOfOld(scene_.morphs.size(), kNoMorph);
    for (std::size_t i = 0; i < scene_.morphs.size(); ++i) {
        if (scene_.morphs[i].vertices.empty()) continue;
        indexOfOld[i] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(std::move(scene_.morphs[i]));
    }
    scene_.morphs = std::move(kept);
    for (auto& [node, found] : nodes_) {
        for (std::uint32_t& target : found.targets) {
            if (target != kNoMorph) target = indexOfOld[target];
        }
    }
}

void GltfMorphs::addChannels(const tinygltf::Animation& animation, Clip& clip) {
    for (const tinygltf::AnimationChannel& source : animation.channels) {
        if (!movesWeights(source)) continue;
        const auto node = static_cast<std::uint32_t>(source.target_node);
        const auto leave = [&](const std::string& why) {
            scene_.warnings.push_back(
                fmt::format("clip '{}': weights of morph targets are left out: {}", clip.name, why));
        };
        const auto found = nodes_.find(node);
        if (found == nodes_.end() || found->second.targets.empty()) {
            leave(fmt::format("node {} has none", node));
            continue;
        }
        const OfNode& of = found->second;
        std::vector<bool> wanted;
        for (const std::uint32_t target : of.targets) wanted.push_back(target != kNoMorph);
        auto tracks = readWeights(file_, animation, source, wanted);
        if (!tracks) {
            leave(tracks.error().message());
            continue;
        }
        for (std::size_t t = 0; t < tracks->size(); ++t) {
            Track<float>& track = (*tracks)[t];
            if (track.times.empty()) continue;
            clip.duration = std::max(clip.duration, track.times.back());
            clip.morphs.push_back({of.targets[t], std::move(track)});
        }
    }
}

}  // namespace hairloom
