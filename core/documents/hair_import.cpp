// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/hair_import.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/documents/head_transfer.h"
#include "core/editing/replay.h"
#include "core/groom/file/json_reader.h"

namespace hairloom {
namespace {

constexpr std::string_view kUpAxes[] = {"y", "z"};
constexpr double kMaxMetresPerUnit = 1e6;

std::function<Result<std::size_t>(Groom&)> readImport(JsonReader& reader) {
    StrandImportOptions options;
    const std::string path = reader.string("file");
    options.metresPerUnit = static_cast<float>(reader.number("metresPerUnit", 1e-6, kMaxMetresPerUnit, "m"));
    options.up = static_cast<UpAxis>(reader.choice("up", kUpAxes));
    options.ribbonSegments = static_cast<std::uint32_t>(reader.count("ribbonSegments", 0, 511));
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
    if (imported && groom.scalp) bindToScalp(imported->groom, groom.scalp, groom.scalpSelection);
    return imported;
}

void replaceHair(Groom& groom, const Groom& hair) {
    groom.offsets = hair.offsets;
    groom.strandAttributes = hair.strandAttributes;
    groom.pointAttributes = hair.pointAttributes;
    groom.operators = hair.operators;
    groom.groupNames = hair.groupNames;
    // The parts that the hair comes in are the layers of its strands.
    if (hair.strandAttributes.has(attribute::kLayer)) groom.layers = hair.layers;
    groom.triangulation = {};
    groom.scalpSelection = hair.scalpSelection;
}

std::string importRecord(const std::string& path, const StrandImportOptions& options) {
    const nlohmann::ordered_json record{{"op", "import"},
                                        {"file", std::filesystem::absolute(path).string()},
                                        {"metresPerUnit", readableDecimal(options.metresPerUnit)},
                                        {"up", kUpAxes[static_cast<std::size_t>(options.up)]},
                                        {"ribbonSegments", options.ribbonSegments}};
    return record.dump();
}

Result<Script> parseDocumentScript(const std::string& file, std::string_view text) {
    std::vector<ScriptExtension> extensions = editing::scriptExtensions();
    extensions.push_back({"import", readImport});
    extensions.push_back(transferExtension());
    return parseScript(file, text, extensions);
}

}  // namespace hairloom
