// SPDX-License-Identifier: MIT
// hairloom.h: what is asked of assets.
#include "hairloom/random.h"
#include "play/c_words.h"

// The plain names are macros that tell sizes: in parentheses they are the functions of older programs.
using namespace hairloom::runtime;

namespace {

/// Farther apart in the head's texture, guides stand on two sides of a seam.
constexpr float kSeam = 0.25f;
/// Separates random numbers of hairs from those that they are drawn with.
constexpr std::uint64_t kHairStream = 0x6861697273ull;

std::array<float, 3> numbersOf(const Asset& asset, const String& name, std::array<float, 3> usual) {
    const asset::Setting* const setting = asset.findSetting(name);
    if (!setting || setting->kind != asset::ValueKind::numbers || setting->count > 3) return usual;
    const auto values = asset.valuesOf(*setting);
    for (std::size_t c = 0; c < values.size(); ++c) usual[c] = static_cast<float>(values[c]);
    return usual;
}

/// What a layer's material says of all of its hairs.
struct LayerLook {
    std::array<float, 3> colour;
    float rootRadius, tipRadius;
};

LayerLook lookOf(const Asset& asset, const String& group, const LayerLook& usual) {
    const float radius = numbersOf(asset, group + ".rootRadius", {usual.rootRadius, 0, 0})[0];
    const float scale = numbersOf(asset, group + ".tipScale", {usual.tipRadius / usual.rootRadius, 0, 0})[0];
    return {numbersOf(asset, group + ".rootColour", usual.colour), radius, radius * scale};
}

/// `Components` floats of each strand; null where there are none of that name and kind.
const float* floatsOf(const Asset& asset, std::string_view name, std::uint32_t components) {
    const asset::Attribute* const found = asset.findAttribute(name);
    if (!found || found->type != asset::AttributeType::float32 || found->components != components)
        return nullptr;
    return reinterpret_cast<const float*>(asset.valuesOf(*found).data());
}

Vector<LayerLook> looksOf(const Asset& asset) {
    const LayerLook all = lookOf(asset, "material", {{0.16f, 0.08f, 0.04f}, 4e-5f, 1.6e-5f});
    Vector<LayerLook> looks(asset.layerCount(), all);
    for (std::size_t layer = 0; layer < asset.layers.size(); ++layer) {
        if (asset.layers[layer].ownMaterial != 0) looks[layer] = lookOf(asset, layerGroup(layer), all);
    }
    return looks;
}

void fillHairs(const Asset& asset, char* out, std::size_t stride) {
    const Asset::Strands rest = asset.strandsAtRest();
    const DrawnHairs drawn = asset.drawnHairs(rest);
    const Vector<LayerLook> looks = looksOf(asset);
    const float* const uvs = floatsOf(asset, "root_uv", 2);
    const float* const colours = floatsOf(asset, "colour", 3);
    std::size_t hair = 0;
    for (std::size_t g = 0; g < asset.guides.size(); ++g) {
        const asset::Guide& guide = asset.guides[g];
        for (std::uint32_t h = 0; h < asset.hairsOf(g); ++h, ++hair) {
            const std::array<std::uint32_t, 3>& guides = drawn.guides[hair];
            const float blend = drawn.blends[hair];
            const Float3 weights = drawn.weights[hair] * blend, roots = drawn.rootWeights[hair];
            hl_hair one{};
            one.guide = guide.strand;
            one.layer = asset.layerOf(guide.strand);
            std::copy(guides.begin(), guides.end(), one.guides);
            const float shares[3] = {1 - blend + weights.x, weights.y, weights.z};
            std::copy_n(shares, 3, one.shares);
            one.random =
                Random(asset.recipe[0].seed ^ kHairStream, (std::uint64_t{guide.id} << 16u) | h).uniform();
            const LayerLook& look = looks[one.layer];
            std::copy_n(look.colour.data(), 3, one.colour);
            one.root_radius = look.rootRadius;
            one.tip_radius = look.tipRadius;
            const float rootShares[3] = {1 - blend + roots.x * blend, roots.y * blend, roots.z * blend};
            const auto mean = [&](const float* values, std::uint32_t components, const float* by, float* to) {
                for (std::uint32_t c = 0; c < components; ++c) {
                    to[c] = 0;
                    for (std::size_t i = 0; i < 3; ++i) to[c] += by[i] * values[components * guides[i] + c];
                }
            };
            if (colours) mean(colours, 3, shares, one.colour);
            if (uvs) {
                const float* const own = uvs + 2 * std::size_t{guide.strand};
                bool together = true;
                for (const std::uint32_t other : guides) {
                    for (std::size_t c = 0; c < 2; ++c)
                        together = together && std::abs(uvs[2 * std::size_t{other} + c] - own[c]) < kSeam;
                }
                std::copy_n(own, 2, one.root_uv);
                if (together) mean(uvs, 2, rootShares, one.root_uv);
            }
            giveBack(one, out + hair * stride, stride);
        }
    }
}

}  // namespace

hl_code hl_asset_open(hl_asset* asset, const void* bytes, size_t size, hl_error* error) {
    if (!asset || !bytes) return nullRefused(error, "no asset or no bytes");
    return guarded(error, [&] {
        const Asset::Result opened = Asset::open({static_cast<const std::byte*>(bytes), size});
        if (!opened.asset) return say(error, opened.error);
        new (asset->inside) Asset(*opened.asset);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_asset_check(const hl_asset* asset, hl_error* error) {
    if (!asset) return nullRefused(error, "no asset");
    return guarded(error, [&] {
        const auto problem = assetOf(asset).check();
        return problem ? say(error, *problem) : say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_asset_clip(const hl_asset* opened, hl_clip* out, hl_error* error) {
    if (!opened || !out) return nullRefused(error, "no asset or no place for its clip");
    if (const Outcome refused = checkSize<hl_clip>("hl_clip", out->size, kFirstClip))
        return say(error, refused);
    return withContent(opened, error, [&](const Asset& asset) {
        hl_clip clip{};
        clip.size = out->size;
        if (const asset::Clip* const found = asset.clip()) {
            const std::string_view name = asset.text(found->name);
            clip.name = name.data();
            clip.name_bytes = name.size();
            clip.frames = found->frames;
            clip.frames_per_second = found->framesPerSecond;
            clip.loops = found->loops;
            clip.largest_error = found->largestError;
            clip.bytes = sizeof(asset::Clip) + asset.clipPlaces().size_bytes() + asset.clipFrames().size();
            clip.memory = Instance::clipMemory(asset);
        }
        giveBack(clip, out, out->size);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_asset_describe_sized(const hl_asset* opened, hl_asset_info* out, size_t size, hl_error* error) {
    if (!opened || !out) return nullRefused(error, "no asset or no place for its description");
    if (const Outcome refused = checkSize<hl_asset_info>("hl_asset_info", size, kFirstAssetInfo))
        return say(error, refused);
    return withContent(opened, error, [&](const Asset& asset) {
        hl_asset_info info{};
        info.major = asset.major();
        info.minor = asset.minor();
        info.guides = asset.strandCount();
        info.guide_points = asset.pointCount();
        info.hairs = asset.hairCount();
        info.points_per_hair = info.hairs > 0 ? asset.recipe[0].pointsPerHair : 0;
        info.bones = static_cast<std::uint32_t>(asset.bones.size());
        info.spheres = static_cast<std::uint32_t>(asset.spheres.size());
        info.scalp_vertices = static_cast<std::uint32_t>(asset.scalpVertices.size());
        const Float3 low = asset.boundsMin_ss(), high = asset.boundsMax_ss();
        std::memcpy(info.bounds_min, &low, sizeof low);
        std::memcpy(info.bounds_max, &high, sizeof high);
        info.greatest_error = static_cast<float>(asset.greatestError());
        const InstanceMemory memory = instanceMemory(asset);
        info.guides_memory = memory.guides + sizeof(hl_instance);
        info.hairs_memory = memory.hairs;
        info.thread_memory = memory.thread;
        info.levels_memory = memory.levels;
        info.layers = asset.layerCount();
        info.settings = static_cast<std::uint32_t>(asset.settings.size());
        info.attributes = static_cast<std::uint32_t>(asset.attributes().size());
        info.measured_levels = asset.levelErrors().empty() ? 0 : 1;
        info.poses = static_cast<std::uint32_t>(asset.poses().size());
        giveBack(info, out, size);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code(hl_asset_describe)(const hl_asset* opened, hl_asset_info* info, hl_error* error) {
    return hl_asset_describe_sized(opened, info, kFirstAssetInfo, error);
}

hl_code hl_asset_bone_sized(const hl_asset* opened, uint32_t bone, hl_bone* out, size_t size,
                            hl_error* error) {
    if (!opened || !out) return nullRefused(error, "no asset or no place for the bone");
    if (const Outcome refused = checkSize<hl_bone>("hl_bone", size, kFirstBone)) return say(error, refused);
    return withContent(opened, error, [&](const Asset& asset) {
        if (bone >= asset.bones.size()) return pastTheLast(error, "bone", bone, asset.bones.size());
        const asset::Bone& record = asset.bones[bone];
        const std::string_view name = asset.text(record.name);
        hl_bone found{name.data(), name.size(), record.index, {}};
        std::copy(std::begin(record.inverseBind), std::end(record.inverseBind), found.inverse_bind);
        giveBack(found, out, size);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code(hl_asset_bone)(const hl_asset* opened, uint32_t bone, hl_bone* out, hl_error* error) {
    return hl_asset_bone_sized(opened, bone, out, kFirstBone, error);
}

hl_code hl_asset_scalp_sources(const hl_asset* opened, uint32_t* vertices, size_t count, hl_error* error) {
    if (!opened || !vertices) return nullRefused(error, "no asset or no place for vertices");
    const Asset& asset = assetOf(opened);
    if (count != asset.scalpVertices.size())
        return say(error, HL_WRONG_SIZE, HL_NO_PLACE, "another number of scalp vertices");
    for (std::size_t v = 0; v < count; ++v) vertices[v] = asset.scalpVertices[v].source;
    return say(error, HL_OK, HL_NO_PLACE, "");
}

hl_code hl_asset_layer_sized(const hl_asset* opened, uint32_t layer, hl_layer* out, size_t size,
                             hl_error* error) {
    if (!opened || !out) return nullRefused(error, "no asset or no place for the layer");
    if (const Outcome refused = checkSize<hl_layer>("hl_layer", size, kFirstLayer))
        return say(error, refused);
    return withContent(opened, error, [&](const Asset& asset) {
        if (layer >= asset.layerCount()) return pastTheLast(error, "layer", layer, asset.layerCount());
        hl_layer found{"", 0, 1, 0};
        if (!asset.layers.empty()) {
            const asset::Layer& record = asset.layers[layer];
            const std::string_view name = asset.text(record.name);
            found = {name.data(), name.size(), record.density, record.ownMaterial};
        }
        giveBack(found, out, size);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code(hl_asset_layer)(const hl_asset* opened, uint32_t layer, hl_layer* out, hl_error* error) {
    return hl_asset_layer_sized(opened, layer, out, kFirstLayer, error);
}

hl_code hl_asset_layers(const hl_asset* opened, uint32_t* layers, uint32_t* of_guides, size_t count,
                        hl_error* error) {
    if (!opened || !layers || (!of_guides && count > 0))
        return nullRefused(error, "no asset or no place for layers");
    return guarded(error, [&] {
        const Asset& asset = assetOf(opened);
        if (of_guides && count != asset.strandCount())
            return say(
                error, HL_WRONG_SIZE, HL_NO_PLACE,
                "space for " + std::to_string(count) + " guides of " + std::to_string(asset.strandCount()));
        if (const auto problem = asset.checkContent()) return say(error, *problem);
        *layers = asset.layerCount();
        for (std::size_t guide = 0; guide < count; ++guide) of_guides[guide] = asset.layerOf(guide);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_asset_setting(const hl_asset* opened, uint32_t number, hl_setting* out, hl_error* error) {
    if (!opened || !out) return nullRefused(error, "no asset or no place for the setting");
    const std::size_t size = out->size;
    if (const Outcome refused = checkSize<hl_setting>("hl_setting", size, sizeof(hl_setting)))
        return say(error, refused);
    return withContent(opened, error, [&](const Asset& asset) {
        if (number >= asset.settings.size())
            return pastTheLast(error, "setting", number, asset.settings.size());
        const asset::Setting& record = asset.settings[number];
        const std::string_view name = asset.nameOf(record);
        hl_setting found{};
        found.size = size;
        found.name = name.data();
        found.name_bytes = name.size();
        found.kind = static_cast<std::uint32_t>(record.kind);
        if (record.kind == asset::ValueKind::choice) {
            const std::string_view choice = asset.choiceOf(record);
            found.choice = choice.data();
            found.choice_bytes = choice.size();
        } else {
            found.count = record.count;
            found.values = asset.valuesOf(record).data();
        }
        giveBack(found, out, size);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_asset_find_setting(const hl_asset* opened, const char* name, uint32_t* setting, hl_error* error) {
    if (!opened || !name || !setting) return nullRefused(error, "no asset, name or place");
    return withContent(opened, error, [&](const Asset& asset) {
        const asset::Setting* const found = asset.findSetting(name);
        if (!found)
            return say(error, HL_BAD_VALUE, HL_NO_PLACE,
                       std::string("no setting of the name '") + name + "'");
        *setting = static_cast<std::uint32_t>(found - asset.settings.data());
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_asset_attribute(const hl_asset* opened, uint32_t number, hl_attribute* out, hl_error* error) {
    if (!opened || !out) return nullRefused(error, "no asset or no place for the attribute");
    const std::size_t size = out->size;
    if (const Outcome refused = checkSize<hl_attribute>("hl_attribute", size, sizeof(hl_attribute)))
        return say(error, refused);
    return withContent(opened, error, [&](const Asset& asset) {
        const auto all = asset.attributes();
        if (number >= all.size()) return pastTheLast(error, "attribute", number, all.size());
        const asset::Attribute& record = all[number];
        const std::string_view name = asset.nameOf(record);
        const auto values = asset.valuesOf(record);
        const hl_attribute found{size,
                                 name.data(),
                                 name.size(),
                                 static_cast<std::uint32_t>(record.type),
                                 record.components,
                                 values.data(),
                                 values.size()};
        giveBack(found, out, size);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_asset_find_attribute(const hl_asset* opened, const char* name, uint32_t* attribute,
                                hl_error* error) {
    if (!opened || !name || !attribute) return nullRefused(error, "no asset, name or place");
    return withContent(opened, error, [&](const Asset& asset) {
        const asset::Attribute* const found = asset.findAttribute(name);
        if (!found)
            return say(error, HL_BAD_VALUE, HL_NO_PLACE,
                       std::string("no attribute of the name '") + name + "'");
        *attribute = static_cast<std::uint32_t>(found - asset.attributes().data());
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_asset_pose(const hl_asset* opened, uint32_t number, hl_hair_pose* out, hl_error* error) {
    if (!opened || !out) return nullRefused(error, "no asset or no place for the pose");
    const std::size_t size = out->size;
    if (const Outcome refused = checkSize<hl_hair_pose>("hl_hair_pose", size, sizeof(hl_hair_pose)))
        return say(error, refused);
    return withContent(opened, error, [&](const Asset& asset) {
        const auto all = asset.poses();
        if (number >= all.size()) return pastTheLast(error, "pose", number, all.size());
        const asset::Pose& record = all[number];
        const std::string_view name = asset.text(record.name);
        const hl_hair_pose found{size, name.data(), name.size(), record.amount, record.weights > 0 ? 1u : 0u};
        giveBack(found, out, size);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_asset_find_pose(const hl_asset* opened, const char* name, uint32_t* pose, hl_error* error) {
    if (!opened || !name || !pose) return nullRefused(error, "no asset, name or place");
    return withContent(opened, error, [&](const Asset& asset) {
        const auto all = asset.poses();
        const auto found = std::find_if(all.begin(), all.end(),
                                        [&](const asset::Pose& one) { return asset.text(one.name) == name; });
        if (found == all.end())
            return say(error, HL_BAD_VALUE, HL_NO_PLACE, std::string("no pose of the name '") + name + "'");
        *pose = static_cast<std::uint32_t>(found - all.begin());
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_asset_hairs(const hl_asset* opened, hl_hair* hairs, size_t bytes, size_t count, hl_error* error) {
    if (!opened || (!hairs && count > 0)) return nullRefused(error, "no asset or no place for hairs");
    if (const Outcome refused = checkSize<hl_hair>("hl_hair", bytes, sizeof(hl_hair)))
        return say(error, refused);
    return withContent(opened, error, [&](const Asset& asset) {
        if (count != asset.hairCount())
            return say(
                error, HL_WRONG_SIZE, HL_NO_PLACE,
                "space for " + std::to_string(count) + " hairs of " + std::to_string(asset.hairCount()));
        if (count > 0) fillHairs(asset, reinterpret_cast<char*>(hairs), bytes);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_asset_numbers(const hl_asset* opened, const char* name, double* values, size_t count,
                         size_t* written, hl_error* error) {
    if (!opened || !name || !written || (!values && count > 0))
        return nullRefused(error, "no asset, name or place");
    return withContent(opened, error, [&](const Asset& asset) {
        const asset::Setting* const setting = asset.findSetting(name);
        if (!setting || setting->kind == asset::ValueKind::choice)
            return say(error, HL_BAD_VALUE, HL_NO_PLACE,
                       std::string("no numbers of the name '") + name + "'");
        const auto found = asset.valuesOf(*setting);
        *written = found.size();
        if (count < found.size())
            return say(error, HL_WRONG_SIZE, HL_NO_PLACE,
                       "space for " + std::to_string(count) + " values of " + std::to_string(found.size()));
        std::copy(found.begin(), found.end(), values);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_asset_levels_memory(const hl_asset* opened, size_t* bytes, hl_error* error) {
    if (!opened || !bytes) return nullRefused(error, "no asset or no place for the bytes");
    return withContent(opened, error, [&](const Asset& asset) {
        *bytes = instanceMemory(asset).levels;
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}
