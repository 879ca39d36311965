// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "core/cards/levels.h"

namespace hairloom::cards {
namespace {

constexpr const char* kGrammar =
    "KIND[:AMOUNT][@PX] of strands (share 0.001 to 1), cards (1 to 4096) and shell (64 to 20000 triangles), "
    "with 16, 32, 64, 128, 256 or 512 pixels of head height";
constexpr double kShellTriangles = 800;

bool readNumber(std::string_view text, double& value) {
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    return result.ec == std::errc() && result.ptr == text.data() + text.size();
}

struct Limits {
    double low, high, standard;
};
Limits limitsOf(LevelKind kind) {
    switch (kind) {
        case LevelKind::strands:
            return {0.001, 1, 1};
        case LevelKind::cards:
            return {1, 4096, 200};
        case LevelKind::shell:
            break;
    }
    return {64, 20000, kShellTriangles};
}

Result<LevelSpec> parseLevel(std::string_view text, std::uint32_t standardPx) {
    const auto refuse = [&](std::string_view why) {
        return fail(fmt::format("level '{}': {}", text, why), kGrammar);
    };
    LevelSpec spec;
    spec.headPx = standardPx;
    std::string_view rest = text;
    if (const auto at = rest.find('@'); at != std::string_view::npos) {
        double px = 0;
        if (!readNumber(rest.substr(at + 1), px)) return refuse("pixels that are not a number");
        spec.headPx = px >= 16 && px <= 512 ? static_cast<std::uint32_t>(px) : 0;
        rest = rest.substr(0, at);
        if (static_cast<double>(spec.headPx) != px) return refuse("pixels out of range");
    }
    const bool isPowerOfTwo = (spec.headPx & (spec.headPx - 1)) == 0;
    if (spec.headPx < 16 || spec.headPx > 512 || !isPowerOfTwo) return refuse("pixels out of range");
    const auto colon = rest.find(':');
    const std::string_view kind = rest.substr(0, colon);
    bool known = false;
    for (const LevelKind one : {LevelKind::strands, LevelKind::cards, LevelKind::shell}) {
        if (kind == nameOf(one)) spec.kind = one, known = true;
    }
    if (!known) return refuse("an unknown kind");
    const Limits limits = limitsOf(spec.kind);
    spec.amount = limits.standard;
    if (colon != std::string_view::npos && !readNumber(rest.substr(colon + 1), spec.amount))
        return refuse("an amount that is not a number");
    if (!(spec.amount >= limits.low) || !(spec.amount <= limits.high))
        return refuse("an amount out of range");
    if (spec.kind != LevelKind::strands && spec.amount != std::floor(spec.amount))
        return refuse("an amount that is not a whole number");
    return spec;
}

}  // namespace

std::string_view nameOf(LevelKind kind) {
    switch (kind) {
        case LevelKind::strands:
            return "strands";
        case LevelKind::cards:
            return "cards";
        case LevelKind::shell:
            break;
    }
    return "shell";
}

Result<std::vector<LevelSpec>> parseLevels(std::string_view text) {
    constexpr std::size_t kMostLevels = 16;
    std::vector<LevelSpec> specs;
    for (;;) {
        const auto comma = text.find(',');
        const auto spec = parseLevel(text.substr(0, comma), specs.empty() ? 512 : specs.back().headPx / 2);
        if (!spec) return tl::unexpected(spec.error());
        if (!specs.empty() && spec->headPx > specs.back().headPx)
            return fail(fmt::format("level '{}' is nearer than the one before it", text.substr(0, comma)),
                        kGrammar);
        specs.push_back(*spec);
        if (specs.size() > kMostLevels) return fail("more than 16 levels", kGrammar);
        if (comma == std::string_view::npos) return specs;
        text = text.substr(comma + 1);
    }
}

std::string standardLevels(std::uint32_t cards, std::uint32_t headPx) {
    return "strands:1@512,strands:0.4@512," + standardCardLevels(cards, headPx);
}

std::string standardCardLevels(std::uint32_t cards, std::uint32_t headPx) {
    const auto share = [](std::uint32_t whole, std::uint32_t part, std::uint32_t least) {
        return std::max(least, whole / part);
    };
    return fmt::format("cards:{}@{},cards:{}@{},cards:{}@{},shell@{}", cards, headPx, share(cards, 2, 1),
                       share(headPx, 2, 16), share(cards, 4, 1), share(headPx, 4, 16), share(headPx, 8, 16));
}

double distanceOf(std::uint32_t headPx) {
    constexpr double kLines = 1080, kFieldOfView = 40 * 3.14159265358979323846 / 180;
    const double focalPx = kLines / 2 / std::tan(kFieldOfView / 2);
    return static_cast<double>(kHeadHeight) * focalPx / static_cast<double>(headPx);
}

}  // namespace hairloom::cards
