// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/ply_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "importers/obj_text.h"

namespace hairloom {
namespace {

constexpr const char* kWholeFile = "expected a whole file: export it again";

template <class T>
double as(const std::array<char, 8>& bytes) {
    T value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return static_cast<double>(value);
}

}  // namespace

tl::unexpected<Error> PlyRows::wrong(std::string problem, std::string expected) const {
    const Place place = encoding_ == PlyEncoding::Text ? Place(Line{line_}) : Place(Byte{position_});
    return failIn(file_, place, std::move(problem), std::move(expected));
}

Status PlyRows::checkCount(const PlyElement& element) const {
    if (element.count <= remaining()) return {};
    return wrong(fmt::format("{} rows of '{}' were announced, and {} bytes are left", element.count,
                             element.name, remaining()),
                 kWholeFile);
}

Result<double> PlyRows::nextWord() {
    while (position_ < text_.size() && isBlank(text_[position_])) line_ += text_[position_++] == '\n';
    const std::size_t begin = position_;
    while (position_ < text_.size() && !isBlank(text_[position_])) ++position_;
    const std::string_view word = text_.substr(begin, position_ - begin);
    if (word.empty()) return wrong("the file ends early", kWholeFile);
    const auto number = parseNumber(word);
    if (!number) return wrong(fmt::format("'{}' is not a number", shortened(word)), "expected a number");
    return *number;
}

Result<double> PlyRows::nextBinary(PlyType type) {
    const std::size_t size = sizeOf(type);
    if (remaining() < size) return wrong("the file ends early", kWholeFile);
    std::array<char, 8> bytes{};
    std::memcpy(bytes.data(), text_.data() + position_, size);
    if (encoding_ == PlyEncoding::BigEndian) std::reverse(bytes.begin(), bytes.begin() + size);
    position_ += size;
    switch (type) {
        case PlyType::Int8:
            return as<std::int8_t>(bytes);
        case PlyType::Uint8:
            return as<std::uint8_t>(bytes);
        case PlyType::Int16:
            return as<std::int16_t>(bytes);
        case PlyType::Uint16:
            return as<std::uint16_t>(bytes);
        case PlyType::Int32:
            return as<std::int32_t>(bytes);
        case PlyType::Uint32:
            return as<std::uint32_t>(bytes);
        case PlyType::Float32:
            return as<float>(bytes);
        case PlyType::Float64:
            return as<double>(bytes);
    }
    return wrong("a value of an unknown type", "expected a type of PLY, as float");
}

Status PlyRows::row(const PlyElement& element, PlyRow& row) {
    row.values.resize(element.properties.size());
    row.lists.resize(element.properties.size());
    for (std::size_t index = 0; index < element.properties.size(); ++index) {
        const PlyProperty& property = element.properties[index];
        if (!property.listSize) {
            const auto value = next(property.type);
            if (!value) return tl::unexpected(value.error());
            row.values[index] = *value;
            continue;
        }
        const auto count = next(*property.listSize);
        if (!count) return tl::unexpected(count.error());
        if (!(*count >= 0) || *count > static_cast<double>(remaining())) {
            return wrong(fmt::format("a list of {} values, and {} bytes are left", *count, remaining()),
                         kWholeFile);
        }
        row.lists[index].clear();
        for (double entry = 0; entry < *count; ++entry) {
            const auto value = next(property.type);
            if (!value) return tl::unexpected(value.error());
            row.lists[index].push_back(*value);
        }
    }
    return {};
}

}  // namespace hairloom
