// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/glb.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/cards/atlas_images.h"
#include "core/cards/level_arrays.h"
#include "core/render/png.h"

namespace hairloom::cards {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFloat = 5126, kUnsignedInt = 5125, kUnsignedShort = 5123, kShort = 5122, kUnsignedByte = 5121,
              kByte = 5120;
constexpr int kVertices = 34962, kIndices = 34963;
/// Of keratin.
constexpr double kHairIor = 1.55;

Json toJson(const Vec3f& v) {
    return Json::array({v.x(), v.y(), v.z()});
}

class Writer {
  public:
    Json json;
    std::vector<std::byte> bin;
    Cancel cancel = nullptr;

    /// Appends a view of raw bytes, aligned to four; its index.
    std::size_t view(const void* data, std::size_t bytes, int target) {
        bin.resize((bin.size() + 3) / 4 * 4);
        const std::size_t offset = bin.size();
        bin.resize(offset + bytes);
        if (bytes > 0) std::memcpy(bin.data() + offset, data, bytes);
        Json entry{{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}};
        if (target != 0) entry["target"] = target;
        json["bufferViews"].push_back(std::move(entry));
        return json["bufferViews"].size() - 1;
    }
    /// Integers that stand for -1 … 1 or 0 … 1; `T` may have more of them than the type, for padding.
    template <class T>
    std::size_t packed(const std::vector<T>& values, int component, const char* type) {
        const std::size_t of = accessor(values, component, type, kVertices);
        json["accessors"][of]["normalized"] = true;
        json["bufferViews"].back()["byteStride"] = sizeof(T);
        return of;
    }
    template <class T>
    std::size_t accessor(const std::vector<T>& values, int component, const char* type, int target) {
        const std::size_t of = view(values.data(), values.size() * sizeof(T), target);
        json["accessors"].push_back(
            Json{{"bufferView", of}, {"componentType", component}, {"count", values.size()}, {"type", type}});
        return json["accessors"].size() - 1;
    }
    std::size_t positions(const std::vector<Vec3f>& values) {
        const std::size_t of = accessor(values, kFloat, "VEC3", kVertices);
        Vec3f low = Vec3f::Constant(std::numeric_limits<float>::infinity()), high = -low;
        for (const Vec3f& p : values) low = low.cwiseMin(p), high = high.cwiseMax(p);
        json["accessors"][of]["min"] = toJson(low), json["accessors"][of]["max"] = toJson(high);
        return of;
    }
    Status image(const render::Image& picture, const std::string& name) {
        if (cancelled(cancel)) return stopped();
        const auto file = render::encodePng(picture);
        if (!file) return tl::unexpected(file.error());
        const std::size_t of = view(file->data(), file->size(), 0);
        json["images"].push_back(Json{{"name", name}, {"mimeType", "image/png"}, {"bufferView", of}});
        json["textures"].push_back(Json{{"sampler", 0}, {"source", json["images"].size() - 1}});
        return {};
    }
    std::size_t lastTexture() const { return json["textures"].size() - 1; }

    Result<std::vector<std::byte>> file() {
        bin.resize((bin.size() + 3) / 4 * 4);
        json["buffers"] = Json::array({Json{{"byteLength", bin.size()}}});
        std::string text = json.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        const std::uint64_t all = 12 + 8 + text.size() + 8 + bin.size();
        if (all > std::numeric_limits<std::uint32_t>::max())
            return fail("a file of more than 4 GB", "smaller textures");
        std::vector<std::byte> out;
        const auto put = [&](std::uint32_t value) {
            for (std::uint32_t shift = 0; shift < 32; shift += 8)
                out.push_back(static_cast<std::byte>(value >> shift & 0xffu));
        };
        for (const std::uint32_t word : {0x46546C67u, 2u, static_cast<std::uint32_t>(all)}) put(word);
        put(static_cast<std::uint32_t>(text.size())), put(0x4E4F534Au);
        for (const char c : text) out.push_back(static_cast<std::byte>(c));
        put(static_cast<std::uint32_t>(bin.size())), put(0x004E4942u);
        out.insert(out.end(), bin.begin(), bin.end());
        return out;
    }
};

Status addCardMaterial(Writer& w, const Level& level, const Cards& cards, float scale) {
    const Picture picture = brightened(cards.atlas, scale);
    if (auto status = w.image(colourImage(picture, 1), level.name + " colour"); !status) return status;
    const std::size_t colour = w.lastTexture();
    if (auto status = w.image(normalImage(picture), level.name + " normal"); !status) return status;
    const std::size_t normal = w.lastTexture();
    if (auto status = w.image(occlusionImage(picture), level.name + " occlusion"); !status) return status;
    // Highlights of hair lie across it: rough that way, which is the tangent, and smoother along a strand.
    constexpr double kRoughAlong = 0.45, kStrength = 0.7;
    w.json["materials"].push_back(
        Json{{"name", level.name},
             {"pbrMetallicRoughness",
              {{"baseColorTexture", {{"index", colour}}},
               {"metallicFactor", 0},
               {"roughnessFactor", kRoughAlong}}},
             {"extensions",
              {{"KHR_materials_anisotropy", {{"anisotropyStrength", kStrength}, {"anisotropyRotation", 0}}},
               {"KHR_materials_ior", {{"ior", kHairIor}}}}},
             {"normalTexture", {{"index", normal}}},
             {"occlusionTexture", {{"index", w.lastTexture()}}},
             {"alphaMode", "MASK"},
             {"alphaCutoff", cards.atlas.threshold},
             {"doubleSided", true}});
    return {};
}

/// Positions of quantised vertices are -1 … 1 in this cube.
struct Cube {
    Vec3f middle_ws = Vec3f::Zero();
    float half = 1;  ///< metres
};

Cube cubeAround(const std::vector<LevelArrays>& levels) {
    Box3f box;
    for (const LevelArrays& a : levels)
        for (const Vec3f& p : a.positions_ws) box.extend(p);
    return {box.center(), std::max(1e-6f, 0.5f * box.sizes().maxCoeff())};
}

template <class T, int kCount>
std::array<T, kCount> integers(const auto& values, int count) {
    std::array<T, kCount> all{};
    for (int i = 0; i < count; ++i) {
        const float share = std::clamp(values[i], -1.0f, 1.0f);
        all[static_cast<std::size_t>(i)] =
            static_cast<T>(std::lround(share * static_cast<float>(std::numeric_limits<T>::max())));
    }
    return all;
}

/// Of 255; what rounding leaves goes to the largest, so that the sum is that.
std::array<std::uint8_t, 4> weightsOf(const Vec4f& weights) {
    auto bytes = integers<std::uint8_t, 4>(weights, 4);
    int sum = 0;
    for (const std::uint8_t byte : bytes) sum += byte;
    auto& largest = *std::ranges::max_element(bytes);
    largest = static_cast<std::uint8_t>(largest + 255 - sum);
    return bytes;
}

/// As bytes, where there are no more joints.
std::size_t smallJoints(Writer& w, const std::vector<std::array<std::uint16_t, 4>>& joints) {
    std::vector<std::array<std::uint8_t, 4>> bytes;
    for (const auto& of : joints) {
        if (*std::ranges::max_element(of) > std::numeric_limits<std::uint8_t>::max())
            return w.accessor(joints, kUnsignedShort, "VEC4", kVertices);
        std::ranges::transform(of, bytes.emplace_back().begin(),
                               [](std::uint16_t joint) { return static_cast<std::uint8_t>(joint); });
    }
    return w.accessor(bytes, kUnsignedByte, "VEC4", kVertices);
}

Json quantised(Writer& w, const LevelArrays& a, const Cube& cube) {
    std::vector<std::array<std::int16_t, 4>> positions;
    std::vector<std::array<std::int8_t, 4>> normals, tangents;
    std::vector<std::array<std::uint16_t, 4>> colours;
    std::vector<std::array<std::uint16_t, 2>> uvs;
    std::vector<std::array<std::uint8_t, 4>> weights;
    std::vector<std::array<std::uint16_t, 4>> joints = a.joints;
    std::array<std::int16_t, 3> low, high;
    low.fill(std::numeric_limits<std::int16_t>::max()), high.fill(std::numeric_limits<std::int16_t>::min());
    for (std::size_t v = 0; v < a.positions_ws.size(); ++v) {
        positions.push_back(
            integers<std::int16_t, 4>(Vec3f((a.positions_ws[v] - cube.middle_ws) / cube.half), 3));
        for (std::size_t i = 0; i < 3; ++i) {
            low[i] = std::min(low[i], positions[v][i]);
            high[i] = std::max(high[i], positions[v][i]);
        }
        normals.push_back(integers<std::int8_t, 4>(a.normals_ws[v], 3));
        colours.push_back(integers<std::uint16_t, 4>(a.colours[v], 3));
        if (!a.uvs.empty()) {
            uvs.push_back(integers<std::uint16_t, 2>(a.uvs[v], 2));
            tangents.push_back(integers<std::int8_t, 4>(a.tangents_ws[v], 4));
        }
        weights.push_back(weightsOf(a.weights[v]));
        // A weight that rounds to none names no joint.
        for (std::size_t i = 0; i < 4; ++i)
            joints[v][i] = weights[v][i] > 0 ? joints[v][i] : std::uint16_t{0};
    }
    Json attributes{{"POSITION", w.packed(positions, kShort, "VEC3")}};
    w.json["accessors"].back()["min"] = low, w.json["accessors"].back()["max"] = high;
    attributes["NORMAL"] = w.packed(normals, kByte, "VEC3");
    attributes["COLOR_0"] = w.packed(colours, kUnsignedShort, "VEC3");
    attributes["JOINTS_0"] = smallJoints(w, joints);
    attributes["WEIGHTS_0"] = w.packed(weights, kUnsignedByte, "VEC4");
    if (!a.uvs.empty()) {
        attributes["TEXCOORD_0"] = w.packed(uvs, kUnsignedShort, "VEC2");
        attributes["TANGENT"] = w.packed(tangents, kByte, "VEC4");
    }
    return attributes;
}

Json floats(Writer& w, const LevelArrays& a) {
    Json attributes{{"POSITION", w.positions(a.positions_ws)},
                    {"NORMAL", w.accessor(a.normals_ws, kFloat, "VEC3", kVertices)},
                    {"COLOR_0", w.accessor(a.colours, kFloat, "VEC3", kVertices)},
                    {"JOINTS_0", w.accessor(a.joints, kUnsignedShort, "VEC4", kVertices)},
                    {"WEIGHTS_0", w.accessor(a.weights, kFloat, "VEC4", kVertices)}};
    if (!a.uvs.empty()) {
        attributes["TEXCOORD_0"] = w.accessor(a.uvs, kFloat, "VEC2", kVertices);
        attributes["TANGENT"] = w.accessor(a.tangents_ws, kFloat, "VEC4", kVertices);
    }
    return attributes;
}

void addMesh(Writer& w, const Level& level, const LevelArrays& a, const std::optional<Cube>& cube) {
    Json attributes = cube ? quantised(w, a, *cube) : floats(w, a);
    const std::size_t indices = w.accessor(a.indices, kUnsignedInt, "SCALAR", kIndices);
    w.json["meshes"].push_back(
        Json{{"name", level.name},
             {"primitives", Json::array({Json{{"attributes", std::move(attributes)},
                                              {"indices", indices},
                                              {"material", w.json["materials"].size() - 1}}})}});
}

/// Nodes of the joints, the head's first.
void addRig(Writer& w, const Rig& rig, const std::string& rootName) {
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        const Joint& joint = rig.joints[j];
        Vec3f at = joint.position_ws;
        if (joint.parent >= 0) at -= rig.joints[static_cast<std::size_t>(joint.parent)].position_ws;
        const std::string name =
            j == 0 ? rootName : fmt::format("hair_{}_{}", (j - 1) / rig.perChain, (j - 1) % rig.perChain);
        w.json["nodes"].push_back(Json{{"name", name}, {"translation", toJson(at)}});
        if (joint.parent >= 0)
            w.json["nodes"][static_cast<std::size_t>(joint.parent)]["children"].push_back(j);
    }
}

/// Joints of the rig, then the character's bones, whose nodes are the last.
void addSkin(Writer& w, const Rig& rig, const Character& character, const Cube& cube) {
    Eigen::Matrix4f placed = Eigen::Matrix4f::Identity();
    placed.topLeftCorner<3, 3>() *= cube.half;
    placed.topRightCorner<3, 1>() = cube.middle_ws;
    std::vector<Eigen::Matrix4f> inverse;
    Json joints = Json::array();
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        inverse.push_back(placed);
        inverse.back().topRightCorner<3, 1>() -= rig.joints[j].position_ws;
        joints.push_back(j);
    }
    const std::size_t first = w.json["nodes"].size() - character.bones.size();
    for (std::size_t b = 0; b < character.bones.size(); ++b) {
        inverse.emplace_back(character.bones[b].bind_ws.inverse().matrix() * placed);
        inverse.back().bottomRows<1>() << 0, 0, 0, 1;  // what division rounds, readers refuse
        joints.push_back(first + b);
    }
    Json skin{{"inverseBindMatrices", w.accessor(inverse, kFloat, "MAT4", 0)}, {"joints", std::move(joints)}};
    if (character.bones.empty()) skin["skeleton"] = 0;
    w.json["skins"] = Json::array({std::move(skin)});
}

/// Where a node is at rest, from what it hangs on.
void placeNode(Json& node, const Eigen::Affine3f& local) {
    Mat3f turn, scale;
    local.computeRotationScaling(&turn, &scale);
    const Quatf rotation = Quatf(turn).normalized();
    node["translation"] = toJson(local.translation());
    if (rotation.vec().norm() > 1e-6f)
        node["rotation"] = Json::array({rotation.x(), rotation.y(), rotation.z(), rotation.w()});
    if (!scale.isIdentity(1e-5f)) node["scale"] = toJson(scale.diagonal());
}

/// A joint of the rig, which now hangs on a node that is elsewhere.
void hangJoint(Writer& w, const Rig& rig, std::size_t joint, std::size_t node,
               const Eigen::Affine3f& node_ws) {
    const Eigen::Affine3f joint_ws(Eigen::Translation3f(rig.joints[joint].position_ws));
    placeNode(w.json["nodes"][joint], node_ws.inverse() * joint_ws);
    w.json["nodes"][node]["children"].push_back(joint);
}

/// The character's bones behind all other nodes; the rig goes to its head, and chains to the bones of their
/// roots. The node that hangs on none.
std::size_t addCharacter(Writer& w, const Chain& chain, const Character& character) {
    const Rig& rig = chain.rig;
    Json roots = Json::array();
    const auto isRoot = [](const Character::Bone& bone) { return bone.parent < 0; };
    if (std::ranges::count_if(character.bones, isRoot) > 1)
        w.json["nodes"].push_back(Json{{"name", "skeleton"}});
    const std::size_t first = w.json["nodes"].size();
    const auto nodeOf = [&](std::int32_t bone) { return first + static_cast<std::size_t>(bone); };
    const auto bindOf = [&](std::int32_t bone) {
        return character.bones[static_cast<std::size_t>(bone)].bind_ws;
    };
    for (const Character::Bone& bone : character.bones) {
        Json node{{"name", bone.name}};
        const std::size_t number = w.json["nodes"].size();
        if (isRoot(bone)) {
            placeNode(node, bone.bind_ws);
            roots.push_back(number);
        } else {
            placeNode(node, bindOf(bone.parent).inverse() * bone.bind_ws);
            w.json["nodes"][nodeOf(bone.parent)]["children"].push_back(number);
        }
        w.json["nodes"].push_back(std::move(node));
    }
    if (character.head < 0) return 0;
    hangJoint(w, rig, 0, nodeOf(character.head), bindOf(character.head));
    const std::vector<std::int32_t> bones = bonesOfChains(chain, character);
    Json stay = Json::array();
    for (std::size_t c = 0; c < bones.size(); ++c) {
        const std::size_t joint = 1 + c * rig.perChain;
        if (bones[c] == character.head)
            stay.push_back(joint);
        else
            hangJoint(w, rig, joint, nodeOf(bones[c]), bindOf(bones[c]));
    }
    w.json["nodes"][0].erase("children");
    if (!stay.empty()) w.json["nodes"][0]["children"] = std::move(stay);
    // A skin wants one node above all of its joints.
    if (roots.size() == 1) return roots[0];
    w.json["nodes"][first - 1]["children"] = std::move(roots);
    return first - 1;
}

/// VRMC_vrm 1.0. Whose it is and what others may do with it is the author's to say: the strictest until then.
void addAvatar(Writer& w, const Character& character) {
    const std::size_t firstBone = w.json["nodes"].size() - character.bones.size();
    Json bones = Json::object();
    for (const auto& [name, bone] : character.humanoid)
        bones[name] = Json{{"node", firstBone + static_cast<std::size_t>(bone)}};
    w.json["extensionsUsed"].push_back("VRMC_vrm");
    w.json["extensions"]["VRMC_vrm"] = Json{{"specVersion", "1.0"},
                                            {"meta",
                                             {{"name", character.name},
                                              {"authors", Json::array({"not named"})},
                                              {"licenseUrl", "https://vrm.dev/licenses/1.0/"},
                                              {"avatarPermission", "onlyAuthor"},
                                              {"commercialUsage", "personalNonProfit"},
                                              {"modification", "prohibited"}}},
                                            {"humanoid", {{"humanBones", std::move(bones)}}}};
}

/// Of a collider: its node, and where that is at rest.
struct Held {
    std::size_t node = 0;
    Eigen::Affine3f bind_ws = Eigen::Affine3f::Identity();
};
Held heldBy(const Collider& collider, const Rig& rig, const Character& character, std::size_t firstBone) {
    const auto bone = std::ranges::find(character.bones, collider.bone, &Character::Bone::name);
    if (collider.bone.empty() || bone == character.bones.end())
        return {0, Eigen::Affine3f(Eigen::Translation3f(rig.joints[0].position_ws))};
    return {firstBone + static_cast<std::size_t>(bone - character.bones.begin()), bone->bind_ws};
}

/// VRMC_springBone 1.0: a spring for each chain, a group for each collider, so that chains leave out those
/// that they stand in at rest.
void addSprings(Writer& w, const Rig& rig, std::span<const Spring> fitted,
                std::span<const Collider> colliders, const Character& character) {
    Json spheres = Json::array(), groups = Json::array(), springs = Json::array();
    const std::size_t firstBone = w.json["nodes"].size() - character.bones.size();
    for (std::size_t c = 0; c < colliders.size(); ++c) {
        const Held held = heldBy(colliders[c], rig, character, firstBone);
        const float scale = std::cbrt(std::abs(held.bind_ws.linear().determinant()));
        spheres.push_back(Json{{"node", held.node},
                               {"shape",
                                {{"sphere",
                                  {{"offset", toJson(held.bind_ws.inverse() * colliders[c].centre_ws)},
                                   {"radius", colliders[c].radius / scale}}}}}});
        groups.push_back(Json{{"name", fmt::format("sphere {}", c)}, {"colliders", Json::array({c})}});
    }
    for (std::size_t chain = 0; chain < rig.chains(); ++chain) {
        const Spring& spring = fitted[chain];
        Json joints = Json::array();
        for (std::uint32_t j = 0; j < rig.perChain; ++j) {
            joints.push_back(Json{{"node", 1 + chain * rig.perChain + j},
                                  {"hitRadius", spring.hitRadius},
                                  {"stiffness", spring.stiffnessAt(j, rig.perChain)},
                                  {"gravityPower", spring.gravity},
                                  {"gravityDir", Json::array({0, -1, 0})},
                                  {"dragForce", spring.drag}});
        }
        Json entry{{"name", fmt::format("hair {}", chain)}, {"joints", std::move(joints)}};
        if (const auto held = collidersOfChain(rig, chain, colliders); !held.empty())
            entry["colliderGroups"] = held;
        springs.push_back(std::move(entry));
    }
    Json extension{{"specVersion", "1.0"}};
    if (!colliders.empty()) {
        extension["colliders"] = std::move(spheres);
        extension["colliderGroups"] = std::move(groups);
    }
    extension["springs"] = std::move(springs);
    w.json["extensionsUsed"].push_back("VRMC_springBone");
    w.json["extensions"]["VRMC_springBone"] = std::move(extension);
}

}  // namespace

Result<std::vector<std::byte>> glbOf(const Chain& chain, std::span<const Collider> colliders,
                                     GlbNumbers numbers, const Character& character, Cancel cancel) {
    std::vector<const Level*> held;
    for (const Level& level : chain.levels)
        if (level.spec.kind != LevelKind::strands) held.push_back(&level);
    if (held.empty()) return fail("no level that glTF can hold", "one of cards or a shell");
    const Rig& rig = chain.rig;
    Writer w;
    w.cancel = cancel;
    w.json = Json{{"asset", {{"version", "2.0"}, {"generator", "Hairloom"}}}, {"scene", 0}};
    w.json["nodes"] = Json::array();
    std::vector<LevelArrays> arrays;
    for (const Level* level : held) {
        arrays.push_back(arraysOf(*level, rig));
        hangOnBones(*level, chain, character, arrays.back());
    }
    std::optional<Cube> cube;
    if (numbers == GlbNumbers::quantised) {
        cube = cubeAround(arrays);
        w.json["extensionsUsed"].push_back("KHR_mesh_quantization");
        w.json["extensionsRequired"].push_back("KHR_mesh_quantization");
    }
    // Not the name that the character's own bone has.
    addRig(w, rig, character.bones.empty() ? "head" : "hair");
    bool hasCards = false;
    for (std::size_t i = 0; i < held.size(); ++i) {
        const Level* const level = held[i];
        if (const auto* cards = std::get_if<Cards>(&level->content)) {
            hasCards = true;
            if (auto status = addCardMaterial(w, *level, *cards, arrays[i].albedoScale); !status)
                return tl::unexpected(status.error());
        } else {
            w.json["materials"].push_back(
                Json{{"name", level->name},
                     {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.7}}},
                     {"extensions", {{"KHR_materials_ior", {{"ior", kHairIor}}}}}});
        }
        addMesh(w, *level, arrays[i], cube);
        w.json["nodes"].push_back(
            Json{{"name", level->name}, {"mesh", w.json["meshes"].size() - 1}, {"skin", 0}});
    }
    if (w.json.contains("textures"))
        w.json["samplers"] =
            Json::array({Json{{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 33071}, {"wrapT", 33071}}});
    const std::size_t nearest = rig.joints.size();
    w.json["extensionsUsed"].push_back("KHR_materials_ior");
    if (hasCards) w.json["extensionsUsed"].push_back("KHR_materials_anisotropy");
    const std::size_t root = addCharacter(w, chain, character);
    addSkin(w, rig, character, cube.value_or(Cube()));
    w.json["scenes"] = Json::array({Json{{"nodes", {root, nearest}}}});
    if (held.size() > 1) {
        Json ids = Json::array(), shares = Json::array();
        for (std::size_t i = 1; i < held.size(); ++i) {
            ids.push_back(nearest + i);
            shares.push_back(static_cast<double>(held[i]->spec.headPx) * 2 / 1080);
        }
        shares.push_back(0);
        w.json["extensionsUsed"].push_back("MSFT_lod");
        w.json["nodes"][nearest]["extensions"]["MSFT_lod"] = Json{{"ids", std::move(ids)}};
        w.json["nodes"][nearest]["extras"]["MSFT_screencoverage"] = std::move(shares);
    }
    if (!character.humanoid.empty()) addAvatar(w, character);
    // Springs swing as they were fitted at this rate alone.
    if (chain.springFit) w.json["extras"]["spring_hz"] = chain.springFit->hz;
    if (rig.chains() > 0) addSprings(w, rig, chain.springs, colliders, character);
    return w.file();
}

}  // namespace hairloom::cards
