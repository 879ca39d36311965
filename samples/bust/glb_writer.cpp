// SPDX-License-Identifier: GPL-3.0-or-later
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/file.h"
#include "samples/bust/rig.h"
#include "samples/bust/writers.h"

namespace hairloom::bust {
namespace {

using Json = nlohmann::ordered_json;

// Constants of the glTF 2.0 specification.
constexpr int kFloat = 5126;
constexpr int kUnsignedByte = 5121;
constexpr int kUnsignedShort = 5123;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr std::uint32_t kMagic = 0x46546C67;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

void words(ByteWriter& file, const std::vector<std::uint32_t>& values) {
    file.writeArray(std::span<const std::uint32_t>(values));
}

class GlbWriter {
  public:
    /// Appends one accessor with a buffer view of its own; target 0 for data that is no vertex or index.
    template <class T>
    int accessor(const std::vector<T>& values, std::size_t width, const char* type, int component,
                 int target) {
        const std::size_t start = binary_.size();
        binary_.writeArray(std::span<const T>(values));
        Json view = {{"buffer", 0}, {"byteOffset", start}, {"byteLength", binary_.size() - start}};
        if (target != 0) view["target"] = target;
        binary_.align(4);
        json["bufferViews"].push_back(view);
        json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                     {"componentType", component},
                                     {"count", values.size() / width},
                                     {"type", type}});
        return static_cast<int>(json["accessors"].size()) - 1;
    }
    int floats(const std::vector<float>& values, std::size_t width, const char* type, int target = 0) {
        return accessor(values, width, type, kFloat, target);
    }
    /// Adds the bounds that the specification asks of positions and of animation times.
    void bound(int accessorIndex, const std::vector<float>& values, std::size_t width) {
        Json low = Json::array();
        Json high = Json::array();
        for (std::size_t k = 0; k < width; ++k) {
            float minimum = values[k];
            float maximum = values[k];
            for (std::size_t i = k; i < values.size(); i += width) {
                minimum = std::min(minimum, values[i]);
                maximum = std::max(maximum, values[i]);
            }
            low.push_back(minimum);
            high.push_back(maximum);
        }
        json["accessors"][accessorIndex]["min"] = low;
        json["accessors"][accessorIndex]["max"] = high;
    }
    std::vector<std::byte> finish() {
        json["buffers"].push_back({{"byteLength", binary_.size()}});
        std::string head = json.dump();
        head.resize((head.size() + 3) / 4 * 4, ' ');
        ByteWriter file;
        file.reserve(28 + head.size() + binary_.size());
        words(file, {kMagic, 2u, static_cast<std::uint32_t>(28 + head.size() + binary_.size())});
        words(file, {static_cast<std::uint32_t>(head.size()), kJsonChunk});
        file.writeArray(std::span<const char>(head));
        words(file, {static_cast<std::uint32_t>(binary_.size()), kBinaryChunk});
        file.writeArray(binary_.bytes());
        const auto bytes = file.bytes();
        return {bytes.begin(), bytes.end()};
    }

    Json json;

  private:
    ByteWriter binary_;
};

void append(std::vector<float>& values, const Vec3d& v) {
    for (const double x : {v.x(), v.y(), v.z()}) values.push_back(static_cast<float>(x));
}

/// A primitive of the triangles of one group.
Json primitive(GlbWriter& glb, const UnwrappedMesh& mesh, Group group) {
    std::vector<float> positions, normals, uvs, weights;
    std::vector<std::uint8_t> joints;
    std::vector<std::uint16_t> indices;
    std::map<int, std::uint16_t> local;
    for (std::size_t t = 0; t < mesh.mesh.triangles.size(); ++t) {
        if (groupOf(mesh.mesh.patches[t]) != group) continue;
        for (const int v : mesh.mesh.triangles[t]) {
            const auto [entry, fresh] = local.try_emplace(v, static_cast<std::uint16_t>(local.size()));
            indices.push_back(entry->second);
            if (!fresh) continue;
            const Vec3d& p = mesh.mesh.positions[v];
            append(positions, p);
            append(normals, gradient(p).normalized());
            uvs.push_back(static_cast<float>(mesh.uv[v].x()));
            uvs.push_back(static_cast<float>(1.0 - mesh.uv[v].y()));
            append(weights, skinWeights(p));
            weights.push_back(0.0f);
            for (std::size_t k = 0; k < 4; ++k) {
                joints.push_back(
                    static_cast<std::uint8_t>(k < 3 && weights[weights.size() - 4 + k] > 0 ? k : 0));
            }
        }
    }
    const int position = glb.floats(positions, 3, "VEC3", kArrayBuffer);
    glb.bound(position, positions, 3);
    const int normal = glb.floats(normals, 3, "VEC3", kArrayBuffer);
    const int uv = glb.floats(uvs, 2, "VEC2", kArrayBuffer);
    const int joint = glb.accessor(joints, 4, "VEC4", kUnsignedByte, kArrayBuffer);
    const int weight = glb.floats(weights, 4, "VEC4", kArrayBuffer);
    const int index = glb.accessor(indices, 1, "SCALAR", kUnsignedShort, kElementArrayBuffer);
    return {{"attributes",
             {{"POSITION", position},
              {"NORMAL", normal},
              {"TEXCOORD_0", uv},
              {"JOINTS_0", joint},
              {"WEIGHTS_0", weight}}},
            {"indices", index},
            {"material", static_cast<int>(group)}};
}

/// Nodes of the bones, the skin over them, and the clip; the first bone becomes node `firstNode`.
void addRig(GlbWriter& glb, int firstNode) {
    Json joints = Json::array();
    std::vector<float> inverseBind;
    for (int i = 0; i < kBoneCount; ++i) {
        const Bone& bone = bones()[i];
        const Vec3d offset =
            bone.position - (bone.parent < 0 ? Vec3d(0, 0, 0) : bones()[bone.parent].position);
        Json node = {{"name", bone.name}, {"translation", {offset.x(), offset.y(), offset.z()}}};
        if (i + 1 < kBoneCount) node["children"] = {firstNode + i + 1};
        glb.json["nodes"].push_back(node);
        joints.push_back(firstNode + i);
        Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
        matrix.topRightCorner<3, 1>() = -bone.position.cast<float>();
        inverseBind.insert(inverseBind.end(), matrix.data(), matrix.data() + 16);
    }
    glb.json["skins"].push_back({{"name", "bust"},
                                 {"inverseBindMatrices", glb.floats(inverseBind, 16, "MAT4")},
                                 {"skeleton", firstNode},
                                 {"joints", joints}});

    std::vector<float> times;
    for (int frame = 0; frame < kClipFrames; ++frame) times.push_back(static_cast<float>(frame / kClipRate));
    const int input = glb.floats(times, 1, "SCALAR");
    glb.bound(input, times, 1);
    Json clip = {{"name", kClipName}};
    for (int i = 0; i < kBoneCount; ++i) {
        std::vector<float> rotations;
        for (int frame = 0; frame < kClipFrames; ++frame) {
            const Eigen::Quaterniond q = boneRotation(i, frame);
            append(rotations, q.vec());
            rotations.push_back(static_cast<float>(q.w()));
        }
        clip["samplers"].push_back(
            {{"input", input}, {"output", glb.floats(rotations, 4, "VEC4")}, {"interpolation", "LINEAR"}});
        clip["channels"].push_back(
            {{"sampler", i}, {"target", {{"node", firstNode + i}, {"path", "rotation"}}}});
    }
    glb.json["animations"].push_back(clip);
}

}  // namespace

std::vector<std::byte> glbBytes(const UnwrappedMesh& mesh) {
    GlbWriter glb;
    glb.json["asset"] = {{"version", "2.0"}, {"generator", "make_bust"}, {"copyright", "CC0 1.0"}};
    glb.json["scene"] = 0;
    Json roots = Json::array();
    for (int i = 0; i <= kGroupCount; ++i) roots.push_back(i);
    glb.json["scenes"].push_back({{"name", "bust"}, {"nodes", roots}});
    for (int i = 0; i < kGroupCount; ++i) {
        const Vec3d c = groupColour(static_cast<Group>(i));
        // Readers find bones by node name, and one of them is called neck too.
        glb.json["nodes"].push_back(
            {{"name", std::string("bust_") + kGroupNames[i]}, {"mesh", i}, {"skin", 0}});
        glb.json["meshes"].push_back(
            {{"name", kGroupNames[i]},
             {"primitives", Json::array({primitive(glb, mesh, static_cast<Group>(i))})}});
        glb.json["materials"].push_back({{"name", kGroupNames[i]},
                                         {"pbrMetallicRoughness",
                                          {{"baseColorFactor", {c.x(), c.y(), c.z(), 1.0}},
                                           {"metallicFactor", 0.0},
                                           {"roughnessFactor", 0.6}}}});
    }
    addRig(glb, kGroupCount);
    return glb.finish();
}

}  // namespace hairloom::bust
