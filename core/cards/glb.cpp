// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/glb.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/cards/atlas_images.h"
#include "core/cards/rig.h"
#include "core/render/png.h"

namespace hairloom::cards {
namespace {

using Json = nlohmann::ordered_json;

// What springs are set to; how the strands of the groom move is not in it.
constexpr double kStiffness = 0.6, kDrag = 0.4, kGravity = 0.2, kHitRadius = 0.008;

constexpr int kFloat = 5126, kUnsignedInt = 5125, kUnsignedShort = 5123;
constexpr int kVertices = 34962, kIndices = 34963;

Json toJson(const Vec3f& v) {
    return Json::array({v.x(), v.y(), v.z()});
}

/// What a vertex of either kind of level has in the file.
struct Arrays {
    std::vector<Vec3f> positions, normals, colours;
    std::vector<Vec4f> tangents, weights;
    std::vector<Vec2f> uvs;
    std::vector<std::array<std::uint16_t, 4>> joints;
    std::vector<std::uint32_t> indices;
};

class Writer {
  public:
    Json json;
    std::vector<std::byte> bin;

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

/// The most that the tint of nearly all vertices is: it goes into the texture, for colours of vertices end
/// at 1.
float tintScale(const Cards& cards) {
    std::vector<float> most;
    for (const CardVertex& v : cards.mesh.vertices) most.push_back(v.tint.maxCoeff());
    const auto at = most.begin() + static_cast<std::ptrdiff_t>(most.size() * 98 / 100);
    std::nth_element(most.begin(), at, most.end());
    return std::max(1.0f, *at);
}

Arrays arraysOf(const Cards& cards, const Rig& rig, float scale) {
    Arrays a;
    for (const CardVertex& v : cards.mesh.vertices) {
        a.positions.push_back(v.position_ws), a.normals.push_back(v.normal_ws), a.uvs.push_back(v.uv);
        a.colours.push_back((v.tint / scale).cwiseMin(1.0f));
        // glTF's tangent is the direction of u, and its bitangent that of -v in images whose rows go down.
        Vec3f across = v.normal_ws.cross(v.along_ws);
        across = (across - across.dot(v.normal_ws) * v.normal_ws).normalized();
        const float hand = v.normal_ws.cross(across).dot(-v.along_ws) < 0 ? -1.0f : 1.0f;
        a.tangents.emplace_back(across.x(), across.y(), across.z(), hand);
    }
    const Binding binding = bind(rig, cards);
    a.joints = binding.joints, a.weights = binding.weights;
    a.indices = cards.mesh.indices;
    return a;
}

Arrays arraysOf(const Shell& shell) {
    Arrays a;
    for (const ShellVertex& v : shell.vertices) {
        a.positions.push_back(v.position_ws), a.normals.push_back(v.normal_ws);
        a.colours.push_back((v.open * v.albedo).cwiseMin(1.0f));
        a.joints.push_back({}), a.weights.emplace_back(1, 0, 0, 0);
    }
    a.indices = shell.indices;
    return a;
}

Status addCardMaterial(Writer& w, const Level& level, const Cards& cards, float scale) {
    Picture picture = cards.atlas.levels[0];
    for (Texel& t : picture.texels) t.albedo = (scale * t.albedo).cwiseMin(1.0f);
    if (auto status = w.image(colourImage(picture, 1), level.name + " colour"); !status) return status;
    const std::size_t colour = w.lastTexture();
    if (auto status = w.image(normalImage(picture), level.name + " normal"); !status) return status;
    const std::size_t normal = w.lastTexture();
    if (auto status = w.image(occlusionImage(picture), level.name + " occlusion"); !status) return status;
    w.json["materials"].push_back(
        Json{{"name", level.name},
             {"pbrMetallicRoughness",
              {{"baseColorTexture", {{"index", colour}}}, {"metallicFactor", 0}, {"roughnessFactor", 0.55}}},
             {"normalTexture", {{"index", normal}}},
             {"occlusionTexture", {{"index", w.lastTexture()}}},
             {"alphaMode", "MASK"},
             {"alphaCutoff", cards.atlas.threshold},
             {"doubleSided", true}});
    return {};
}

void addMesh(Writer& w, const Level& level, const Arrays& a) {
    Json attributes{{"POSITION", w.positions(a.positions)},
                    {"NORMAL", w.accessor(a.normals, kFloat, "VEC3", kVertices)},
                    {"COLOR_0", w.accessor(a.colours, kFloat, "VEC3", kVertices)},
                    {"JOINTS_0", w.accessor(a.joints, kUnsignedShort, "VEC4", kVertices)},
                    {"WEIGHTS_0", w.accessor(a.weights, kFloat, "VEC4", kVertices)}};
    if (!a.uvs.empty()) {
        attributes["TEXCOORD_0"] = w.accessor(a.uvs, kFloat, "VEC2", kVertices);
        attributes["TANGENT"] = w.accessor(a.tangents, kFloat, "VEC4", kVertices);
    }
    const std::size_t indices = w.accessor(a.indices, kUnsignedInt, "SCALAR", kIndices);
    w.json["meshes"].push_back(
        Json{{"name", level.name},
             {"primitives", Json::array({Json{{"attributes", std::move(attributes)},
                                              {"indices", indices},
                                              {"material", w.json["materials"].size() - 1}}})}});
}

/// Nodes of the joints, the head's first, and the skin.
void addRig(Writer& w, const Rig& rig) {
    std::vector<Eigen::Matrix4f> inverse;
    Json joints = Json::array();
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        const Joint& joint = rig.joints[j];
        Vec3f at = joint.position_ws;
        if (joint.parent >= 0) at -= rig.joints[static_cast<std::size_t>(joint.parent)].position_ws;
        const std::string name =
            j == 0 ? "head" : fmt::format("hair_{}_{}", (j - 1) / rig.perChain, (j - 1) % rig.perChain);
        w.json["nodes"].push_back(Json{{"name", name}, {"translation", toJson(at)}});
        if (joint.parent >= 0)
            w.json["nodes"][static_cast<std::size_t>(joint.parent)]["children"].push_back(j);
        Eigen::Matrix4f bind = Eigen::Matrix4f::Identity();
        bind.topRightCorner<3, 1>() = -joint.position_ws;
        inverse.push_back(bind);
        joints.push_back(j);
    }
    const std::size_t matrices = w.accessor(inverse, kFloat, "MAT4", 0);
    w.json["skins"] =
        Json::array({Json{{"inverseBindMatrices", matrices}, {"joints", joints}, {"skeleton", 0}}});
}

/// VRMC_springBone 1.0: a spring for each chain.
void addSprings(Writer& w, const Rig& rig, std::span<const Collider> colliders) {
    Json spheres = Json::array(), all = Json::array(), springs = Json::array();
    for (std::size_t c = 0; c < colliders.size(); ++c) {
        spheres.push_back(Json{{"node", 0},
                               {"shape",
                                {{"sphere",
                                  {{"offset", toJson(colliders[c].centre_ws - rig.joints[0].position_ws)},
                                   {"radius", colliders[c].radius}}}}}});
        all.push_back(c);
    }
    for (std::size_t chain = 0; chain < rig.chains(); ++chain) {
        Json joints = Json::array();
        for (std::uint32_t j = 0; j < rig.perChain; ++j) {
            joints.push_back(Json{{"node", 1 + chain * rig.perChain + j},
                                  {"hitRadius", kHitRadius},
                                  {"stiffness", kStiffness},
                                  {"gravityPower", kGravity},
                                  {"gravityDir", Json::array({0, -1, 0})},
                                  {"dragForce", kDrag}});
        }
        Json spring{{"name", fmt::format("hair {}", chain)}, {"joints", std::move(joints)}};
        if (!colliders.empty()) spring["colliderGroups"] = Json::array({0});
        springs.push_back(std::move(spring));
    }
    Json extension{{"specVersion", "1.0"}};
    if (!colliders.empty()) {
        extension["colliders"] = std::move(spheres);
        extension["colliderGroups"] = Json::array({Json{{"name", "head"}, {"colliders", std::move(all)}}});
    }
    extension["springs"] = std::move(springs);
    w.json["extensionsUsed"].push_back("VRMC_springBone");
    w.json["extensions"]["VRMC_springBone"] = std::move(extension);
}

}  // namespace

Result<std::vector<std::byte>> glbOf(const std::vector<const Level*>& levels,
                                     std::span<const Collider> colliders) {
    std::vector<const Level*> held;
    const Cards* first = nullptr;
    for (const Level* level : levels) {
        if (level->spec.kind == LevelKind::strands) continue;
        held.push_back(level);
        if (first == nullptr) first = std::get_if<Cards>(&level->content);
    }
    if (held.empty()) return fail("no level that glTF can hold", "one of cards or a shell");
    Rig rig{kJointsPerChain, {Joint{Vec3f::Zero(), -1}}, {}};
    if (first != nullptr) {
        auto made = makeRig(*first, kChains, kJointsPerChain, nullptr);
        if (!made) return tl::unexpected(made.error());
        rig = std::move(*made);
    }
    Writer w;
    w.json = Json{{"asset", {{"version", "2.0"}, {"generator", "Hairloom"}}}, {"scene", 0}};
    w.json["nodes"] = Json::array();
    addRig(w, rig);
    for (const Level* level : held) {
        if (const auto* cards = std::get_if<Cards>(&level->content)) {
            const float scale = tintScale(*cards);
            if (auto status = addCardMaterial(w, *level, *cards, scale); !status)
                return tl::unexpected(status.error());
            addMesh(w, *level, arraysOf(*cards, rig, scale));
        } else {
            w.json["materials"].push_back(
                Json{{"name", level->name},
                     {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.7}}}});
            addMesh(w, *level, arraysOf(std::get<Shell>(level->content)));
        }
        w.json["nodes"].push_back(
            Json{{"name", level->name}, {"mesh", w.json["meshes"].size() - 1}, {"skin", 0}});
    }
    if (w.json.contains("textures"))
        w.json["samplers"] =
            Json::array({Json{{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 33071}, {"wrapT", 33071}}});
    const std::size_t nearest = rig.joints.size();
    w.json["scenes"] = Json::array({Json{{"nodes", Json::array({0, nearest})}}});
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
    if (rig.chains() > 0) addSprings(w, rig, colliders);
    return w.file();
}

}  // namespace hairloom::cards
