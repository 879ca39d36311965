// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/versions.h"

#include <fmt/format.h>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>

#include "core/base/write_rules.h"

namespace hairloom::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostDigits = 9;

struct OutputName {
    const char* option;
    const char* job;  ///< null: of all
};
constexpr std::array kOutputNames{OutputName{"--output", nullptr},     OutputName{"--exr", "render"},
                                  OutputName{"--animation", "render"}, OutputName{"--strip", "render"},
                                  OutputName{"--record", "simulate"},  OutputName{"--record", "import"},
                                  OutputName{"--keep", "stack"},       OutputName{"--markdown", "bench"},
                                  OutputName{"--man", "reference"},    OutputName{"--readme", "reference"},
                                  OutputName{"--jobs", "reference"},   OutputName{"--openjd", "sweep"}};

/// Where the digits begin, and how many are asked for.
struct Token {
    std::size_t digits, count;
};

bool isWordCharacter(char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

std::optional<Token> tokenIn(std::string_view name) {
    for (std::size_t at = name.find("v#"); at != std::string_view::npos; at = name.find("v#", at + 1)) {
        if (at > 0 && isWordCharacter(name[at - 1])) continue;
        const std::size_t end = std::min(name.find_first_not_of('#', at + 1), name.size());
        const std::size_t count = end - at - 1;
        if (count <= kMostDigits) return Token{at + 1, count};
    }
    return std::nullopt;
}

/// The version in a name that begins like this; 0 where there is none.
unsigned versionIn(std::string_view name, std::string_view beginning) {
    if (!name.starts_with(beginning)) return 0;
    const char* const first = name.data() + beginning.size();
    unsigned version = 0;
    const auto [end, code] = std::from_chars(first, name.data() + name.size(), version);
    const bool isNumber = code == std::errc() && static_cast<std::size_t>(end - first) <= kMostDigits;
    return isNumber ? version : 0;
}

/// Up to and with the version, without what is behind: names that begin so are of this version.
fs::path beginningOf(const fs::path& path, unsigned version) {
    fs::path beginning;
    for (const fs::path& part : path) {
        const std::string name = part.string();
        const auto token = tokenIn(name);
        if (token)
            return beginning / fmt::format("{}{:0{}}", name.substr(0, token->digits), version, token->count);
        beginning /= part;
    }
    return beginning;
}

/// By the path with its token.
std::map<std::string, unsigned>& taken() {
    static std::map<std::string, unsigned> instance;
    return instance;
}

}  // namespace

std::vector<CLI::Option*> outputOptions(CLI::App& job) {
    std::vector<CLI::Option*> options;
    for (const OutputName& name : kOutputNames) {
        if (name.job != nullptr && name.job != job.get_name()) continue;
        if (CLI::Option* const option = job.get_option_no_throw(name.option)) options.push_back(option);
    }
    return options;
}

bool hasVersionToken(const fs::path& path) {
    return std::ranges::any_of(path, [](const fs::path& part) { return tokenIn(part.string()).has_value(); });
}

unsigned nextVersion(const fs::path& path) {
    fs::path folder;
    for (const fs::path& part : path) {
        const std::string name = part.string();
        const auto token = tokenIn(name);
        if (!token) {
            folder /= part;
            continue;
        }
        unsigned last = 0;
        std::error_code code;
        for (fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, code), end;
             !code && entry != end; entry.increment(code))
            last = std::max(last, versionIn(entry->path().filename().string(),
                                            std::string_view(name).substr(0, token->digits)));
        return last + 1;
    }
    return 1;
}

fs::path withVersion(const fs::path& path, unsigned version) {
    fs::path versioned;
    for (const fs::path& part : path) {
        std::string name = part.string();
        while (const auto token = tokenIn(name))
            name.replace(token->digits, token->count, fmt::format("{:0{}}", version, token->count));
        versioned /= name;
    }
    return versioned;
}

void takeVersions(CLI::App& job) {
    for (CLI::Option* const option : outputOptions(job)) {
        const auto take = [&job](std::string& value) {
            if (!hasVersionToken(value)) return std::string();
            // The first output looks at all of them, whose names are as they were typed then.
            unsigned version = taken().empty() ? 0 : taken().begin()->second;
            if (version == 0)
                for (const CLI::Option* const other : outputOptions(job))
                    for (const std::string& path : other->results())
                        if (hasVersionToken(path)) version = std::max(version, nextVersion(path));
            taken()[value] = version;
            value = withVersion(value, version).string();
            return std::string();
        };
        option->transform(CLI::Validator(take, "", ""));
    }
}

bool isVersioned(const std::string& output) {
    return std::ranges::any_of(
        taken(), [&](const auto& one) { return withVersion(one.first, one.second).string() == output; });
}

std::vector<std::string> keepVersions() {
    std::vector<std::string> outputs;
    for (const auto& [path, version] : taken()) {
        outputs.push_back(withVersion(path, version).string());
        keepNew(beginningOf(path, version));
    }
    return outputs;
}

}  // namespace hairloom::cli
