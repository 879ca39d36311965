// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep_merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <optional>
#include <random>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "cli/certificate_report.h"
#include "cli/sweep_run.h"
#include "core/base/file.h"
#include "core/base/output_file.h"
#include "core/charts/html_report.h"
#include "core/groom/file/manifest.h"

namespace hairloom::cli {
namespace {

namespace fs = std::filesystem;

struct Parts {
    std::vector<std::pair<const SweepPart*, DonePart>> done;
    std::vector<std::pair<const SweepPart*, std::optional<Error>>> open;  ///< failed, or not there yet
};

Parts partsOf(const SweepFolder& folder) {
    Parts parts;
    KnownHashes known;
    for (const SweepPart& part : folder.sweep().parts) {
        if (auto done = folder.done(part, known))
            parts.done.emplace_back(&part, std::move(*done));
        else
            parts.open.emplace_back(&part, folder.failure(part));
    }
    return parts;
}

SweepOutcome outcomeOf(const SweepFolder& folder, const Parts& parts) {
    SweepOutcome outcome{folder.sweep().parts.size(), parts.done.size(), 0, {}, 0};
    for (const auto& [part, done] : parts.done) outcome.seconds += done.seconds;
    for (const auto& [part, error] : parts.open) {
        if (!error) continue;
        ++outcome.failed;
        outcome.failures.push_back(fmt::format("{}: {}", inWords(*part), error->message()));
    }
    return outcome;
}

/// Whether a report's member says how long something took, or on what: each run has its own.
bool isMeasured(std::string_view key) {
    constexpr std::array kNames{"ms", "seconds", "device", "ns_per_particle_substep", "why", "busy"};
    if (std::ranges::find(kNames, key) != kNames.end()) return true;
    constexpr std::array kEnds{"_seconds", "_ms"};
    // Computed, not measured.
    if (key == "longest_stable_ms") return false;
    return key.starts_with("ms_") ||
           std::ranges::any_of(kEnds, [&](std::string_view end) { return key.ends_with(end); });
}

Report withoutTimes(const Report& value) {
    if (!value.is_structured()) return value;
    Report all = value.is_array() ? Report::array() : Report::object();
    for (const auto& [key, part] : value.items()) {
        if (value.is_array())
            all.push_back(withoutTimes(part));
        else if (!isMeasured(key))
            all[key] = withoutTimes(part);
    }
    return all;
}

/// One certificate for all tallies that differ in their storms alone.
Result<Report> certificatesOf(const Parts& parts) {
    struct Group {
        Report values;
        std::vector<StormTally> tallies;
    };
    std::vector<std::pair<std::vector<std::string>, Group>> groups;
    for (const auto& [part, done] : parts.done) {
        if (!done.report.contains("tally")) continue;
        std::vector<std::string> words = part->words;
        std::erase_if(words, [](const std::string& word) {
            return word.starts_with("--first-storm=") || word.starts_with("--storms=") ||
                   word.starts_with("--output=");
        });
        auto group = std::ranges::find(groups, words, [](const auto& pair) { return pair.first; });
        if (group == groups.end()) {
            groups.emplace_back(words, Group{part->values, {}});
            group = groups.end() - 1;
        }
        // What differs inside the group is the part's own.
        Report same = Report::object();
        for (const auto& [name, value] : group->second.values.items())
            if (part->values[name] == value) same[name] = value;
        group->second.values = std::move(same);
        auto tally = tallyFrom(done.report["tally"], inWords(*part));
        if (!tally) return tl::unexpected(tally.error());
        group->second.tallies.push_back(std::move(*tally));
    }
    Report rows = Report::array();
    for (auto& [words, group] : groups) {
        const auto certificate = certificateOf(std::move(group.tallies));
        if (!certificate) return tl::unexpected(certificate.error());
        rows.push_back(Report{{"values", group.values}, {"certificate", toReport(*certificate)}});
    }
    return rows;
}

Report mergedOf(const SweepFolder& folder, const Parts& parts) {
    Report merged{{"sweep", folder.sweep().name}, {"job", folder.sweep().job}, {"parts", Report::array()}};
    for (const auto& [part, done] : parts.done)
        merged["parts"].push_back(
            Report{{"part", part->number}, {"values", part->values}, {"report", withoutTimes(done.report)}});
    return merged;
}

std::string csvCell(const Report& value) {
    std::string text = value.is_string() ? value.get<std::string>() : value.is_null() ? "" : value.dump();
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

/// A row a part: its values, and what its report has outside of lists.
std::string tableOf(const Parts& parts) {
    std::vector<std::pair<std::string, std::vector<Report>>> columns;
    const auto cell = [&](std::size_t row, const std::string& name, const Report& value) {
        auto column = std::ranges::find(columns, name, [](const auto& pair) { return pair.first; });
        if (column == columns.end()) column = columns.insert(columns.end(), {name, {}});
        column->second.resize(row + 1);
        column->second[row] = value;
    };
    for (std::size_t row = 0; row < parts.done.size(); ++row) {
        const auto& [part, done] = parts.done[row];
        cell(row, "part", part->number);
        for (const auto& [name, value] : part->values.items()) {
            if (!value.is_object()) cell(row, name, value);
            if (!value.is_object()) continue;
            for (const auto& [member, inner] : value.items()) cell(row, name + "." + member, inner);
        }
        const Report report = withoutTimes(done.report);
        for (const auto& [name, value] : report.items())
            if (!value.is_structured() && name != "output") cell(row, "report." + name, value);
    }
    std::string text;
    for (std::size_t i = 0; i < columns.size(); ++i) text += (i == 0 ? "" : ",") + csvCell(columns[i].first);
    text += '\n';
    for (std::size_t row = 0; row < parts.done.size(); ++row) {
        for (std::size_t i = 0; i < columns.size(); ++i) {
            const auto& cells = columns[i].second;
            text += (i == 0 ? "" : ",") + (row < cells.size() ? csvCell(cells[row]) : std::string());
        }
        text += '\n';
    }
    return text;
}

/// Every output with its hash, as JSON and as `xxhsum --check` reads it.
std::pair<Report, std::string> manifestOf(const SweepFolder& folder, const Parts& parts) {
    Report manifest = manifestHead("hairloom-cli " HAIRLOOM_VERSION);
    manifest["sweep"] = folder.sweep().name;
    manifest["files"] = Report::array();
    std::string lines;
    for (const auto& [part, done] : parts.done) {
        for (const PartFile& file : done.files) {
            const std::string name = "parts/" + part->name + "/" + file.name;
            Report row = manifestRow(name, file.bytes, file.hash);
            row["values"] = part->values;
            manifest["files"].push_back(std::move(row));
            lines += fmt::format("XXH3 ({}) = {}\n", name, file.hash);
        }
    }
    return {std::move(manifest), std::move(lines)};
}

/// Links to, or copies of, all outputs in one folder.
Status gather(const SweepFolder& folder, const Parts& parts) {
    const fs::path target = folder.path() / "files";
    std::map<std::string, const SweepPart*> owners;
    for (const auto& [part, done] : parts.done) {
        for (const PartFile& file : done.files) {
            const auto [owner, isNew] = owners.emplace(file.name, part);
            if (!isNew)
                return failIn(
                    folder.sweep().file, {},
                    fmt::format("{} and {} both write {}", inWords(*owner->second), inWords(*part),
                                file.name),
                    "expected a name for each, as in {out}/hair.{part}.png, where outputs are gathered");
        }
    }
    std::error_code code;
    fs::remove_all(target, code);
    for (const auto& [name, part] : owners) {
        const fs::path from = folder.folderOf(*part) / name, to = target / name;
        fs::create_directories(to.parent_path(), code);
        fs::create_hard_link(from, to, code);
        if (code) fs::copy_file(from, to, code);
        if (code)
            return failIn(to.string(), {}, "cannot be made: " + code.message(),
                          "expected a folder that can be written");
    }
    return {};
}

std::string pageOf(const SweepFolder& folder, const Parts& parts, const SweepOutcome& outcome) {
    HtmlReport page(fmt::format("Sweep {}", folder.sweep().name));
    page.facts({{"job", folder.sweep().job},
                {"parts", std::to_string(outcome.parts)},
                {"done", std::to_string(outcome.done)},
                {"failed", std::to_string(outcome.failed)},
                {"missing", std::to_string(outcome.parts - outcome.done - outcome.failed)},
                {"time of all parts", durationText(outcome.seconds)}});
    if (!parts.open.empty()) page.heading("Not done");
    std::vector<std::vector<std::string>> open{{"part", "state", "why"}};
    for (const auto& [part, error] : parts.open)
        open.push_back({inWords(*part), error ? "failed" : "missing", error ? error->message() : ""});
    if (!parts.open.empty()) page.table(open);
    page.heading("Done");
    std::vector<std::vector<std::string>> done{{"part", "seconds", "machine", "files", "warnings"}};
    for (const auto& [part, what] : parts.done) {
        std::string warnings;
        for (const std::string& warning : what.warnings) warnings += (warnings.empty() ? "" : "; ") + warning;
        done.push_back({inWords(*part), fmt::format("{:.1f}", what.seconds), what.node,
                        std::to_string(what.files.size()), warnings});
    }
    page.table(done);
    return page.html();
}

/// Merging is for one at a time: another that has seen fewer parts done would take away what this one joins.
/// Waits up to a minute for it.
Result<OutputFile> turnToMerge(const SweepFolder& folder) {
    const fs::path state = folder.path() / "state";
    constexpr int kTries = 600;
    for (int i = 0;; ++i) {
        auto turn = OutputFile::open(state / "merge", {}, Replacing::Anything);
        if (turn || i == kTries) return turn;
        // A folder that takes no file at all is waited for in vain.
        const fs::path other = state / fmt::format("merge-{:08x}", std::random_device{}());
        if (i == 0 && !OutputFile::open(other, {}, Replacing::Anything)) return turn;
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
}

}  // namespace

SweepOutcome statusOf(const SweepFolder& folder) {
    return outcomeOf(folder, partsOf(folder));
}

Result<SweepOutcome> mergeSweep(const SweepFolder& folder) {
    const auto turn = turnToMerge(folder);
    if (!turn) return tl::unexpected(turn.error());
    const Parts parts = partsOf(folder);
    SweepOutcome outcome = outcomeOf(folder, parts);
    const auto write = [&](const std::string& name, const std::string& text) {
        return writeFileAtomically(folder.path() / name, std::as_bytes(std::span(text)), Replacing::Anything);
    };
    // What an earlier merge made goes, whatever comes of this one.
    std::error_code code;
    for (const char* stale :
         {"merged.json", "table.csv", "manifest.json", "manifest.xxh3", "certificates.json"})
        fs::remove(folder.path() / stale, code);
    fs::remove_all(folder.path() / "files", code);
    if (auto status = write("report.html", pageOf(folder, parts, outcome)); !status)
        return tl::unexpected(status.error());
    std::vector<std::pair<std::string, std::string>> files;
    if (parts.open.empty()) {
        files.emplace_back("merged.json", mergedOf(folder, parts).dump(1) + "\n");
        files.emplace_back("table.csv", tableOf(parts));
        const auto [manifest, lines] = manifestOf(folder, parts);
        files.emplace_back("manifest.json", manifest.dump(1) + "\n");
        files.emplace_back("manifest.xxh3", lines);
        const auto certificates = certificatesOf(parts);
        if (!certificates) return tl::unexpected(certificates.error());
        if (!certificates->empty()) files.emplace_back("certificates.json", certificates->dump(1) + "\n");
        if (folder.sweep().gather) {
            if (auto status = gather(folder, parts); !status) return tl::unexpected(status.error());
        }
    }
    for (const auto& [name, text] : files) {
        if (auto status = write(name, text); !status) return tl::unexpected(status.error());
    }
    return outcome;
}

}  // namespace hairloom::cli
