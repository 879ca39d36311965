// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/documents.h"

#include <fmt/format.h>

#include <CLI/Validators.hpp>
#include <charconv>
#include <cmath>

#include "core/base/file.h"
#include "core/base/log.h"
#include "importers/length_unit.h"

namespace hairloom::cli {

std::vector<std::string> unitNames() {
    std::vector<std::string> names;
    for (const LengthUnit& unit : lengthUnits()) names.emplace_back(unit.name);
    return names;
}

void addUnitOption(CLI::App& job, std::string& unit, const std::string& name, const std::string& of) {
    job.add_option(name, unit,
                   "Unit of lengths in " + of + ", if the file states none: m, dm, cm, mm or inch")
        ->check(CLI::IsMember(unitNames()));
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
            return failIn(path, Line{line}, "is not a density", "expected a number from 0 to 1");
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

Report toReport(const std::vector<Finding>& findings) {
    Report rows = Report::array();
    for (const Finding& finding : findings) rows.push_back(toReport(finding));
    return rows;
}

void tellFindings(const std::vector<Finding>& findings) {
    for (const Finding& finding : findings) {
        if (finding.severity == Severity::Info) continue;
        log::warning("{}: {}{}{}", finding.where, finding.what, finding.fix.empty() ? "" : "; ", finding.fix);
    }
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
