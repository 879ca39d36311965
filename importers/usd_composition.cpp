// SPDX-License-Identifier: GPL-3.0-or-later
// What a stage shows of its layers: sublayers, inherits, variants, references, payloads and specializes, the
// stronger over the weaker in this order (OpenUSD's "LIVRPS").

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "importers/usd_files.h"
#include "importers/usd_value_clips.h"

namespace hairloom {
namespace {

constexpr int kMaxArcs = 32;                ///< that lead to each other
constexpr int kMaxDepth = 384;              ///< of prims in each other, with those of arcs
constexpr std::size_t kMaxPrims = 200'000;  ///< of the stage, copies counted
constexpr std::uint64_t kMaxNumbers = std::uint64_t{1} << 28u;  ///< likewise

void moveInTime(UsdPrim& prim, const UsdTimeOffset& time) {
    if (time.offset == 0 && time.scale == 1) return;
    for (UsdAttribute& attribute : prim.attributes) {
        std::map<double, UsdValue> moved;
        for (auto& [at, value] : attribute.samples) moved.insert_or_assign(time.at(at), std::move(value));
        attribute.samples = std::move(moved);
    }
    for (UsdArcs* const arcs : {&prim.inherits, &prim.references, &prim.payloads, &prim.specializes}) {
        for (std::vector<UsdArc>* const list : {&arcs->items, &arcs->appended}) {
            for (UsdArc& arc : *list)
                arc.time = {time.scale * arc.time.offset + time.offset, time.scale * arc.time.scale};
        }
    }
    for (UsdPrim& child : prim.children) moveInTime(child, time);
    for (UsdVariantSet& set : prim.variantSets) {
        for (UsdPrim& variant : set.variants) moveInTime(variant, time);
    }
}

/// Every arc remembers whose names of files it uses.
void signArcs(UsdPrim& prim, const std::string& key) {
    for (UsdArcs* const arcs : {&prim.inherits, &prim.references, &prim.payloads, &prim.specializes}) {
        for (std::vector<UsdArc>* const list : {&arcs->items, &arcs->appended, &arcs->deleted}) {
            for (UsdArc& arc : *list) arc.from = key;
        }
    }
    for (UsdPrim& child : prim.children) signArcs(child, key);
    for (UsdVariantSet& set : prim.variantSets) {
        for (UsdPrim& variant : set.variants) signArcs(variant, key);
    }
}

/// Targets of relationships below a prim that comes from elsewhere lie below where it comes to.
void moveTargets(UsdPrim& prim, const std::string& from, const std::string& to) {
    for (UsdAttribute& attribute : prim.attributes) {
        if (attribute.type != "rel") continue;
        for (std::string& path : attribute.value.texts) {
            const bool below =
                path.starts_with(from) &&
                (path.size() == from.size() || path[from.size()] == '/' || path[from.size()] == '.');
            if (below) path = to + path.substr(from.size());
        }
    }
    for (UsdPrim& child : prim.children) moveTargets(child, from, to);
}

void mergeAttribute(UsdAttribute& strong, UsdAttribute&& weak) {
    if (strong.type.empty()) strong.type = std::move(weak.type);
    if (strong.displayName.empty()) strong.displayName = std::move(weak.displayName);
    if (strong.interpolation.empty()) strong.interpolation = std::move(weak.interpolation);
    if (strong.elementSize == 1) strong.elementSize = weak.elementSize;
    strong.isOfClips = strong.isOfClips && weak.isOfClips;
    if (strong.hasValue()) return;
    strong.value = std::move(weak.value);
    strong.samples = std::move(weak.samples);
}

void merge(UsdPrim& strong, UsdPrim&& weak);

/// In the weaker order, since stronger layers add behind.
void mergeChildren(std::vector<UsdPrim>& strong, std::vector<UsdPrim>&& weak) {
    if (weak.empty()) return;
    std::map<std::string, std::size_t, std::less<>> places;
    for (std::size_t i = 0; i < weak.size(); ++i) places.emplace(weak[i].name, i);
    std::vector<UsdPrim> all = std::move(weak);
    for (UsdPrim& child : strong) {
        const auto found = places.find(child.name);
        if (found == places.end()) {
            all.push_back(std::move(child));
        } else {
            merge(child, std::move(all[found->second]));
            all[found->second] = std::move(child);
        }
    }
    strong = std::move(all);
}

void merge(UsdPrim& strong, UsdPrim&& weak) {
    if (strong.type.empty()) strong.type = std::move(weak.type);
    if (strong.specifier == UsdPrim::Specifier::Over) strong.specifier = weak.specifier;
    if (!strong.active) strong.active = weak.active;
    if (!strong.instanceable) strong.instanceable = weak.instanceable;
    if (strong.displayName.empty()) strong.displayName = std::move(weak.displayName);
    strong.customTexts.merge(weak.customTexts);
    for (UsdAttribute& attribute : weak.attributes) {
        if (UsdAttribute* const found = strong.find(attribute.name))
            mergeAttribute(*found, std::move(attribute));
        else
            strong.attributes.push_back(std::move(attribute));
    }
    strong.inherits.over(weak.inherits);
    strong.references.over(weak.references);
    strong.payloads.over(weak.payloads);
    strong.specializes.over(weak.specializes);
    strong.inactiveIds.over(weak.inactiveIds);
    strong.selections.merge(weak.selections);
    for (UsdVariantSet& set : weak.variantSets) {
        auto found = std::ranges::find(strong.variantSets, set.name, &UsdVariantSet::name);
        if (found == strong.variantSets.end())
            strong.variantSets.push_back(std::move(set));
        else
            mergeChildren(found->variants, std::move(set.variants));
    }
    mergeChildren(strong.children, std::move(weak.children));
}

bool isAnyComposed(const UsdPrim& prim) {
    return prim.isComposed() || std::ranges::any_of(prim.children, isAnyComposed);
}

double ratesOf(const UsdMetadata& metadata) {
    const double rate = usdNumber(metadata, "timeCodesPerSecond", usdNumber(metadata, "framesPerSecond", 24));
    return rate > 0 && std::isfinite(rate) ? rate : 24;
}

class Composer {
  public:
    Composer(std::string file, const std::filesystem::path& folder)
        : files_(std::move(file), folder),
          clips_(files_, [this](std::string text) { note(stage_.notFollowed, std::move(text)); }) {}

    Result<UsdStage> run(std::vector<std::byte>&& bytes) {
        std::string key;
        auto layer = files_.first(std::move(bytes), key);
        if (!layer) return tl::unexpected(layer.error());
        Stack& stack = stacks_[key];
        UsdStrongerClips clips;
        addLayer(std::move(*layer), key, {}, stack, {}, clips);
        stage_.metadata = stack.metadata;
        if (clips_.isFull()) return tooMuch();
        if (!isAnyComposed(stack.root)) {
            stage_.root = std::move(stack.root);
            eraseUndeclared(stage_.root);
            return std::move(stage_);
        }
        stage_.root.name = "";
        for (const UsdPrim& spec : stack.root.children) {
            UsdPrim prim = expand(stack, spec, "/" + spec.name, {}, 0);
            stage_.root.children.push_back(std::move(prim));
        }
        if (isFull() || clips_.isFull()) return tooMuch();
        eraseUndeclared(stage_.root);
        return std::move(stage_);
    }

  private:
    /// A layer and those below it, as one.
    struct Stack {
        UsdPrim root;
        UsdMetadata metadata;
        bool isBroken = false;
    };
    /// Weaker layers' choice of variants gives way to these.
    using Stronger = std::vector<const UsdPrim*>;

    static tl::unexpected<Error> tooMuch() {
        return fail("the stage has more prims or numbers than are kept once it is composed",
                    fmt::format("expected at most {} prims and {} numbers", kMaxPrims, kMaxNumbers));
    }

    void note(std::vector<std::string>& list, std::string text) {
        constexpr std::size_t kMost = 64;
        if (list.size() < kMost && std::ranges::find(list, text) == list.end())
            list.push_back(std::move(text));
    }

    void addLayer(UsdLayer&& layer, const std::string& key, const UsdTimeOffset& time, Stack& stack,
                  std::vector<std::string> above, UsdStrongerClips& clips) {
        signArcs(layer.root, key);
        moveInTime(layer.root, time);
        clips_.addTo(layer.root, key, time, clips);
        for (const std::string& repeated : layer.repeated) note(stage_.repeated, repeated);
        for (const std::string& left : layer.leftOut) note(stage_.notFollowed, left);
        if (above.empty()) stack.metadata = std::move(layer.metadata);
        merge(stack.root, std::move(layer.root));
        above.push_back(key);
        for (const UsdArc& below : layer.subLayers) addSubLayer(below, key, time, stack, above, clips);
    }

    void addSubLayer(const UsdArc& below, const std::string& key, const UsdTimeOffset& time, Stack& stack,
                     const std::vector<std::string>& above, UsdStrongerClips& clips) {
        const auto leave = [&](const std::string& why) {
            note(stage_.notFollowed, fmt::format("the layer \"{}\": {}", below.asset, why));
        };
        auto found = files_.keyOf(key, below.asset);
        if (!found) return leave(found.error().problem);
        if (std::ranges::find(above, *found) != above.end()) return leave("it lies below itself");
        if (above.size() > kMaxArcs) return leave("layers lie below each other too deep");
        auto layer = files_.open(*found);
        if (!layer) return leave(layer.error().message());
        const double ratio = ratesOf(stack.metadata) / ratesOf(layer->metadata);
        addLayer(std::move(*layer), *found,
                 {time.scale * below.time.offset + time.offset, time.scale * below.time.scale * ratio}, stack,
                 above, clips);
    }

    bool isFull() const { return prims_ > kMaxPrims || numbers_ > kMaxNumbers; }

    /// A prim's own part, without its children; counted, since arcs may bring it in again and again.
    UsdPrim ownPart(const UsdPrim& spec) {
        UsdPrim own;
        own.type = spec.type;
        own.name = spec.name;
        own.specifier = spec.specifier;
        own.active = spec.active;
        own.instanceable = spec.instanceable;
        own.displayName = spec.displayName;
        own.customTexts = spec.customTexts;
        own.inactiveIds = spec.inactiveIds;
        numbers_ += own.inactiveIds.all().size();
        ++prims_;
        for (const UsdAttribute& attribute : spec.attributes) {
            numbers_ += attribute.value.numbers.size();
            for (const auto& [time, value] : attribute.samples) numbers_ += value.numbers.size();
            if (isFull()) return own;
            own.attributes.push_back(attribute);
        }
        return own;
    }

    /// The prim with all that its arcs bring in, and no arcs.
    UsdPrim expand(const Stack& stack, const UsdPrim& spec, const std::string& path, const Stronger& stronger,
                   int depth) {
        UsdPrim result = ownPart(spec);
        if (isFull()) return result;
        if (depth_ >= kMaxDepth) {
            note(stage_.notFollowed, fmt::format("what lies below {}: it lies too deep", path));
            return result;
        }
        ++depth_;
        expandInto(stack, spec, path, stronger, depth, result);
        --depth_;
        return result;
    }

    void expandInto(const Stack& stack, const UsdPrim& spec, const std::string& path,
                    const Stronger& stronger, int depth, UsdPrim& result) {
        Stronger here = stronger;
        here.push_back(&spec);
        // What lies below an instance is its prototype's.
        const bool isInstance = spec.instanceable.value_or(false) && spec.isComposed();
        for (const UsdPrim& child : spec.children) {
            if (isInstance) break;
            Stronger ofChild;
            for (const UsdPrim* const prim : stronger) {
                if (const UsdPrim* const same = prim->child(child.name)) ofChild.push_back(same);
            }
            result.children.push_back(expand(stack, child, path + "/" + child.name, ofChild, depth));
        }
        if (!spec.isComposed()) return;
        follow(stack, spec.inherits, "inherited", path, here, depth, result);
        for (const UsdVariantSet& set : spec.variantSets) {
            if (const UsdPrim* const variant = chosen(set, here, path))
                merge(result, renamed(expand(stack, *variant, path, here, depth + 1), spec.name));
        }
        follow(stack, spec.references, "reference", path, here, depth, result);
        follow(stack, spec.payloads, "payload", path, here, depth, result);
        follow(stack, spec.specializes, "specialized", path, here, depth, result);
    }

    static UsdPrim renamed(UsdPrim prim, const std::string& name) {
        prim.name = name;
        return prim;
    }

    const UsdPrim* chosen(const UsdVariantSet& set, const Stronger& here, const std::string& path) {
        for (const UsdPrim* const prim : here) {
            const auto selection = prim->selections.find(set.name);
            if (selection == prim->selections.end()) continue;
            const auto found = std::ranges::find(set.variants, selection->second, &UsdPrim::name);
            if (found == set.variants.end()) break;
            note(stage_.chosen, fmt::format("variant \"{}\" of \"{}\" of {}", found->name, set.name, path));
            return &*found;
        }
        std::string names;
        for (const UsdPrim& variant : set.variants) names += (names.empty() ? "" : ", ") + variant.name;
        note(stage_.notFollowed,
             fmt::format("the variants \"{}\" of {} ({}): none is selected", set.name, path, names));
        return nullptr;
    }

    void follow(const Stack& stack, const UsdArcs& arcs, std::string_view kind, const std::string& path,
                const Stronger& here, int depth, UsdPrim& result) {
        for (const UsdArc& arc : arcs.all()) {
            if (isFull()) return;
            const auto leave = [&](const std::string& why) {
                note(stage_.notFollowed,
                     fmt::format("{} {}{} of {}: {}", kind, arc.asset.empty() ? "" : "\"" + arc.asset + "\"",
                                 arc.path.empty() ? "" : "<" + arc.path + ">", path, why));
            };
            const Stack* const from = arc.asset.empty() ? &stack : stackOf(arc, leave);
            if (from == nullptr) continue;
            std::string target = arc.path;
            if (target.empty()) target = defaultPrim(from->metadata);
            if (target.empty()) {
                leave("the file names no default prim");
                continue;
            }
            const auto active = std::pair(from, target);
            const bool isAbove = from == &stack && (path + "/").starts_with(target + "/");
            if (isAbove || depth >= kMaxArcs || !following_.insert(active).second) {
                leave("it leads to itself");
                continue;
            }
            auto found = expandAt(*from, target, here, depth + 1);
            following_.erase(active);
            if (!found) {
                leave("there is no such prim");
                continue;
            }
            const double ratio = from == &stack ? 1 : ratesOf(stack.metadata) / ratesOf(from->metadata);
            moveInTime(*found, {arc.time.offset, arc.time.scale * ratio});
            moveTargets(*found, target, path);
            // A class that is inherited makes no class of who inherits.
            if (arc.asset.empty() && found->specifier == UsdPrim::Specifier::Class)
                found->specifier = UsdPrim::Specifier::Over;
            merge(result, renamed(std::move(*found), result.name));
        }
    }

    static std::string defaultPrim(const UsdMetadata& metadata) {
        const auto found = metadata.find("defaultPrim");
        if (found == metadata.end() || found->second.texts.empty()) return {};
        const std::string& name = found->second.texts.front();
        return name.starts_with('/') ? name : "/" + name;
    }

    template <class Leave>
    const Stack* stackOf(const UsdArc& arc, const Leave& leave) {
        auto key = files_.keyOf(arc.from, arc.asset);
        if (!key) {
            leave(key.error().problem);
            return nullptr;
        }
        const auto [known, isNew] = stacks_.try_emplace(*key);
        if (isNew) {
            std::string own = *key;
            auto layer = files_.open(own);
            known->second.isBroken = !layer;
            UsdStrongerClips clips;
            if (layer)
                addLayer(std::move(*layer), own, {}, known->second, {}, clips);
            else
                leave(layer.error().message());
        }
        return known->second.isBroken ? nullptr : &known->second;
    }

    /// The prim at a path, which may lie in what an arc of one above it brings in.
    std::optional<UsdPrim> expandAt(const Stack& stack, const std::string& target, const Stronger& stronger,
                                    int depth) {
        const UsdPrim* spec = &stack.root;
        std::string path;
        for (std::size_t at = 1; at < target.size();) {
            const std::size_t end = std::min(target.find('/', at), target.size());
            spec = spec->child(std::string_view(target).substr(at, end - at));
            if (spec == nullptr) return std::nullopt;
            path = target.substr(0, end);
            at = end + 1;
            if (at >= target.size() || !spec->isComposed()) continue;
            const UsdPrim above = expand(stack, *spec, path, {}, depth);
            return below(above, std::string_view(target).substr(at));
        }
        return expand(stack, *spec, path, stronger, depth);
    }

    static std::optional<UsdPrim> below(const UsdPrim& above, std::string_view rest) {
        const UsdPrim* prim = &above;
        while (!rest.empty()) {
            const std::size_t end = std::min(rest.find('/'), rest.size());
            prim = prim->child(rest.substr(0, end));
            if (prim == nullptr) return std::nullopt;
            rest.remove_prefix(std::min(end + 1, rest.size()));
        }
        return *prim;
    }

    UsdFiles files_;
    UsdValueClips clips_;
    std::map<std::string, Stack> stacks_;
    std::set<std::pair<const Stack*, std::string>> following_;
    UsdStage stage_;
    int depth_ = 0;
    std::size_t prims_ = 0;
    std::uint64_t numbers_ = 0;
};

}  // namespace

Result<UsdStage> openUsdStage(const std::string& file, std::vector<std::byte>&& bytes,
                              const std::filesystem::path& folder) {
    auto stage = Composer(file, folder).run(std::move(bytes));
    if (!stage) return tl::unexpected(inFile(stage.error(), file));
    return stage;
}

}  // namespace hairloom
