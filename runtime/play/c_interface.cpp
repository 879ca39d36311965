// SPDX-License-Identifier: MIT
// hairloom.h: hands over to Asset and Instance, and lets nothing be thrown across.
#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <new>

#include "hairloom/hairloom.h"
#include "play/crowd.h"
#include "play/instance.h"

using namespace hairloom::runtime;

namespace {

static_assert(sizeof(Asset) <= sizeof(hl_asset) && alignof(Asset) <= alignof(hl_asset));
static_assert(std::is_trivially_destructible_v<Asset> && std::is_trivially_copyable_v<Asset>);

hl_code say(hl_error* error, hl_code code, std::uint64_t byte, std::string_view words) {
    if (error) {
        error->code = code;
        error->byte = byte;
        const std::size_t size = std::min(words.size(), sizeof error->words - 1);
        std::memcpy(error->words, words.data(), size);
        error->words[size] = 0;
    }
    return code;
}

hl_code say(hl_error* error, const AssetError& problem) {
    const bool misaligned = problem.kind == AssetError::Kind::misaligned;
    const hl_code code = problem.kind == AssetError::Kind::newer ? HL_NEWER
                         : misaligned                            ? HL_BAD_VALUE
                                                                 : HL_DAMAGED;
    return say(error, code, misaligned ? HL_NO_PLACE : problem.byte, problem.words);
}

hl_code say(hl_error* error, const Outcome& refused) {
    return refused ? say(error, refused->code, HL_NO_PLACE, refused->words)
                   : say(error, HL_OK, HL_NO_PLACE, "");
}

/// Whatever is thrown inside comes out as a code.
template <class Body>
hl_code guarded(hl_error* error, const Body& body) {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        return say(error, HL_NO_MEMORY, HL_NO_PLACE, "there is not enough memory");
    } catch (const std::exception& thrown) {
        return say(error, HL_NO_MEMORY, HL_NO_PLACE, thrown.what());
    }
}

hl_code nullRefused(hl_error* error, const char* what) {
    return say(error, HL_BAD_VALUE, HL_NO_PLACE, std::string_view(what));
}

const Asset& assetOf(const hl_asset* asset) {
    return *std::launder(reinterpret_cast<const Asset*>(asset->inside));
}

Host hostOf(const hl_jobs* jobs) {
    Host host;
    if (!jobs || !jobs->parallel_for) return host;
    host.parallelFor = [lent = *jobs](std::size_t count, std::size_t grain, const Host::Body& body) {
        const auto call = [](void* context, std::size_t begin, std::size_t end) {
            (*static_cast<const Host::Body*>(context))(begin, end);
        };
        lent.parallel_for(lent.user, count, grain, call, const_cast<Host::Body*>(&body));
    };
    return host;
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

hl_code hl_asset_describe(const hl_asset* opened, hl_asset_info* info, hl_error* error) {
    if (!opened || !info) return nullRefused(error, "no asset or no place for its description");
    return guarded(error, [&] {
        const Asset& asset = assetOf(opened);
        if (const auto problem = asset.checkContent()) return say(error, *problem);
        *info = {};
        info->major = asset.major();
        info->minor = asset.minor();
        info->guides = asset.strandCount();
        info->guide_points = asset.pointCount();
        info->hairs = asset.hairCount();
        info->points_per_hair = info->hairs > 0 ? asset.recipe[0].pointsPerHair : 0;
        info->bones = static_cast<std::uint32_t>(asset.bones.size());
        info->spheres = static_cast<std::uint32_t>(asset.spheres.size());
        info->scalp_vertices = static_cast<std::uint32_t>(asset.scalpVertices.size());
        const Float3 low = asset.boundsMin_ss(), high = asset.boundsMax_ss();
        std::memcpy(info->bounds_min, &low, sizeof low);
        std::memcpy(info->bounds_max, &high, sizeof high);
        info->greatest_error = static_cast<float>(asset.greatestError());
        const InstanceMemory memory = instanceMemory(asset);
        info->guides_memory = memory.guides + sizeof(hl_instance);
        info->hairs_memory = memory.hairs;
        info->thread_memory = memory.thread;
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_asset_bone(const hl_asset* opened, uint32_t bone, hl_bone* out, hl_error* error) {
    if (!opened || !out) return nullRefused(error, "no asset or no place for the bone");
    return guarded(error, [&] {
        const Asset& asset = assetOf(opened);
        if (bone >= asset.bones.size())
            return say(error, HL_BAD_VALUE, HL_NO_PLACE,
                       "bone " + std::to_string(bone) + " of " + std::to_string(asset.bones.size()));
        if (const auto problem = asset.checkContent()) return say(error, *problem);
        const asset::Bone& record = asset.bones[bone];
        const std::string_view name = asset.text(record.name);
        *out = {name.data(), name.size(), record.index, {}};
        std::copy(std::begin(record.inverseBind), std::end(record.inverseBind), out->inverse_bind);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_asset_scalp_sources(const hl_asset* opened, uint32_t* vertices, size_t count, hl_error* error) {
    if (!opened || !vertices) return nullRefused(error, "no asset or no place for vertices");
    const Asset& asset = assetOf(opened);
    if (count != asset.scalpVertices.size())
        return say(error, HL_WRONG_SIZE, HL_NO_PLACE, "another number of scalp vertices");
    for (std::size_t v = 0; v < count; ++v) vertices[v] = asset.scalpVertices[v].source;
    return say(error, HL_OK, HL_NO_PLACE, "");
}

hl_code hl_asset_layer(const hl_asset* opened, uint32_t layer, hl_layer* out, hl_error* error) {
    if (!opened || !out) return nullRefused(error, "no asset or no place for the layer");
    return guarded(error, [&] {
        const Asset& asset = assetOf(opened);
        if (layer >= asset.layerCount())
            return say(error, HL_BAD_VALUE, HL_NO_PLACE,
                       "layer " + std::to_string(layer) + " of " + std::to_string(asset.layerCount()));
        if (const auto problem = asset.checkContent()) return say(error, *problem);
        *out = {"", 0, 1, 0};
        if (!asset.layers.empty()) {
            const asset::Layer& record = asset.layers[layer];
            const std::string_view name = asset.text(record.name);
            *out = {name.data(), name.size(), record.density, record.ownMaterial};
        }
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
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
                "room for " + std::to_string(count) + " guides of " + std::to_string(asset.strandCount()));
        if (const auto problem = asset.checkContent()) return say(error, *problem);
        *layers = asset.layerCount();
        for (std::size_t guide = 0; guide < count; ++guide) of_guides[guide] = asset.layerOf(guide);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_asset_numbers(const hl_asset* opened, const char* name, double* values, size_t count,
                         size_t* written, hl_error* error) {
    if (!opened || !name || !written || (!values && count > 0))
        return nullRefused(error, "no asset, name or place");
    return guarded(error, [&] {
        const Asset& asset = assetOf(opened);
        if (const auto problem = asset.checkContent()) return say(error, *problem);
        const asset::Setting* const setting = asset.findSetting(name);
        if (!setting || setting->kind == asset::ValueKind::choice)
            return say(error, HL_BAD_VALUE, HL_NO_PLACE,
                       std::string("no numbers of the name '") + name + "'");
        const auto found = asset.valuesOf(*setting);
        *written = found.size();
        if (count < found.size())
            return say(error, HL_WRONG_SIZE, HL_NO_PLACE,
                       "room for " + std::to_string(count) + " values of " + std::to_string(found.size()));
        std::copy(found.begin(), found.end(), values);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_instance_make(const hl_asset* opened, uint32_t what, const hl_jobs* jobs, hl_instance** out,
                         hl_error* error) {
    if (!opened || !out) return nullRefused(error, "no asset or no place for the instance");
    if (what > (HL_HAIRS | HL_LEVELS))
        return nullRefused(error, "neither HL_GUIDES nor a sum of HL_HAIRS and HL_LEVELS");
    return guarded(error, [&] {
        const Asset& asset = assetOf(opened);
        if (const auto problem = asset.checkContent()) return say(error, *problem);
        Instance::Result made =
            Instance::make(asset, (what & HL_HAIRS) != 0, (what & HL_LEVELS) != 0, hostOf(jobs));
        if (!made.instance) return say(error, HL_DAMAGED, HL_NO_PLACE, made.error);
        *out = new hl_instance{std::move(*made.instance)};
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_instance_copy(const hl_instance* instance, hl_instance** out, hl_error* error) {
    if (!instance || !out) return nullRefused(error, "no instance or no place for its copy");
    return guarded(error, [&] {
        *out = new hl_instance(*instance);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

void hl_instance_free(hl_instance* instance) {
    delete instance;
}

void hl_frame_init(hl_frame* frame) {
    if (!frame) return;
    *frame = {};
    frame->size = sizeof(hl_frame);
    frame->dt = 1.0f / 60.0f;
}

hl_code hl_instance_reset(hl_instance* instance, const hl_frame* frame, hl_error* error) {
    if (!instance || !frame) return nullRefused(error, "no instance or no frame");
    return guarded(error, [&] { return say(error, instance->instance.reset(*frame)); });
}

hl_code hl_instance_step(hl_instance* instance, const hl_frame* frame, hl_error* error) {
    if (!instance || !frame) return nullRefused(error, "no instance or no frame");
    return guarded(error, [&] { return say(error, instance->instance.step(*frame)); });
}

hl_code hl_instance_set(hl_instance* instance, const char* name, const double* values, size_t count,
                        hl_error* error) {
    if (!instance || !name || (!values && count > 0))
        return nullRefused(error, "no instance, name or values");
    return guarded(error, [&] { return say(error, instance->instance.set(name, {values, count})); });
}

hl_code hl_instance_describe(const hl_instance* instance, hl_instance_info* info, hl_error* error) {
    if (!instance || !info) return nullRefused(error, "no instance or no place for its description");
    return guarded(error, [&] {
        *info = instance->instance.describe();
        info->bytes += sizeof(hl_instance) - sizeof(Instance);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_instance_time(hl_instance* instance, uint64_t (*nanoseconds)(void* user), void* user,
                         hl_error* error) {
    if (!instance) return nullRefused(error, "no instance");
    return guarded(error, [&] {
        std::function<std::uint64_t()> clock;
        if (nanoseconds) clock = [nanoseconds, user] { return nanoseconds(user); };
        instance->instance.setClock(clock);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_instance_effect(const hl_instance* instance, uint32_t effect, hl_effect* out, hl_error* error) {
    static_assert(HL_EFFECT_COUNT == kEffectCount + 1);
    if (!instance || !out) return nullRefused(error, "no instance or no place for the effect");
    if (effect >= HL_EFFECT_COUNT) return nullRefused(error, "an effect that there is not");
    return guarded(error, [&] {
        *out = instance->instance.describeEffect(effect);
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_instance_offsets(const hl_instance* instance, uint32_t* offsets, size_t count, hl_error* error) {
    if (!instance || !offsets) return nullRefused(error, "no instance or no place for offsets");
    return guarded(error, [&] { return say(error, instance->instance.readOffsets({offsets, count})); });
}

uint64_t hl_instance_hash(const hl_instance* instance) {
    return instance ? instance->instance.hash() : 0;
}

hl_code hl_instance_read_guides(hl_instance* instance, hl_out positions, hl_out tangents, hl_out radii,
                                hl_error* error) {
    if (!instance) return nullRefused(error, "no instance");
    return guarded(error,
                   [&] { return say(error, instance->instance.readGuides(positions, tangents, radii)); });
}

hl_code hl_instance_read_hairs(hl_instance* instance, hl_out positions, hl_out tangents, hl_out radii,
                               hl_error* error) {
    if (!instance) return nullRefused(error, "no instance");
    return guarded(error,
                   [&] { return say(error, instance->instance.readHairs(positions, tangents, radii)); });
}

hl_code hl_asset_levels_memory(const hl_asset* opened, size_t* bytes, hl_error* error) {
    if (!opened || !bytes) return nullRefused(error, "no asset or no place for the bytes");
    return guarded(error, [&] {
        const Asset& asset = assetOf(opened);
        if (const auto problem = asset.checkContent()) return say(error, *problem);
        *bytes = instanceMemory(asset).levels;
        return say(error, HL_OK, HL_NO_PLACE, "");
    });
}

hl_code hl_instance_level(const hl_instance* instance, uint32_t level, hl_level* out, hl_error* error) {
    if (!instance || !out) return nullRefused(error, "no instance or no place for the level");
    if (!instance->instance.hasLevels()) return nullRefused(error, "the instance was made without HL_LEVELS");
    if (level >= HL_LEVEL_COUNT) return nullRefused(error, "a level that there is not");
    *out = instance->instance.describeLevel(level);
    return say(error, HL_OK, HL_NO_PLACE, "");
}

hl_code hl_instance_set_level(hl_instance* instance, uint32_t level, float hair_share, hl_error* error) {
    if (!instance) return nullRefused(error, "no instance");
    return guarded(error, [&] { return say(error, instance->instance.setLevel(level, hair_share)); });
}

void hl_crowd_limits_init(hl_crowd_limits* limits) {
    if (!limits) return;
    *limits = {sizeof(hl_crowd_limits), 2, 0.7f, std::numeric_limits<float>::infinity(), 1};
}

hl_code hl_crowd_plan(const hl_crowd_limits* limits, hl_viewed* characters, size_t count,
                      hl_crowd_report* report, hl_error* error) {
    if (!limits || (!characters && count > 0)) return nullRefused(error, "no limits or no characters");
    return guarded(error, [&] {
        hl_crowd_report ignored;
        return say(error, planCrowd(*limits, {characters, count}, report ? *report : ignored));
    });
}
