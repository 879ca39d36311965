// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/glb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numeric>
#include <span>
#include <string>
#include <string_view>

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

/// Entries of an accessor of floats.
std::vector<float> floatsOf(const Glb& glb, std::size_t accessor, std::size_t perEntry) {
    const json& of = glb.head["accessors"][accessor];
    const std::size_t view = of["bufferView"];
    std::vector<float> values(of["count"].get<std::size_t>() * perEntry);
    std::memcpy(values.data(),
                glb.bin.data() + glb.head["bufferViews"][view]["byteOffset"].get<std::size_t>(),
                values.size() * sizeof(float));
    return values;
}

/// As glTF has a skin: the sum of what joints do, from where they were bound to where they are.
std::vector<Vec3f> skinned(const Glb& glb, std::size_t mesh, std::span<const Eigen::Affine3f> joints_ws) {
    const json& attributes = glb.head["meshes"][mesh]["primitives"][0]["attributes"];
    const auto positions = floatsOf(glb, attributes["POSITION"], 3);
    const auto weights = floatsOf(glb, attributes["WEIGHTS_0"], 4);
    const auto binds = floatsOf(glb, glb.head["skins"][0]["inverseBindMatrices"], 16);
    const json& joints = glb.head["accessors"][attributes["JOINTS_0"].get<std::size_t>()];
    const std::size_t jointBytes =
        glb.head["bufferViews"][joints["bufferView"].get<std::size_t>()]["byteOffset"];
    std::vector<Vec3f> posed;
    for (std::size_t v = 0; v < positions.size() / 3; ++v) {
        const Vec3f rest(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]);
        Vec3f sum = Vec3f::Zero();
        float all = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            std::uint16_t joint = 0;
            std::memcpy(&joint, glb.bin.data() + jointBytes + 8 * v + 2 * k, 2);
            const Eigen::Map<const Eigen::Matrix4f> bind(binds.data() + std::ptrdiff_t{16} * joint);
            sum += weights[4 * v + k] * (joints_ws[joint] * Eigen::Affine3f(Eigen::Matrix4f(bind)) * rest);
            all += weights[4 * v + k];
        }
        EXPECT_NEAR(all, 1, 1e-5f);
        posed.push_back(sum);
    }
    return posed;
}

/// Where the joints of the skin are.
std::vector<Eigen::Affine3f> jointsOf(const json& head) {
    std::vector<Eigen::Affine3f> joints_ws;
    for (const json& node : head["skins"][0]["joints"]) joints_ws.push_back(placeOf(head, node));
    return joints_ws;
}

/// Roots of `chain` on three bones: the more at the side, the more with a jaw that hangs on the head.
Character jawed(const Chain& chain) {
    Character character;
    const Eigen::Affine3f neck(Eigen::Translation3f(0, -0.2f, 0.02f) *
                               Eigen::AngleAxisf(0.4f, Vec3f(1, 2, 3).normalized()));
    const Eigen::Affine3f head = neck * Eigen::Translation3f(0, 0.15f, 0);
    character.bones = {
        {"neck", -1, neck}, {"head", 0, head}, {"jaw", 1, head * Eigen::Translation3f(0.05f, 0.02f, 0)}};
    character.head = 1;
    for (const Vec3f& root : chain.roots_ws) {
        const float jaw = std::clamp(10 * root.x(), 0.0f, 1.0f), neckShare = 0.3f * (1 - jaw);
        character.roots.push_back({{1, 2, 0, 0}, Vec4f(1 - jaw - neckShare, jaw, neckShare, 0)});
    }
    return character;
}

TEST(Glb, RootsMoveWithTheirSkin) {
    const auto chain = smallChain("cards:20@64,shell:200@16");
    ASSERT_TRUE(chain) << chain.error().message();
    const Character character = jawed(*chain);
    const auto file = glbOf(*chain, {}, GlbNumbers::floats, character);
    ASSERT_TRUE(file) << file.error().message();
    Glb glb = parsed(*file);
    const auto& cards = std::get<Cards>(chain->levels[0].content);
    const auto atRest = skinned(glb, 0, jointsOf(glb.head));
    ASSERT_EQ(atRest.size(), cards.mesh.vertices.size());
    for (std::size_t v = 0; v < atRest.size(); ++v)
        ASSERT_LT((atRest[v] - cards.mesh.vertices[v].position_ws).norm(), 2e-6f) << v;
    // The bones are turned, and with them what hangs on them; and chains swing.
    std::vector<Eigen::Affine3f> moved;
    const auto named = [&](std::string_view name) -> json& {
        for (json& node : glb.head["nodes"])
            if (node["name"] == name) return node;
        ADD_FAILURE() << name;
        return glb.head["nodes"][0];
    };
    const auto firstBone = static_cast<std::ptrdiff_t>(chain->rig.joints.size());
    const auto before = jointsOf(glb.head);
    named("jaw")["rotation"] = {0.38f, 0, 0, std::sqrt(1 - 0.38f * 0.38f)};
    named("head")["rotation"] = {0, 0.26f, 0, std::sqrt(1 - 0.26f * 0.26f)};
    named("hair_0_0")["rotation"] = {0, 0, 0.5f, std::sqrt(0.75f)};
    const auto now = jointsOf(glb.head);
    for (std::size_t b = 0; b < character.bones.size(); ++b) {
        const auto joint = static_cast<std::size_t>(firstBone) + b;
        EXPECT_LT((before[joint].matrix() - character.bones[b].bind_ws.matrix()).norm(), 1e-5f);
        moved.push_back(now[joint] * character.bones[b].bind_ws.inverse());
    }
    const auto posed = skinned(glb, 0, now);
    std::size_t roots = 0;
    float farthest = 0;
    std::vector<std::uint32_t> all(chain->roots_ws.size());
    std::iota(all.begin(), all.end(), 0u);
    for (std::size_t v = 0; v < posed.size(); ++v) {
        const CardVertex& vertex = cards.mesh.vertices[v];
        if (vertex.hangs > 0) continue;
        float least = 1;
        Character::Root nearest;
        const auto& strands = vertex.card == kOfCap ? all : cards.cards[vertex.card].strands;
        for (const std::uint32_t strand : strands) {
            const float distance = (chain->roots_ws[strand] - vertex.position_ws).norm();
            if (distance < least) least = distance, nearest = character.roots[strand];
        }
        Vec3f expected = Vec3f::Zero();
        for (std::size_t k = 0; k < 4; ++k)
            expected += nearest.weights[static_cast<int>(k)] * (moved[nearest.bones[k]] * vertex.position_ws);
        ASSERT_LT((posed[v] - expected).norm(), 2e-6f) << v;
        farthest = std::max(farthest, (expected - vertex.position_ws).norm());
        ++roots;
    }
    EXPECT_GT(roots, 40u);
    EXPECT_GT(farthest, 0.02f) << "the pose moves roots";
    // Chains at the side hang on the jaw, and others on the head.
    std::size_t onJaw = 0, onHead = 0;
    const std::size_t jaw = static_cast<std::size_t>(&named("jaw") - &glb.head["nodes"][0]);
    for (std::size_t c = 0; c < chain->rig.chains(); ++c) {
        const json joint(1 + c * chain->rig.perChain);
        const auto holds = [&](const json& node) {
            const json children = node.value("children", json::array());
            return std::count(children.begin(), children.end(), joint) == 1;
        };
        const bool isAside = chain->rig.curves[c][0].x() > 0.06f;
        if (isAside) {
            ++onJaw;
            EXPECT_TRUE(holds(glb.head["nodes"][jaw])) << c;
        }
        if (chain->rig.curves[c][0].x() < 0) {
            ++onHead;
            EXPECT_TRUE(holds(glb.head["nodes"][0])) << c;
        }
    }
    EXPECT_GT(onJaw, 0u);
    EXPECT_GT(onHead, 0u);
    // The shell follows the same skin.
    const auto shell = skinned(glb, 1, now), still = skinned(glb, 1, before);
    EXPECT_TRUE(std::ranges::equal(
        skinned(parsed(*glbOf(*chain, {})), 1, std::vector<Eigen::Affine3f>(before.begin(), before.end())),
        still, [](const Vec3f& a, const Vec3f& b) { return (a - b).norm() < 2e-6f; }));
    EXPECT_TRUE(std::ranges::any_of(shell, [&](const Vec3f& p) {
        return (p - still[static_cast<std::size_t>(&p - shell.data())]).norm() > 0.02f;
    }));
}

TEST(Glb, OfACharacterWithSeveralRootsHasOneNodeAboveItsJoints) {
    const auto chain = smallChain("cards:8@64");
    ASSERT_TRUE(chain) << chain.error().message();
    Character character = jawed(*chain);
    character.bones[2].parent = -1;
    const auto file = glbOf(*chain, {}, GlbNumbers::quantised, character);
    ASSERT_TRUE(file) << file.error().message();
    const json head = parsed(*file).head;
    ASSERT_EQ(head["scenes"][0]["nodes"].size(), 2u);
    std::vector<bool> below(head["nodes"].size());
    const auto mark = [&](const auto& self, std::size_t node) -> void {
        below[node] = true;
        for (const json& child : head["nodes"][node].value("children", json::array())) self(self, child);
    };
    mark(mark, head["scenes"][0]["nodes"][0]);
    for (const json& joint : head["skins"][0]["joints"]) EXPECT_TRUE(below[joint]) << joint;
}

TEST(Glb, JointsBeyond255AreNotCutToBytes) {
    const auto chain = smallChain("cards:8@64");
    ASSERT_TRUE(chain) << chain.error().message();
    Character character = jawed(*chain);
    // Many bones before the one that all roots hang on.
    for (int b = 0; b < 300; ++b)
        character.bones.push_back({"b" + std::to_string(b), 0, character.bones[0].bind_ws});
    for (Character::Root& root : character.roots) root = {{302, 0, 0, 0}, Vec4f(1, 0, 0, 0)};
    const auto file = glbOf(*chain, {}, GlbNumbers::quantised, character);
    ASSERT_TRUE(file) << file.error().message();
    const json head = parsed(*file).head;
    const std::size_t joints = head["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"];
    EXPECT_EQ(head["accessors"][joints]["componentType"], 5123);
}

TEST(Glb, AWeightThatRoundsToNoneNamesNoJoint) {
    const auto chain = smallChain("cards:8@64");
    ASSERT_TRUE(chain) << chain.error().message();
    Character character = jawed(*chain);
    for (Character::Root& root : character.roots) root = {{1, 2, 0, 0}, Vec4f(0.999f, 0.001f, 0, 0)};
    const auto file = glbOf(*chain, {}, GlbNumbers::quantised, character);
    ASSERT_TRUE(file) << file.error().message();
    const Glb glb = parsed(*file);
    const json& attributes = glb.head["meshes"][0]["primitives"][0]["attributes"];
    const auto bytes = [&](const char* name) {
        const json& accessor = glb.head["accessors"][attributes[name].get<std::size_t>()];
        const json& view = glb.head["bufferViews"][accessor["bufferView"].get<std::size_t>()];
        const auto first =
            glb.bin.begin() + static_cast<std::ptrdiff_t>(view["byteOffset"].get<std::size_t>());
        const std::vector<std::byte> all(first, first + 4 * accessor["count"].get<std::ptrdiff_t>());
        return all;
    };
    const std::vector<std::byte> joints = bytes("JOINTS_0"), weights = bytes("WEIGHTS_0");
    ASSERT_EQ(joints.size(), weights.size());
    for (std::size_t i = 0; i < joints.size(); ++i)
        ASSERT_TRUE(weights[i] != std::byte{0} || joints[i] == std::byte{0}) << i;
}

TEST(Glb, StopsWhenItIsCancelled) {
    const auto chain = smallChain("cards:4");
    ASSERT_TRUE(chain) << chain.error().message();
    const std::atomic<bool> cancel = true;
    const auto file = glbOf(*chain, {}, GlbNumbers::floats, {}, &cancel);
    ASSERT_FALSE(file);
    EXPECT_THAT(file.error().message(), testing::HasSubstr("stopped"));
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
