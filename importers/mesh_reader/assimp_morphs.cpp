// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/mesh_reader/assimp_morphs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "importers/scene_parts.h"

namespace hairloom {
namespace {

/// A channel is named NODE*NUMBER, by the number of the geometry in the node.
std::string nodeOf(const aiMeshMorphAnim& channel) {
    const std::string name = channel.mName.C_Str();
    return name.substr(0, name.rfind('*'));
}

/// Ticks that assimp counts times from in a file that states no range and moves no node.
constexpr double kNoStart = 1e10;

double ticksOf(const aiMeshMorphKey& key) {
    return key.mTime < -0.5 * kNoStart ? key.mTime + kNoStart : key.mTime;
}

/// Several shapes of one channel, of which each is whole at a weight of its own. Keys count channels.
bool hasInBetweens(const aiMesh& mesh) {
    for (unsigned s = 0; s < mesh.mNumAnimMeshes; ++s) {
        if (mesh.mAnimMeshes[s]->mWeight != 1.0f) return true;
        if (s > 0 && mesh.mAnimMeshes[s]->mName == mesh.mAnimMeshes[s - 1]->mName) return true;
    }
    return false;
}

}  // namespace

AssimpMorphs::AssimpMorphs(const aiScene& source, RawScene& scene) : source_(source), scene_(scene) {
    for (unsigned a = 0; a < source.mNumAnimations; ++a) {
        for (unsigned c = 0; c < source.mAnimations[a]->mNumMorphMeshChannels; ++c)
            nodes_.try_emplace(nodeOf(*source.mAnimations[a]->mMorphMeshChannels[c]));
    }
}

void AssimpMorphs::add(const aiMesh& mesh, const aiNode& node, std::uint32_t first, const Mat3f& toWorld) {
    const auto found = nodes_.find(node.mName.C_Str());
    if (found == nodes_.end()) return;
    if (hasInBetweens(mesh)) {
        ++inBetween_;
        return;
    }
    std::vector<std::uint32_t>& targets = found->second;
    for (unsigned s = 0; s < mesh.mNumAnimMeshes; ++s) {
        const aiAnimMesh& shape = *mesh.mAnimMeshes[s];
        if (targets.size() <= s) targets.resize(s + 1, kNoMorph);
        if (!shape.mVertices || shape.mNumVertices != mesh.mNumVertices) continue;
        MorphTarget taken;
        bool isFinite = true;
        for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
            const aiVector3D offset = shape.mVertices[v] - mesh.mVertices[v];
            if (offset == aiVector3D()) continue;
            taken.vertices.push_back(first + v);
            taken.offsets.push_back(toWorld * Vec3f(offset.x, offset.y, offset.z));
            isFinite = isFinite && taken.offsets.back().allFinite();
        }
        if (taken.vertices.empty()) continue;
        if (!isFinite || moved_ + taken.vertices.size() > kMostMorphed) {
            ++(isFinite ? tooMany_ : notFinite_);
            continue;
        }
        moved_ += taken.vertices.size();
        if (targets[s] == kNoMorph) {
            targets[s] = static_cast<std::uint32_t>(scene_.morphs.size());
            scene_.morphs.emplace_back().name = shape.mName.C_Str();
        }
        MorphTarget& target = scene_.morphs[targets[s]];
        target.vertices.insert(target.vertices.end(), taken.vertices.begin(), taken.vertices.end());
        target.offsets.insert(target.offsets.end(), taken.offsets.begin(), taken.offsets.end());
    }
}

void AssimpMorphs::addChannels(const aiAnimation& animation, double ticksPerSecond, Clip& clip) {
    for (unsigned c = 0; c < animation.mNumMorphMeshChannels; ++c) {
        const aiMeshMorphAnim& source = *animation.mMorphMeshChannels[c];
        const std::vector<std::uint32_t>& targets = nodes_.at(nodeOf(source));
        std::map<std::uint32_t, Track<float>> tracks;
        for (unsigned k = 0; k < source.mNumKeys; ++k) {
            const aiMeshMorphKey& key = source.mKeys[k];
            const auto time = static_cast<float>(ticksOf(key) / ticksPerSecond);
            for (unsigned i = 0; i < key.mNumValuesAndWeights && std::isfinite(time); ++i) {
                const auto weight = static_cast<float>(key.mWeights[i]);
                if (key.mValues[i] >= targets.size() || targets[key.mValues[i]] == kNoMorph) continue;
                Track<float>& track = tracks[targets[key.mValues[i]]];
                if (!std::isfinite(weight) || (!track.times.empty() && time <= track.times.back())) continue;
                track.times.push_back(time);
                track.values.push_back(weight);
            }
        }
        for (auto& [target, track] : tracks) {
            if (track.times.empty()) continue;
            clip.duration = std::max(clip.duration, track.times.back());
            clip.morphs.push_back({target, std::move(track)});
        }
    }
}

void AssimpMorphs::finish() {
    const auto say = [this](std::size_t count, const char* what) {
        if (count > 0) scene_.warnings.push_back(fmt::format("{} {}", count, what));
    };
    say(inBetween_,
        "meshes have in-between blend shapes, which are not read: their blend shapes stay at rest");
    say(notFinite_, "blend shapes have numbers that are not finite, and stay at rest");
    say(tooMany_, "blend shapes are left out, since all together they move too many vertices");
    bool hasShapes = false;
    for (unsigned m = 0; m < source_.mNumMeshes; ++m)
        hasShapes = hasShapes || source_.mMeshes[m]->mNumAnimMeshes > 0;
    if (hasShapes && scene_.morphs.empty() && inBetween_ == 0)
        scene_.warnings.emplace_back("blend shapes stay at 0, since no clip moves them");
}

}  // namespace hairloom
