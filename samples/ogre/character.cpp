// SPDX-License-Identifier: GPL-3.0-or-later
#include "character.h"

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <OgreAnimation.h>
#include <OgreBone.h>
#include <OgreKeyFrame.h>
#include <OgreManualObject.h>
#include <OgreMeshManager.h>
#include <OgreSkeleton.h>
#include <OgreSkeletonManager.h>
#include <OgreSubMesh.h>
#include <tiny_gltf.h>

#include <map>
#include <stdexcept>

using namespace Ogre;

namespace {

/// Numbers of an accessor, one element after another.
std::vector<double> numbersOf(const tinygltf::Model& model, int index) {
    const tinygltf::Accessor& accessor = model.accessors.at(static_cast<std::size_t>(index));
    const tinygltf::BufferView& view = model.bufferViews.at(static_cast<std::size_t>(accessor.bufferView));
    const std::vector<unsigned char>& buffer = model.buffers.at(static_cast<std::size_t>(view.buffer)).data;
    const auto width =
        static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
    const auto bytes = static_cast<std::size_t>(
        tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType)));
    const auto stride = static_cast<std::size_t>(accessor.ByteStride(view));
    std::vector<double> numbers;
    for (std::size_t e = 0; e < accessor.count; ++e) {
        for (std::size_t c = 0; c < width; ++c) {
            const std::size_t at = view.byteOffset + accessor.byteOffset + e * stride + c * bytes;
            if (at + bytes > buffer.size()) throw std::runtime_error("an accessor ends after its buffer");
            const unsigned char* from = &buffer[at];
            const auto take = [&](auto value) {
                std::memcpy(&value, from, sizeof value);
                return static_cast<double>(value);
            };
            switch (accessor.componentType) {
                case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
                    numbers.push_back(*from);
                    break;
                case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
                    numbers.push_back(take(std::uint16_t{}));
                    break;
                case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
                    numbers.push_back(take(std::uint32_t{}));
                    break;
                case TINYGLTF_COMPONENT_TYPE_FLOAT:
                    numbers.push_back(take(float{}));
                    break;
                default:
                    throw std::runtime_error("an accessor has an unsupported type");
            }
        }
    }
    return numbers;
}

Vector3 vectorAt(const std::vector<double>& numbers, std::size_t e) {
    return {static_cast<Real>(numbers[3 * e]), static_cast<Real>(numbers[3 * e + 1]),
            static_cast<Real>(numbers[3 * e + 2])};
}
Quaternion turnAt(const std::vector<double>& xyzw, std::size_t e) {
    return {static_cast<Real>(xyzw[4 * e + 3]), static_cast<Real>(xyzw[4 * e]),
            static_cast<Real>(xyzw[4 * e + 1]), static_cast<Real>(xyzw[4 * e + 2])};
}

/// Bones by the number of their node. The nodes' own places are where the mesh was bound.
std::map<int, Bone*> addBones(const tinygltf::Model& model, Skeleton& skeleton) {
    std::map<int, Bone*> bones;
    for (const int joint : model.skins.at(0).joints) {
        const tinygltf::Node& node = model.nodes.at(static_cast<std::size_t>(joint));
        Bone* const bone = skeleton.createBone(node.name);
        if (!node.translation.empty()) bone->setPosition(vectorAt(node.translation, 0));
        if (!node.rotation.empty()) bone->setOrientation(turnAt(node.rotation, 0));
        bones[joint] = bone;
    }
    for (const auto& [joint, bone] : bones) {
        for (const int child : model.nodes[static_cast<std::size_t>(joint)].children) {
            if (bones.count(child)) bone->addChild(bones[child]);
        }
    }
    skeleton.setBindingPose();
    return bones;
}

/// Turns of bones; Ogre's keys are relative to the pose in which the mesh was bound.
void addClips(const tinygltf::Model& model, const std::map<int, Bone*>& bones, Skeleton& skeleton) {
    for (const tinygltf::Animation& clip : model.animations) {
        Animation* animation = nullptr;
        for (const tinygltf::AnimationChannel& channel : clip.channels) {
            const auto bone = bones.find(channel.target_node);
            if (bone == bones.end() || channel.target_path != "rotation") continue;
            const auto& sampler = clip.samplers.at(static_cast<std::size_t>(channel.sampler));
            const std::vector<double> times = numbersOf(model, sampler.input),
                                      turns = numbersOf(model, sampler.output);
            if (!animation) animation = skeleton.createAnimation(clip.name, static_cast<Real>(times.back()));
            NodeAnimationTrack* const track =
                animation->createNodeTrack(bone->second->getHandle(), bone->second);
            for (std::size_t k = 0; k < times.size(); ++k) {
                track->createNodeKeyFrame(static_cast<Real>(times[k]))
                    ->setRotation(bone->second->getInitialOrientation().Inverse() * turnAt(turns, k));
            }
        }
    }
}

}  // namespace

MeshPtr loadCharacter(const std::string& file, const std::string& name) {
    tinygltf::Model model;
    std::string errors, warnings;
    if (!tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &errors, &warnings, file))
        throw std::runtime_error(file + ": " + errors);
    SkeletonPtr skeleton =
        SkeletonManager::getSingleton().create(name, ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME, true);
    const std::map<int, Bone*> bones = addBones(model, *skeleton);
    addClips(model, bones, *skeleton);

    ManualObject parts(name);
    struct Weights {
        std::vector<double> joints, shares;
    };
    std::vector<Weights> weights;
    for (const tinygltf::Mesh& mesh : model.meshes) {
        for (const tinygltf::Primitive& primitive : mesh.primitives) {
            const std::vector<double> positions = numbersOf(model, primitive.attributes.at("POSITION")),
                                      normals = numbersOf(model, primitive.attributes.at("NORMAL")),
                                      indices = numbersOf(model, primitive.indices);
            parts.begin("skin", RenderOperation::OT_TRIANGLE_LIST,
                        ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME);
            for (std::size_t v = 0; v < positions.size() / 3; ++v) {
                parts.position(vectorAt(positions, v));
                parts.normal(vectorAt(normals, v));
            }
            for (const double index : indices) parts.index(static_cast<std::uint32_t>(index));
            parts.end();
            weights.push_back({numbersOf(model, primitive.attributes.at("JOINTS_0")),
                               numbersOf(model, primitive.attributes.at("WEIGHTS_0"))});
        }
    }
    MeshPtr mesh = parts.convertToMesh(name);
    mesh->_notifySkeleton(skeleton);
    for (std::size_t part = 0; part < weights.size(); ++part) {
        const auto& [joints, shares] = weights[part];
        for (std::size_t i = 0; i < shares.size(); ++i) {
            if (shares[i] == 0) continue;
            const int node = model.skins[0].joints.at(static_cast<std::size_t>(joints[i]));
            mesh->getSubMesh(part)->addBoneAssignment({static_cast<std::uint32_t>(i / 4),
                                                       bones.at(node)->getHandle(),
                                                       static_cast<Real>(shares[i])});
        }
    }
    mesh->_updateCompiledBoneAssignments();
    return mesh;
}
