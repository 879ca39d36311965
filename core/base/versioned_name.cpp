// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/versioned_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <system_error>

namespace hairloom {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostDigits = 9;

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

}  // namespace

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

fs::path versionBeginning(const fs::path& path, unsigned version) {
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

fs::path withVersionToken(const fs::path& path) {
    static const std::regex kVersion("(^|[^A-Za-z0-9])v([0-9]{1,9})(?![A-Za-z0-9])");
    std::string stem = path.stem().string();
    std::size_t at = stem.size(), count = 0;
    for (std::sregex_iterator match(stem.begin(), stem.end(), kVersion), end; match != end; ++match) {
        at = static_cast<std::size_t>(match->position(2));
        count = static_cast<std::size_t>(match->length(2));
    }
    if (count > 0)
        stem.replace(at, count, std::string(count, '#'));
    else
        stem += "_v###";
    return path.parent_path() / (stem + path.extension().string());
}

}  // namespace hairloom
