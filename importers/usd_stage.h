// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// USD as far as hair needs it: layers as files have them, and the stage that they compose.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "importers/usd_numbers.h"

namespace hairloom {

/// Numbers, or texts.
struct UsdValue {
    UsdNumbers numbers;
    std::uint32_t components = 1;  ///< numbers of one element
    std::vector<std::string> texts;
    bool isBlock = false;  ///< "None": there is no value, whatever weaker layers say

    bool empty() const { return numbers.empty() && texts.empty(); }
    bool isThere() const { return isBlock || !empty(); }
};

/// An attribute; or a relationship, whose type is "rel" and whose texts are paths.
struct UsdAttribute {
    std::string type;  ///< "float3[]"
    std::string name;  ///< "primvars:groom_id"
    UsdValue value;    ///< without a time; may be empty
    std::map<double, UsdValue> samples;
    std::string interpolation;  ///< "vertex" …, or empty
    std::string displayName;    ///< for people; may be empty
    double elementSize = 1;
    bool isOfClips = false;  ///< value clips alone have it, which declare nothing

    bool hasValue() const { return value.isThere() || !samples.empty(); }
};

/// Time of a layer in that of whoever brings it in: t · scale + offset.
struct UsdTimeOffset {
    double offset = 0, scale = 1;

    double at(double code) const { return code * scale + offset; }
};

/// What brings a prim in: of the same layers, or of a file.
struct UsdArc {
    std::string asset;  ///< as the layer names the file; empty: of the same layers
    std::string path;   ///< of the prim; empty: the default one
    UsdTimeOffset time;
    std::string from;  ///< the layer that says so (UsdFiles)
};

inline bool isSame(const UsdArc& a, const UsdArc& b) {
    return a.asset == b.asset && a.path == b.path;
}
inline bool isSame(std::int64_t a, std::int64_t b) {
    return a == b;
}
inline bool isSame(const std::string& a, const std::string& b) {
    return a == b;
}

/// A list as a layer edits it.
template <class T>
struct UsdListEdits {
    bool isExplicit = false;  ///< `items` are all there are; otherwise they are put before or behind
    std::vector<T> items, appended, deleted;

    bool empty() const { return items.empty() && appended.empty() && deleted.empty() && !isExplicit; }
    /// In order of strength.
    std::vector<T> all() const;
    /// What a weaker layer says is edited by what this one says.
    void over(const UsdListEdits& weaker);
};
using UsdArcs = UsdListEdits<UsdArc>;

struct UsdVariantSet;

/// Of a dictionary and those in it, by their keys: "default:assetPaths".
using UsdDictionary = std::map<std::string, UsdValue, std::less<>>;

struct UsdPrim {
    enum class Specifier : std::uint8_t { Def, Over, Class };
    std::string type, name;
    Specifier specifier = Specifier::Over;
    std::optional<bool> active, instanceable;
    std::string displayName;  ///< for people; may be empty
    /// Texts of its customData, by their keys in dictionaries: "hairloom:settings".
    std::map<std::string, std::string, std::less<>> customTexts;
    std::vector<UsdAttribute> attributes;
    std::vector<UsdPrim> children;
    UsdArcs inherits, references, payloads, specializes;
    UsdListEdits<std::int64_t> inactiveIds;         ///< instances that an instancer leaves out
    std::map<std::string, std::string> selections;  ///< variant of each set
    std::vector<UsdVariantSet> variantSets;
    UsdDictionary clips;                 ///< values that lie in other files, time by time: sets of these
    UsdListEdits<std::string> clipSets;  ///< their order

    const UsdAttribute* find(std::string_view attribute) const;
    UsdAttribute* find(std::string_view attribute);
    const UsdPrim* child(std::string_view childName) const;
    /// Whether other prims are needed to know what it is.
    bool isComposed() const;
};

struct UsdVariantSet {
    std::string name;
    std::vector<UsdPrim> variants;  ///< by their names
};

using UsdMetadata = std::map<std::string, UsdValue, std::less<>>;  ///< upAxis, metersPerUnit …

/// The metadata's first number.
double usdNumber(const UsdMetadata& metadata, std::string_view name, double otherwise);

/// One file.
struct UsdLayer {
    UsdPrim root;
    UsdMetadata metadata;
    std::vector<UsdArc> subLayers;      ///< the strongest first
    std::vector<std::string> repeated;  ///< properties and prims that stand twice, which USD refuses
    std::vector<std::string> leftOut;   ///< what there is and is not read
};

/// A layer of text. Errors with the line.
Result<UsdLayer> readUsda(const std::string& file, std::string_view text);
/// A binary layer. Errors with the byte.
Result<UsdLayer> readUsdc(const std::string& file, std::span<const std::byte> bytes);

/// Prims without arcs, and what was made of these.
struct UsdStage {
    UsdPrim root;
    UsdMetadata metadata;
    std::vector<std::string> repeated;
    std::vector<std::string> notFollowed;  ///< "payload "a.usd" of /groom: no such file"
    std::vector<std::string> chosen;       ///< "variant "high" of "lod" of /groom"
};

/// The stage of a file, in text, binary or a package, composed of other files in `folder` (which may be
/// empty: none are opened). Errors: no USD, damage in the file itself, a stage larger than is kept. What is
/// wrong with other files is told by `notFollowed`.
Result<UsdStage> openUsdStage(const std::string& file, std::vector<std::byte>&& bytes,
                              const std::filesystem::path& folder);

}  // namespace hairloom
