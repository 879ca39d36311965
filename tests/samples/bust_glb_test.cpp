// SPDX-License-Identifier: GPL-3.0-or-later
// Skeleton, skin and clip of bust.glb, as assimp sees them and as the specification wants them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/base/file.h"
#include "samples/bust/head_shape.h"
#include "samples/bust/rig.h"
#include "tests/samples/bust_files.h"

namespace hairloom::bust {
namespace {

TEST(BustGlb, WeightsAddUpAndTheScalpFollowsTheHead) {
    Assimp::Importer importer;
    const aiScene* scene = readBust(importer, "bust.glb");
    ASSERT_NE(scene, nullptr) << importer.GetErrorString();
    ASSERT_EQ(scene->mNumMeshes, unsigned{kGroupCount});
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        const aiMesh& mesh = *scene->mMeshes[m];
        std::vector<double> sums(mesh.mNumVertices);
        std::vector<double> head(mesh.mNumVertices);
        for (unsigned b = 0; b < mesh.mNumBones; ++b) {
            const aiBone& bone = *mesh.mBones[b];
            ASSERT_NE(scene->mRootNode->FindNode(bone.mName), nullptr);
            for (unsigned w = 0; w < bone.mNumWeights; ++w) {
                EXPECT_GE(bone.mWeights[w].mWeight, 0.0f);
                sums[bone.mWeights[w].mVertexId] += bone.mWeights[w].mWeight;
                if (bone.mName == aiString("head"))
                    head[bone.mWeights[w].mVertexId] += bone.mWeights[w].mWeight;
            }
        }
        for (const double sum : sums) ASSERT_NEAR(sum, 1.0, 1e-6);
        if (scene->mMaterials[mesh.mMaterialIndex]->GetName() != aiString("scalp")) continue;
        for (const double share : head) ASSERT_NEAR(share, 1.0, 0.02);
    }
}

TEST(BustGlb, ClipTurnsThreeBonesForTwoSecondsAndLoops) {
    Assimp::Importer importer;
    const aiScene* scene = readBust(importer, "bust.glb");
    ASSERT_NE(scene, nullptr) << importer.GetErrorString();
    ASSERT_EQ(scene->mNumAnimations, 1u);
    const aiAnimation& clip = *scene->mAnimations[0];
    EXPECT_STREQ(clip.mName.C_Str(), kClipName);
    EXPECT_NEAR(clip.mDuration / clip.mTicksPerSecond, 2.0, 1e-3);
    ASSERT_EQ(clip.mNumChannels, unsigned{kBoneCount});
    double left = 0.0;
    double right = 0.0;
    double nod = 0.0;
    for (unsigned c = 0; c < clip.mNumChannels; ++c) {
        const aiNodeAnim& channel = *clip.mChannels[c];
        ASSERT_EQ(channel.mNumRotationKeys, unsigned{kClipFrames});
        const aiQuatKey* keys = channel.mRotationKeys;
        EXPECT_NEAR(keys[0].mValue.w, 1.0, 1e-6);
        EXPECT_NEAR(keys[kClipFrames - 1].mValue.w, 1.0, 1e-6);
        for (int k = 0; k < kClipFrames; ++k) {
            left = std::max(left, 1.0 * keys[k].mValue.y);
            right = std::min(right, 1.0 * keys[k].mValue.y);
            nod = std::max(nod, 1.0 * keys[k].mValue.x);
        }
    }
    EXPECT_GT(left, 0.15);
    EXPECT_LT(right, -0.15);
    EXPECT_GT(nod, 0.08);
}

TEST(BustGlb, BoneAndRestPoseCancel) {
    Assimp::Importer importer;
    const aiScene* scene = readBust(importer, "bust.glb");
    ASSERT_NE(scene, nullptr) << importer.GetErrorString();
    for (unsigned b = 0; b < scene->mMeshes[0]->mNumBones; ++b) {
        const aiBone& bone = *scene->mMeshes[0]->mBones[b];
        aiMatrix4x4 world;
        for (const aiNode* node = scene->mRootNode->FindNode(bone.mName); node != nullptr;
             node = node->mParent) {
            world = node->mTransformation * world;
        }
        EXPECT_TRUE((world * bone.mOffsetMatrix).Equal(aiMatrix4x4(), 1e-5f)) << bone.mName.C_Str();
    }
}

TEST(BustGlb, KeepsTheRulesOfTheContainer) {
    const auto bytes = readFile(bustFolder() / "bust.glb");
    ASSERT_TRUE(bytes);
    EXPECT_LT(bytes->size(), std::size_t{1} << 20u);
    ByteReader reader("bust.glb", *bytes);
    const auto head = reader.readArray<std::uint32_t>(5, "header");
    ASSERT_TRUE(head);
    EXPECT_EQ((*head)[0], 0x46546C67u);
    EXPECT_EQ((*head)[1], 2u);
    EXPECT_EQ((*head)[2], bytes->size());
    EXPECT_EQ((*head)[3] % 4, 0u);
    const auto text = reader.readArray<char>((*head)[3], "JSON");
    ASSERT_TRUE(text);
    const auto json = nlohmann::json::parse(text->begin(), text->end());
    const auto binary = reader.readArray<std::uint32_t>(2, "binary chunk");
    ASSERT_TRUE(binary);
    EXPECT_EQ(reader.remaining(), (*binary)[0]);
    EXPECT_EQ(json["buffers"][0]["byteLength"], (*binary)[0]);
    const std::map<int, std::size_t> componentBytes = {{5121, 1}, {5123, 2}, {5126, 4}};
    const std::map<std::string, std::size_t> width = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
    for (const auto& accessor : json["accessors"]) {
        const auto& view = json["bufferViews"].at(accessor["bufferView"].get<std::size_t>());
        const std::size_t element = componentBytes.at(accessor["componentType"]) * width.at(accessor["type"]);
        EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
        EXPECT_EQ(view["byteLength"].get<std::size_t>(), accessor["count"].get<std::size_t>() * element);
        EXPECT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(),
                  (*binary)[0]);
    }
    for (const auto& mesh : json["meshes"]) {
        const auto& attributes = mesh["primitives"][0]["attributes"];
        const auto& position = json["accessors"].at(attributes["POSITION"].get<std::size_t>());
        EXPECT_EQ(position["min"].size(), 3u);
        EXPECT_EQ(position["max"].size(), 3u);
        for (const auto& [name, index] : attributes.items()) {
            EXPECT_EQ(json["accessors"].at(index.get<std::size_t>())["count"], position["count"]) << name;
        }
    }
    for (const auto& sampler : json["animations"][0]["samplers"]) {
        EXPECT_TRUE(json["accessors"].at(sampler["input"].get<std::size_t>()).contains("max"));
    }
}

}  // namespace
}  // namespace hairloom::bust
