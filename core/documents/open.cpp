// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/open.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "core/base/file.h"
#include "core/base/log.h"
#include "core/groom/file/project_file.h"
#include "core/groom/file/settings_json.h"
#include "core/groom/mask_names.h"
#include "core/operations/stack.h"
#include "importers/length_unit.h"
#include "importers/mesh_format.h"
#include "importers/strands.h"

namespace hairloom {

float metresPerUnit(const std::string& unit) {
    for (const LengthUnit& known : lengthUnits()) {
        if (unit == known.name) return static_cast<float>(known.metres);
    }
    return 1.0f;
}

Result<ImportedScene> importSceneLoud(const std::string& path, const MeshImportOptions& options) {
    auto scene = importScene(path, options);
    if (scene) {
        for (const std::string& warning : scene->warnings) log::warning("{}: {}", path, warning);
    }
    return scene;
}

Result<ImportedScene> importSceneWithUnit(const std::string& path, const std::string& unit) {
    MeshImportOptions options;
    if (!unit.empty()) options.metresPerUnit = metresPerUnit(unit);
    return importSceneLoud(path, options);
}

namespace {

std::string& unitOfHairFiles() {
    static std::string unit;
    return unit;
}

StrandImportOptions inUnit(const std::string& unit) {
    StrandImportOptions options;
    options.isUnitAsked = !unit.empty();
    if (options.isUnitAsked) options.metresPerUnit = metresPerUnit(unit);
    return options;
}

/// The mesh reader has words for these.
bool isUtf16(const std::string& path) {
    const std::vector<std::byte> mark = readBeginning(path, 2);
    return mark.size() == 2 && (mark == std::vector{std::byte{0xff}, std::byte{0xfe}} ||
                                mark == std::vector{std::byte{0xfe}, std::byte{0xff}});
}

/// Before a reader is asked, which expects what it reads.
Status checkIsSomething(const std::string& path) {
    constexpr const char* kExpected = "expected a project, hair file or mesh";
    std::error_code code;
    const auto status = std::filesystem::status(path, code);
    if (!std::filesystem::exists(status)) return failIn(path, {}, "no such file", kExpected);
    if (!std::filesystem::is_regular_file(status))
        return failIn(path, {}, "is not a regular file", kExpected);
    if (std::filesystem::file_size(path, code) == 0 && !code) return failIn(path, {}, "is empty", kExpected);
    return {};
}

}  // namespace

void setUnitOfHairFiles(const std::string& unit) {
    unitOfHairFiles() = unit;
}

bool mayBeHead(const std::string& path) {
    std::error_code code;
    const std::uint64_t size = std::filesystem::file_size(path, code);
    return !code && meshFormatOf(readBeginning(path, kMeshFormatHead), size).has_value();
}

Result<Groom> openGroom(const std::string& path) {
    if (looksLikeProject(path)) return openProject(path);
    auto imported = importStrands(path, inUnit(unitOfHairFiles()));
    if (!imported) return tl::unexpected(imported.error());
    logFindings(path, imported->warnings);
    return std::move(imported->groom);
}

Result<Opened> openAny(const std::string& path, const std::string& unit) {
    Opened opened;
    if (looksLikeProject(path)) {
        auto groom = openProject(path);
        if (!groom) return tl::unexpected(groom.error());
        opened.groom = std::move(*groom);
        opened.format = "hairloom";
        opened.findings = validate(opened.groom);
        return opened;
    }
    if (auto status = checkIsSomething(path); !status) return tl::unexpected(status.error());
    auto imported = importStrands(path, inUnit(unit));
    if (imported) {
        opened.groom = std::move(imported->groom);
        opened.format = imported->format;
        opened.findings = validate(opened.groom);
        for (const Finding& warning : imported->warnings) {
            const auto isSame = [&](const Finding& other) {
                return other.what == warning.what && other.where == warning.where;
            };
            if (std::ranges::none_of(opened.findings, isSame)) opened.findings.push_back(warning);
        }
        for (const DroppedStrand& dropped : imported->dropped) {
            opened.findings.push_back({Severity::Error, std::string(dropReasonName(dropped.reason)),
                                       fmt::format("strand {}", dropped.strand),
                                       "import drops such strands"});
        }
        return opened;
    }
    if (looksLikeStrandFile(readBeginning(path, 256))) {
        if (!mayBeHead(path)) return tl::unexpected(imported.error());
        if (const auto head = importScene(path); !head) {
            Error both = imported.error();
            both.problem += "; and as a head it " + head.error().problem;
            return tl::unexpected(both);
        }
    }
    if (!mayBeHead(path) && !isUtf16(path))
        return failIn(path, {}, "is in no format that is known",
                      fmt::format("expected a project, hair ({}) or a mesh ({})", labelsOf(strandFormats()),
                                  labelsOf(meshFormats())));
    auto scene = importSceneWithUnit(path, unit);
    if (!scene) return tl::unexpected(scene.error());
    opened.format = scene->format;
    for (const MeshRepair& repair : scene->mesh.repairs()) {
        opened.findings.push_back(
            {Severity::Warning, repair.what, fmt::format("{} places", repair.count), "repaired on import"});
    }
    for (const std::string& warning : scene->warnings) {
        opened.findings.push_back({Severity::Warning, warning, "file", ""});
    }
    opened.groom.scalp = std::make_shared<const ScalpMesh>(std::move(scene->mesh));
    return opened;
}

Result<std::vector<CollisionSphere>> readSpheres(const std::string& path) {
    const auto text = readTextFile(path, kMaxJsonBytes);
    if (!text) return tl::unexpected(text.error());
    auto parsed = parseJson(path, *text);
    if (!parsed) return tl::unexpected(parsed.error());
    const nlohmann::json document{{"spheres", std::move(*parsed)}};
    JsonReader reader(document, path);
    std::vector<CollisionSphere> spheres = readSphereList(reader);
    if (auto status = reader.status(); !status) return tl::unexpected(status.error());
    return spheres;
}

namespace {

void readLayerSettings(JsonReader reader, const nlohmann::json& named, Groom& groom) {
    for (const std::string& name : reader.keys()) {
        JsonReader entry = reader.object(name);
        if (!reader.ok()) return;
        std::size_t found = 0;
        for (Layer& layer : groom.layers) {
            if (layer.name != name) continue;
            ++found;
            if (entry.has("density"))
                layer.density =
                    static_cast<float>(entry.number("density", 0, static_cast<double>(kMaxLayerDensity)));
            if (!entry.has("material")) continue;
            if (named.at(name).at("material").is_null()) {
                layer.material.reset();
                continue;
            }
            HairMaterial material = layer.material.value_or(groom.material);
            readSettings(entry.object("material"), material);
            layer.material = material;
        }
        if (found == 0) reader.complain(name, "is not a layer", "expected one listed by `layers`");
        entry.finish();
    }
}

}  // namespace

Status applySettings(const nlohmann::json& document, const std::string& source, Groom& groom) {
    JsonReader reader(document, source);
    if (reader.has("simulation")) readSettings(reader.object("simulation"), groom.simulation);
    if (reader.has("material")) readSettings(reader.object("material"), groom.material);
    if (reader.has("shadows")) readSettings(reader.object("shadows"), groom.shadows);
    if (reader.has("interpolation")) readSettings(reader.object("interpolation"), groom.interpolation);
    if (reader.has("layers")) readLayerSettings(reader.object("layers"), document.at("layers"), groom);
    if (reader.has("masks")) readMaskNames(reader.object("masks"), groom.maskNames);
    reader.finish();
    return reader.status();
}

void logFindings(const std::string& path, const std::vector<Finding>& findings) {
    for (const Finding& finding : findings) {
        log::warning("{}: {}: {}{}{}", path, finding.where, finding.what, finding.fix.empty() ? "" : "; ",
                     finding.fix);
    }
}

}  // namespace hairloom
