// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep_file.h"

#include <fmt/format.h>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>

#include "cli/error_report.h"
#include "cli/finite_numbers.h"
#include "cli/global_options.h"
#include "cli/job_list.h"
#include "cli/usage_error.h"
#include "core/base/file.h"
#include "core/groom/file/json_reader.h"

namespace hairloom::cli {
namespace {

using nlohmann::json;

constexpr std::string_view kOut = "{out}";

struct Axis {
    std::string name;
    std::vector<json> values;
};

/// A value as the command line has it.
std::string textOf(const json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (!value.is_array()) return value.dump();
    std::string all;
    for (const json& item : value) all += (all.empty() ? "" : ",") + textOf(item);
    return all;
}

bool isPlain(const json& value) {
    return value.is_string() || value.is_number() || value.is_boolean();
}

/// Values given by their first, last and distance, as often as that fits.
std::vector<json> steps(JsonReader& axis) {
    constexpr double kMost = 1e12;
    const double from = axis.number("from", -kMost, kMost);
    const double to = axis.number("to", -kMost, kMost);
    const double step = axis.has("step") ? axis.number("step", -kMost, kMost) : 1;
    if (!axis.ok()) return {};
    // A last value that rounding has put a hair beyond the end counts.
    const double count = step == 0 ? -1 : std::floor((to - from) / step + 1e-9);
    if (count < 0 || count >= static_cast<double>(kMaxParts)) {
        axis.complain("step", fmt::format("does not lead from {} to {}", from, to),
                      fmt::format("expected at most {} values", kMaxParts));
        return {};
    }
    // As people write them: 0.3, not the 0.30000000000000004 of a sum. 13 digits of the largest number are
    // kept, at least 3 of them the step's. Sums of whole numbers are exact.
    const double largest = std::max({std::abs(from), std::abs(to), std::abs(step)});
    const bool isWhole = from == std::floor(from) && step == std::floor(step);
    if (!isWhole && std::abs(step) < largest * 1e-10) {
        axis.complain("step", fmt::format("is {}, too small beside {}", step, largest),
                      fmt::format("expected at least {}", largest * 1e-10));
        return {};
    }
    const int decimals =
        isWhole ? 0 : std::clamp(13 - static_cast<int>(std::ceil(std::log10(largest))), 0, 300);
    std::vector<json> values;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(count); ++i) {
        const std::string text = fmt::format("{:.{}f}", from + step * static_cast<double>(i), decimals);
        double value = 0;
        std::from_chars(text.data(), text.data() + text.size(), value);
        // Whole numbers stay so: options that count take no "5.0".
        if (value == std::floor(value))
            values.emplace_back(static_cast<std::int64_t>(value));
        else
            values.emplace_back(value);
    }
    return values;
}

std::vector<json> listed(JsonReader& axis, const json& list) {
    if (!list.is_array() || list.empty()) {
        axis.complain("values", list.is_array() ? "is empty" : "is no list", "expected a list of values");
        return {};
    }
    for (const json& value : list) {
        const bool isObject = value.is_object() && !value.empty() && std::ranges::all_of(value, isPlain);
        if (!isPlain(value) && !isObject) {
            axis.complain("values", "has " + value.dump().substr(0, 60),
                          "expected texts, numbers, or objects of these");
            return {};
        }
    }
    return list.get<std::vector<json>>();
}

std::vector<Axis> readAxes(JsonReader& reader, const json& all) {
    std::vector<Axis> axes;
    std::set<std::string> names{"out", "part"};
    std::vector<JsonReader> rows = reader.objects("over");
    for (std::size_t i = 0; i < rows.size() && reader.ok(); ++i) {
        Axis axis{rows[i].string("name"), {}};
        if (!reader.ok()) break;
        if (axis.name.empty() || !names.insert(axis.name).second)
            rows[i].complain("name", fmt::format("is '{}', which is empty or taken", axis.name),
                             "expected a name of its own, other than out and part");
        if (rows[i].has("values"))
            axis.values = listed(rows[i], all["over"][i]["values"]);
        else
            axis.values = steps(rows[i]);
        rows[i].finish();
        axes.push_back(std::move(axis));
    }
    return axes;
}

/// What stands in braces: an axis, a member of an axis' object, or the part; "{turn:04}" has leading zeros.
Result<std::string> filledIn(const std::string& text, const SweepPart& part) {
    std::string filled;
    std::size_t at = 0;
    while (at < text.size()) {
        const auto open = text.find('{', at), close = text.find('}', open);
        if (open == std::string::npos || close == std::string::npos) break;
        filled += text.substr(at, open - at);
        at = close + 1;
        std::string name = text.substr(open + 1, close - open - 1);
        std::size_t width = 0;
        if (const auto colon = name.find(":0"); colon != std::string::npos) {
            const char* const end = name.data() + name.size();
            const auto read = std::from_chars(name.data() + colon + 2, end, width);
            if (read.ptr != end || width > 20)
                return fail("the width in {" + name + "} is no number up to 20", "expected one as {turn:04}");
            name.resize(colon);
        }
        if (name == "out") {
            filled += kOut;
            continue;
        }
        const Report* value = nullptr;
        const Report number = part.number;
        const auto dot = name.find('.');
        if (name == "part") {
            value = &number;
            width = std::max<std::size_t>(width, 4);
        } else if (part.values.contains(name)) {
            value = &part.values[name];
        } else if (dot != std::string::npos && part.values.contains(name.substr(0, dot))) {
            const Report& object = part.values[name.substr(0, dot)];
            if (object.is_object() && object.contains(name.substr(dot + 1)))
                value = &object[name.substr(dot + 1)];
        }
        if (value == nullptr || value->is_object())
            return fail(fmt::format("nothing is named {{{}}}", name),
                        "expected out, part, the name of an axis, or AXIS.MEMBER");
        std::string shown = textOf(*value);
        // A sign stays before the zeros.
        const std::size_t digits = value->is_number() && shown.starts_with('-') ? 1 : 0;
        if (shown.size() < width) shown.insert(digits, width - shown.size(), '0');
        filled += shown;
    }
    return filled + text.substr(at);
}

Result<json> filledIn(const json& value, const SweepPart& part) {
    if (value.is_string()) {
        auto text = filledIn(value.get<std::string>(), part);
        if (!text) return tl::unexpected(text.error());
        return json(*text);
    }
    if (!value.is_array()) return value;
    json items = json::array();
    for (const json& item : value) {
        auto filled = filledIn(item, part);
        if (!filled) return filled;
        items.push_back(std::move(*filled));
    }
    return items;
}

/// The words of one option, as the Python module writes them.
Result<std::vector<std::string>> wordsOf(const Report& option, const json& value, const SweepPart& part) {
    const auto name = option["name"].get<std::string>();
    const auto filled = filledIn(value, part);
    if (!filled) return tl::unexpected(filled.error());
    if (option["type"] == "FLAG") {
        const std::string shown = textOf(*filled);
        if (shown != "true" && shown != "false")
            return fail(fmt::format("/arguments/{} is {}", name, filled->dump()), "expected true or false");
        if (shown == "false") return std::vector<std::string>();
        return std::vector<std::string>{option["argument"].get<std::string>()};
    }
    const bool several = option["many"].get<bool>() && filled->is_array();
    std::vector<std::string> words;
    for (const json& item : several ? *filled : json::array({*filled})) {
        std::string word = textOf(item);
        if (!option["argument"].is_null()) word = option["argument"].get<std::string>() + "=" + word;
        words.push_back(std::move(word));
    }
    return words;
}

/// What the parser says of a command line of the job.
Status checkWords(const Job& job, const std::vector<std::string>& words) {
    CLI::App app("hairloom-cli");
    app.require_subcommand(1);
    app.allow_windows_style_options(false);
    app.fallthrough();
    GlobalOptions options;
    addGlobalOptions(app, options);
    CLI::App& command = *app.add_subcommand(job.name, job.does);
    const JobRun run = declareJob(job, command);
    refuseNumbersThatAreNone(command);
    std::vector<std::string> backwards(words.rbegin(), words.rend());
    backwards.push_back(job.name);
    try {
        app.parse(backwards);
        refuseEmptyItems(app, words);
    } catch (const CLI::ParseError& error) {
        return tl::unexpected(usageError(app, error));
    } catch (const WrongUsage& error) {
        return tl::unexpected(error.error());
    }
    return {};
}

Status addWords(const Report& options, const json& arguments, SweepPart& part) {
    std::vector<std::string> placed;
    for (const Report& option : options) {
        const auto value = arguments.find(option["name"].get<std::string>());
        if (value == arguments.end()) continue;
        auto words = wordsOf(option, *value, part);
        if (!words) return tl::unexpected(words.error());
        std::vector<std::string>& target = option["argument"].is_null() ? placed : part.words;
        target.insert(target.end(), words->begin(), words->end());
    }
    if (!placed.empty()) part.words.emplace_back("--");
    part.words.insert(part.words.end(), placed.begin(), placed.end());
    return {};
}

std::string optionNames(const Report& options) {
    std::string names;
    for (const Report& option : options)
        names += (names.empty() ? "" : ", ") + option["name"].get<std::string>();
    return names;
}

/// The values of part `number`: the last axis turns fastest.
Report valuesOf(const std::vector<Axis>& axes, std::size_t number) {
    std::vector<std::size_t> at(axes.size());
    for (std::size_t i = axes.size(); i-- > 0;) {
        at[i] = number % axes[i].values.size();
        number /= axes[i].values.size();
    }
    Report values = Report::object();
    for (std::size_t i = 0; i < axes.size(); ++i) values[axes[i].name] = axes[i].values[at[i]];
    return values;
}

Status addParts(const std::vector<Axis>& axes, const json& arguments, std::optional<std::size_t> only,
                Sweep& sweep) {
    const auto job = std::ranges::find(jobs(), sweep.job, &Job::name);
    const Report described = describedJobs();
    const auto options =
        std::ranges::find_if(described["jobs"], [&](const Report& row) { return row["name"] == sweep.job; });
    for (const auto& [name, value] : arguments.items()) {
        const bool known = std::ranges::any_of((*options)["options"],
                                               [&](const Report& option) { return option["name"] == name; });
        if (!known)
            return failIn(sweep.file, {}, fmt::format("/arguments/{} is no option of {}", name, sweep.job),
                          "expected one of " + optionNames((*options)["options"]));
        const bool fits = isPlain(value) || (value.is_array() && std::ranges::all_of(value, isPlain));
        if (!fits)
            return failIn(sweep.file, {},
                          fmt::format("/arguments/{} is {}", name, value.dump().substr(0, 60)),
                          "expected a text, a number, true, false, or a list");
    }
    std::size_t count = 1;
    for (const Axis& axis : axes) {
        count *= axis.values.size();
        if (count > kMaxParts)
            return failIn(sweep.file, {}, "/over has too many combinations",
                          fmt::format("expected at most {} parts", kMaxParts));
    }
    for (std::size_t number = 0; number < count; ++number) {
        SweepPart part{number, fmt::format("{:04}", number), valuesOf(axes, number), {}};
        auto status = addWords((*options)["options"], arguments, part);
        if (status && only.value_or(number) == number) status = checkWords(*job, part.words);
        if (!status)
            return failIn(sweep.file, {}, fmt::format("{}: {}", inWords(part), status.error().problem),
                          status.error().expected);
        sweep.parts.push_back(std::move(part));
    }
    return {};
}

}  // namespace

Result<Sweep> readSweep(const std::string& file, std::optional<std::size_t> only) {
    const auto text = readTextFile(file, kMaxJsonBytes);
    if (!text) return tl::unexpected(text.error());
    const auto all = parseJson(file, *text);
    if (!all) return tl::unexpected(all.error());
    JsonReader reader(*all, file);
    Sweep sweep;
    sweep.file = file;
    const std::filesystem::path path = std::filesystem::absolute(file);
    sweep.folder = path.parent_path();
    sweep.name = path.stem().string();
    static_cast<void>(reader.count("hairloom_sweep", 1, 1));
    sweep.job = reader.string("job");
    std::string names;
    for (const Job& job : jobs())
        if (job.name != "sweep") names += (names.empty() ? "" : ", ") + job.name;
    const bool known =
        sweep.job != "sweep" && std::ranges::find(jobs(), sweep.job, &Job::name) != jobs().end();
    if (reader.ok() && !known)
        reader.complain("job", fmt::format("is '{}'", sweep.job), "expected one of " + names);
    static_cast<void>(reader.object("arguments"));
    if (reader.has("gather")) sweep.gather = reader.boolean("gather");
    const std::vector<Axis> axes = readAxes(reader, *all);
    reader.finish();
    if (auto status = reader.status(); !status) return tl::unexpected(status.error());
    if (auto status = addParts(axes, (*all)["arguments"], only, sweep); !status)
        return tl::unexpected(status.error());
    return sweep;
}

Result<std::vector<std::size_t>> partNumbers(const std::string& list, std::size_t parts) {
    std::set<std::size_t> numbers;
    const char* at = list.data();
    const char* const end = at + list.size();
    const auto number = [&](std::size_t& value) {
        const auto read = std::from_chars(at, end, value);
        at = read.ptr;
        return read.ec == std::errc();
    };
    const auto skip = [&](char mark) { return at != end && *at == mark && (++at, true); };
    while (true) {
        std::size_t first = 0, step = 1;
        if (!number(first)) break;
        std::size_t last = first;
        if (skip('-') && !number(last)) break;
        if (skip(':') && (!number(step) || step == 0 || step > kMaxParts)) break;
        if (last < first) break;
        if (last >= parts)
            return fail(fmt::format("there is no part {}", last),
                        fmt::format("expected parts from 0 to {}", parts - 1));
        for (std::size_t i = first; i <= last; i += step) numbers.insert(i);
        if (at == end) return std::vector<std::size_t>(numbers.begin(), numbers.end());
        if (!skip(',')) break;
    }
    return fail(fmt::format("'{}' lists no parts", list), "expected numbers like 7, 3-5, 1-9:2 or 1-3,7");
}

std::vector<std::string> wordsIn(const std::filesystem::path& folder, const SweepPart& part) {
    const std::string path = folder.generic_string();
    std::vector<std::string> words = part.words;
    for (std::string& word : words)
        for (auto at = word.find(kOut); at != std::string::npos; at = word.find(kOut, at + path.size()))
            word.replace(at, kOut.size(), path);
    return words;
}

std::string inWords(const SweepPart& part) {
    std::string values;
    for (const auto& [name, value] : part.values.items())
        values += fmt::format("{}{} {}", values.empty() ? "" : ", ", name, textOf(value));
    return values.empty() ? "part " + part.name : fmt::format("part {} ({})", part.name, values);
}

}  // namespace hairloom::cli
