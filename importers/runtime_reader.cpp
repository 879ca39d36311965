// SPDX-License-Identifier: GPL-3.0-or-later
// Runtime assets, read as games read them: by runtime/.

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "core/base/file.h"
#include "core/groom/file/fields.h"
#include "hairloom/asset.h"
#include "importers/raw_strands.h"

namespace hairloom {
namespace {

namespace asset = runtime::asset;

constexpr std::uint32_t kMostGroups = 65536;

bool isAsset(std::span<const std::byte> bytes) {
    return bytes.size() >= asset::kMagic.size() &&
           std::memcmp(bytes.data(), asset::kMagic.data(), asset::kMagic.size()) == 0;
}

template <class S>
void readSettings(const runtime::Asset& from, std::string_view group, S& settings) {
    for (const Field<S>& field : fieldsOf(settings)) {
        const asset::Setting* const setting = from.findSetting(std::string(group) + "." + field.name);
        if (!setting) continue;
        const auto values = from.valuesOf(*setting);
        if (setting->kind == asset::ValueKind::numbers && values.size() == field.components()) {
            for (std::uint32_t c = 0; c < values.size(); ++c) setFieldValue(settings, field, values[c], c);
        } else if (setting->kind == asset::ValueKind::choice) {
            const auto found = std::ranges::find(field.choices, from.choiceOf(*setting));
            if (found != field.choices.end())
                setFieldValue(settings, field, static_cast<double>(found - field.choices.begin()));
        } else if (setting->kind == asset::ValueKind::seed && field.kind == FieldKind::Seed) {
            runtime::member<std::uint64_t>(settings, field) =
                static_cast<std::uint64_t>(values[0]) | static_cast<std::uint64_t>(values[1]) << 32u;
        }
    }
}

std::shared_ptr<const Groom> readAuthored(const runtime::Asset& from) {
    auto authored = std::make_shared<Groom>();
    authored->simulation = from.simulation();
    readSettings(from, "material", authored->material);
    readSettings(from, "interpolation", authored->interpolation);
    if (!from.layers.empty()) authored->layers.clear();
    for (const asset::Layer& layer : from.layers) {
        Layer& read = authored->layers.emplace_back();
        read.name = from.text(layer.name);
        read.density = std::min(layer.density, kMaxLayerDensity);
        if (layer.ownMaterial == 0) continue;
        read.material.emplace();
        readSettings(from, fmt::format("layer{}", authored->layers.size()), *read.material);
    }
    for (const asset::Sphere& sphere : from.spheres) {
        CollisionSphere read;
        read.name = from.text(sphere.name);
        read.centre = Vec3f(sphere.centre[0], sphere.centre[1], sphere.centre[2]);
        read.radius = sphere.radius;
        read.joined = static_cast<std::int32_t>(sphere.joined) - 1;
        if (sphere.bone >= 0) read.bone = from.text(from.bones[static_cast<std::size_t>(sphere.bone)].name);
        authored->spheres.push_back(std::move(read));
    }
    return authored;
}

void readLayers(const runtime::Asset& from, RawStrands& raw) {
    if (from.strandLayers.empty()) return;
    RawAttribute layers;
    layers.name = attribute::kLayer;
    layers.type = RawAttribute::Type::Index;
    layers.whole.assign(from.strandLayers.begin(), from.strandLayers.end());
    raw.attributes.push_back(std::move(layers));
}

/// Marks where some strands are guides and others not.
void readGuides(const runtime::Asset& from, RawStrands& raw) {
    if (from.guides.empty() || from.guides.size() == from.strands.size()) return;
    RawAttribute guides;
    guides.name = attribute::kGuide;
    guides.type = RawAttribute::Type::Flag;
    guides.whole.assign(from.strands.size(), 0);
    for (const asset::Guide& guide : from.guides) guides.whole[guide.strand] = 1;
    raw.attributes.push_back(std::move(guides));
}

/// What the groom says of its strands by name; layers and guides have sections of their own.
void readAttributes(const runtime::Asset& from, RawStrands& raw) {
    for (const asset::Attribute& record : from.attributes()) {
        const std::string name(from.nameOf(record));
        const auto values = from.valuesOf(record);
        const std::size_t count = from.strands.size() * record.components;
        const bool known = std::ranges::any_of(raw.attributes,
                                               [&](const RawAttribute& other) { return other.name == name; });
        if (known || name == attribute::kLayer) continue;
        RawAttribute read;
        read.name = name;
        read.components = record.components;
        if (record.type == asset::AttributeType::float32) {
            read.numbers.resize(count);
            std::memcpy(read.numbers.data(), values.data(), count * sizeof(float));
            if (name == attribute::kRootUv && record.components == 2) {
                for (std::size_t s = 0; s < from.strands.size(); ++s)
                    raw.rootUvs.emplace_back(read.numbers[2 * s], read.numbers[2 * s + 1]);
                continue;
            }
        } else {
            if (record.components != 1) continue;
            std::uint32_t most = 0;
            read.type = record.type == asset::AttributeType::uint8   ? RawAttribute::Type::Flag
                        : record.type == asset::AttributeType::int32 ? RawAttribute::Type::Whole
                                                                     : RawAttribute::Type::Index;
            for (std::size_t s = 0; s < count; ++s) {
                std::uint32_t value = 0;
                if (record.type == asset::AttributeType::uint8)
                    value = static_cast<std::uint32_t>(values[s]);
                else
                    std::memcpy(&value, &values[sizeof value * s], sizeof value);
                read.whole.push_back(static_cast<std::int32_t>(value));
                most = std::max(most, value);
            }
            // Names of groups are not in the asset.
            if (name == attribute::kGroup && most >= kMostGroups) continue;
            for (std::uint32_t group = 0; name == attribute::kGroup && group <= most; ++group)
                raw.groupNames.push_back(fmt::format("group {}", group));
        }
        raw.attributes.push_back(std::move(read));
    }
}

Result<RawStrands> readRuntime(const std::string& file, std::vector<std::byte>&& given,
                               const StrandImportOptions&) {
    // Memory of whole files is aligned so; a piece of another buffer need not be.
    struct alignas(asset::kAlignment) Aligned {
        std::byte bytes[asset::kAlignment];
    };
    std::vector<Aligned> aligned;
    std::span<const std::byte> bytes = given;
    if (reinterpret_cast<std::uintptr_t>(given.data()) % asset::kAlignment != 0) {
        aligned.resize(given.size() / sizeof(Aligned) + 1);
        std::memcpy(aligned.data(), given.data(), given.size());
        bytes = std::as_bytes(std::span(aligned)).first(given.size());
    }
    const auto opened = runtime::Asset::open(bytes);
    const auto refuse = [&](const runtime::AssetError& error) {
        Error said = expecting(errorOfWords(error.words), "expected a whole asset: export it again");
        said.file = file;
        said.place = Byte{error.byte};
        return tl::unexpected(std::move(said));
    };
    if (!opened.asset) return refuse(opened.error);
    if (const auto problem = opened.asset->check()) return refuse(*problem);
    const runtime::Asset& from = *opened.asset;
    const auto strands = from.strandsAtRest();
    RawStrands raw;
    raw.format = "Hairloom runtime asset";
    raw.offsets.assign(strands.offsets.begin(), strands.offsets.end());
    for (const runtime::Float3& p : strands.positions_ss) raw.positions.emplace_back(p.x, p.y, p.z);
    for (const std::uint16_t radius : from.radii)
        raw.thickness.push_back(2 * asset::kRadiusStep * static_cast<float>(radius));
    raw.statedMetresPerUnit = 1.0f;
    raw.statedUp = UpAxis::Y;
    raw.authored = readAuthored(from);
    readLayers(from, raw);
    readGuides(from, raw);
    readAttributes(from, raw);
    if (!from.roots.empty() && from.bones.empty())
        raw.warnings.push_back(fileWarning("the asset has no bones: roots go with the head as a whole",
                                           "skin",
                                           "export from a head with a skeleton, or have the game give roots "
                                           "or the scalp's vertices"));
    if (!from.body().empty())
        raw.warnings.push_back(fileNote("the skin collider goes with its head, which the file does not have",
                                        "body", "fit it again on the head (colliders --fit field)"));
    if (const asset::Clip* const clip = from.clip())
        raw.warnings.push_back(
            fileNote(fmt::format("the clip '{}' of {} frames is not read back, which games play",
                                 from.text(clip->name), clip->frames),
                     "clip", "keep the take that it was exported from"));
    if (!from.poses().empty())
        raw.warnings.push_back(
            fileNote(fmt::format("{} poses are not read back, which games play", from.poses().size()),
                     "poses", "keep the project that they were exported from"));
    return raw;
}

}  // namespace

StrandReader runtimeReader() {
    return {{"Hairloom runtime asset", {"hairrt"}}, Recognition::Signature, isAsset, readRuntime};
}

}  // namespace hairloom
