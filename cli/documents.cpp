// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/documents.h"

#include <fmt/format.h>

#include <CLI/Validators.hpp>
#include <charconv>
#include <cmath>

#include "core/base/file.h"
#include "core/base/log.h"
#include "core/groom/project_file.h"
#include "core/groom/settings_json.h"
#include "importers/length_unit.h"
#include "importers/strands.h"

namespace hairloom::cli {
namespace {

std::vector<std::string> unitNames() {
    std::vector<std::string> names;
    for (const LengthUnit& unit : lengthUnits()) names.emplace_back(unit.name);
    return names;
}

}  // namespace

void addUnitOption(CLI::App& job, std::string& unit, const std::string& name, const std::string& of) {
    job.add_option(name, unit, "Unit of lengths in " + of + " where it states none: m, dm, cm, mm or inch")
        ->check(CLI::IsMember(unitNames()));
}

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

Result<Groom> loadDocument(const std::string& path) {
    if (looksLikeProject(path)) return loadProject(path);
    auto imported = importStrands(path, {});
    if (!imported) return tl::unexpected(imported.error());
    logFindings(path, imported->warnings);
    return std::move(imported->groom);
}

Result<Opened> openAny(const std::string& path, const std::string& unit) {
    Opened opened;
    if (looksLikeProject(path)) {
        auto groom = loadProject(path);
        if (!groom) return tl::unexpected(groom.error());
        opened.groom = std::move(*groom);
        opened.format = "hairloom";
        opened.findings = validate(opened.groom);
        return opened;
    }
    StrandImportOptions options;
    if (!unit.empty()) options.metresPerUnit = metresPerUnit(unit);
    if (auto imported = importStrands(path, options)) {
        opened.groom = std::move(imported->groom);
        opened.format = imported->format;
        opened.findings = validate(opened.groom);
        opened.findings.insert(opened.findings.end(), imported->warnings.begin(), imported->warnings.end());
        for (const DroppedStrand& dropped : imported->dropped) {
            opened.findings.push_back({Severity::Error, std::string(dropReasonName(dropped.reason)),
                                       fmt::format("strand {}", dropped.strand),
                                       "import drops such strands"});
        }
        return opened;
    } else if (looksLikeStrandFile(readBeginning(path, 256))) {
        return tl::unexpected(imported.error());
    }
    auto scene = importSceneWithUnit(path, unit);
    if (!scene) return tl::unexpected(scene.error());
    opened.format = scene->format;
    for (const MeshRepair& repair : scene->mesh.repairs()) {
        opened.findings.push_back(
            {Severity::Warning, repair.what, fmt::format("{} places", repair.count), "mended when imported"});
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
    std::vector<CollisionSphere> spheres;
    for (JsonReader& entry : reader.objects("spheres")) spheres.push_back(readSphere(entry));
    if (auto status = reader.status(); !status) return tl::unexpected(status.error());
    return spheres;
}

Result<std::vector<float>> readVertexMask(const std::string& path, const ScalpMesh& mesh) {
    const auto text = readTextFile(path);
    if (!text) return tl::unexpected(text.error());
    std::vector<float> perSourceVertex;
    std::uint64_t line = 1;
    const char* at = text->data();
    const char* const end = at + text->size();
    while (true) {
        while (at != end && (*at == ' ' || *at == '\t' || *at == '\r' || *at == '\n')) line += *at++ == '\n';
        if (at == end) break;
        float value = 0;
        const auto [next, code] = std::from_chars(at, end, value);
        if (code != std::errc() || !(value >= 0 && value <= 1)) {
            return failIn(path, Line{line}, "is no density", "expected a number from 0 to 1");
        }
        perSourceVertex.push_back(value);
        at = next;
    }
    std::vector<float> mask(mesh.vertexCount());
    for (std::size_t v = 0; v < mask.size(); ++v) {
        const std::uint32_t source = mesh.sourceVertices()[v];
        if (source >= perSourceVertex.size()) {
            return failIn(path, {}, fmt::format("has {} densities", perSourceVertex.size()),
                          "expected one for each vertex of the mesh file");
        }
        mask[v] = perSourceVertex[source];
    }
    return mask;
}

void logFindings(const std::string& path, const std::vector<Finding>& findings) {
    for (const Finding& finding : findings) {
        log::warning("{}: {}: {}{}{}", path, finding.where, finding.what, finding.fix.empty() ? "" : "; ",
                     finding.fix);
    }
}

Report toReport(const std::vector<Finding>& findings) {
    Report rows = Report::array();
    for (const Finding& finding : findings) rows.push_back(toReport(finding));
    return rows;
}

Report toReport(const Finding& finding) {
    return Report{{"severity", severityName(finding.severity)},
                  {"what", finding.what},
                  {"where", finding.where},
                  {"fix", finding.fix}};
}

Report toReport(const Vec3f& vector) {
    return Report::array({vector.x(), vector.y(), vector.z()});
}

Report finiteOrNull(double value) {
    return std::isfinite(value) ? Report(value) : Report(nullptr);
}

}  // namespace hairloom::cli
