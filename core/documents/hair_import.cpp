// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/hair_import.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <utility>

#include "core/documents/hair_blend.h"
#include "core/documents/head_transfer.h"
#include "core/editing/replay.h"
#include "core/groom/file/json_reader.h"
#include "core/operations/stack.h"

namespace hairloom {
namespace {

template <class T>
T zeroOf() {
    if constexpr (std::is_arithmetic_v<T>)
        return T{};
    else
        return T(T::Zero());
}

/// Each point has the material's radius where it has none of its own.
void giveRadii(Groom& groom) {
    if (groom.pointAttributes.has(attribute::kRadius)) return;
    std::vector<float> radii;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const std::uint32_t points = groom.offsets[s + 1] - groom.offsets[s];
        for (std::uint32_t p = 0; p < points; ++p) {
            const float t = static_cast<float>(p) / static_cast<float>(std::max(1u, points - 1));
            radii.push_back(groom.material.rootRadius * (1 + t * (groom.material.tipScale - 1)));
        }
    }
    groom.pointAttributes.set(attribute::kRadius, std::move(radii));
}

/// The values of both behind each other; zeros for those that one of them does not have.
void appendAttributes(AttributeSet& attributes, std::size_t count, const AttributeSet& more,
                      std::size_t added) {
    AttributeSet all;
    const auto append = [&](const std::string& name, const AttributeData& type) {
        std::visit(
            [&](const auto& array) {
                using T = std::remove_cvref_t<decltype(array[0])>;
                std::vector<T> values;
                const auto take = [&](const AttributeSet& set, std::size_t size) {
                    const auto own = set.view<T>(name);
                    if (own.size() == size)
                        values.insert(values.end(), own.begin(), own.end());
                    else
                        values.resize(values.size() + size, zeroOf<T>());
                };
                take(attributes, count);
                take(more, added);
                all.set(name, std::move(values));
            },
            type);
    };
    for (const auto& [name, data] : attributes.all()) append(name, data);
    for (const auto& [name, data] : more.all()) {
        if (!attributes.has(name)) append(name, data);
    }
    attributes = std::move(all);
}

constexpr std::string_view kUpAxes[] = {"y", "z"};
constexpr std::string_view kOrders[] = {"auto", "interleaved", "edges", "around"};
constexpr std::string_view kParticles[] = {"edge", "centre"};
constexpr double kMaxMetresPerUnit = 1e6;

std::function<Result<std::size_t>(Groom&)> readImport(JsonReader& reader) {
    StrandImportOptions options;
    const std::string path = reader.string("file");
    options.metresPerUnit = static_cast<float>(reader.number("metresPerUnit", 1e-6, kMaxMetresPerUnit, "m"));
    options.up = static_cast<UpAxis>(reader.choice("up", kUpAxes));
    options.ribbonSegments = static_cast<std::uint32_t>(reader.count("ribbonSegments", 0, 65535));
    // Scripts of before have none of these.
    if (reader.has("ribbonOrder"))
        options.ribbonOrder = static_cast<RibbonOrder>(reader.choice("ribbonOrder", kOrders));
    if (reader.has("ribbonParticle"))
        options.ribbonParticle = static_cast<RibbonParticle>(reader.choice("ribbonParticle", kParticles));
    if (reader.has("pointsPerStrand"))
        options.pointsPerStrand = static_cast<std::uint32_t>(reader.count("pointsPerStrand", 0, 65536));
    return [path, options](Groom& groom) -> Result<std::size_t> {
        const auto hair = importHairFor(groom, path, options);
        if (!hair) return tl::unexpected(hair.error());
        replaceHair(groom, hair->groom);
        return groom.strandCount();
    };
}

}  // namespace

Result<ImportedStrands> importHairFor(const Groom& groom, const std::string& path,
                                      StrandImportOptions options) {
    options.scalp = groom.scalp.get();
    auto imported = importStrands(path, options);
    if (imported) checkOperators(path, *imported);
    if (imported && groom.scalp) bindToScalp(imported->groom, groom.scalp, groom.scalpSelection);
    return imported;
}

void checkOperators(const std::string& path, ImportedStrands& imported) {
    const auto complete = completeOperators(path, imported.groom);
    if (complete) return;
    dropOperators(imported.groom);
    imported.warnings.push_back({Severity::Warning,
                                 "its operators were left out: " + complete.error().problem, "operators",
                                 complete.error().expected});
}

void replaceHair(Groom& groom, const Groom& hair) {
    groom.offsets = hair.offsets;
    groom.strandAttributes = hair.strandAttributes;
    groom.pointAttributes = hair.pointAttributes;
    groom.operators = hair.operators;
    groom.groupNames = hair.groupNames;
    groom.maskNames = hair.maskNames;
    groom.poses = hair.poses;
    // The parts that the hair comes in are the layers of its strands.
    if (hair.strandAttributes.has(attribute::kLayer)) groom.layers = hair.layers;
    groom.triangulation = {};
    groom.scalpSelection = hair.scalpSelection;
}

void appendGuides(Groom& groom, const Groom& guides) {
    Groom behind = guides;
    dropOperators(groom);
    dropOperators(behind);
    const bool hasRadii =
        groom.pointAttributes.has(attribute::kRadius) || behind.pointAttributes.has(attribute::kRadius);
    if (hasRadii) {
        giveRadii(groom);
        giveRadii(behind);
    }
    // Ids tell the strands of one file apart.
    groom.strandAttributes.erase(attribute::kStrandId);
    behind.strandAttributes.erase(attribute::kStrandId);
    // Groups and layers are numbers of the file's own names.
    for (const std::string_view name : {attribute::kGroup, attribute::kLayer})
        behind.strandAttributes.erase(name);
    const std::size_t hairs = groom.strandCount(), count = behind.strandCount();
    appendAttributes(groom.strandAttributes, hairs, behind.strandAttributes, count);
    appendAttributes(groom.pointAttributes, groom.pointCount(), behind.pointAttributes, behind.pointCount());
    std::vector<std::uint32_t> offsets(groom.offsets.view().begin(), groom.offsets.view().end());
    const std::uint32_t points = offsets.back();
    for (std::size_t s = 1; s <= count; ++s) offsets.push_back(points + behind.offsets[s]);
    groom.offsets = CowArray<std::uint32_t>(std::move(offsets));
    std::vector<std::uint8_t> flags(hairs + count, 0);
    std::fill(flags.begin() + static_cast<std::ptrdiff_t>(hairs), flags.end(), std::uint8_t{1});
    groom.strandAttributes.set(attribute::kGuide, std::move(flags));
}

std::string importRecord(const std::string& path, const StrandImportOptions& options) {
    const nlohmann::ordered_json record{
        {"op", "import"},
        {"file", std::filesystem::absolute(path).string()},
        {"metresPerUnit", readableDecimal(options.metresPerUnit)},
        {"up", kUpAxes[static_cast<std::size_t>(options.up)]},
        {"ribbonSegments", options.ribbonSegments},
        {"ribbonOrder", kOrders[static_cast<std::size_t>(options.ribbonOrder)]},
        {"ribbonParticle", kParticles[static_cast<std::size_t>(options.ribbonParticle)]},
        {"pointsPerStrand", options.pointsPerStrand}};
    return record.dump();
}

Result<Script> parseDocumentScript(const std::string& file, std::string_view text) {
    std::vector<ScriptExtension> extensions = editing::scriptExtensions();
    extensions.push_back({"import", readImport});
    extensions.push_back(transferExtension());
    extensions.push_back(blendExtension());
    return parseScript(file, text, extensions);
}

}  // namespace hairloom
