// SPDX-License-Identifier: GPL-3.0-or-later
// USD as text. What hair does not need is read over: dictionaries, relationships, variants that are not
// chosen.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

#include "importers/usd_stage.h"

namespace hairloom {

const UsdAttribute* UsdPrim::find(std::string_view attribute) const {
    const auto found = std::ranges::find(attributes, attribute, &UsdAttribute::name);
    return found == attributes.end() ? nullptr : &*found;
}
UsdAttribute* UsdPrim::find(std::string_view attribute) {
    const auto found = std::ranges::find(attributes, attribute, &UsdAttribute::name);
    return found == attributes.end() ? nullptr : &*found;
}

namespace {

/// "float", "half3[]", "point3f": names of types end in the letter of their precision behind their size.
bool isSingle(std::string_view type) {
    if (type.starts_with("float") || type.starts_with("half")) return true;
    if (type.ends_with("[]")) type.remove_suffix(2);
    return type.size() > 1 && (type.back() == 'f' || type.back() == 'h') && type[type.size() - 2] >= '2' &&
           type[type.size() - 2] <= '4';
}

constexpr int kMaxDepth = 128;

class Parser {
  public:
    Parser(const std::string& file, std::string_view text) : file_(file), text_(text) {}

    Result<UsdStage> run() {
        if (!text_.starts_with("#usda")) return error("is not USD text", "expected \"#usda 1.0\" first");
        if (parseLayer()) return std::move(stage_);
        return failIn(file_, Line{failedLine_}, problem_, expected_);
    }

  private:
    tl::unexpected<Error> error(std::string what, std::string expected) const {
        return failIn(file_, Line{line_}, std::move(what), std::move(expected));
    }

    /// Remembers the first thing that was wrong; the parser's functions then return false up to run().
    bool wrong(std::string what, std::string expected) {
        if (problem_.empty()) {
            problem_ = std::move(what);
            expected_ = std::move(expected);
            failedLine_ = line_;
        }
        return false;
    }

    // Characters and words

    void skip() {
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == '\n') ++line_;
            if (c == '#') {
                while (at_ < text_.size() && text_[at_] != '\n') ++at_;
            } else if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ';') {
                ++at_;
            } else {
                return;
            }
        }
    }
    bool atEnd() {
        skip();
        return at_ >= text_.size();
    }
    char peek() {
        skip();
        return at_ < text_.size() ? text_[at_] : '\0';
    }
    bool take(char c) {
        if (peek() != c) return false;
        ++at_;
        return true;
    }
    bool need(char c) {
        return take(c) || wrong(fmt::format("found {}", shown()), fmt::format("expected '{}'", c));
    }
    std::string shown() {
        if (atEnd()) return "the end";
        return fmt::format("'{}'",
                           std::string(text_.substr(at_, std::min<std::size_t>(12, text_.size() - at_))));
    }
    static bool isWordCharacter(char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == ':' || c == '.' || static_cast<unsigned char>(c) >= 0x80;
    }
    std::string_view word() {
        skip();
        const std::size_t start = at_;
        while (at_ < text_.size() && isWordCharacter(text_[at_])) ++at_;
        return text_.substr(start, at_ - start);
    }
    /// The next word, left where it is.
    std::string_view nextWord() {
        const std::size_t at = at_, line = line_;
        const std::string_view found = word();
        at_ = at;
        line_ = line;
        return found;
    }

    bool takeString(std::string& into) {
        const char quote = peek();
        if (quote != '"' && quote != '\'')
            return wrong(fmt::format("found {}", shown()), "expected a string");
        const std::string triple(3, quote);
        const bool isLong = text_.substr(at_).starts_with(triple);
        const std::string_view end =
            isLong ? std::string_view(triple) : std::string_view(triple).substr(0, 1);
        at_ += end.size();
        while (at_ < text_.size() && !text_.substr(at_).starts_with(end)) {
            if (text_[at_] == '\n') {
                if (!isLong) return wrong("a string is not closed", "expected its quotation mark");
                ++line_;
            }
            if (text_[at_] == '\\' && at_ + 1 < text_.size()) ++at_;
            into += text_[at_++];
        }
        if (at_ >= text_.size()) return wrong("a string is not closed", "expected its quotation mark");
        at_ += end.size();
        return true;
    }

    /// @path@ or <path>
    bool takeUntil(std::string_view close, std::string& into) {
        const std::size_t end = text_.find(close, at_);
        if (end == std::string_view::npos)
            return wrong("a path is not closed", fmt::format("expected '{}'", close));
        into = text_.substr(at_, end - at_);
        at_ = end + close.size();
        return true;
    }
    bool takeReference(std::string& into) {
        if (take('<')) return takeUntil(">", into);
        const std::string_view mark = text_.substr(at_).starts_with("@@@") ? "@@@" : "@";
        at_ += mark.size();
        if (!takeUntil(mark, into)) return false;
        if (peek() == '<') {
            std::string prim;
            return takeReference(prim);
        }
        return true;
    }

    // Values

    bool number(UsdValue& value) {
        const char* const begin = text_.data() + at_ + (peek() == '+' ? 1 : 0);
        double parsed = 0;
        const auto [end, code] = std::from_chars(begin, text_.data() + text_.size(), parsed);
        if (code == std::errc::invalid_argument)
            return wrong(fmt::format("found {}", shown()), "expected a number");
        // Too large or too small for a double: what is not finite is found where it is used.
        if (code == std::errc::result_out_of_range) parsed = std::numeric_limits<double>::infinity();
        at_ = static_cast<std::size_t>(end - text_.data());
        value.numbers.push_back(parsed);
        return true;
    }

    bool scalar(UsdValue& value) {
        const char c = peek();
        if (c == '"' || c == '\'') {
            value.texts.emplace_back();
            return takeString(value.texts.back());
        }
        if (c == '@' || c == '<') {
            value.texts.emplace_back();
            return takeReference(value.texts.back());
        }
        if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_') {
            const std::string_view name = word();
            if (name == "true" || name == "True")
                value.numbers.push_back(1);
            else if (name == "false" || name == "False")
                value.numbers.push_back(0);
            else if (name == "inf")
                value.numbers.push_back(std::numeric_limits<double>::infinity());
            else if (name == "nan")
                value.numbers.push_back(std::numeric_limits<double>::quiet_NaN());
            else if (name != "None")
                value.texts.emplace_back(name);
            return true;
        }
        if (c == '-' && text_.substr(at_).starts_with("-inf")) {
            at_ += 4;
            value.numbers.push_back(-std::numeric_limits<double>::infinity());
            return true;
        }
        return number(value);
    }

    /// A tuple, which may hold tuples (matrices).
    bool tuple(UsdValue& value, int depth) {
        if (depth > 4) return wrong("tuples are nested too deep", "expected a matrix at most");
        if (!need('(')) return false;
        while (!take(')')) {
            if (!(peek() == '(' ? tuple(value, depth + 1) : scalar(value))) return false;
            if (!take(',') && peek() != ')')
                return wrong(fmt::format("found {}", shown()), "expected ',' or ')'");
        }
        return true;
    }

    bool element(UsdValue& value) {
        const std::size_t before = value.numbers.size();
        if (peek() == '(') {
            if (!tuple(value, 0)) return false;
        } else if (!scalar(value)) {
            return false;
        }
        const auto size = static_cast<std::uint32_t>(value.numbers.size() - before);
        if (size == 0) return true;
        if (before == 0) value.components = size;
        return size == value.components || wrong(fmt::format("an element of {} numbers", size),
                                                 fmt::format("expected {}", value.components));
    }

    bool value(UsdValue& into) {
        if (peek() == '{') return dictionary();
        if (!take('[')) return element(into);
        while (!take(']')) {
            if (!element(into)) return false;
            // Lists of lists are in no attribute of curves.
            if (!take(',') && peek() != ']')
                return wrong(fmt::format("found {}", shown()), "expected ',' or ']'");
        }
        return true;
    }

    /// Read over, whatever is in it.
    bool dictionary() { return skipBlock('{', '}'); }

    bool skipBlock(char open, char close) {
        if (!need(open)) return false;
        int depth = 1;
        while (depth > 0) {
            if (atEnd()) return wrong("the file ends inside a block", fmt::format("expected '{}'", close));
            const char c = text_[at_];
            std::string ignored;
            if (c == '"' || c == '\'') {
                if (!takeString(ignored)) return false;
                continue;
            }
            if (c == '@') {
                if (!takeReference(ignored)) return false;
                continue;
            }
            depth += c == open ? 1 : c == close ? -1 : 0;
            ++at_;
        }
        return true;
    }

    bool samples(UsdAttribute& attribute) {
        if (!need('{')) return false;
        while (!take('}')) {
            UsdValue time;
            if (!number(time) || !need(':')) return false;
            UsdValue at;
            if (isSingle(attribute.type)) at.numbers.keepSingle();
            if (!value(at)) return false;
            attribute.samples.insert_or_assign(time.numbers.front(), std::move(at));
            if (!take(',') && peek() != '}')
                return wrong(fmt::format("found {}", shown()), "expected ',' or '}'");
        }
        return true;
    }

    // Metadata, properties, prims

    static bool isListWord(std::string_view name) {
        return name == "prepend" || name == "append" || name == "add" || name == "delete" ||
               name == "reorder";
    }

    /// "(key = value …)"; keys of prims that bring in other files are noted.
    template <class Use>
    bool metadata(Use use) {
        if (!take('(')) return true;
        while (!take(')')) {
            if (atEnd()) return wrong("the file ends inside metadata", "expected ')'");
            if (peek() == '"' || peek() == '\'') {
                std::string comment;
                if (!takeString(comment)) return false;
                continue;
            }
            std::string key(word());
            if (isListWord(key)) key = word();
            if (key.empty()) return wrong(fmt::format("found {}", shown()), "expected a name");
            if (!take('=')) continue;
            UsdValue found;
            if (peek() == '{') {
                if (!dictionary()) return false;
            } else if (!value(found)) {
                return false;
            }
            // Behind a reference there may be an offset in time.
            if (peek() == '(' && !skipBlock('(', ')')) return false;
            if (key == "references" || key == "payload" || key == "subLayers" || key == "inherits")
                stage_.notFollowed.insert(stage_.notFollowed.end(), found.texts.begin(), found.texts.end());
            use(key, std::move(found));
            take(',');
        }
        return true;
    }

    bool parseLayer() {
        if (!metadata(
                [&](const std::string& key, UsdValue found) { stage_.metadata[key] = std::move(found); }))
            return false;
        while (!atEnd()) {
            if (!prim(stage_.root, 0)) return false;
        }
        return true;
    }

    bool prim(UsdPrim& parent, int depth) {
        if (depth > kMaxDepth)
            return wrong("prims are nested too deep", fmt::format("expected {}", kMaxDepth));
        const std::string_view specifier = word();
        if (specifier != "def" && specifier != "over" && specifier != "class")
            return wrong(fmt::format("found '{}' {}", specifier, shown()), "expected def, over or class");
        UsdPrim child;
        child.isOver = specifier != "def";
        if (peek() != '"' && peek() != '\'') child.type = word();
        if (!takeString(child.name)) return false;
        if (!metadata([](const std::string&, const UsdValue&) {})) return false;
        if (!need('{')) return false;
        while (!take('}')) {
            if (atEnd()) return wrong("the file ends inside a prim", "expected '}'");
            if (!item(child, depth)) return false;
        }
        parent.children.push_back(std::move(child));
        return true;
    }

    bool item(UsdPrim& prim_, int depth) {
        const std::string_view first = nextWord();
        if (first == "def" || first == "over" || first == "class") return prim(prim_, depth + 1);
        if (first == "variantSet") return variantSet();
        return property(prim_);
    }

    /// Which variant is chosen is composition's business; what is in one is told to be left out.
    bool variantSet() {
        word();
        std::string name;
        if (!takeString(name)) return false;
        stage_.notFollowed.push_back("the variants \"" + name + "\"");
        return need('=') && skipBlock('{', '}');
    }

    bool property(UsdPrim& prim_) {
        UsdAttribute attribute;
        std::string_view type = word();
        while (type == "custom" || type == "uniform" || type == "varying" || type == "config" ||
               isListWord(type))
            type = word();
        if (type.empty()) return wrong(fmt::format("found {}", shown()), "expected a property");
        attribute.type = type;
        if (take('[')) {
            if (!need(']')) return false;
            attribute.type += "[]";
        }
        attribute.name = word();
        const bool isSampled = cut(attribute.name, ".timeSamples");
        const bool isConnection = cut(attribute.name, ".connect");
        if (take('=')) {
            if (isSingle(attribute.type)) attribute.value.numbers.keepSingle();
            if (!(isSampled ? samples(attribute) : value(attribute.value))) return false;
        }
        const auto use = [&](const std::string& key, const UsdValue& found) {
            if (key == "interpolation" && !found.texts.empty()) attribute.interpolation = found.texts.front();
            if (key == "elementSize" && !found.numbers.empty()) attribute.elementSize = found.numbers.front();
        };
        if (!metadata(use)) return false;
        if (type != "rel" && !isConnection && !attribute.name.empty()) keep(prim_, std::move(attribute));
        return true;
    }

    static bool cut(std::string& name, std::string_view ending) {
        if (!name.ends_with(ending)) return false;
        name.resize(name.size() - ending.size());
        return true;
    }

    /// An attribute's value, samples and metadata may stand in several lines.
    static void keep(UsdPrim& prim_, UsdAttribute attribute) {
        const auto found = std::ranges::find(prim_.attributes, attribute.name, &UsdAttribute::name);
        if (found == prim_.attributes.end()) {
            prim_.attributes.push_back(std::move(attribute));
            return;
        }
        if (!attribute.value.empty()) found->value = std::move(attribute.value);
        if (!attribute.samples.empty()) found->samples = std::move(attribute.samples);
        if (!attribute.interpolation.empty()) found->interpolation = std::move(attribute.interpolation);
    }

    const std::string& file_;
    std::string_view text_;
    std::size_t at_ = 0;
    std::uint64_t line_ = 1;
    std::string problem_, expected_;
    std::uint64_t failedLine_ = 0;
    UsdStage stage_;
};

}  // namespace

Result<UsdStage> readUsda(const std::string& file, std::string_view text) {
    return Parser(file, text).run();
}

}  // namespace hairloom
