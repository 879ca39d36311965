// SPDX-License-Identifier: MIT
// hairloom/gpu.h: what the passes that light and shade hairs are given.
#include "play/gpu_shading.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "hairloom/gpu.h"
#include "play/c_words.h"

namespace hairloom::runtime {
namespace {

static_assert(sizeof(hl_gpu_lamp) == sizeof(shaders::HairLamp));
static_assert(offsetof(hl_gpu_lamp, ground) == offsetof(shaders::HairLamp, ground));
static_assert(sizeof(asset::Material) == sizeof(shaders::HairMaterial));
static_assert(offsetof(asset::Material, absorbs) == offsetof(shaders::LookConstants, absorbs));
static_assert(offsetof(asset::Material, primary) == offsetof(shaders::HairMaterial, primary));
static_assert(offsetof(asset::Material, tilts) == offsetof(shaders::HairMaterial, tilts));
static_assert(offsetof(asset::Material, table) == offsetof(shaders::HairMaterial, table));
static_assert(asset::kTableHalves == HAIR_TABLE_FLOATS);

/// One by pi times R_O of the exponent (Rünz 2012, Eq. 31, in closed form).
float kajiyaNormalisation(float exponent) {
    const double m{exponent}, pi = 3.14159265358979323846;
    const double reflectance = 2 * std::sqrt(pi) * std::tgamma((m + 3) / 2) / std::tgamma((m + 4) / 2);
    return static_cast<float>(1 / (pi * reflectance));
}

std::array<float, 4> colourOf(const Asset& asset, const String& name, std::array<float, 4> colour) {
    const asset::Setting* const setting = asset.findSetting(name);
    if (!setting || setting->kind != asset::ValueKind::numbers || setting->count != 3) return colour;
    for (std::size_t c = 0; c < 3; ++c) colour[c] = static_cast<float>(asset.valuesOf(*setting)[c]);
    return colour;
}

/// Of an asset that names no materials: Kajiya and Kay's hair of the two colours that its settings have.
asset::Material plainMaterial(const Asset& asset, const String& group) {
    asset::Material m{};
    m.rootLook = colourOf(asset, group + ".rootColour", {0.16f, 0.08f, 0.04f, 0});
    m.tipLook = colourOf(asset, group + ".tipColour", {0.30f, 0.17f, 0.09f, 0});
    m.streakRoot = m.rootLook;
    m.streakTip = m.tipLook;
    m.gradientScale = m.dyeScale = m.regrowthScale = 1;
    m.primary = {0.16f, 0.16f, 0.16f, 90};
    m.secondary = {0.55f, 0.55f, 0.55f, 24};
    m.primaryTilt = 0.07f;
    m.secondaryTilt = -0.105f;
    m.primaryNormalisation = kajiyaNormalisation(m.primary[3]);
    m.secondaryNormalisation = kajiyaNormalisation(m.secondary[3]);
    m.diffuse = m.scattering = 0.55f;
    m.diffuseNormalisation = kajiyaNormalisation(0);
    m.fibreOpacity = 0.65f;
    m.widths[3] = static_cast<float>(asset.numberOf(group + ".colourVariation", 0.15));
    m.scales[3] = 1;
    m.bounded = 1;
    m.axisRatio = 1;
    return m;
}

float fromHalf(std::uint16_t half) {
    const std::uint32_t exponent = half >> 10u & 31u, mantissa = half & 1023u;
    // Infinite numbers and those that are none are refused before.
    const float size =
        exponent == 0 ? std::ldexp(static_cast<float>(mantissa), -24)
                      : std::ldexp(static_cast<float>(1024u + mantissa), static_cast<int>(exponent) - 25);
    return half >> 15u != 0 ? -size : size;
}

void fillMaterials(const Asset& asset, char* out) {
    const auto known = asset.materials();
    if (!known.empty()) {
        std::memcpy(out, known.data(), known.size_bytes());
        return;
    }
    const auto put = [&out](const asset::Material& material) {
        std::memcpy(out, &material, sizeof material);
        out += sizeof material;
    };
    put(plainMaterial(asset, "material"));
    for (std::size_t layer = 0; layer < asset.layers.size(); ++layer) {
        if (asset.layers[layer].ownMaterial != 0) put(plainMaterial(asset, layerGroup(layer)));
    }
}

/// Of each layer: its place among the materials.
Vector<std::uint32_t> materialsOfLayers(const Asset& asset) {
    Vector<std::uint32_t> ofLayers(asset.layerCount(), 0u);
    std::uint32_t own = 0;
    for (std::size_t layer = 0; layer < asset.layers.size(); ++layer) {
        if (asset.layers[layer].ownMaterial != 0) ofLayers[layer] = ++own;
    }
    return ofLayers;
}

void fillShades(const Asset& asset, std::span<const std::uint32_t> order, char* out) {
    const Vector<std::uint32_t> ofLayers = materialsOfLayers(asset);
    Vector<std::uint32_t> layers;
    for (std::size_t guide = 0; guide < asset.guides.size(); ++guide)
        layers.insert(layers.end(), asset.hairsOf(guide), asset.layerOf(asset.guides[guide].strand));
    const auto looks = asset.hairLooks();
    const asset::Attribute* const colours = asset.findAttribute("colour");
    const bool own = colours && colours->type == asset::AttributeType::float32 && colours->components == 3;
    for (const std::uint32_t number : order) {
        const asset::HairLook look =
            looks.empty() ? asset::HairLook{0, 0, asset::kPlainPigment, 0} : looks[number];
        const auto share = [](std::uint16_t value) { return static_cast<float>(value) / 65535.0f; };
        const shaders::HairShade shade{
            ofLayers[layers[number]],
            number,
            share(look.streak),
            share(look.dye),
            static_cast<float>(look.pigment) / static_cast<float>(asset::kPlainPigment),
            static_cast<float>(look.length) * asset::kLengthStep,
            own ? 1.0f : 0.0f,
            0};
        std::memcpy(out, &shade, sizeof shade);
        out += sizeof shade;
    }
}

}  // namespace

bool fillsShading(std::uint32_t buffer) {
    return buffer == HL_GPU_BUFFER_MATERIALS || buffer == HL_GPU_BUFFER_TABLES ||
           buffer == HL_GPU_BUFFER_SHADES || buffer == HL_GPU_BUFFER_CROSSED;
}

void fillShading(const Asset& asset, std::uint32_t buffer, std::span<const std::uint32_t> order, void* out) {
    auto* const at = static_cast<char*>(out);
    if (buffer == HL_GPU_BUFFER_MATERIALS) {
        fillMaterials(asset, at);
    } else if (buffer == HL_GPU_BUFFER_SHADES) {
        fillShades(asset, order, at);
    } else if (buffer == HL_GPU_BUFFER_CROSSED) {
        std::memset(out, 0, kLampCells * sizeof(std::uint32_t));
    } else {
        const auto tables = asset.fibreTables();
        if (tables.empty()) std::memset(out, 0, sizeof(float));
        for (std::size_t i = 0; i < tables.size(); ++i) {
            const float value = fromHalf(tables[i]);
            std::memcpy(at + i * sizeof value, &value, sizeof value);
        }
    }
}

}  // namespace hairloom::runtime

using namespace hairloom::runtime;

hl_code hl_gpu_lamp_init_sized(const float to_light[3], const float centre[3], float radius,
                               hl_gpu_lamp* lamp, size_t size, hl_error* error) {
    if (!to_light || !centre || !lamp) return nullRefused(error, "no direction, place or lamp");
    if (const Outcome refused = checkSize<hl_gpu_lamp>("hl_gpu_lamp", size, kFirstLamp))
        return say(error, refused);
    const Float3 given{to_light[0], to_light[1], to_light[2]}, middle{centre[0], centre[1], centre[2]};
    const float largest = std::max({std::abs(given.x), std::abs(given.y), std::abs(given.z)});
    if (!(largest > 0) || !std::isfinite(largest) || !std::isfinite(given.x + given.y + given.z))
        return say(error, HL_BAD_VALUE, HL_NO_PLACE,
                   "to_light is no direction; expected three numbers, not all 0");
    if (!std::isfinite(dot(middle, middle)) || !(radius > 0) || !std::isfinite(radius) ||
        !std::isfinite(0.5f / radius * (1 + length(middle))))
        return say(error, HL_BAD_VALUE, HL_NO_PLACE,
                   "centre or radius is no place or size; expected numbers, and a radius above 0");
    Float3 to = {given.x / largest, given.y / largest, given.z / largest};
    to = to * (1 / length(to));
    const Float3 least = std::abs(to.y) < 0.9f ? Float3{0, 1, 0} : Float3{1, 0, 0};
    Float3 across = cross(least, to);
    across = across * (1 / length(across));
    const Float3 up = cross(to, across);
    const float scale = 0.5f / radius, column = 2 * radius / HAIR_COLUMNS;
    const auto row = [&](Float3 axis, float(&out)[4]) {
        out[0] = scale * axis.x;
        out[1] = scale * axis.y;
        out[2] = scale * axis.z;
        out[3] = 0.5f - scale * dot(axis, middle);
    };
    hl_gpu_lamp made{{}, {}, {}, {to.x, to.y, to.z, 0}, {1, 1, 1, 0}, {0, 0, 0, column * column}};
    row(across, made.across);
    row(up, made.up);
    row(to * -1.0f, made.away);
    giveBack(made, lamp, size);
    return say(error, HL_OK, HL_NO_PLACE, "");
}
