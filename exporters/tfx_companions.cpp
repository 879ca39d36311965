// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/tfx_companions.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>

#include "exporters/character.h"

namespace hairloom {
namespace {

/// Of a bone's name in TressFX's loader, its NUL included.
constexpr std::size_t kMaxNameBytes = 128;

/// Bones by name, and of each strand or vertex up to four of them.
struct NamedWeights {
    std::vector<std::string> bones;
    SkinWeights skin;  ///< of these bones; the strongest first
};

using Influences = std::vector<std::pair<std::uint32_t, float>>;

/// Gives numbers to the bones of a skeleton in the order in which they are met.
class BoneNumbers {
  public:
    explicit BoneNumbers(const Skeleton& skeleton) : skeleton_(skeleton) {}

    std::uint32_t of(std::uint32_t bone, std::vector<std::string>& names) {
        const auto [found, isNew] = numbers_.emplace(bone, static_cast<std::uint32_t>(names.size()));
        if (isNew) names.push_back(skeleton_.bones()[bone].name);
        return found->second;
    }

  private:
    const Skeleton& skeleton_;
    std::map<std::uint32_t, std::uint32_t> numbers_;
};

void add(NamedWeights& weights, const Influences& influences) {
    weights.skin.bones.emplace_back();
    weights.skin.weights.emplace_back();
    setStrongest(weights.skin, weights.skin.vertexCount() - 1, influences, 4);
}

/// Those of a root are its triangle's, by its place on it.
NamedWeights rootWeights(const Groom& groom, const PreparedStrands& strands, const ImportedScene& scene) {
    const auto bindings = groom.rootBindings();
    NamedWeights result;
    BoneNumbers numbers(scene.skeleton);
    for (const std::uint32_t source : strands.sources) {
        const SurfacePoint& root = bindings[source];
        std::map<std::uint32_t, float> sums;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = scene.mesh.triangles()[root.triangle][corner];
            for (std::size_t i = 0; i < kBonesOfVertex; ++i) {
                const float weight =
                    scene.skin.weights[vertex][i] * root.barycentric[static_cast<Eigen::Index>(corner)];
                if (weight > 0) sums[numbers.of(scene.skin.bones[vertex][i], result.bones)] += weight;
            }
        }
        add(result, {sums.begin(), sums.end()});
    }
    return result;
}

/// Of weights that came in with the strands.
NamedWeights carriedWeights(const Groom& groom, const PreparedStrands& strands) {
    NamedWeights result;
    std::vector<std::span<const float>> values;
    for (const auto& [name, data] : groom.strandAttributes.all()) {
        if (!name.starts_with(attribute::kBoneWeightPrefix)) continue;
        const auto own = groom.strandAttributes.view<float>(name);
        if (own.size() != groom.strandCount()) continue;
        result.bones.push_back(name.substr(attribute::kBoneWeightPrefix.size()));
        values.push_back(own);
    }
    if (values.empty()) return result;
    for (const std::uint32_t source : strands.sources) {
        Influences influences;
        for (std::uint32_t bone = 0; bone < values.size(); ++bone) {
            if (values[bone][source] > 0) influences.emplace_back(bone, values[bone][source]);
        }
        add(result, influences);
    }
    return result;
}

/// What TressFX cannot read of it, in words; empty where it can.
std::string refusal(const NamedWeights& weights) {
    for (const std::string& name : weights.bones) {
        if (name.empty() || name.size() >= kMaxNameBytes)
            return fmt::format("the name of bone '{}' has {} bytes, and TressFX takes 1 to {}",
                               name.substr(0, 40), name.size(), kMaxNameBytes - 1);
    }
    const auto none =
        std::ranges::find_if(weights.skin.weights, [](const auto& own) { return !(own[0] > 0); });
    if (none == weights.skin.weights.end()) return {};
    return fmt::format("no bone moves the root of strand {}", none - weights.skin.weights.begin());
}

std::vector<std::byte> boneFile(const NamedWeights& weights) {
    ByteWriter writer;
    const auto writeCount = [&](std::size_t count) { writer.write(static_cast<std::int32_t>(count)); };
    writeCount(weights.bones.size());
    for (std::size_t bone = 0; bone < weights.bones.size(); ++bone) {
        writeCount(bone);
        writeCount(weights.bones[bone].size() + 1);
        writer.writeArray(std::span<const char>(weights.bones[bone].c_str(), weights.bones[bone].size() + 1));
    }
    writeCount(weights.skin.vertexCount());
    for (std::size_t strand = 0; strand < weights.skin.vertexCount(); ++strand) {
        writeCount(strand);
        for (std::size_t i = 0; i < 4; ++i) {
            writeCount(weights.skin.bones[strand][i]);
            writer.write(weights.skin.weights[strand][i]);
        }
    }
    return {writer.bytes().begin(), writer.bytes().end()};
}

/// All bones of the skeleton, so that numbers are those of the character; a vertex that nothing moves goes
/// with the first one. Names end at a blank there.
std::string meshFile(const ImportedScene& scene, const StrandExportOptions& options) {
    std::string text = "# TressFX collision mesh\n";
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "numOfBones {}\n", scene.skeleton.bones().size());
    for (std::size_t bone = 0; bone < scene.skeleton.bones().size(); ++bone)
        fmt::format_to(out, "{} {}\n", bone, scene.skeleton.bones()[bone].name);
    fmt::format_to(out, "numOfVertices {}\n", scene.mesh.vertexCount());
    StrandExportOptions turned = options;
    turned.metresPerUnit = 1;
    for (std::size_t v = 0; v < scene.mesh.vertexCount(); ++v) {
        const Vec3f p = toFile(scene.mesh.positions()[v], options);
        const Vec3f n = toFile(scene.mesh.normals()[v], turned);
        auto [bones, weights] = strongestFour(scene.skin, v);
        if (!(weights[0] > 0)) weights = {1, 0, 0, 0};
        fmt::format_to(out, "{} {} {} {} {} {} {} {} {} {} {} {} {} {} {}\n", v, p.x(), p.y(), p.z(), n.x(),
                       n.y(), n.z(), bones[0], bones[1], bones[2], bones[3], weights[0], weights[1],
                       weights[2], weights[3]);
    }
    fmt::format_to(out, "numOfTriangles {}\n", scene.mesh.triangleCount());
    for (std::size_t t = 0; t < scene.mesh.triangleCount(); ++t) {
        const auto& corners = scene.mesh.triangles()[t];
        fmt::format_to(out, "{} {} {} {}\n", t, corners[0], corners[1], corners[2]);
    }
    return text;
}

std::string meshRefusal(const ImportedScene& scene) {
    for (const Bone& bone : scene.skeleton.bones()) {
        if (bone.name.empty() || bone.name.find_first_of(" \t\r\n") != std::string::npos)
            return fmt::format("bone '{}' has a space in its name, or no name", bone.name);
    }
    return {};
}

}  // namespace

std::vector<TfxCompanion> tfxCompanions(const Groom& groom, PreparedStrands& strands,
                                        const StrandExportOptions& options,
                                        const std::filesystem::path& path) {
    std::vector<TfxCompanion> made;
    // What goes into a device has nothing beside it.
    std::error_code code;
    const auto type = std::filesystem::status(path, code).type();
    if (type != std::filesystem::file_type::regular && type != std::filesystem::file_type::not_found)
        return made;
    const auto leave = [&](const std::string& why, const char* ending, std::string fix) {
        strands.findings.push_back({Severity::Warning, why, std::string("no .") + ending, std::move(fix)});
    };
    const auto add = [&](const char* ending, std::vector<std::byte> bytes) {
        TfxCompanion companion{path, std::move(bytes)};
        companion.path.replace_extension(ending);
        if (companion.path != path) made.push_back(std::move(companion));  // else that is the strands' name
    };
    const auto scene = characterOf(groom, strands.findings);
    const bool isSkinned = scene && scene->skin.vertexCount() == scene->mesh.vertexCount();
    const bool isBound = groom.rootBindings().size() == groom.strandCount();
    const NamedWeights weights =
        isSkinned && isBound ? rootWeights(groom, strands, *scene) : carriedWeights(groom, strands);
    if (!weights.bones.empty()) {
        if (const std::string why = refusal(weights); !why.empty())
            leave(why, "tfxbone", "fix the character's skin, and export again");
        else
            add("tfxbone", boneFile(weights));
    } else if (isSkinned && !isBound) {
        leave("the strands are not bound to a scalp", "tfxbone", "bind them, so that bones move their roots");
    }
    if (!isSkinned) return made;
    if (const std::string why = meshRefusal(*scene); !why.empty()) {
        leave(why, "tfxmesh", "rename it in the character's file");
    } else {
        const std::string text = meshFile(*scene, options);
        const auto bytes = std::as_bytes(std::span(text));
        add("tfxmesh", {bytes.begin(), bytes.end()});
    }
    return made;
}

}  // namespace hairloom
