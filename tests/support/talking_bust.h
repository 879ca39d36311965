// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The sample bust with a face that talks: morph targets on all of its meshes, and clips that move them. Where
// a point of its skin is then is known in double precision.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/math.h"

namespace hairloom::test {

/// browsUp lifts the front of the head, jawOpen lowers what is below the ears; metres at weight 1.
inline std::array<Vec3d, 2> morphOffsets(const Vec3d& rest) {
    const double brow = std::exp(-(rest - Vec3d(0, 1.72, 0.08)).squaredNorm() / (2 * 0.05 * 0.05));
    const double jaw = std::exp(-(rest - Vec3d(0, 1.58, 0.06)).squaredNorm() / (2 * 0.04 * 0.04));
    return {Vec3d(0, 0.012 * brow, 0.006 * brow), Vec3d(0, -0.02 * jaw, 0)};
}

/// Linear between keys at a quarter of a second each.
inline double keyedAt(const std::array<double, 5>& keys, double time) {
    const double at = std::clamp(time, 0.0, 1.0) * 4;
    const auto k = std::min<std::size_t>(static_cast<std::size_t>(at), 3);
    return keys[k] + (at - static_cast<double>(k)) * (keys[k + 1] - keys[k]);
}

/// Both clips last a second. "talk" turns the head about X, too; "frown" leaves all bones at rest.
struct FaceAt {
    double browsUp = 0, jawOpen = 0, radians = 0;
};
inline constexpr std::array<double, 5> kTalkBrows{0, 1, 0.2, 1.2, 0}, kTalkJaw{0, 0.5, 1, 0.3, 0},
    kTalkTurn{0, 0.2, 0.1, -0.15, 0}, kFrownBrows{-0.5, -0.9, -0.6, -1, -0.5}, kFrownJaw{0, 0, 0.4, 0, 0};
inline FaceAt talkAt(double time) {
    return {keyedAt(kTalkBrows, time), keyedAt(kTalkJaw, time), keyedAt(kTalkTurn, time)};
}
inline FaceAt frownAt(double time) {
    return {keyedAt(kFrownBrows, time), keyedAt(kFrownJaw, time), 0};
}
inline FaceAt between(const FaceAt& a, const FaceAt& b, double share) {
    return {a.browsUp + share * (b.browsUp - a.browsUp), a.jawOpen + share * (b.jawOpen - a.jawOpen),
            a.radians + share * (b.radians - a.radians)};
}

/// A point of the skin that follows the bone "head" by this weight and bones that stay by the rest of it:
/// morphed, then skinned (glTF 2.0, 3.7.3).
inline Vec3d skinAt(const Vec3d& rest, double weightOfHead, const FaceAt& face) {
    const auto offsets = morphOffsets(rest);
    const Vec3d morphed = rest + face.browsUp * offsets[0] + face.jawOpen * offsets[1];
    const Vec3d joint(0, 1.446 + 0.06 + 0.11, -0.045 + 0.005 + 0.02);
    const Eigen::AngleAxisd turn(face.radians, Vec3d::UnitX());
    const Vec3d turned = joint + turn * (morphed - joint);
    return (1 - weightOfHead) * morphed + weightOfHead * turned;
}

/// The bytes of such a bust. `plain`: the file of the sample, a GLB.
inline std::string talkingBust(const std::string& plain) {
    using Json = nlohmann::json;
    std::ifstream stream(plain, std::ios::binary);
    const std::string source((std::istreambuf_iterator<char>(stream)), {});
    const auto wordAt = [&](std::size_t at) {
        std::uint32_t word = 0;
        std::memcpy(&word, source.data() + at, 4);
        return std::size_t{word};
    };
    Json json = Json::parse(source.substr(20, wordAt(12)));
    std::string bytes = source.substr(20 + wordAt(12) + 8);

    const auto add = [&](const std::vector<float>& values, const char* type, std::size_t components) {
        bytes.resize((bytes.size() + 3) / 4 * 4);
        json["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * 4}});
        bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * 4);
        json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                     {"componentType", 5126},
                                     {"count", values.size() / components},
                                     {"type", type}});
        return json["accessors"].size() - 1;
    };
    for (Json& mesh : json["meshes"]) {
        for (Json& primitive : mesh["primitives"]) {
            const Json accessor = json["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
            const Json view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
            const std::size_t first = view.value("byteOffset", 0u) + accessor.value("byteOffset", 0u);
            std::array<std::vector<float>, 2> offsets;
            for (std::size_t v = 0; v < accessor["count"].get<std::size_t>(); ++v) {
                Vec3f rest;
                std::memcpy(rest.data(), bytes.data() + first + v * 12, 12);
                const auto moved = morphOffsets(rest.cast<double>());
                for (std::size_t target = 0; target < 2; ++target) {
                    for (int axis = 0; axis < 3; ++axis)
                        offsets[target].push_back(static_cast<float>(moved[target][axis]));
                }
            }
            for (const auto& target : offsets)
                primitive["targets"].push_back({{"POSITION", add(target, "VEC3", 3)}});
        }
        mesh["weights"] = {0, 0};
        mesh["extras"]["targetNames"] = {"browsUp", "jawOpen"};
    }
    const std::size_t times = add({0, 0.25f, 0.5f, 0.75f, 1}, "SCALAR", 1);
    const auto weights = [&](const std::array<double, 5>& brows, const std::array<double, 5>& jaw) {
        std::vector<float> values;
        for (std::size_t k = 0; k < 5; ++k)
            values.insert(values.end(), {static_cast<float>(brows[k]), static_cast<float>(jaw[k])});
        return add(values, "SCALAR", 1);
    };
    std::vector<float> turns;
    for (const double angle : kTalkTurn)
        turns.insert(turns.end(), {static_cast<float>(std::sin(angle / 2)), 0, 0,
                                   static_cast<float>(std::cos(angle / 2))});
    const std::size_t turn = add(turns, "VEC4", 4);
    const auto clip = [&](const char* name, std::size_t output) {
        Json made{{"name", name}, {"samplers", {{{"input", times}, {"output", output}}}}, {"channels", {}}};
        for (std::size_t node = 0; node < json["nodes"].size(); ++node) {
            if (json["nodes"][node].contains("mesh"))
                made["channels"].push_back(
                    {{"sampler", 0}, {"target", {{"node", node}, {"path", "weights"}}}});
        }
        return made;
    };
    Json talk = clip("talk", weights(kTalkBrows, kTalkJaw));
    for (std::size_t node = 0; node < json["nodes"].size(); ++node) {
        if (json["nodes"][node]["name"] != "head") continue;
        talk["samplers"].push_back({{"input", times}, {"output", turn}});
        talk["channels"].push_back({{"sampler", 1}, {"target", {{"node", node}, {"path", "rotation"}}}});
    }
    json["animations"].push_back(std::move(talk));
    json["animations"].push_back(clip("frown", weights(kFrownBrows, kFrownJaw)));

    bytes.resize((bytes.size() + 3) / 4 * 4);
    json["buffers"][0]["byteLength"] = bytes.size();
    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string glb = "glTF";
    const auto word = [&](std::size_t value) {
        const auto number = static_cast<std::uint32_t>(value);
        glb.append(reinterpret_cast<const char*>(&number), 4);
    };
    word(2), word(12 + 8 + text.size() + 8 + bytes.size());
    word(text.size()), glb += "JSON" + text;
    word(bytes.size()), glb += std::string("BIN\0", 4) + bytes;
    return glb;
}

}  // namespace hairloom::test
