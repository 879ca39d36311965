// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/certificate_report.h"

#include <algorithm>
#include <limits>

#include "core/groom/file/json_reader.h"

namespace hairloom::cli {
namespace {

void addStrength(Report& report, const StormStrength& strength) {
    report["largest_step_s"] = strength.step;
    report["root_speed"] = strength.rootSpeed;
    report["turn"] = strength.turn;
    report["wind"] = strength.wind;
}

Report failuresOf(const std::vector<FailedStorm>& failed, std::size_t most) {
    Report rows = Report::array();
    for (std::size_t i = 0; i < std::min(most, failed.size()); ++i) {
        Report row{{"storm", failed[i].number}, {"what", failed[i].what}};
        addStrength(row, failed[i].strength);
        rows.push_back(std::move(row));
    }
    return rows;
}

std::uint32_t number(JsonReader& reader, std::string_view key) {
    return static_cast<std::uint32_t>(reader.count(key, 0, std::numeric_limits<std::uint32_t>::max()));
}

}  // namespace

Report toReport(const Certificate& certificate) {
    constexpr std::size_t kListed = 8;
    Report report;
    addStrength(report, certificate.limits);
    report["margin"] = kStormMargin;
    report["storms"] = certificate.storms;
    report["storms_within"] = certificate.within;
    report["calm"] = certificate.calm;
    report["calm_after_15_s"] = certificate.calmLate;
    report["failed"] = certificate.failed.size();
    report["failures"] = failuresOf(certificate.failed, kListed);
    report["words"] = inWords(certificate);
    return report;
}

Report toReport(const StormTally& tally) {
    return {{"first_storm", tally.first},
            {"storms", tally.storms},
            {"calm", tally.calm},
            {"calm_after_15_s", tally.calmLate},
            {"failures", failuresOf(tally.failed, tally.failed.size())}};
}

Result<StormTally> tallyFrom(const Report& report, const std::string& file) {
    const nlohmann::json json = report;
    JsonReader reader(json, file);
    StormTally tally;
    tally.first = number(reader, "first_storm");
    tally.storms = number(reader, "storms");
    tally.calm = number(reader, "calm");
    tally.calmLate = number(reader, "calm_after_15_s");
    constexpr double kAny = std::numeric_limits<double>::max();
    for (JsonReader& row : reader.objects("failures"))
        tally.failed.push_back({number(row, "storm"),
                                {row.number("largest_step_s", 0, kAny), row.number("root_speed", 0, kAny),
                                 row.number("turn", 0, kAny), row.number("wind", 0, kAny)},
                                row.string("what")});
    if (auto status = reader.status(); !status) return tl::unexpected(status.error());
    return tally;
}

}  // namespace hairloom::cli
