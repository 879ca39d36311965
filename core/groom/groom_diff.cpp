// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/groom_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <span>
#include <utility>

#include "core/base/profiler.h"
#include "core/groom/file/fields.h"
#include "core/groom/file/json_diff.h"
#include "core/groom/file/json_reader.h"
#include "core/groom/file/json_words.h"
#include "core/groom/file/project_content.h"
#include "core/groom/file/project_sections.h"
#include "core/groom/strand_pairs.h"
#include "hairloom/body_field.h"

namespace hairloom {
namespace {

using Json = nlohmann::ordered_json;
using Array = ArchiveWriter::Array;
using Arrays = std::map<std::string, const Array*, std::less<>>;

constexpr double kMillimetres = 1e3;

/// 12345 is "12,345".
std::string counted(std::size_t number, std::string_view noun) {
    std::string text = std::to_string(number);
    for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, ",");
    return fmt::format("{} {}{}", text, noun, number == 1 ? "" : "s");
}
std::string share(std::size_t number, std::size_t of, std::string_view noun) {
    std::string text = counted(number, noun);
    return number == of ? "all " + text : text.substr(0, text.find(' ')) + " of " + counted(of, noun);
}

/// Elements that differ, one after another.
class Tally {
  public:
    Tally(const Array& before, const Array& after)
        : before_(before.bytes.data()),
          after_(after.bytes.data()),
          size_(before.count == 0 ? 0 : before.bytes.size() / before.count),
          isFloat_(before.type.starts_with("float")) {}

    /// So many elements from each of these.
    void add(std::size_t before, std::size_t after, std::size_t count) {
        of_ += count;
        if (count == 0) return;
        const std::byte *a = before_ + before * size_, *b = after_ + after * size_;
        if (std::memcmp(a, b, count * size_) == 0) return;
        for (std::size_t i = 0; i < count; ++i, a += size_, b += size_) {
            if (std::memcmp(a, b, size_) == 0) continue;
            ++changed_;
            for (std::size_t c = 0; isFloat_ && c < size_; c += sizeof(float)) {
                float old = 0, now = 0;
                std::memcpy(&old, a + c, sizeof old);
                std::memcpy(&now, b + c, sizeof now);
                const double distance = std::abs(static_cast<double>(now) - static_cast<double>(old));
                if (std::isfinite(distance)) largest_ = std::max(largest_, distance);
            }
        }
    }
    std::size_t changed() const { return changed_; }

    GroomDifference difference(std::string where, std::string_view noun, bool isLength) const {
        GroomDifference one{std::move(where), {}, {}, {}, changed_, of_, {}, isLength, {}};
        one.what = share(changed_, of_, noun) + " changed";
        if (!isFloat_) return one;
        one.largest = largest_ * (isLength ? kMillimetres : 1);
        if (largest_ > 0) one.what += fmt::format(", by up to {:.4g}{}", *one.largest, isLength ? " mm" : "");
        return one;
    }

  private:
    const std::byte *before_, *after_;
    std::size_t size_;
    bool isFloat_;
    std::size_t changed_ = 0, of_ = 0;
    double largest_ = 0;
};

/// Of "simulation.hairRadius" or "layers[Fringe].material.width"; empty where no description says one.
std::string unitOf(std::string_view where) {
    static const std::map<std::string_view, std::vector<FieldRow>> kSections{
        {"simulation", fieldRows<runtime::SimulationSettings>()},
        {"material", fieldRows<HairMaterial>()},
        {"shadows", fieldRows<ShadowSettings>()},
        {"interpolation", fieldRows<InterpolationSettings>()},
        {"placement", fieldRows<PlacementSettings>()}};
    const std::size_t dot = where.rfind('.');
    if (dot == std::string_view::npos) return {};
    const std::string_view owner = where.substr(0, dot), name = where.substr(dot + 1);
    for (const auto& [section, rows] : kSections) {
        if (owner != section && !owner.ends_with("." + std::string(section))) continue;
        const auto row = std::ranges::find(rows, name, [](const FieldRow& one) { return one.info.name; });
        return row == rows.end() ? std::string() : row->info.unit;
    }
    return {};
}

/// Indices into `before` become those of the same names in `after`, where all names of both are different.
void translate(Groom& groom, std::string_view attribute, const std::vector<std::string>& before,
               const std::vector<std::string>& after) {
    const auto indices = groom.strandAttributes.view<std::uint32_t>(attribute);
    const auto placesOf = [](const std::vector<std::string>& names) {
        std::map<std::string_view, std::uint32_t> places;
        for (std::uint32_t i = 0; i < names.size(); ++i) places.emplace(names[i], i);
        return places;
    };
    const auto old = placesOf(before), now = placesOf(after);
    if (before == after || indices.empty() || old.size() != before.size() || now.size() != after.size())
        return;
    std::vector<std::uint32_t> becomes(before.size());
    for (std::uint32_t i = 0; i < before.size(); ++i) {
        const auto found = now.find(before[i]);
        const bool isRenamed = found == now.end() && i < after.size() && !old.contains(after[i]);
        // One that is gone has no index there.
        becomes[i] = isRenamed ? i : found == now.end() ? ~0u : found->second;
    }
    std::vector<std::uint32_t> translated(indices.begin(), indices.end());
    for (std::uint32_t& index : translated)
        if (index < becomes.size()) index = becomes[index];
    groom.strandAttributes.set(attribute, std::move(translated));
}

/// The groom before, whose strands name layers and groups as those after do.
Groom inTermsOf(const Groom& before, const Groom& after) {
    const auto layersOf = [](const Groom& groom) {
        std::vector<std::string> names;
        for (const Layer& layer : groom.layers) names.push_back(layer.name);
        return names;
    };
    Groom groom = before;
    translate(groom, attribute::kLayer, layersOf(before), layersOf(after));
    translate(groom, attribute::kGroup, before.groupNames, after.groupNames);
    return groom;
}

class Comparison {
  public:
    Comparison(const GroomVersion& before, const GroomVersion& after, ComparedParts parts)
        : before_(before), after_(after), parts_(parts), strands_(pairStrands(before.groom, after.groom)) {}

    GroomComparison run() {
        ArchiveWriter before({}, 0), after({}, 0);
        const auto oldBody = bodyOf(before_.groom), newBody = bodyOf(after_.groom);
        const Groom translated = inTermsOf(before_.groom, after_.groom);
        addProjectArrays(before, translated, oldBody);
        addProjectArrays(after, after_.groom, newBody);
        compareStrands();
        compareArrays(before, after, true);
        if (parts_ == ComparedParts::all) {
            compareHeads();
            compareArrays(before, after, false);
        }
        return {std::move(all_), strands_.match};
    }

  private:
    static std::vector<std::uint8_t> bodyOf(const Groom& groom) {
        return groom.body ? groom.body->toBytes() : std::vector<std::uint8_t>();
    }
    void say(std::string where, std::string what, Json before = {}, Json after = {}, std::size_t count = 0,
             std::size_t of = 0) {
        all_.push_back({std::move(where),
                        std::move(what),
                        std::move(before),
                        std::move(after),
                        count,
                        of,
                        {},
                        false,
                        {}});
    }
    bool hasOneScalp() const { return (before_.groom.scalp == nullptr) != (after_.groom.scalp == nullptr); }

    void addCount(std::string what, std::size_t count) {
        say("strands", std::move(what), before_.groom.strandCount(), after_.groom.strandCount(), count,
            strands_.pairs.size());
    }
    void addMoved(std::string_view how, std::size_t moved, std::size_t of, double farthest) {
        if (moved == 0) return;
        GroomDifference one{"strands", share(moved, of, "strand"), {},   {}, moved,
                            of,        kMillimetres * farthest,    true, {}};
        one.what += fmt::format(" {}", how);
        // Of what is not a number there is no distance.
        if (farthest > 0) one.what += fmt::format(", by up to {:.4g} mm", *one.largest);
        all_.push_back(std::move(one));
    }

    void compareStrands() {
        const Groom &before = before_.groom, &after = after_.groom;
        if (strands_.removed > 0)
            addCount(counted(strands_.removed, "strand") + " removed", strands_.removed);
        if (strands_.added > 0) addCount(counted(strands_.added, "strand") + " added", strands_.added);
        std::size_t moved = 0, rooted = 0, resampled = 0;
        double farthest = 0, farthestRoot = 0;
        for (const auto& [old, now] : strands_.pairs) {
            const auto a = before.strand(old), b = after.strand(now);
            if (a.size() != b.size()) {
                ++resampled;
                continue;
            }
            if (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0) continue;
            ++moved;
            for (std::size_t p = 0; p < a.size(); ++p) {
                const double distance = (b[p] - a[p]).cast<double>().norm();
                if (std::isfinite(distance)) farthest = std::max(farthest, distance);
                if (p > 0 || a[0] == b[0]) continue;
                ++rooted;
                if (std::isfinite(distance)) farthestRoot = std::max(farthestRoot, distance);
            }
        }
        const std::size_t count = strands_.pairs.size();
        addMoved("moved", moved, count - resampled, farthest);
        addMoved("have a root elsewhere", rooted, count - resampled, farthestRoot);
        if (resampled > 0)
            say("strands", share(resampled, count, "strand") + " have another number of points",
                before.pointCount(), after.pointCount(), resampled, count);
        if (!strands_.inOrder()) say("strands", "are in another order", {}, {}, count, count);
    }

    /// Strands and points, or all else.
    void compareArrays(const ArchiveWriter& before, const ArchiveWriter& after, bool ofHair) {
        const auto wanted = [&](const ArchiveWriter& writer) {
            Arrays arrays;
            for (const Array& array : writer.arrays()) {
                const bool isHair = array.name.starts_with(section::kStrandPrefix) ||
                                    array.name.starts_with(section::kPointPrefix);
                if (isHair == ofHair && !isToldElsewhere(array.name)) arrays.emplace(array.name, &array);
            }
            return arrays;
        };
        const Arrays old = wanted(before), now = wanted(after);
        for (const auto& [name, array] : old) {
            const auto found = now.find(name);
            if (found == now.end())
                say(whereOf(name), "removed", {}, {}, array->count, 0);
            else
                compareArray(*array, *found->second);
        }
        for (const auto& [name, array] : now)
            if (!old.contains(name)) say(whereOf(name), "added", {}, {}, array->count, 0);
    }

    /// By strands, or by one word for all of them.
    bool isToldElsewhere(std::string_view name) const {
        if (name == section::kOffsets) return true;
        if (name.starts_with(section::kPointPrefix))
            return name.substr(section::kPointPrefix.size()) == attribute::kPosition;
        if (name.starts_with(section::kStrandPrefix))
            return strands_.match == StrandMatch::ids &&
                   name.substr(section::kStrandPrefix.size()) == attribute::kStrandId;
        return hasOneScalp() && name.starts_with("scalp/");
    }

    static std::string whereOf(std::string_view name) {
        if (name.starts_with(section::kStrandPrefix))
            return fmt::format("strands.{}", name.substr(section::kStrandPrefix.size()));
        if (name.starts_with(section::kPointPrefix))
            return fmt::format("points.{}", name.substr(section::kPointPrefix.size()));
        if (name == section::kBody) return "skin_collider";
        std::string where(name);
        std::ranges::replace(where, '/', '.');
        return where;
    }

    void compareArray(const Array& before, const Array& after) {
        const std::string where = whereOf(before.name);
        if (before.type != after.type) {
            say(where, "another type", before.type, after.type, before.count, after.count);
            return;
        }
        const bool isStrands = before.name.starts_with(section::kStrandPrefix);
        const bool isPoints = before.name.starts_with(section::kPointPrefix);
        if (!isStrands && !isPoints && before.count != after.count) {
            say(where, "another number of values", before.count, after.count);
            return;
        }
        Tally tally(before, after);
        if (isStrands)
            for (const auto& [old, now] : strands_.pairs) tally.add(old, now, 1);
        else if (isPoints)
            addPoints(tally);
        else
            tally.add(0, 0, before.count);
        if (tally.changed() == 0) return;
        // Bytes of a baked field say nothing.
        if (before.name == section::kBody)
            say(where, "changed");
        else
            all_.push_back(tally.difference(where,
                                            isStrands  ? "strand"
                                            : isPoints ? "point"
                                                       : "value",
                                            isLength(before.name)));
    }

    void addPoints(Tally& tally) const {
        const auto old = before_.groom.offsets.view(), now = after_.groom.offsets.view();
        for (const auto& [a, b] : strands_.pairs) {
            const std::size_t count = old[a + 1] - old[a];
            if (count == now[b + 1] - now[b]) tally.add(old[a], now[b], count);
        }
    }

    static bool isLength(std::string_view name) {
        const auto isPoints = [&](std::string_view attribute) {
            return name.starts_with(section::kPointPrefix) &&
                   name.substr(section::kPointPrefix.size()) == attribute;
        };
        return name == section::kScalpPositions || isPoints(attribute::kRadius) ||
               isPoints(attribute::kBasePosition);
    }

    void compareHeads() {
        const auto headOf = [&](const GroomVersion& version) {
            auto head = projectHead(version.groom, version.file);
            head.erase("strands");
            head.erase("points");
            if (hasOneScalp()) head.erase("scalp");
            return head;
        };
        if (hasOneScalp()) say("scalp", after_.groom.scalp ? "added" : "removed");
        for (JsonDifference& one : differences(headOf(before_), headOf(after_)))
            all_.push_back({one.where,
                            std::move(one.what),
                            std::move(one.before),
                            std::move(one.after),
                            0,
                            0,
                            {},
                            false,
                            unitOf(one.where)});
    }

    const GroomVersion &before_, &after_;
    ComparedParts parts_;
    StrandPairs strands_;
    std::vector<GroomDifference> all_;
};

}  // namespace

std::string_view strandMatchName(StrandMatch match) {
    constexpr std::array<std::string_view, 3> kNames{"ids", "order", "roots"};
    return kNames.at(static_cast<std::size_t>(match));
}

std::string changeInWords(const GroomDifference& difference) {
    constexpr std::size_t kLongest = 120;
    const auto& [where, what, before, after, count, of, largest, isLength, unit] = difference;
    const auto text = [](const Json& value) { return shortText(withFewDigits(value), kLongest); };
    std::string old = text(before), now = text(after);
    if (old == now) {
        old = shortText(before, kLongest);
        now = shortText(after, kLongest);
    }
    const std::string behind = unit.empty() ? "" : " " + unit;
    if (before.is_null() && after.is_null()) return what;
    if (before.is_null()) return fmt::format("{} {}{}", what, now, behind);
    if (after.is_null()) return fmt::format("{} {}{}", what, old, behind);
    if (what == "changed") return fmt::format("{} → {}{}", old, now, behind);
    return fmt::format("{} ({} → {})", what, old, now);
}

std::string inWords(const GroomDifference& difference) {
    return fmt::format("{}: {}", difference.where, changeInWords(difference));
}

GroomComparison compare(const GroomVersion& before, const GroomVersion& after, ComparedParts parts) {
    HAIRLOOM_PROFILE("groom: compare");
    return Comparison(before, after, parts).run();
}

}  // namespace hairloom
