// SPDX-License-Identifier: GPL-3.0-or-later
// USD as text: layers. What hair does not need is read over: dictionaries, connections, splines.

#include <fmt/format.h>

#include <algorithm>

#include "importers/usda_scanner.h"

namespace hairloom {
namespace {

/// "float", "half3[]", "point3f": names of types end in the letter of their precision behind their size.
bool isSingle(std::string_view type) {
    if (type.starts_with("float") || type.starts_with("half")) return true;
    if (type.ends_with("[]")) type.remove_suffix(2);
    return type.size() > 1 && (type.back() == 'f' || type.back() == 'h') && type[type.size() - 2] >= '2' &&
           type[type.size() - 2] <= '4';
}

UsdNumbers::Kind kindOf(std::string_view type) {
    if (type.starts_with("int") || type.starts_with("uint") || type.starts_with("uchar"))
        return UsdNumbers::Kind::Whole;
    return isSingle(type) ? UsdNumbers::Kind::Single : UsdNumbers::Kind::Double;
}

bool cut(std::string& name, std::string_view ending) {
    if (!name.ends_with(ending)) return false;
    name.resize(name.size() - ending.size());
    return true;
}

enum class ListEdit : std::uint8_t { Explicit, Front, Back, Delete, Reorder };

std::optional<ListEdit> listEditOf(std::string_view word) {
    if (word == "prepend") return ListEdit::Front;
    if (word == "append" || word == "add") return ListEdit::Back;
    if (word == "delete") return ListEdit::Delete;
    if (word == "reorder") return ListEdit::Reorder;
    return std::nullopt;
}

constexpr int kMaxDepth = 128;

class Parser {
  public:
    explicit Parser(std::string_view text) : in_(text) {}

    bool run() { return parseLayer(); }
    UsdLayer take() { return std::move(layer_); }
    tl::unexpected<Error> error(const std::string& file) const { return in_.error(file); }

  private:
    bool found(const char* expected) { return in_.wrong(fmt::format("found {}", in_.shown()), expected); }

    // Metadata

    /// "(offset = 10; scale = 2)" behind a file.
    bool timeOffset(UsdTimeOffset& time) {
        if (!in_.take('(')) return true;
        while (!in_.take(')')) {
            if (in_.atEnd()) return in_.wrong("the file ends behind a file's name", "expected ')'");
            const std::string key(in_.word());
            if (key.empty()) return found("expected offset or scale");
            if (!in_.need('=')) return false;
            UsdValue value;
            if (!in_.value(value)) return false;
            if (!value.numbers.empty() && key == "offset") time.offset = value.numbers.front();
            if (!value.numbers.empty() && key == "scale") time.scale = value.numbers.front();
            in_.take(',');
        }
        return true;
    }

    /// "@file@</prim> (offset = 1)", "</prim>", a list of these, or None.
    bool arcs(std::vector<UsdArc>& into) {
        if (in_.nextWord() == "None") {
            in_.word();
            return true;
        }
        const bool isList = in_.take('[');
        while (!isList || !in_.take(']')) {
            UsdArc arc;
            if (in_.peek() == '@' && !in_.takeAsset(arc.asset)) return false;
            if (in_.peek() == '<' && !in_.takePath(arc.path)) return false;
            if (arc.asset.empty() && arc.path.empty()) return found("expected a file or a path");
            if (!timeOffset(arc.time)) return false;
            into.push_back(std::move(arc));
            if (!isList) return true;
            if (!in_.take(',') && in_.peek() != ']') return found("expected ',' or ']'");
        }
        return true;
    }

    /// Of a list's edits the one that is meant. `ignored` is of an order, which is not followed.
    template <class T>
    static std::vector<T>& editedList(UsdListEdits<T>& edits, ListEdit edit, std::vector<T>& ignored) {
        if (edit == ListEdit::Explicit) edits.isExplicit = true;
        return edit == ListEdit::Back      ? edits.appended
               : edit == ListEdit::Delete  ? edits.deleted
               : edit == ListEdit::Reorder ? ignored
                                           : edits.items;
    }

    bool arcs(UsdArcs& into, ListEdit edit) {
        std::vector<UsdArc> ignored;
        return arcs(editedList(into, edit, ignored));
    }

    /// "[1, 2]", or None.
    bool wholes(UsdListEdits<std::int64_t>& into, ListEdit edit) {
        std::vector<std::int64_t> ignored, &list = editedList(into, edit, ignored);
        UsdValue value;
        value.numbers.keep(UsdNumbers::Kind::Whole);
        if (!in_.value(value)) return false;
        for (std::size_t i = 0; i < value.numbers.size(); ++i) list.push_back(value.numbers.whole(i));
        return true;
    }

    /// { string lod = "high" }
    bool selections(std::map<std::string, std::string>& into) {
        if (!in_.need('{')) return false;
        while (!in_.take('}')) {
            if (in_.word() != "string") return found("expected string NAME = \"VARIANT\"");
            std::string set;
            if (in_.peek() == '"' || in_.peek() == '\'') {
                if (!in_.takeString(set)) return false;
            } else {
                set = in_.word();
            }
            if (!in_.need('=') || !in_.takeString(into[set])) return false;
        }
        return true;
    }

    /// { dictionary a = { string b = "text" } }, a value for each key: "a:b". `key` is of what it lies in.
    /// `keep` takes the key, the type and the value.
    template <class Keep>
    bool dictionary(const std::string& key, int depth, const Keep& keep) {
        if (depth > kMaxDepth)
            return in_.wrong("dictionaries are nested too deep", fmt::format("expected {}", kMaxDepth));
        if (!in_.need('{')) return false;
        while (!in_.take('}')) {
            const std::string type(in_.word());
            if (type.empty()) return found("expected TYPE NAME = VALUE");
            const bool isList = in_.take('[');
            if (isList && !in_.need(']')) return false;
            std::string name;
            if (in_.peek() == '"' || in_.peek() == '\'') {
                if (!in_.takeString(name)) return false;
            } else {
                name = in_.word();
            }
            if (!key.empty()) name = key + ':' + name;
            if (!in_.need('=')) return false;
            if (type == "dictionary") {
                if (!dictionary(name, depth + 1, keep)) return false;
            } else {
                UsdValue value;
                if (!in_.value(value)) return false;
                keep(name, isList ? type + "[]" : type, std::move(value));
            }
            in_.take(';'), in_.take(',');
        }
        return true;
    }

    bool customTexts(UsdPrim& prim_) {
        return dictionary({}, 0, [&](const std::string& key, const std::string& type, UsdValue&& value) {
            if (type == "string" && value.texts.size() == 1)
                prim_.customTexts[key] = std::move(value.texts.front());
        });
    }

    bool clips(UsdPrim& prim_) {
        return dictionary({}, 0, [&](const std::string& key, const std::string&, UsdValue&& value) {
            prim_.clips[key] = std::move(value);
        });
    }

    /// ["a", "b"], or None.
    bool texts(UsdListEdits<std::string>& into, ListEdit edit) {
        std::vector<std::string> ignored, &list = editedList(into, edit, ignored);
        UsdValue value;
        if (!in_.value(value)) return false;
        list.insert(list.end(), value.texts.begin(), value.texts.end());
        return true;
    }

    /// "(key = value …)": `use` takes what it knows of, with the edit that stands before, and says whether it
    /// did.
    template <class Use>
    bool metadata(Use use) {
        if (!in_.take('(')) return true;
        while (!in_.take(')')) {
            if (in_.atEnd()) return in_.wrong("the file ends inside metadata", "expected ')'");
            if (in_.peek() == '"' || in_.peek() == '\'') {
                std::string comment;
                if (!in_.takeString(comment)) return false;
                continue;
            }
            std::string key(in_.word());
            const std::optional<ListEdit> edit = listEditOf(key);
            if (edit) key = in_.word();
            if (key.empty()) return found("expected a name");
            if (!in_.take('=')) continue;
            bool good = true;
            if (!use(key, edit.value_or(ListEdit::Explicit), good)) {
                UsdValue ignored;
                good = in_.value(ignored);
            }
            if (!good) return false;
            if (in_.peek() == '(' && !in_.skipBlock('(', ')')) return false;
            in_.take(',');
        }
        return true;
    }

    bool parseLayer() {
        const auto use = [&](const std::string& key, ListEdit, bool& good) {
            if (key == "subLayers") {
                good = arcs(layer_.subLayers);
            } else if (key == "relocates") {
                layer_.leftOut.emplace_back("relocated prims are not followed");
                return false;
            } else if (in_.peek() == '{') {
                return false;
            } else {
                UsdValue value;
                good = in_.value(value);
                layer_.metadata[key] = std::move(value);
            }
            return true;
        };
        if (!metadata(use)) return false;
        while (!in_.atEnd()) {
            if (in_.nextWord() == "reorder") {
                if (!reorder()) return false;
            } else if (!prim(layer_.root, 0)) {
                return false;
            }
        }
        return true;
    }

    /// "reorder rootPrims = […]": the order that prims are listed in, which is no order of hair.
    bool reorder() {
        in_.word();
        in_.word();
        UsdValue ignored;
        return in_.need('=') && in_.value(ignored);
    }

    // Prims

    bool primMetadata(UsdPrim& prim_) {
        const auto text = [&](std::string& into) {
            UsdValue value;
            const bool good = in_.value(value);
            if (!value.texts.empty()) into = std::move(value.texts.front());
            return good;
        };
        const auto flag = [&](std::optional<bool>& into) {
            UsdValue value;
            const bool good = in_.value(value);
            if (!value.numbers.empty()) into = value.numbers.front() != 0;
            return good;
        };
        return metadata([&](const std::string& key, ListEdit edit, bool& good) {
            if (key == "active")
                good = flag(prim_.active);
            else if (key == "instanceable")
                good = flag(prim_.instanceable);
            else if (key == "displayName")
                good = text(prim_.displayName);
            else if (key == "references")
                good = arcs(prim_.references, edit);
            else if (key == "payload")
                good = arcs(prim_.payloads, edit);
            else if (key == "inherits")
                good = arcs(prim_.inherits, edit);
            else if (key == "specializes")
                good = arcs(prim_.specializes, edit);
            else if (key == "inactiveIds")
                good = wholes(prim_.inactiveIds, edit);
            else if (key == "variants")
                good = selections(prim_.selections);
            else if (key == "customData" && in_.peek() == '{')
                good = customTexts(prim_);
            else if (key == "clips" && in_.peek() == '{')
                good = clips(prim_);
            else if (key == "clipSets")
                good = texts(prim_.clipSets, edit);
            else
                return false;
            return true;
        });
    }

    bool prim(UsdPrim& parent, int depth) {
        const std::string_view specifier = in_.word();
        if (specifier != "def" && specifier != "over" && specifier != "class")
            return in_.wrong(fmt::format("found '{}' {}", specifier, in_.shown()),
                             "expected def, over or class");
        UsdPrim child;
        if (specifier == "def") child.specifier = UsdPrim::Specifier::Def;
        if (specifier == "class") child.specifier = UsdPrim::Specifier::Class;
        if (in_.peek() != '"' && in_.peek() != '\'') child.type = in_.word();
        if (!in_.takeString(child.name) || !primMetadata(child) || !body(child, depth)) return false;
        if (parent.child(child.name) != nullptr) layer_.repeated.push_back("prim " + child.name);
        parent.children.push_back(std::move(child));
        return true;
    }

    bool body(UsdPrim& prim_, int depth) {
        if (depth > kMaxDepth)
            return in_.wrong("prims are nested too deep", fmt::format("expected {}", kMaxDepth));
        if (!in_.need('{')) return false;
        while (!in_.take('}')) {
            if (in_.atEnd()) return in_.wrong("the file ends inside a prim", "expected '}'");
            const std::string_view first = in_.nextWord();
            const bool isPrim = first == "def" || first == "over" || first == "class";
            if (!(isPrim                  ? prim(prim_, depth + 1)
                  : first == "variantSet" ? variantSet(prim_, depth + 1)
                                          : property(prim_)))
                return false;
        }
        return true;
    }

    bool variantSet(UsdPrim& prim_, int depth) {
        in_.word();
        UsdVariantSet set;
        if (!in_.takeString(set.name) || !in_.need('=') || !in_.need('{')) return false;
        while (!in_.take('}')) {
            if (in_.atEnd()) return in_.wrong("the file ends inside variants", "expected '}'");
            UsdPrim variant;
            if (!in_.takeString(variant.name) || !primMetadata(variant) || !body(variant, depth))
                return false;
            set.variants.push_back(std::move(variant));
        }
        prim_.variantSets.push_back(std::move(set));
        return true;
    }

    // Properties

    bool samples(UsdAttribute& attribute) {
        if (!in_.need('{')) return false;
        while (!in_.take('}')) {
            UsdValue time, at;
            at.numbers.keep(kindOf(attribute.type));
            if (!in_.number(time) || !in_.need(':') || !in_.value(at)) return false;
            attribute.samples.insert_or_assign(time.numbers.front(), std::move(at));
            if (!in_.take(',') && in_.peek() != '}') return found("expected ',' or '}'");
        }
        return true;
    }

    bool property(UsdPrim& prim_) {
        UsdAttribute attribute;
        std::string_view type = in_.word();
        while (type == "custom" || type == "uniform" || type == "varying" || type == "config" ||
               listEditOf(type))
            type = in_.word();
        if (type.empty()) return found("expected a property");
        attribute.type = type;
        if (in_.take('[')) {
            if (!in_.need(']')) return false;
            attribute.type += "[]";
        }
        attribute.name = in_.word();
        const bool isSampled = cut(attribute.name, ".timeSamples");
        const bool isRead = !cut(attribute.name, ".connect") && !attribute.name.empty();
        if (in_.take('=')) {
            attribute.value.numbers.keep(kindOf(attribute.type));
            if (in_.nextWord() == "edit") {
                layer_.leftOut.push_back("the edit of the array " + attribute.name + " is not followed");
                in_.word();
                if (!in_.skipBlock('[', ']')) return false;
            } else if (cut(attribute.name, ".spline")) {
                layer_.leftOut.push_back("the spline of " + attribute.name + " is not followed");
                if (!in_.skipBlock('{', '}')) return false;
            } else if (!(isSampled ? samples(attribute) : in_.value(attribute.value))) {
                return false;
            }
        }
        const auto use = [&](const std::string& key, ListEdit, bool& good) {
            if (key != "interpolation" && key != "elementSize" && key != "displayName") return false;
            UsdValue value;
            good = in_.value(value);
            if (key == "interpolation" && !value.texts.empty()) attribute.interpolation = value.texts.front();
            if (key == "displayName" && !value.texts.empty()) attribute.displayName = value.texts.front();
            if (key == "elementSize" && !value.numbers.empty()) attribute.elementSize = value.numbers.front();
            return true;
        };
        if (!metadata(use)) return false;
        if (isRead) keep(prim_, std::move(attribute));
        return true;
    }

    /// An attribute's value, samples and metadata may stand in several lines, each of them once.
    void keep(UsdPrim& prim_, UsdAttribute attribute) {
        UsdAttribute* const found = prim_.find(attribute.name);
        if (found == nullptr) {
            prim_.attributes.push_back(std::move(attribute));
            return;
        }
        const bool valueTwice = found->value.isThere() && attribute.value.isThere();
        const bool samplesTwice = !found->samples.empty() && !attribute.samples.empty();
        if ((valueTwice || samplesTwice || found->type != attribute.type) && found->type != "rel")
            layer_.repeated.push_back(attribute.name + " of " + prim_.name);
        if (attribute.value.isThere()) found->value = std::move(attribute.value);
        if (!attribute.samples.empty()) found->samples = std::move(attribute.samples);
        if (!attribute.displayName.empty()) found->displayName = std::move(attribute.displayName);
        if (!attribute.interpolation.empty()) found->interpolation = std::move(attribute.interpolation);
        if (attribute.elementSize != 1) found->elementSize = attribute.elementSize;
    }

    UsdaScanner in_;
    UsdLayer layer_;
};

}  // namespace

Result<UsdLayer> readUsda(const std::string& file, std::string_view text) {
    if (!text.starts_with("#usda"))
        return failIn(file, Line{1}, "is not USD text", "expected \"#usda 1.0\" first");
    Parser parser(text);
    if (!parser.run()) return parser.error(file);
    return parser.take();
}

}  // namespace hairloom
