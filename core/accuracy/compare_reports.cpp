// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/accuracy/compare_reports.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>

namespace hairloom {
namespace {

constexpr double kTenth = 1.1;
constexpr double kLeastMm = 1e-3;

std::vector<std::string_view> split(std::string_view text, char at) {
    std::vector<std::string_view> parts;
    for (std::size_t begin = 0;;) {
        const std::size_t end = text.find(at, begin);
        parts.push_back(text.substr(begin, end - begin));
        if (end == std::string_view::npos) return parts;
        begin = end + 1;
    }
}

struct Row {
    std::string setting;
    double ms = 0, q1 = 0, q3 = 0, error = 0;
    bool diverged = false;
};

/// Columns by name, and those before them, which are the axes.
class Table {
  public:
    static Result<std::vector<Row>> read(std::string_view text) {
        const std::vector<std::string_view> lines = split(text, '\n');
        Table table;
        table.head_ = split(lines.front(), ',');
        for (const char* name : {"ms_median", "ms_q1", "ms_q3", "error_mm_rms", "diverged"}) {
            const auto found = std::ranges::find(table.head_, std::string_view(name));
            if (found == table.head_.end())
                return failIn({}, Line{1}, fmt::format("there is no column {}", name),
                              "expected a data.csv written by `accuracy`");
            table.columns_[name] = static_cast<std::size_t>(found - table.head_.begin());
        }
        std::vector<Row> rows;
        for (std::size_t l = 1; l < lines.size(); ++l) {
            if (lines[l].empty()) continue;
            auto row = table.row(lines[l], l + 1);
            if (!row) return tl::unexpected(row.error());
            rows.push_back(std::move(*row));
        }
        return rows;
    }

  private:
    Result<Row> row(std::string_view line, std::size_t number) const {
        const std::vector<std::string_view> cells = split(line, ',');
        if (cells.size() != head_.size())
            return failIn({}, Line{number}, fmt::format("{} columns", cells.size()),
                          fmt::format("expected {}, as in the first line", head_.size()));
        Row row;
        for (std::size_t c = 0; c < columns_.at("ms_median"); ++c)
            row.setting += fmt::format("{}{} {}", c > 0 ? ", " : "", head_[c], cells[c]);
        row.diverged = cells[columns_.at("diverged")] == "1";
        if (row.diverged) return row;
        for (const auto& [name, into] :
             {std::pair{"ms_median", &row.ms}, std::pair{"ms_q1", &row.q1}, std::pair{"ms_q3", &row.q3},
              std::pair{"error_mm_rms", &row.error}}) {
            const std::string_view cell = cells[columns_.at(name)];
            const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), *into);
            if (error != std::errc() || end != cell.data() + cell.size())
                return failIn({}, Line{number}, fmt::format("{} is '{}'", name, cell), "expected a number");
        }
        return row;
    }

    std::vector<std::string_view> head_;
    std::map<std::string_view, std::size_t> columns_;
};

ComparedRun compared(const Row& before, const Row& after) {
    ComparedRun run{before.setting,  before.ms,      after.ms, before.error, after.error,
                    before.diverged, after.diverged, false,    false};
    const bool numbers = !before.diverged && !after.diverged;
    run.slower = numbers && after.ms > kTenth * before.ms && after.q1 > before.q3;
    run.lessExact = (after.diverged && !before.diverged) ||
                    (numbers && after.error > std::max(kTenth * before.error, before.error + kLeastMm));
    return run;
}

}  // namespace

Result<ComparedReports> compareReports(std::string_view before, std::string_view after) {
    const auto first = Table::read(before);
    if (!first) return tl::unexpected(first.error());
    const auto second = Table::read(after);
    if (!second) return tl::unexpected(second.error());
    ComparedReports result;
    for (const Row& row : *first) {
        const auto same = std::ranges::find(*second, row.setting, &Row::setting);
        if (same == second->end()) {
            result.missing.push_back(row.setting);
        } else {
            result.runs.push_back(compared(row, *same));
        }
    }
    for (const Row& row : *second) {
        if (std::ranges::find(*first, row.setting, &Row::setting) == first->end())
            result.missing.push_back(row.setting);
    }
    if (result.runs.empty())
        return fail("the two reports have no setting in common", "expected measurements of the same grid");
    return result;
}

}  // namespace hairloom
