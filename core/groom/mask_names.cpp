// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/mask_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace hairloom {
namespace {

/// "Fringe" and "fringe" are one name to people who type it.
std::string inSmallLetters(std::string_view name) {
    std::string small(name);
    for (char& letter : small) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    return small;
}

std::string_view withoutSpaces(std::string_view name) {
    constexpr std::string_view kSpaces = " \t\r\n";
    const std::size_t first = name.find_first_not_of(kSpaces);
    if (first == std::string_view::npos) return {};
    return name.substr(first, name.find_last_not_of(kSpaces) - first + 1);
}

std::string numbered(std::uint32_t number) {
    return fmt::format("Mask {}", number);
}

/// What it means without names; 0: nothing.
std::uint32_t numberIn(std::string_view small) {
    for (std::uint32_t number = 1; number <= kPaintedMasks; ++number) {
        if (small == std::to_string(number) || small == inSmallLetters(numbered(number))) return number;
    }
    return 0;
}

Status checkName(std::uint32_t number, const std::string& name) {
    const std::string expected = "a name of letters, such as Fringe";
    if (name.size() > kLongestMaskName)
        return fail(fmt::format("the name of mask {} is {} bytes long", number, name.size()),
                    fmt::format("at most {}", kLongestMaskName));
    if (std::ranges::any_of(name, [](unsigned char letter) { return letter < 0x20 || letter == 0x7f; }))
        return fail(fmt::format("the name of mask {} has control characters", number), expected);
    if (!name.empty() && std::ranges::all_of(name, [](unsigned char letter) { return std::isdigit(letter); }))
        return fail(fmt::format("mask {} is called '{}', as a number", number, name), expected);
    const std::uint32_t meant = numberIn(inSmallLetters(name));
    if (meant != 0 && meant != number)
        return fail(fmt::format("mask {} is called '{}', as mask {} is", number, name, meant), expected);
    return {};
}

}  // namespace

std::string maskName(const Groom& groom, std::uint32_t number) {
    if (number == 0 || number > groom.maskNames.size() || groom.maskNames[number - 1].empty())
        return numbered(number);
    return groom.maskNames[number - 1];
}

Result<std::uint32_t> findMask(const Groom& groom, std::string_view name) {
    const std::string wanted = inSmallLetters(withoutSpaces(name));
    std::string known;
    for (std::uint32_t number = 1; number <= kPaintedMasks; ++number) {
        if (inSmallLetters(maskName(groom, number)) == wanted) return number;
        known += fmt::format("{}{}", known.empty() ? "" : ", ", maskName(groom, number));
    }
    if (const std::uint32_t number = numberIn(wanted); number > 0) return number;
    return fail(fmt::format("no mask is called '{}'", name), fmt::format("one of: {}", known));
}

Status checkMaskNames(const std::vector<std::string>& names) {
    if (names.size() > kPaintedMasks)
        return fail(fmt::format("{} masks have names", names.size()),
                    fmt::format("at most {}", kPaintedMasks));
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (auto status = checkName(static_cast<std::uint32_t>(i + 1), names[i]); !status) return status;
        if (names[i].empty()) continue;
        for (std::size_t other = 0; other < i; ++other) {
            if (inSmallLetters(names[other]) == inSmallLetters(names[i]))
                return fail(fmt::format("masks {} and {} are both called '{}'", other + 1, i + 1, names[i]),
                            "another name for one of them");
        }
    }
    return {};
}

Result<std::vector<std::string>> maskNamesWith(const std::vector<std::string>& names, std::uint32_t number,
                                               std::string_view name) {
    if (number == 0 || number > kPaintedMasks)
        return fail(fmt::format("there is no mask {}", number), fmt::format("1 to {}", kPaintedMasks));
    std::vector<std::string> changed = names;
    if (changed.size() < number) changed.resize(number);
    changed[number - 1] = withoutSpaces(name);
    // Its own number is no name.
    if (numberIn(inSmallLetters(changed[number - 1])) == number) changed[number - 1].clear();
    while (!changed.empty() && changed.back().empty()) changed.pop_back();
    if (auto status = checkMaskNames(changed); !status) return tl::unexpected(status.error());
    return changed;
}

nlohmann::ordered_json maskNamesToJson(const std::vector<std::string>& names) {
    auto json = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (!names[i].empty()) json[std::to_string(i + 1)] = names[i];
    }
    return json;
}

void readMaskNames(JsonReader reader, std::vector<std::string>& names) {
    for (const std::string& key : reader.keys()) {
        const std::string name = reader.string(key);
        if (!reader.ok()) return;
        const bool isNumber =
            key.size() == 1 && key[0] >= '1' && key[0] < '1' + static_cast<int>(kPaintedMasks);
        if (!isNumber)
            return reader.complain(key, "is not a mask", fmt::format("expected 1 to {}", kPaintedMasks));
        auto changed = maskNamesWith(names, static_cast<std::uint32_t>(key[0] - '0'), name);
        if (!changed)
            return reader.complain(key, "cannot be its name: " + changed.error().problem,
                                   "expected " + changed.error().expected);
        names = std::move(*changed);
    }
    reader.finish();
}

}  // namespace hairloom
