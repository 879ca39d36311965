// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/file/card_edits_json.h"

#include <fmt/format.h>

#include <cmath>

namespace hairloom {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kFarthest = 1e3;           // metres
constexpr std::size_t kStationNumbers = 9;  // centre, across, half width, bend, spread
constexpr float kOffUnit = 0.001f;
constexpr double kSharpest = 1e4, kWidest = 1, kLeastHalf = 1e-6;

void push(Json& list, const Vec3f& v) {
    for (int i = 0; i < 3; ++i) list.push_back(readableDecimal(v[i]));
}

Vec3f vectorAt(const std::vector<double>& numbers, std::size_t first) {
    return Vec3d(numbers[first], numbers[first + 1], numbers[first + 2]).cast<float>();
}

std::vector<Vec3f> readRoots(JsonReader& reader) {
    const auto numbers = reader.numbers("roots", -kFarthest, kFarthest, 3 * kMaxCardRoots, "m");
    if (numbers.empty() || numbers.size() % 3 != 0) {
        reader.complain("roots", fmt::format("has {} numbers", numbers.size()),
                        "expected three for each root, at least one root");
        return {};
    }
    std::vector<Vec3f> roots;
    for (std::size_t i = 0; i < numbers.size(); i += 3) roots.push_back(vectorAt(numbers, i));
    return roots;
}

std::vector<CardStation> readStrip(JsonReader& reader) {
    constexpr std::size_t kNumbers = kStationNumbers * kCardStations;
    const auto numbers = reader.numbers("strip", -kSharpest, kSharpest, kNumbers);
    std::vector<CardStation> strip;
    for (std::size_t i = 0; numbers.size() == kNumbers && i < kNumbers; i += kStationNumbers) {
        const CardStation station{vectorAt(numbers, i), vectorAt(numbers, i + 3),
                                  static_cast<float>(numbers[i + 6]), static_cast<float>(numbers[i + 7]),
                                  static_cast<float>(numbers[i + 8])};
        const bool isSound = numbers[i + 6] >= kLeastHalf && numbers[i + 6] <= kWidest &&
                             numbers[i + 8] >= 0 && numbers[i + 8] <= kWidest &&
                             station.centre.norm() <= kFarthest &&
                             std::abs(station.across.norm() - 1) < kOffUnit;
        if (!isSound) break;
        strip.push_back(station);
    }
    if (strip.size() != kCardStations) {
        reader.complain(
            "strip", fmt::format("has {} numbers, or one out of range", numbers.size()),
            fmt::format("expected {} stations of centre, direction across, half width, bend and spread",
                        kCardStations));
        return {};
    }
    return strip;
}

CardEdit readCardEdit(JsonReader& reader) {
    CardEdit edit;
    edit.level = static_cast<std::uint32_t>(reader.count("level", 1, 4096));
    edit.roots = readRoots(reader);
    if (reader.has("width"))
        edit.width = static_cast<float>(reader.number("width", static_cast<double>(kLeastCardWidth),
                                                      static_cast<double>(kMostCardWidth)));
    if (reader.has("bend")) edit.bend = static_cast<float>(reader.number("bend", -1, 1));
    if (reader.has("deleted")) edit.deleted = reader.boolean("deleted");
    if (reader.has("strip")) edit.strip = readStrip(reader);
    reader.finish();
    return edit;
}

}  // namespace

Json toJson(const CardEdit& edit) {
    Json roots = Json::array();
    for (const Vec3f& root : edit.roots) push(roots, root);
    Json json{{"level", edit.level},
              {"width", readableDecimal(edit.width)},
              {"bend", readableDecimal(edit.bend)},
              {"deleted", edit.deleted},
              {"roots", std::move(roots)}};
    if (edit.strip.empty()) return json;
    Json strip = Json::array();
    for (const CardStation& station : edit.strip) {
        push(strip, station.centre);
        push(strip, station.across);
        for (const float value : {station.halfWidth, station.bend, station.spread})
            strip.push_back(readableDecimal(value));
    }
    json["strip"] = std::move(strip);
    return json;
}

Json toJson(const std::vector<CardEdit>& edits) {
    Json list = Json::array();
    for (const CardEdit& edit : edits) list.push_back(toJson(edit));
    return list;
}

std::vector<CardEdit> readCardEdits(JsonReader& reader) {
    std::vector<CardEdit> edits;
    std::size_t roots = 0;
    for (JsonReader& entry : reader.objects("card_edits")) {
        if (edits.size() == kMaxCardEdits || roots > kMaxCardRoots) {
            reader.complain("card_edits", "has too many entries or roots",
                            fmt::format("expected at most {} with {} roots", kMaxCardEdits, kMaxCardRoots));
            break;
        }
        edits.push_back(readCardEdit(entry));
        roots += edits.back().roots.size();
    }
    return edits;
}

}  // namespace hairloom
