// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/finite_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "cli/error_report.h"

namespace hairloom::cli {
namespace {

/// Reads the whole text as one decimal number; hexadecimal, blanks and words are none.
bool isFinite(const std::string& text) {
    const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
    double value = 0;
    const auto [end, code] = std::from_chars(begin, text.data() + text.size(), value);
    return code == std::errc() && end == text.data() + text.size() &&
           std::isfinite(static_cast<float>(value));
}

bool hasEmptyItem(std::string_view list, char delimiter) {
    return list.starts_with(delimiter) || list.ends_with(delimiter) ||
           list.find(std::string(2, delimiter)) != std::string_view::npos;
}

void refuseEmptyItems(const CLI::Option& option, const std::vector<std::string>& words) {
    for (const std::string& name : option.get_lnames()) {
        const std::string flag = "--" + name;
        for (std::size_t i = 0; i < words.size(); ++i) {
            std::string_view list;
            if (words[i] == flag && i + 1 < words.size()) list = words[i + 1];
            if (words[i].starts_with(flag + '=')) list = std::string_view(words[i]).substr(flag.size() + 1);
            if (hasEmptyItem(list, option.get_delimiter()))
                throw WrongUsage(fmt::format("{} is '{}'", flag, list),
                                 "expected a value between all commas");
        }
    }
}

}  // namespace

void refuseEmptyItems(const CLI::App& app, const std::vector<std::string>& words) {
    for (const CLI::App* job : app.get_subcommands()) {
        for (const CLI::Option* option : job->get_options()) {
            if (option->get_delimiter() != '\0') refuseEmptyItems(*option, words);
            if (!option->get_lnames().empty() &&
                std::ranges::find(option->results(), "") != option->results().end())
                throw WrongUsage(fmt::format("{} has no value", option->get_name()), "expected one");
        }
    }
}

void refuseNumbersThatAreNone(CLI::App& job) {
    const CLI::Validator finite(
        [](std::string& text) {
            return isFinite(text) ? std::string() : fmt::format("'{}' is not a finite number", text);
        },
        "");
    // Groups of options that exclude each other are jobs of their own to CLI11.
    for (CLI::App* group : job.get_subcommands([](const CLI::App* app) { return app->get_name().empty(); }))
        refuseNumbersThatAreNone(*group);
    for (CLI::Option* option : job.get_options()) {
        const std::string type = option->get_type_name();
        const bool number = type.starts_with("FLOAT") || type.starts_with("INT") || type.starts_with("UINT");
        // In front of the checks of ranges, which take what is no number for 0.
        if (number) option->check(finite);
    }
}

}  // namespace hairloom::cli
