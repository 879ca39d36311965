// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/glb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "tests/cards/card_samples.h"

namespace hairloom::cards {
namespace {

using nlohmann::json;

/// The chunks of a binary glTF.
struct Glb {
    json head;
    std::vector<std::byte> bin;
};
Glb parsed(const std::vector<std::byte>& file) {
    const auto word = [&](std::size_t at) {
        std::uint32_t value = 0;
        std::memcpy(&value, file.data() + at, 4);
        return value;
    };
    EXPECT_EQ(word(0), 0x46546C67u);
    EXPECT_EQ(word(4), 2u);
    EXPECT_EQ(word(8), file.size());
    const std::uint32_t text = word(12);
    EXPECT_EQ(text % 4, 0u);
    Glb glb;
    glb.head = json::parse(reinterpret_cast<const char*>(file.data()) + 20,
                           reinterpret_cast<const char*>(file.data()) + 20 + text);
    EXPECT_EQ(word(20 + text), file.size() - 28 - text);
    glb.bin.assign(file.begin() + 28 + text, file.end());
    return glb;
}

Result<Chain> smallChain(const char* levels) {
    ChainOptions options;
    options.directions = 1;
    options.mostSide = 256;
    return makeChain(
        ballHair(600), *parseLevels(levels), options, [](std::string_view, double) {}, nullptr);
}

TEST(Glb, HoldsMeshesSkinLevelsAndSprings) {
    const auto chain = smallChain("cards:20@64,cards:8@32,shell:200@16");
    ASSERT_TRUE(chain) << chain.error().message();
    const std::vector<Collider> colliders{{Vec3f(0, 0.01f, 0), 0.095f}};
    const auto file = glbOf(*chain, colliders);
    ASSERT_TRUE(file) << file.error().message();
    const Glb glb = parsed(*file);
    const json& head = glb.head;
    ASSERT_EQ(head["meshes"].size(), 3u);
    EXPECT_EQ(head["materials"][0]["alphaMode"], "MASK");
    EXPECT_EQ(head["materials"][0]["doubleSided"], true);
    EXPECT_EQ(head["materials"][0]["extensions"]["KHR_materials_anisotropy"]["anisotropyRotation"], 0)
        << "tangents lie across strands";
    for (const json& material : head["materials"])
        for (const auto& [extension, values] : material["extensions"].items())
            EXPECT_THAT(head["extensionsUsed"], testing::Contains(extension));
    EXPECT_EQ(head["images"].size(), 6u) << "colour, normal and occlusion of two levels";
    for (const json& view : head["bufferViews"]) {
        EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
        EXPECT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(),
                  glb.bin.size());
    }
    const auto joints = head["skins"][0]["joints"].size();
    for (std::size_t m = 0; m < 3; ++m) {
        const json& attributes = head["meshes"][m]["primitives"][0]["attributes"];
        const json& accessor = head["accessors"][attributes["JOINTS_0"].get<std::size_t>()];
        const json& view = head["bufferViews"][accessor["bufferView"].get<std::size_t>()];
        for (std::size_t i = 0; i < 4 * accessor["count"].get<std::size_t>(); ++i) {
            std::uint16_t joint = 0;
            std::memcpy(&joint, glb.bin.data() + view["byteOffset"].get<std::size_t>() + 2 * i, 2);
            ASSERT_LT(joint, joints);
        }
    }
    const std::size_t nearest = head["scenes"][0]["nodes"][1];
    EXPECT_EQ(head["nodes"][nearest]["extensions"]["MSFT_lod"]["ids"], (json{nearest + 1, nearest + 2}));
    EXPECT_EQ(head["nodes"][nearest]["extras"]["MSFT_screencoverage"].size(), 3u);
    const json& springs = head["extensions"]["VRMC_springBone"];
    EXPECT_NEAR(springs["colliders"][0]["shape"]["sphere"]["radius"].get<double>(), 0.095, 1e-6);
    ASSERT_FALSE(springs["springs"].empty());
    EXPECT_EQ(springs["springs"].size() * 5 + 1, joints);
    EXPECT_EQ(*file, *glbOf(*chain, colliders)) << "the same bytes again";
}

/// Integers of an accessor whose entries are `stride` bytes apart.
template <class T>
T at(const Glb& glb, const json& accessor, std::size_t entry, std::size_t number) {
    const json& view = glb.head["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    T value;
    std::memcpy(&value,
                glb.bin.data() + view["byteOffset"].get<std::size_t>() +
                    entry * view["byteStride"].get<std::size_t>() + number * sizeof(T),
                sizeof(T));
    return value;
}

TEST(Glb, IsSmallerWithIntegersAndStandsWhereItStood) {
    const auto chain = smallChain("cards:20@64,shell:200@16");
    ASSERT_TRUE(chain) << chain.error().message();
    const auto file = glbOf(*chain, {}, GlbNumbers::quantised);
    ASSERT_TRUE(file) << file.error().message();
    const Glb glb = parsed(*file), whole = parsed(*glbOf(*chain, {}));
    EXPECT_EQ(glb.head["extensionsRequired"], json{"KHR_mesh_quantization"});
    EXPECT_FALSE(whole.head.contains("extensionsRequired"));
    EXPECT_LT(glb.bin.size(), whole.bin.size());
    const json& attributes = glb.head["meshes"][0]["primitives"][0]["attributes"];
    const auto accessor = [&](const char* name) {
        return glb.head["accessors"][attributes[name].get<std::size_t>()];
    };
    const json positions = accessor("POSITION"), weights = accessor("WEIGHTS_0"),
               joints = accessor("JOINTS_0");
    const auto& vertices = std::get<Cards>(chain->levels[0].content).mesh.vertices;
    ASSERT_EQ(positions["count"], vertices.size());
    // The skin brings them back: bind matrix and joint at rest.
    const json& matrices =
        glb.head["accessors"][glb.head["skins"][0]["inverseBindMatrices"].get<std::size_t>()];
    const std::size_t first =
        glb.head["bufferViews"][matrices["bufferView"].get<std::size_t>()]["byteOffset"].get<std::size_t>();
    const json& jointView = glb.head["bufferViews"][joints["bufferView"].get<std::size_t>()];
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        Vec3f stored;
        int sum = 0;
        for (std::size_t i = 0; i < 3; ++i)
            stored[static_cast<int>(i)] = static_cast<float>(at<std::int16_t>(glb, positions, v, i)) / 32767;
        for (std::size_t i = 0; i < 4; ++i) sum += at<std::uint8_t>(glb, weights, v, i);
        ASSERT_EQ(sum, 255);
        std::uint8_t joint = 0;
        std::memcpy(&joint, glb.bin.data() + jointView["byteOffset"].get<std::size_t>() + 4 * v, 1);
        Eigen::Matrix4f bind;
        std::memcpy(bind.data(), glb.bin.data() + first + 64 * joint, 64);
        const Vec3f back = bind.topLeftCorner<3, 3>() * stored + bind.topRightCorner<3, 1>() +
                           chain->rig.joints[joint].position_ws;
        ASSERT_LT((back - vertices[v].position_ws).norm(), 2e-5f);
    }
}

/// Where a node is, by all that it hangs on.
Eigen::Affine3f placeOf(const json& head, std::size_t node) {
    Eigen::Affine3f place = Eigen::Affine3f::Identity();
    const json& given = head["nodes"][node];
    const auto& t = given["translation"];
    place.translate(Vec3f(t[0].get<float>(), t[1].get<float>(), t[2].get<float>()));
    if (given.contains("rotation")) {
        const auto& r = given["rotation"];
        place.rotate(Quatf(r[3].get<float>(), r[0].get<float>(), r[1].get<float>(), r[2].get<float>()));
    }
    if (given.contains("scale")) {
        const auto& s = given["scale"];
        place.scale(Vec3f(s[0].get<float>(), s[1].get<float>(), s[2].get<float>()));
    }
    for (std::size_t parent = 0; parent < head["nodes"].size(); ++parent) {
        const json& other = head["nodes"][parent];
        if (!other.contains("children")) continue;
        for (const json& child : other["children"])
            if (child == node) return placeOf(head, parent) * place;
    }
    return place;
}

TEST(Glb, HangsHairAndSpheresOnTheCharactersBones) {
    const auto chain = smallChain("cards:20@64");
    ASSERT_TRUE(chain) << chain.error().message();
    Character character;
    const Eigen::Affine3f spine(Eigen::Translation3f(0, -0.5f, 0.1f) *
                                Eigen::AngleAxisf(0.7f, Vec3f(1, 2, 3).normalized()));
    const Eigen::Affine3f neck(spine * Eigen::Translation3f(0.1f, 0.2f, 0) *
                               Eigen::AngleAxisf(-1.1f, Vec3f::UnitZ()) * Eigen::Scaling(2.0f));
    character.bones = {
        {"spine", -1, spine}, {"neck", 0, neck}, {"head", 1, neck * Eigen::Translation3f(0, 0.1f, 0)}};
    character.head = 2;
    const std::vector<Collider> colliders{{Vec3f(0, 0.01f, 0), 0.095f, "head"},
                                          {Vec3f(0.1f, -0.3f, 0.05f), 0.08f, "spine"},
                                          {Vec3f(0, -0.1f, 0), 0.05f, "neck"},
                                          {Vec3f(0, -0.2f, 0), 0.04f, ""}};
    const auto file = glbOf(*chain, colliders, GlbNumbers::floats, character);
    ASSERT_TRUE(file) << file.error().message();
    const json head = parsed(*file).head;
    const json& spheres = head["extensions"]["VRMC_springBone"]["colliders"];
    const char* const nodes[] = {"head", "spine", "neck", "hair"};
    for (std::size_t c = 0; c < colliders.size(); ++c) {
        const std::size_t node = spheres[c]["node"];
        EXPECT_EQ(head["nodes"][node]["name"], nodes[c]);
        const json& sphere = spheres[c]["shape"]["sphere"];
        const auto& at = sphere["offset"];
        const Eigen::Affine3f place = placeOf(head, node);
        const Vec3f centre = place * Vec3f(at[0].get<float>(), at[1].get<float>(), at[2].get<float>());
        EXPECT_LT((centre - colliders[c].centre_ws).norm(), 1e-5f) << nodes[c];
        EXPECT_NEAR(sphere["radius"].get<float>() * std::cbrt(place.linear().determinant()),
                    colliders[c].radius, 1e-5f);
    }
    for (std::size_t j = 0; j < chain->rig.joints.size(); ++j)
        EXPECT_LT((placeOf(head, j).translation() - chain->rig.joints[j].position_ws).norm(), 2e-5f) << j;
    // Each node hangs on one other at most, and the scene has those that hang on none.
    std::vector<int> parents(head["nodes"].size());
    for (const json& node : head["nodes"])
        if (node.contains("children"))
            for (const json& child : node["children"]) ++parents[child.get<std::size_t>()];
    for (const json& root : head["scenes"][0]["nodes"]) EXPECT_EQ(parents[root.get<std::size_t>()]++, 0);
    EXPECT_TRUE(std::ranges::all_of(parents, [](int count) { return count == 1; }));
    // Chains are told of the spheres that they do not stand in.
    const json& springs = head["extensions"]["VRMC_springBone"]["springs"];
    for (std::size_t s = 0; s < springs.size(); ++s) {
        const auto held = collidersOfChain(chain->rig, s, colliders);
        EXPECT_EQ(springs[s].value("colliderGroups", json::array()), json(held));
    }
}

TEST(Glb, RefusesStrandsAlone) {
    const auto chain = smallChain("strands:1@16");
    ASSERT_TRUE(chain) << chain.error().message();
    const auto file = glbOf(*chain, {});
    ASSERT_FALSE(file);
    EXPECT_THAT(file.error().message(), testing::HasSubstr("one of cards or a shell"));
}

}  // namespace
}  // namespace hairloom::cards
