// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// As much of XML as tells whether a drawing is well-formed, and finds its elements.

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace hairloom::test {

struct XmlElement {
    std::string name;
    std::map<std::string, std::string> attributes;  ///< entities resolved
    std::string text;                               ///< of the element and all within it, entities resolved
};

/// All elements in the order of their start tags, or nothing where the text is not well-formed: tags that do
/// not match, repeated or unquoted attributes, a bare '<' or '&', anything after the root.
std::optional<std::vector<XmlElement>> parseXml(const std::string& text);

std::vector<XmlElement> named(const std::vector<XmlElement>& elements, const std::string& name);

}  // namespace hairloom::test
