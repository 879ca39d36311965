// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <utility>

#include "importers/obj_text.h"

namespace hairloom {
namespace {

// Every name in use, those of Turk's paper and those with a width.
constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes{{{"char", PlyType::Int8},
                                                                       {"int8", PlyType::Int8},
                                                                       {"uchar", PlyType::Uint8},
                                                                       {"uint8", PlyType::Uint8},
                                                                       {"short", PlyType::Int16},
                                                                       {"int16", PlyType::Int16},
                                                                       {"ushort", PlyType::Uint16},
                                                                       {"uint16", PlyType::Uint16},
                                                                       {"int", PlyType::Int32},
                                                                       {"int32", PlyType::Int32},
                                                                       {"uint", PlyType::Uint32},
                                                                       {"uint32", PlyType::Uint32},
                                                                       {"float", PlyType::Float32},
                                                                       {"float32", PlyType::Float32},
                                                                       {"double", PlyType::Float64},
                                                                       {"float64", PlyType::Float64}}};

std::optional<PlyType> typeNamed(std::string_view name) {
    const auto found = std::ranges::find(kTypes, name, &std::pair<std::string_view, PlyType>::first);
    if (found == kTypes.end()) return std::nullopt;
    return found->second;
}

class HeaderReader {
  public:
    HeaderReader(const std::string& file, std::string_view text) : file_(file), text_(text) {}

    Result<PlyHeader> read() {
        if (takeLine() != "ply" || !open_)
            return wrong("does not begin with the line 'ply'", "expected a PLY file");
        bool ended = false;
        while (!ended) {
            std::string_view rest = takeLine();
            if (!open_) return wrong("the header has no end", "expected a line 'end_header'");
            const std::string_view keyword = takeWord(rest);
            ended = keyword == "end_header";
            if (auto status = readLine(keyword, rest); !status) return tl::unexpected(status.error());
        }
        if (!hasFormat_) return wrong("the header has no format", "expected a line 'format'");
        header_.bodyOffset = position_;
        header_.lines = line_;
        return std::move(header_);
    }

  private:
    Status readLine(std::string_view keyword, std::string_view rest) {
        if (keyword == "format") return readFormat(rest);
        if (keyword == "element") return readElement(rest);
        if (keyword == "property") return readProperty(rest);
        const bool known =
            keyword.empty() || keyword == "comment" || keyword == "obj_info" || keyword == "end_header";
        if (known) return {};
        return wrong(fmt::format("found '{}'", shortened(keyword)),
                     "expected format, element, property, comment, obj_info or end_header");
    }

    Status readFormat(std::string_view rest) {
        const std::string_view name = takeWord(rest), version = takeWord(rest);
        const bool known = name == "ascii" || name == "binary_little_endian" || name == "binary_big_endian";
        if (!known || version != "1.0" || !takeWord(rest).empty()) {
            return wrong(fmt::format("the format is '{} {}'", shortened(name), shortened(version)),
                         "expected ascii, binary_little_endian or binary_big_endian and version 1.0");
        }
        header_.encoding = name == "ascii"                  ? PlyEncoding::Text
                           : name == "binary_little_endian" ? PlyEncoding::LittleEndian
                                                            : PlyEncoding::BigEndian;
        hasFormat_ = true;
        return {};
    }

    Status readElement(std::string_view rest) {
        PlyElement element;
        element.name = takeWord(rest);
        const std::string_view count = takeWord(rest);
        const auto [end, code] = std::from_chars(count.data(), count.data() + count.size(), element.count);
        const bool whole = code == std::errc() && end == count.data() + count.size();
        if (element.name.empty() || !whole || !takeWord(rest).empty()) {
            return wrong("an element without a name or a count", "expected 'element NAME COUNT'");
        }
        header_.elements.push_back(std::move(element));
        return {};
    }

    Status readProperty(std::string_view rest) {
        PlyProperty property;
        std::string_view typeName = takeWord(rest);
        if (typeName == "list") {
            const std::string_view sizeName = takeWord(rest);
            property.listSize = typeNamed(sizeName);
            const bool whole = property.listSize && *property.listSize < PlyType::Float32;
            if (!whole) return wrong(fmt::format("'{}' is not an integer type", shortened(sizeName)), "");
            typeName = takeWord(rest);
        }
        const auto type = typeNamed(typeName);
        if (!type)
            return wrong(fmt::format("'{}' is not a type", shortened(typeName)), "expected char … double");
        property.type = *type;
        property.name = takeWord(rest);
        if (property.name.empty() || !takeWord(rest).empty()) {
            return wrong("a property with too few or too many words", "expected 'property TYPE NAME'");
        }
        if (header_.elements.empty())
            return wrong("a property before any element", "expected 'element' first");
        header_.elements.back().properties.push_back(std::move(property));
        return {};
    }

    /// Without blanks at its end; open_ turns false where no line is left.
    std::string_view takeLine() {
        ++line_;
        const std::size_t end = text_.find('\n', position_);
        open_ = end != text_.npos;
        if (!open_) return {};
        std::string_view line = text_.substr(position_, end - position_);
        position_ = end + 1;
        while (line.ends_with('\r') || line.ends_with(' ')) line.remove_suffix(1);
        return line;
    }

    tl::unexpected<Error> wrong(std::string problem, std::string expected) const {
        return failIn(file_, Line{line_}, std::move(problem), std::move(expected));
    }

    std::string file_;
    std::string_view text_;
    PlyHeader header_;
    std::size_t position_ = 0;
    std::uint64_t line_ = 0;
    bool open_ = true;
    bool hasFormat_ = false;
};

}  // namespace

std::size_t sizeOf(PlyType type) {
    constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

std::optional<std::size_t> PlyElement::find(std::initializer_list<const char*> names) const {
    for (const char* wanted : names) {
        const auto found = std::ranges::find(properties, std::string_view(wanted), &PlyProperty::name);
        if (found != properties.end()) return static_cast<std::size_t>(found - properties.begin());
    }
    return std::nullopt;
}

Result<PlyHeader> readPlyHeader(const std::string& file, std::span<const std::byte> bytes) {
    return HeaderReader(file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()))
        .read();
}

}  // namespace hairloom
