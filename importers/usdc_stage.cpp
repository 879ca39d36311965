// SPDX-License-Identifier: GPL-3.0-or-later
// Binary USD as a layer: prims, variants and attributes from its table of paths.

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <unordered_map>

#include "importers/usdc_values.h"

namespace hairloom {
namespace {

constexpr std::uint32_t kMaxDepth = 128;  ///< of prims in each other

class Reader {
  public:
    explicit Reader(const UsdcFile& file) : file_(file), values_(file) {}

    Result<UsdLayer> run() {
        const auto& paths = file_.paths();
        specs_.resize(paths.size(), nullptr);
        for (const UsdcSpec& spec : file_.specs()) {
            if (specs_[spec.path] != nullptr) layer_.repeated.push_back(file_.pathText(spec.path));
            specs_[spec.path] = &spec;
        }
        children_.resize(paths.size());
        for (std::uint32_t path = 0; path < paths.size(); ++path) {
            const bool isKnown = specs_[path] != nullptr && paths[path].parent < paths.size();
            if (isKnown) children_[paths[path].parent].push_back(path);
        }
        const auto root = std::ranges::find(file_.specs(), kUsdcRoot, &UsdcSpec::type);
        if (root == file_.specs().end()) return failIn(file_.name(), {}, "has no root", "expected a stage");
        if (auto status = readRoot(*root); !status) return tl::unexpected(status.error());
        return std::move(layer_);
    }

  private:
    Status readRoot(const UsdcSpec& root) {
        std::vector<std::string> childNames;
        UsdcValue layers, times;
        for (const UsdcField& field : file_.fieldsOf(root)) {
            const std::string& name = file_.token(field.token);
            if (name == "primChildren") {
                childNames = values_.tokensOf(field.value);
            } else if (name == "subLayers") {
                layers = field.value;
            } else if (name == "subLayerOffsets") {
                times = field.value;
            } else if (name == "relocates" || name == "layerRelocates") {
                layer_.leftOut.emplace_back("relocated prims are not followed");
            } else {
                auto value = values_.valueOf(field.value);
                if (!value) return tl::unexpected(value.error());
                if (value->isThere()) layer_.metadata[name] = std::move(*value);
            }
        }
        auto below = values_.subLayersOf(layers, times);
        if (!below) return tl::unexpected(below.error());
        layer_.subLayers = std::move(*below);
        return addChildren(root.path, layer_.root, 0, childNames);
    }

    /// `names` are the layer's order of prims; the file lists them in any.
    Status addChildren(std::uint32_t path, UsdPrim& prim, std::uint32_t depth,
                       const std::vector<std::string>& names) {
        if (depth > kMaxDepth)
            return failIn(file_.name(), {}, "prims are nested too deep",
                          fmt::format("expected {}", kMaxDepth));
        std::unordered_map<std::string_view, std::size_t> places;
        for (std::size_t i = 0; i < names.size(); ++i) places.emplace(names[i], i);
        std::vector<std::uint32_t> order = children_[path];
        const auto place = [&](std::uint32_t child) {
            const auto found = places.find(file_.token(file_.paths()[child].token));
            return found == places.end() ? names.size() : found->second;
        };
        std::ranges::stable_sort(order, {}, place);
        std::set<std::string_view> seen;
        for (const std::uint32_t child : order) {
            if (!seen.insert(file_.token(file_.paths()[child].token)).second)
                layer_.repeated.push_back(file_.pathText(child));
            if (auto status = addChild(child, prim, depth); !status) return status;
        }
        return {};
    }

    Status addChild(std::uint32_t path, UsdPrim& prim, std::uint32_t depth) {
        switch (specs_[path]->type) {
            case kUsdcPrim: {
                UsdPrim child;
                child.name = file_.token(file_.paths()[path].token);
                if (auto status = readPrim(path, child, depth); !status) return status;
                prim.children.push_back(std::move(child));
                return {};
            }
            case kUsdcAttribute:
                return addAttribute(path, prim);
            case kUsdcRelationship:
                return addRelationship(path, prim);
            case kUsdcVariant:
                return addVariant(path, prim, depth);
            default:
                return {};
        }
    }

    Status readArcs(const std::string& name, const UsdcValue& value, UsdPrim& prim) {
        UsdArcs* const into = name == "references"     ? &prim.references
                              : name == "payload"      ? &prim.payloads
                              : name == "inheritPaths" ? &prim.inherits
                              : name == "specializes"  ? &prim.specializes
                                                       : nullptr;
        if (into == nullptr) return {};
        auto arcs = values_.arcsOf(value);
        if (!arcs) return tl::unexpected(arcs.error());
        *into = std::move(*arcs);
        return {};
    }

    Status readPrim(std::uint32_t path, UsdPrim& prim, std::uint32_t depth) {
        std::vector<std::string> childNames;
        for (const UsdcField& field : file_.fieldsOf(*specs_[path])) {
            const std::string& name = file_.token(field.token);
            const std::uint64_t payload = field.value.payload();
            if (name == "typeName") prim.type = file_.token(payload);
            if (name == "specifier")
                prim.specifier = payload == 0   ? UsdPrim::Specifier::Def
                                 : payload == 2 ? UsdPrim::Specifier::Class
                                                : UsdPrim::Specifier::Over;
            if (name == "active") prim.active = payload != 0;
            if (name == "instanceable") prim.instanceable = payload != 0;
            if (name == "displayName") prim.displayName = file_.string(payload);
            if (name == "primChildren") childNames = values_.tokensOf(field.value);
            if (name == "variantSelection") {
                auto selections = values_.selectionsOf(field.value);
                if (!selections) return tl::unexpected(selections.error());
                prim.selections = std::move(*selections);
            }
            if (name == "inactiveIds") {
                auto ids = values_.wholesOf(field.value);
                if (!ids) return tl::unexpected(ids.error());
                prim.inactiveIds = std::move(*ids);
            }
            if (name == "customData") {
                auto texts = values_.textsIn(field.value);
                if (!texts) return tl::unexpected(texts.error());
                prim.customTexts = std::move(*texts);
            }
            if (name == "clips") {
                auto clips = values_.valuesIn(field.value);
                if (!clips) return tl::unexpected(clips.error());
                prim.clips = std::move(*clips);
            }
            if (name == "clipSets") {
                auto sets = values_.textEditsOf(field.value);
                if (!sets) return tl::unexpected(sets.error());
                prim.clipSets = std::move(*sets);
            }
            if (auto status = readArcs(name, field.value, prim); !status) return status;
        }
        return addChildren(path, prim, depth + 1, childNames);
    }

    /// "{lod=high}": a variant of the set that is called so.
    Status addVariant(std::uint32_t path, UsdPrim& prim, std::uint32_t depth) {
        const std::string& element = file_.token(file_.paths()[path].token);
        const std::size_t equals = element.find('=');
        if (element.size() < 3 || element.front() != '{' || element.back() != '}' ||
            equals == std::string::npos)
            return {};
        const std::string set = element.substr(1, equals - 1);
        UsdPrim variant;
        variant.name = element.substr(equals + 1, element.size() - equals - 2);
        if (auto status = readPrim(path, variant, depth); !status) return status;
        auto found = std::ranges::find(prim.variantSets, set, &UsdVariantSet::name);
        if (found == prim.variantSets.end())
            found = prim.variantSets.insert(prim.variantSets.end(), UsdVariantSet{set, {}});
        found->variants.push_back(std::move(variant));
        return {};
    }

    Status addRelationship(std::uint32_t path, UsdPrim& prim) {
        UsdAttribute relationship;
        relationship.type = "rel";
        relationship.name = file_.token(file_.paths()[path].token);
        for (const UsdcField& field : file_.fieldsOf(*specs_[path])) {
            if (file_.token(field.token) != "targetPaths") continue;
            auto paths = values_.pathsOf(field.value);
            if (!paths) return tl::unexpected(paths.error());
            relationship.value.texts = std::move(*paths);
        }
        prim.attributes.push_back(std::move(relationship));
        return {};
    }

    Status addAttribute(std::uint32_t path, UsdPrim& prim) {
        UsdAttribute attribute;
        attribute.name = file_.token(file_.paths()[path].token);
        for (const UsdcField& field : file_.fieldsOf(*specs_[path])) {
            const std::string& name = file_.token(field.token);
            if (name == "typeName") attribute.type = file_.token(field.value.payload());
            if (name == "displayName") attribute.displayName = file_.string(field.value.payload());
            if (name == "interpolation") attribute.interpolation = file_.token(field.value.payload());
            if (name == "spline")
                layer_.leftOut.push_back("the spline of " + attribute.name + " is not followed");
            if (name != "default" && name != "elementSize" && name != "timeSamples") continue;
            if (name == "timeSamples") {
                if (auto status = values_.readSamples(field.value, attribute); !status) return status;
                continue;
            }
            if (field.value.isArrayEdit())
                layer_.leftOut.push_back("the edit of the array " + attribute.name + " is not followed");
            auto value = values_.valueOf(field.value);
            if (!value) return tl::unexpected(value.error());
            if (name == "default") attribute.value = std::move(*value);
            if (name == "elementSize" && !value->numbers.empty())
                attribute.elementSize = value->numbers.front();
        }
        prim.attributes.push_back(std::move(attribute));
        return {};
    }

    const UsdcFile& file_;
    UsdcValues values_;
    UsdLayer layer_;
    std::vector<std::vector<std::uint32_t>> children_;
    std::vector<const UsdcSpec*> specs_;
};

}  // namespace

Result<UsdLayer> readUsdc(const std::string& file, std::span<const std::byte> bytes) {
    const auto crate = UsdcFile::open(file, bytes);
    if (!crate) return tl::unexpected(crate.error());
    return Reader(*crate).run();
}

}  // namespace hairloom
