// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/usage_error.h"

#include <fmt/format.h>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <numeric>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "cli/help_format.h"

namespace hairloom::cli {
namespace {

/// The job on the command line, or null before one was read.
const CLI::App* jobOf(const CLI::App& app) {
    const auto jobs = app.get_subcommands();
    return jobs.empty() ? nullptr : jobs.front();
}

std::string helpOf(const CLI::App* job) {
    return fmt::format("see hairloom-cli {}--help", job ? job->get_name() + ' ' : "");
}

std::size_t distanceOf(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

/// The name nearest to `word`, or empty where none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& names) {
    if (word.size() > 40) return {};
    std::string best;
    std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const std::string& name : names) {
        const std::size_t distance = distanceOf(word, name);
        if (distance >= least) continue;
        least = distance;
        best = name;
    }
    return best;
}

std::string orHelp(const std::string& guess, const CLI::App* job) {
    return guess.empty() ? helpOf(job) : fmt::format("did you mean {}?", guess);
}

std::vector<std::string> splitAtCommas(const std::string& list) {
    std::vector<std::string> parts;
    std::istringstream in(list);
    for (std::string part; std::getline(in, part, ',');) parts.push_back(part);
    return parts;
}

/// Options of the job and of all jobs; groups of options are apps without a name.
void addOptions(const CLI::App& app, std::vector<const CLI::Option*>& options) {
    for (const CLI::Option* option : app.get_options()) options.push_back(option);
    for (const CLI::App* group :
         app.get_subcommands([](const CLI::App* part) { return part->get_name().empty(); }))
        addOptions(*group, options);
}

std::vector<const CLI::Option*> optionsOf(const CLI::App& app) {
    std::vector<const CLI::Option*> options;
    if (const CLI::App* job = jobOf(app)) addOptions(*job, options);
    addOptions(app, options);
    return options;
}

const CLI::Option* findOption(const CLI::App& app, std::string_view name) {
    for (const CLI::Option* option : optionsOf(app))
        if (option->get_name() == name) return option;
    return nullptr;
}

/// What the option takes: "one of y, z", "1 to 100", "TEXT".
std::string wanted(const CLI::Option& option) {
    const OptionValues values = valuesOf(option);
    if (!values.choices.empty()) return "expected one of " + spaced(values.choices);
    if (const auto dash = values.range.find(" - "); dash != std::string::npos)
        return fmt::format("expected {} to {}", values.range.substr(0, dash), values.range.substr(dash + 3));
    if (values.type.starts_with("INT") || values.type.starts_with("UINT")) return "expected a whole number";
    if (values.type.starts_with("FLOAT") || values.type.starts_with("POSITIVE")) return "expected a number";
    const std::string meaning = option.get_description();
    return "expected a value: " + meaning.substr(0, meaning.find_first_of("\n"));
}

/// "--a, --b" of "Exactly 1 option from [--a,--b]"; empty where it is no such list.
std::string listIn(const std::string& words) {
    const auto begin = words.find('['), end = words.find(']');
    if (begin == std::string::npos || end == std::string::npos || end < begin) return {};
    return spaced(words.substr(begin + 1, end - begin - 1));
}

Error unknownWord(const CLI::App& app, const std::string& word) {
    const CLI::App* job = jobOf(app);
    std::vector<std::string> names;
    if (word.starts_with('-')) {
        for (const CLI::Option* option : optionsOf(app)) {
            for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
            for (const std::string& name : option->get_snames()) names.push_back("-" + name);
        }
        return {{},
                {},
                fmt::format("there is no option {}", word),
                orHelp(nearest(word.substr(0, word.find('=')), names), job)};
    }
    if (job) return {{}, {}, fmt::format("unexpected argument '{}'", word), helpOf(job)};
    for (const CLI::App* each : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(each->get_name());
    return {{}, {}, fmt::format("there is no job '{}'", word), orHelp(nearest(word, names), nullptr)};
}

/// "--name: words" of a check that the value did not pass.
Error wrongValue(const CLI::App& app, const std::string& name, const std::string& words) {
    const CLI::Option* option = findOption(app, name);
    if (!option) return {{}, {}, fmt::format("{}: {}", name, words), helpOf(jobOf(app))};
    std::string expected = wanted(*option), value;
    if (const auto end = words.find(" not in {"); end != std::string::npos) {
        value = words.substr(0, end);
        const std::string guess = nearest(value, splitAtCommas(valuesOf(*option).choices));
        if (!guess.empty()) expected += fmt::format(" (did you mean {}?)", guess);
    } else if (words.starts_with("Value ") && words.find(" not in range ") != std::string::npos) {
        value = words.substr(6, words.find(" not in range ") - 6);
    } else if (const auto finite = words.find(" is not a finite number"); finite != std::string::npos) {
        return {{}, {}, fmt::format("{} is {}", name, words.substr(0, finite)), expected};
    } else {
        return {{}, {}, fmt::format("{}: {}", name, words), expected};
    }
    return {{}, {}, fmt::format("{} is '{}'", name, value), expected};
}

}  // namespace

Error usageError(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::App* job = jobOf(app);
    const std::string kind = error.get_name();
    std::string words = error.what();
    std::ranges::replace(words, '\n', ' ');
    const auto after = [&](std::string_view mark) {
        const auto at = words.find(mark);
        return at == std::string::npos ? std::string() : words.substr(at + mark.size());
    };
    const auto before = [&](std::string_view mark) { return words.substr(0, words.find(mark)); };
    const bool isNamed = words.find(": ") != std::string::npos && findOption(app, before(": "));
    // An unknown word goes before what it may have left out: a misspelt option before a required one.
    auto unknown = app.remaining(true);
    std::erase(unknown, "--");
    const auto flag = std::ranges::find_if(unknown, [](const auto& word) { return word.starts_with('-'); });
    if (flag != unknown.end()) return unknownWord(app, *flag);
    if (!unknown.empty()) return unknownWord(app, unknown.front());
    if (kind == "RequiredError" && words.starts_with("A subcommand"))
        return {{}, {}, "a job is required", helpOf(nullptr)};
    if (kind == "RequiredError" && words.starts_with("Exactly 1 option from ")) {
        const bool none = words.ends_with("] is required");
        return {{},
                {},
                none ? "an option is missing" : "options exclude each other",
                "expected one of " + listIn(words)};
    }
    if (kind == "RequiredError" && words.find(" and ") != std::string::npos &&
        words.ends_with(" is required"))
        words.replace(words.size() - 11, 11, "are required");
    if (kind == "ValidationError" && isNamed) return wrongValue(app, before(": "), after(": "));
    if (kind == "ConversionError" && words.starts_with("Could not convert: ")) {
        const std::string name = after("convert: ").substr(0, after("convert: ").find(" = "));
        const CLI::Option* option = findOption(app, name);
        return {
            {}, {}, fmt::format("{} is '{}'", name, after(" = ")), option ? wanted(*option) : helpOf(job)};
    }
    if (kind == "ArgumentMismatch" && isNamed && words.ends_with(" missing")) {
        const CLI::Option* option = findOption(app, before(": "));
        return {{}, {}, before(": ") + " has no value", option ? wanted(*option) : helpOf(job)};
    }
    if (kind == "RequiresError") {
        if (const auto at = words.find(" requires "); at != std::string::npos)
            words.replace(at, 10, " needs ");
    }
    if (kind == "ExcludesError") {
        if (const auto at = words.find(" excludes "); at != std::string::npos)
            words = words.substr(0, at) + " and " + words.substr(at + 10) + " exclude each other";
    }
    return {{}, {}, words, helpOf(job)};
}

}  // namespace hairloom::cli
