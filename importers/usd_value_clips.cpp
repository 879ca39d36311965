// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/usd_value_clips.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "importers/usd_values.h"

namespace hairloom {
namespace {

constexpr std::uint64_t kMaxNumbers = std::uint64_t{1} << 28u;
constexpr std::size_t kMaxClips = 4096;  ///< files of a set
constexpr std::size_t kMaxPlays = 65536;
constexpr std::size_t kMaxAttributes = 16384;
/// Time codes before a jump at which what is left still holds, as USD's own library has it
/// (UsdTimeCode::SafeStep).
constexpr double kBeforeJump = 4.440892098500626e-9;

/// A time of the stage and that of the clip that plays then.
struct Knot {
    double stage = 0, clip = 0;
};

/// Pairs whose first is a time of the layer, in the time of its stack.
void moveInTime(UsdValue& pairs, const UsdTimeOffset& time) {
    if (time.offset == 0 && time.scale == 1) return;
    for (std::size_t i = 0; i + 1 < pairs.numbers.size(); i += 2)
        pairs.numbers.set(i, time.at(pairs.numbers[i]));
}

std::vector<Knot> pairsOf(const UsdDictionary& all, const std::string& name) {
    std::vector<Knot> pairs;
    const auto found = all.find(name);
    if (found == all.end()) return pairs;
    const UsdNumbers& numbers = found->second.numbers;
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) pairs.push_back({numbers[i], numbers[i + 1]});
    std::ranges::stable_sort(pairs, {}, &Knot::stage);
    return pairs;
}

std::string textOf(const UsdDictionary& all, const std::string& name) {
    const auto found = all.find(name);
    return found == all.end() || found->second.texts.empty() ? std::string() : found->second.texts.front();
}

std::optional<double> numberOf(const UsdDictionary& all, const std::string& name) {
    const auto found = all.find(name);
    if (found == all.end() || found->second.numbers.empty()) return std::nullopt;
    return found->second.numbers.front();
}

/// The clip's time at one of the stage: along straight lines, and held beyond the first and the last. Without
/// any it is that of the layer that names the clips.
double clipTimeAt(const std::vector<Knot>& times, const UsdTimeOffset& ofLayer, double stage) {
    if (times.empty()) return (stage - ofLayer.offset) / ofLayer.scale;
    const auto after = std::ranges::upper_bound(times, stage, {}, &Knot::stage);
    if (after == times.begin()) return times.front().clip;
    const Knot& before = *std::prev(after);
    if (after == times.end() || before.stage == stage) return before.clip;
    const double share = (stage - before.stage) / (after->stage - before.stage);
    return before.clip + share * (after->clip - before.clip);
}

const UsdPrim* primAt(const UsdPrim& root, std::string_view path) {
    const UsdPrim* prim = &root;
    while (prim != nullptr && !path.empty()) {
        path.remove_prefix(std::min<std::size_t>(1, path.size()));
        const std::size_t end = std::min(path.find('/'), path.size());
        prim = prim->child(path.substr(0, end));
        path.remove_prefix(end);
    }
    return prim;
}

/// An attribute of each clip that has samples of it, by the clip's index.
using OfClips = std::map<std::size_t, const UsdAttribute*>;
using Attributes = std::map<std::string, OfClips>;

/// Attributes of the prim of a clip and of those below it, by "/kid.size".
void collect(const UsdPrim& prim, const std::string& path, std::size_t index, Attributes& into) {
    for (const UsdAttribute& attribute : prim.attributes) {
        if (!attribute.samples.empty()) into[path + "." + attribute.name][index] = &attribute;
    }
    for (const UsdPrim& child : prim.children) collect(child, path + "/" + child.name, index, into);
}

/// What the manifest has: nothing else is looked up in clips.
void collectDeclared(const UsdPrim& prim, const std::string& path,
                     std::map<std::string, const UsdAttribute*>& into) {
    for (const UsdAttribute& attribute : prim.attributes) {
        if (attribute.type != "rel") into[path + "." + attribute.name] = &attribute;
    }
    for (const UsdPrim& child : prim.children) collectDeclared(child, path + "/" + child.name, into);
}

/// Where the values of an attribute of "/kid.size" go; what there is not yet declares nothing.
UsdAttribute& placeOf(UsdPrim& anchor, std::string_view path) {
    UsdPrim* prim = &anchor;
    const std::size_t dot = path.find('.');
    const std::string_view name = path.substr(dot + 1);
    path = path.substr(0, dot);
    while (!path.empty()) {
        path.remove_prefix(1);
        const std::size_t end = std::min(path.find('/'), path.size());
        const auto found = std::ranges::find(prim->children, path.substr(0, end), &UsdPrim::name);
        if (found != prim->children.end()) {
            prim = &*found;
        } else {
            prim->children.emplace_back().name = path.substr(0, end);
            prim = &prim->children.back();
        }
        path.remove_prefix(end);
    }
    if (UsdAttribute* const known = prim->find(name)) return *known;
    UsdAttribute& attribute = prim->attributes.emplace_back();
    attribute.name = name;
    attribute.isOfClips = true;
    return attribute;
}

/// Attributes that the schemas of what is read declare and that may change in time.
bool isOfSchema(const UsdPrim& prim, std::string_view name) {
    constexpr std::array<std::string_view, 26> kNames{"visibility",
                                                      "extent",
                                                      "points",
                                                      "normals",
                                                      "velocities",
                                                      "accelerations",
                                                      "widths",
                                                      "tangents",
                                                      "curveVertexCounts",
                                                      "order",
                                                      "knots",
                                                      "ranges",
                                                      "pointWeights",
                                                      "faceVertexCounts",
                                                      "faceVertexIndices",
                                                      "positions",
                                                      "orientations",
                                                      "orientationsf",
                                                      "scales",
                                                      "protoIndices",
                                                      "ids",
                                                      "invisibleIds",
                                                      "translations",
                                                      "rotations",
                                                      "primvars:displayColor",
                                                      "primvars:displayOpacity"};
    return !prim.type.empty() && std::ranges::find(kNames, name) != kNames.end();
}

}  // namespace

struct UsdValueClips::Set {
    std::string words;   ///< "the value clips "default" of /hair"
    std::string key;     ///< of the layer that names the files
    UsdTimeOffset time;  ///< of this layer
    std::vector<std::string> assets;
    std::string manifest, primPath;
    std::vector<Knot> active;  ///< whose second number is that of a file
    std::vector<Knot> times;
    /// Where a clip lacks values: straight from the last of the clip before to the first of the next. (USD's
    /// own library 26.11 may jump where a gap begins, if the clip before has samples behind that.)
    bool interpolates = false;
};

/// The files of a set that are open, by their keys.
struct UsdValueClips::Clips {
    std::map<std::string, std::optional<UsdLayer>> layers;
};

bool UsdValueClips::isFull() const {
    return numbers_ > kMaxNumbers;
}

void UsdValueClips::addTo(UsdPrim& root, const std::string& key, const UsdTimeOffset& time,
                          UsdStrongerClips& stronger) {
    visit(root, "", key, time, stronger);
}

void UsdValueClips::visit(UsdPrim& prim, const std::string& path, const std::string& key,
                          const UsdTimeOffset& time, UsdStrongerClips& stronger) {
    // Those of the nearest prim go before those of prims above.
    for (UsdPrim& child : prim.children) visit(child, path + "/" + child.name, key, time, stronger);
    for (UsdVariantSet& set : prim.variantSets) {
        for (UsdPrim& variant : set.variants)
            visit(variant, fmt::format("{}{{{}={}}}", path, set.name, variant.name), key, time, stronger);
    }
    if (prim.clips.empty() || isFull()) return;
    std::set<std::string> named;
    UsdDictionary& all = stronger[path];
    for (auto& [name, value] : prim.clips) {
        const std::size_t end = std::min(name.rfind(':'), name.size());
        if (name.ends_with(":active") || name.ends_with(":times")) moveInTime(value, time);
        const bool isNew = all.try_emplace(name, std::move(value)).second;
        if (isNew && (name.ends_with(":assetPaths") || name.ends_with(":templateAssetPath")))
            named.insert(name.substr(0, end));
    }
    prim.clips.clear();
    // In the order of their names where there is no other.
    UsdListEdits<std::string> order = prim.clipSets;
    order.over({true, {named.begin(), named.end()}, {}, {}});
    for (const std::string& name : order.all()) {
        if (named.erase(name) == 0) continue;
        Set set;
        set.words = fmt::format("the value clips \"{}\" of {}", name, path);
        set.key = key;
        set.time = time;
        if (readSet(all, name, set)) addSet(prim, set);
    }
}

bool UsdValueClips::readSet(const UsdDictionary& all, const std::string& name, Set& set) {
    const auto leave = [&](const std::string& why) {
        note_(fmt::format("{}: {}", set.words, why));
        return false;
    };
    set.manifest = textOf(all, name + ":manifestAssetPath");
    set.primPath = textOf(all, name + ":primPath");
    set.interpolates = numberOf(all, name + ":interpolateMissingClipValues").value_or(0) != 0;
    if (!set.primPath.starts_with('/') || set.primPath.size() < 2)
        return leave(fmt::format("primPath is \"{}\" and no path of a prim", set.primPath));
    const auto files = all.find(name + ":assetPaths");
    if (files != all.end()) {
        set.assets = files->second.texts;
        set.active = pairsOf(all, name + ":active");
        set.times = pairsOf(all, name + ":times");
    } else if (!expandTemplate(all, name, set)) {
        return leave("its template names no files that are there");
    }
    if (set.active.empty()) return leave("no clip is active");
    if (set.assets.size() > kMaxClips)
        return leave(
            fmt::format("there are {} clips, and at most {} are read", set.assets.size(), kMaxClips));
    if (set.active.size() > kMaxPlays)
        return leave(fmt::format("clips become active {} times, and at most {} are read", set.active.size(),
                                 kMaxPlays));
    for (std::size_t i = 0; i < set.active.size(); ++i) {
        const double index = set.active[i].clip;
        if (!(index >= 0 && index < static_cast<double>(set.assets.size())) || index != std::floor(index))
            return leave(fmt::format("clip {} is active, of {}", index, set.assets.size()));
        if (!std::isfinite(set.active[i].stage) || (i > 0 && set.active[i].stage == set.active[i - 1].stage))
            return leave("two clips are active at a time");
    }
    for (std::size_t i = 0; i < set.times.size(); ++i) {
        if (!std::isfinite(set.times[i].stage) || !std::isfinite(set.times[i].clip))
            return leave("a time is not finite");
        if (i + 2 < set.times.size() && set.times[i].stage == set.times[i + 2].stage)
            return leave(fmt::format("three times are {}", set.times[i].stage));
    }
    // Two at one time are a jump, which is behind the first.
    for (std::size_t i = 0; i + 1 < set.times.size(); ++i) {
        if (set.times[i].stage == set.times[i + 1].stage) set.times[i].stage -= kBeforeJump;
    }
    return true;
}

/// "hair.###.usd" or "hair.##.##.usd", whose numbers are times.
bool UsdValueClips::expandTemplate(const UsdDictionary& all, const std::string& name, Set& set) {
    const std::string path = textOf(all, name + ":templateAssetPath");
    const auto start = numberOf(all, name + ":templateStartTime"),
               end = numberOf(all, name + ":templateEndTime"),
               stride = numberOf(all, name + ":templateStride"),
               offset = numberOf(all, name + ":templateActiveOffset");
    const std::size_t digits = path.find('#', path.find_last_of('/') + 1);
    if (digits == std::string::npos || !start || !end || !stride) return false;
    if (!(*stride > 0) || !((*end - *start) / *stride < static_cast<double>(kMaxClips))) return false;
    const std::size_t behind = std::min(path.find_first_not_of('#', digits), path.size());
    const bool hasFraction = path.substr(behind).starts_with(".#");
    const std::size_t rest =
        hasFraction ? std::min(path.find_first_not_of('#', behind + 1), path.size()) : behind;
    const std::size_t fractions = hasFraction ? rest - behind - 1 : 0;
    const double parts = std::pow(10, static_cast<double>(fractions));
    const auto addTime = [&](double code) { set.times.push_back({set.time.at(code), code}); };
    if (behind - digits > 18 || fractions > 9) return false;
    for (std::size_t n = 0; n <= kMaxClips; ++n) {
        const double code = *start + static_cast<double>(n) * *stride;
        if (!(code <= *end) || !(std::abs(code * parts) < 9e18)) break;
        // A stride that is too small for numbers as large as these leads nowhere.
        if (n > 0 && code == *start + static_cast<double>(n - 1) * *stride) break;
        const auto whole = static_cast<std::int64_t>(std::llround(code * parts));
        const auto perCode = static_cast<std::int64_t>(parts);
        std::string asset = fmt::format("{}{:0{}}", path.substr(0, digits), whole / perCode, behind - digits);
        if (hasFraction) asset += fmt::format(".{:0{}}", whole % perCode, fractions);
        asset += path.substr(rest);
        if (!files_.keyOf(set.key, asset)) continue;
        set.active.push_back(
            {set.time.at(code + offset.value_or(0)), static_cast<double>(set.assets.size())});
        addTime(code);
        if (offset) addTime(code + *offset);
        set.assets.push_back(std::move(asset));
    }
    if (offset && !set.assets.empty()) {
        addTime(*start - std::abs(*offset));
        addTime(*end + std::abs(*offset));
    }
    const auto isFinite = [](const Knot& knot) {
        return std::isfinite(knot.stage) && std::isfinite(knot.clip);
    };
    if (!std::ranges::all_of(set.times, isFinite)) return false;
    std::ranges::sort(set.times, {}, &Knot::stage);
    const auto last = std::unique(set.times.begin(), set.times.end(),
                                  [](const Knot& a, const Knot& b) { return a.stage == b.stage; });
    set.times.erase(last, set.times.end());
    return !set.assets.empty();
}

UsdLayer* UsdValueClips::open(const Set& set, const std::string& asset, const char* what, Clips& clips) {
    const auto leave = [&](const std::string& why) -> UsdLayer* {
        note_(fmt::format("the {} \"{}\" of {}: {}", what, asset, set.words, why));
        return nullptr;
    };
    auto key = files_.keyOf(set.key, asset);
    if (!key) return leave(key.error().problem);
    const auto [known, isNew] = clips.layers.try_emplace(*key);
    if (!isNew) return known->second ? &*known->second : nullptr;
    auto layer = files_.open(*key);
    if (!layer) return leave(layer.error().message());
    known->second = std::move(*layer);
    return &*known->second;
}

void UsdValueClips::addSet(UsdPrim& prim, const Set& set) {
    Clips clips;
    Attributes attributes;
    std::set<std::size_t> used;
    for (const Knot& active : set.active) used.insert(static_cast<std::size_t>(active.clip));
    for (const std::size_t index : used) {
        const UsdLayer* const layer = open(set, set.assets[index], "clip", clips);
        const UsdPrim* const of = layer == nullptr ? nullptr : primAt(layer->root, set.primPath);
        if (of != nullptr) collect(*of, "", index, attributes);
    }
    std::map<std::string, const UsdAttribute*> declared;
    if (!set.manifest.empty()) {
        const UsdLayer* const layer = open(set, set.manifest, "manifest", clips);
        const UsdPrim* const of = layer == nullptr ? nullptr : primAt(layer->root, set.primPath);
        if (of != nullptr) collectDeclared(*of, "", declared);
        std::erase_if(attributes, [&](const auto& one) { return !declared.contains(one.first); });
        for (const auto& [path, attribute] : declared) {
            if (attribute->value.isThere()) attributes.try_emplace(path);
        }
    }
    if (attributes.size() > kMaxAttributes) {
        note_(fmt::format("{}: they have {} attributes, and at most {} are read", set.words,
                          attributes.size(), kMaxAttributes));
        return;
    }
    for (const auto& [path, ofClips] : attributes) {
        UsdAttribute& into = placeOf(prim, path);
        if (into.hasValue()) continue;
        const auto manifest = declared.find(path);
        UsdValue otherwise;
        otherwise.isBlock = true;
        if (manifest != declared.end() && manifest->second->value.isThere())
            otherwise = manifest->second->value;
        if (into.type.empty())
            into.type = ofClips.empty() ? manifest->second->type : ofClips.begin()->second->type;
        into.samples = samplesOf(set, ofClips, otherwise);
    }
}

UsdValue UsdValueClips::timed(const UsdAttribute& attribute, double time) {
    UsdValue value = valueAt(attribute, time);
    numbers_ += 1 + value.numbers.size();
    return value;
}

/// Samples in the stage's time: those of the clip that is active, where its time changes its pace, and where
/// a clip begins. Between them values go straight, as in USD's own library.
std::map<double, UsdValue> UsdValueClips::samplesOf(const Set& set,
                                                    const std::map<std::size_t, const UsdAttribute*>& ofClips,
                                                    const UsdValue& otherwise) {
    std::map<double, UsdValue> samples;
    for (std::size_t a = 0; a < set.active.size() && !isFull(); ++a) {
        ++numbers_;
        const bool isFirst = a == 0, isLast = a + 1 == set.active.size();
        const double begin = isFirst ? -HUGE_VAL : set.active[a].stage,
                     end = isLast ? HUGE_VAL : set.active[a + 1].stage;
        const auto playing = ofClips.find(static_cast<std::size_t>(set.active[a].clip));
        if (playing == ofClips.end()) {
            if (set.interpolates) continue;
            // Up to the last time that is told of it, from where values go to the next clip's.
            std::vector<double> moments{set.active[a].stage};
            const auto behindLast = std::ranges::lower_bound(set.times, end, {}, &Knot::stage);
            if (!isLast && behindLast != set.times.begin() && std::prev(behindLast)->stage > begin)
                moments.push_back(std::prev(behindLast)->stage);
            for (const double stage : moments) {
                numbers_ += 1 + otherwise.numbers.size();
                samples.insert_or_assign(stage, otherwise);
            }
            continue;
        }
        const UsdAttribute* const attribute = playing->second;
        std::map<double, double> moments;  // of the clip, by those of the stage
        const auto add = [&](double stage, double clip) {
            constexpr std::uint64_t kCost = 8;  // in numbers, of one that is looked up
            numbers_ += kCost;
            if (stage >= begin && stage < end) moments.insert_or_assign(stage, clip);
        };
        add(set.active[a].stage, clipTimeAt(set.times, set.time, set.active[a].stage));
        if (set.times.empty()) {
            for (const auto& [time, value] : attribute->samples) add(set.time.at(time), time);
        }
        const auto behind = std::ranges::upper_bound(set.times, begin, {}, &Knot::stage);
        for (auto to = behind; to != set.times.end() && !isFull(); ++to) {
            if (to == set.times.begin()) {
                add(to->stage, to->clip);
                continue;
            }
            const Knot& from = *std::prev(to);
            if (from.stage >= end) break;
            add(to->stage, to->clip);
            if (to->stage - from.stage < 2 * kBeforeJump || to->clip == from.clip) continue;
            // Samples that the clip passes on the way.
            const auto last = attribute->samples.lower_bound(std::max(from.clip, to->clip));
            for (auto one = attribute->samples.upper_bound(std::min(from.clip, to->clip)); one != last;
                 ++one) {
                const double share = (one->first - from.clip) / (to->clip - from.clip);
                add(from.stage + share * (to->stage - from.stage), one->first);
                if (isFull()) break;
            }
        }
        // What is held before the first and behind the last needs no samples.
        const double first = attribute->samples.begin()->first, last = attribute->samples.rbegin()->first;
        const auto isHeld = [&](double one, double other) {
            return one == other || (one <= first && other <= first) || (one >= last && other >= last);
        };
        while (isFirst && moments.size() > 1 &&
               isHeld(moments.begin()->second, std::next(moments.begin())->second))
            moments.erase(moments.begin());
        while (isLast && moments.size() > 1 &&
               isHeld(moments.rbegin()->second, std::next(moments.rbegin())->second))
            moments.erase(std::prev(moments.end()));
        for (const auto& [stage, clip] : moments) {
            if (isFull()) break;
            samples.insert_or_assign(stage, timed(*attribute, clip));
        }
    }
    return samples;
}

void eraseUndeclared(UsdPrim& root) {
    std::erase_if(root.attributes, [&](const UsdAttribute& attribute) {
        return attribute.isOfClips && !isOfSchema(root, attribute.name);
    });
    for (UsdPrim& child : root.children) eraseUndeclared(child);
}

}  // namespace hairloom
