// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/report.h"

#include <nlohmann/json.hpp>

namespace hairloom {

nlohmann::json toJson(const ExportReport& report) {
    nlohmann::json findings = nlohmann::json::array();
    for (const Finding& finding : report.findings) {
        findings.push_back({{"severity", std::string(severityName(finding.severity))},
                            {"what", finding.what},
                            {"where", finding.where},
                            {"fix", finding.fix}});
    }
    nlohmann::json attributes = nlohmann::json::array();
    for (const ComparedAttribute& attribute : report.attributes)
        attributes.push_back({{"name", attribute.name}, {"max_error", attribute.maxError}});
    nlohmann::json leftBehind = nlohmann::json::array();
    for (const LeftBehind& left : report.leftBehind)
        leftBehind.push_back({{"what", left.what}, {"fix", left.fix}});
    nlohmann::json json{{"attributes", std::move(attributes)},
                        {"names", report.names},
                        {"left_behind", std::move(leftBehind)},
                        {"format", report.format},
                        {"strands", report.strands},
                        {"points", report.points},
                        {"bytes", report.bytes},
                        {"max_error_mm", nullptr},
                        {"findings", std::move(findings)}};
    if (report.maxErrorMm) json["max_error_mm"] = *report.maxErrorMm;
    for (const WrittenLevel& level : report.levels) {
        json["levels"].push_back({{"name", level.name},
                                  {"cards", level.cards},
                                  {"triangles", level.triangles},
                                  {"bytes", level.bytes},
                                  {"distance_m", level.distance},
                                  {"coverage", level.coverage},
                                  {"flip", level.flip},
                                  {"light", level.light}});
    }
    if (report.springHz > 0) {
        json["springs"] = {{"hz", report.springHz}, {"rates", nlohmann::json::array()}};
        for (const WrittenSpringRate& rate : report.springRates)
            json["springs"]["rates"].push_back(
                {{"hz", rate.hz}, {"error_mm", rate.errorMm}, {"largest_mm", rate.largestMm}});
    }
    if (report.safeLimits) {
        for (const auto& field : fieldsOf(*report.safeLimits))
            json["certificate"][std::string(field.name)] = field.get(*report.safeLimits, 0);
    }
    if (!report.companions.empty()) json["companions"] = report.companions;
    if (report.frames > 0) json["frames"] = report.frames;
    if (report.samples > report.frames) json["samples"] = report.samples;
    return json;
}

}  // namespace hairloom
