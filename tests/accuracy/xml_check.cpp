// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/accuracy/xml_check.h"

#include <cctype>

namespace hairloom::test {
namespace {

class Parser {
  public:
    explicit Parser(const std::string& text) : text_(text) {}

    std::optional<std::vector<XmlElement>> run() {
        skipSpace();
        if (!element()) return std::nullopt;
        skipSpace();
        if (at_ != text_.size()) return std::nullopt;
        return elements_;
    }

  private:
    bool have(const std::string& token) const { return text_.compare(at_, token.size(), token) == 0; }
    bool take(const std::string& token) {
        if (!have(token)) return false;
        at_ += token.size();
        return true;
    }
    void skipSpace() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    }
    std::string name() {
        const std::size_t from = at_;
        while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) ||
                                      text_[at_] == '-' || text_[at_] == ':' || text_[at_] == '_')) {
            ++at_;
        }
        return text_.substr(from, at_ - from);
    }

    /// One character of content, an entity as what it stands for.
    bool character(std::string& into) {
        static const std::map<std::string, char> kEntities{
            {"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&#39;", '\''}};
        if (text_[at_] == '<' || static_cast<unsigned char>(text_[at_]) < 9) return false;
        if (text_[at_] != '&') {
            into += text_[at_++];
            return true;
        }
        for (const auto& [entity, meant] : kEntities) {
            if (take(entity)) {
                into += meant;
                return true;
            }
        }
        return false;
    }

    bool attribute(XmlElement& owner) {
        const std::string key = name();
        if (key.empty() || !take("=\"")) return false;
        std::string value;
        while (at_ < text_.size() && text_[at_] != '"') {
            if (!character(value)) return false;
        }
        return take("\"") && owner.attributes.emplace(key, value).second;
    }

    bool element() {
        if (!take("<")) return false;
        XmlElement found;
        found.name = name();
        if (found.name.empty()) return false;
        while (true) {
            const std::size_t before = at_;
            skipSpace();
            if (have("/>") || have(">")) break;
            if (at_ == before || !attribute(found)) return false;
        }
        const std::size_t index = elements_.size();
        elements_.push_back(found);
        if (take("/>")) return true;
        if (!take(">")) return false;
        std::string text;
        while (at_ < text_.size() && !have("</")) {
            if (have("<")) {
                const std::size_t child = elements_.size();
                if (!element()) return false;
                text += elements_[child].text;
            } else if (!character(text)) {
                return false;
            }
        }
        elements_[index].text = text;
        return take("</" + found.name + ">");
    }

    const std::string& text_;
    std::size_t at_ = 0;
    std::vector<XmlElement> elements_;
};

}  // namespace

std::optional<std::vector<XmlElement>> parseXml(const std::string& text) {
    return Parser(text).run();
}

std::vector<XmlElement> named(const std::vector<XmlElement>& elements, const std::string& name) {
    std::vector<XmlElement> found;
    for (const XmlElement& element : elements) {
        if (element.name == name) found.push_back(element);
    }
    return found;
}

}  // namespace hairloom::test
