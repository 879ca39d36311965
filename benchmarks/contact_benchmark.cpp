// SPDX-License-Identifier: GPL-3.0-or-later
// Where hair touches something: what docs/contact.md lists, with the mark of each.

#include <fmt/format.h>

#include <cmath>

#include "benchmarks/contact_rows.h"

namespace hairloom::benchmarks {
namespace {

/// Three digits.
std::string inDigits(double value) {
    if (!std::isfinite(value)) return "none";
    if (value == std::floor(value) && value < 1e6) return fmt::format("{:.0f}", value);
    return value >= 100    ? fmt::format("{:.0f}", value)
           : value >= 0.01 ? fmt::format("{:.3g}", value)
                           : "0.01";
}

std::string marksTable(const std::vector<ContactRow>& rows) {
    std::string text = "| what | today | mark | what limits it |\n|---|---|---|---|\n";
    const auto cell = [](double value, const std::string& unit) {
        return unit.empty() ? inDigits(value) : fmt::format("{} {}", inDigits(value), unit);
    };
    for (const ContactRow& row : rows) {
        const bool isBelow = row.value > 0 && row.value < 0.01;
        text +=
            fmt::format("| {} | {}{} | {} | {} |\n", row.name, isBelow ? "below " : "",
                        cell(row.value, row.unit), cell(row.mark, row.unit), row.met() ? "" : row.limited);
    }
    return text;
}

Result<Outcome> run(const Options& options) {
    const std::size_t all = contactStepsOfRods(options.quick) + contactStepsOfSamples(options);
    std::size_t begun = 0;
    const auto next = [&] {
        if (options.progress) options.progress("contact", begun, all);
        ++begun;
    };
    std::vector<ContactRow> rows = contactsOfRods(options.quick, next);
    auto more = contactsOfSamples(options, next);
    if (!more) return tl::unexpected(more.error());
    rows.insert(rows.end(), more->begin(), more->end());
    if (options.progress) options.progress("contact", all, all);
    Report report = Report::array();
    for (const ContactRow& row : rows) {
        report.push_back({{"name", row.name},
                          {"value", std::isfinite(row.value) ? Report(row.value) : Report()},
                          {"unit", row.unit},
                          {"mark", row.mark},
                          {"met", row.met()}});
    }
    const std::string table = marksTable(rows);
    return Outcome{Report{{"name", "contact"}, {"rows", std::move(report)}}, table, {{"contact.md", table}}};
}

}  // namespace

Benchmark contactBenchmark() {
    return {"contact",
            "how exact hair is where it touches, beside marks",
            {"--quick", "--grooms", "--markdown", "--output"},
            run};
}

}  // namespace hairloom::benchmarks
