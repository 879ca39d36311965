// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/numpy_array.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

#include "importers/obj_text.h"

namespace hairloom {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kMostSides = 8;

/// What stands behind 'key': in the header, which is a Python dictionary.
std::string_view textBehind(std::string_view header, std::string_view key) {
    const std::size_t at = header.find(key);
    if (at == header.npos) return {};
    const std::size_t colon = header.find(':', at);
    return colon == header.npos ? std::string_view() : trimmed(header.substr(colon + 1));
}

std::optional<std::vector<std::uint64_t>> shapeIn(std::string_view text) {
    const std::size_t end = text.find(')');
    if (!text.starts_with('(') || end == text.npos) return std::nullopt;
    text = text.substr(1, end - 1);
    std::vector<std::uint64_t> shape;
    while (!trimmed(text).empty()) {
        const std::size_t comma = std::min(text.find(','), text.size());
        const auto side = parseWhole(trimmed(text.substr(0, comma)));
        if (!side || *side < 0 || shape.size() == kMostSides) return std::nullopt;
        shape.push_back(static_cast<std::uint64_t>(*side));
        text.remove_prefix(std::min(text.size(), comma + 1));
    }
    return shape;
}

template <class From, class To>
To converted(const std::byte* at, bool isSwapped) {
    std::array<std::byte, sizeof(From)> bytes{};
    std::copy_n(at, sizeof(From), bytes.begin());
    if (isSwapped) std::ranges::reverse(bytes);
    From value;
    std::memcpy(&value, bytes.data(), sizeof value);
    if constexpr (std::is_integral_v<To> && std::is_floating_point_v<From>)
        return std::abs(value) < From{9e18f} ? static_cast<To>(value) : To{0};
    else
        return static_cast<To>(value);
}

template <class To>
To half(const std::byte* at, bool isSwapped) {
    const auto bits = converted<std::uint16_t, std::uint16_t>(at, isSwapped);
    const float value = Eigen::half_impl::half_to_float(Eigen::half_impl::raw_uint16_to_half(bits));
    return std::isfinite(value) || std::is_floating_point_v<To> ? static_cast<To>(value) : To{0};
}

template <class To>
To valueAt(const NumpyArray& array, std::uint64_t index) {
    const std::byte* const at = array.data.data() + index * array.bytesEach;
    const bool swap = array.isBigEndian;
    if (array.kind == 'f') {
        if (array.bytesEach == 2) return half<To>(at, swap);
        return array.bytesEach == 4 ? converted<float, To>(at, swap) : converted<double, To>(at, swap);
    }
    if (array.kind == 'i') {
        if (array.bytesEach == 1) return converted<std::int8_t, To>(at, swap);
        if (array.bytesEach == 2) return converted<std::int16_t, To>(at, swap);
        return array.bytesEach == 4 ? converted<std::int32_t, To>(at, swap)
                                    : converted<std::int64_t, To>(at, swap);
    }
    if (array.bytesEach == 1) return converted<std::uint8_t, To>(at, swap);
    if (array.bytesEach == 2) return converted<std::uint16_t, To>(at, swap);
    return array.bytesEach == 4 ? converted<std::uint32_t, To>(at, swap)
                                : converted<std::uint64_t, To>(at, swap);
}

template <class To>
std::vector<To> valuesOf(const NumpyArray& array) {
    std::vector<To> values(static_cast<std::size_t>(array.count()));
    if (!array.isFortran) {
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = valueAt<To>(array, i);
        return values;
    }
    // The first axis is the fastest: the place of each is told by its indices, which count up here.
    std::vector<std::uint64_t> index(array.shape.size(), 0);
    for (To& value : values) {
        std::uint64_t at = 0;
        for (std::size_t axis = array.shape.size(); axis-- > 0;) at = at * array.shape[axis] + index[axis];
        value = valueAt<To>(array, at);
        for (std::size_t axis = array.shape.size(); axis-- > 0;) {
            if (++index[axis] < array.shape[axis]) break;
            index[axis] = 0;
        }
    }
    return values;
}

}  // namespace

std::uint64_t NumpyArray::count() const {
    std::uint64_t count = 1;
    for (const std::uint64_t side : shape) count *= side;
    return count;
}

std::vector<float> NumpyArray::numbers() const {
    return valuesOf<float>(*this);
}

std::vector<std::int64_t> NumpyArray::whole() const {
    return valuesOf<std::int64_t>(*this);
}

std::string NumpyArray::words() const {
    return fmt::format("{} ({})", shortened(name), fmt::join(shape, ", "));
}

bool looksLikeNumpy(std::span<const std::byte> bytes) {
    return bytes.size() > kMagic.size() && std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) == 0;
}

Result<NumpyArray> readNumpy(const std::string& file, const std::string& name,
                             std::span<const std::byte> bytes) {
    const auto wrong = [&](std::uint64_t at, std::string problem, std::string expected) {
        return failIn(file, Byte{at}, fmt::format("{}: {}", shortened(name), problem), std::move(expected));
    };
    if (!looksLikeNumpy(bytes) || bytes.size() < 12) return wrong(0, "is no array", "expected a .npy file");
    const bool isLong = std::to_integer<int>(bytes[6]) >= 2;
    const std::size_t begin = isLong ? 12 : 10;
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 8, isLong ? 4 : 2);
    if (length > bytes.size() - begin)
        return wrong(8, fmt::format("announces a header of {} bytes", length),
                     fmt::format("it has {}", bytes.size() - begin));
    const std::string_view header(reinterpret_cast<const char*>(bytes.data() + begin), length);
    NumpyArray array;
    array.name = name;
    const std::string_view type = textBehind(header, "'descr'");
    if (type.starts_with("'|O") || type.starts_with("'O"))
        return wrong(begin, "holds Python objects (pickle), which are not read",
                     "expected plain numbers: points (N, 3) and a count of points for each strand");
    constexpr std::string_view kKinds = "fiub", kOrders = "<>|=";
    if (type.size() < 5 || kOrders.find(type[1]) == kOrders.npos || kKinds.find(type[2]) == kKinds.npos)
        return wrong(begin, fmt::format("holds values of type {}", shortened(type.substr(0, type.find(',')))),
                     "expected numbers");
    array.kind = type[2] == 'b' ? 'u' : type[2];
    array.isBigEndian = type[1] == '>';
    array.bytesEach = static_cast<std::size_t>(type[3] - '0');
    const bool isSize =
        array.bytesEach == 1 || array.bytesEach == 2 || array.bytesEach == 4 || array.bytesEach == 8;
    if (!isSize || type[4] != '\'' || (array.kind == 'f' && array.bytesEach == 1))
        return wrong(begin, fmt::format("holds values of type {}", shortened(type.substr(0, 6))),
                     "expected numbers of 1, 2, 4 or 8 bytes");
    array.isFortran = textBehind(header, "'fortran_order'").starts_with("True");
    auto shape = shapeIn(textBehind(header, "'shape'"));
    if (!shape) return wrong(begin, "has no shape", "expected 'shape': (N, …)");
    array.data = bytes.subspan(begin + length);
    std::uint64_t room = array.data.size() / array.bytesEach;
    for (const std::uint64_t side : *shape) {
        if (side > 0 && room / side == 0)
            return wrong(begin, fmt::format("announces ({}) numbers", fmt::join(*shape, ", ")),
                         fmt::format("{} bytes follow", array.data.size()));
        room = side > 0 ? room / side : room;
    }
    for (std::size_t axis = 0; axis < shape->size(); ++axis) {
        // Sides of one change no place, in either order.
        if ((*shape)[axis] != 1 || axis + 1 == shape->size()) array.shape.push_back((*shape)[axis]);
    }
    return array;
}

}  // namespace hairloom
