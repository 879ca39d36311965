// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/usdc_values.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "importers/usdc_packing.h"
#include "importers/usdc_types.h"

namespace hairloom {

using namespace usdc;

namespace {

std::size_t sizeOf(Type component) {
    switch (component) {
        case UChar:
            return 1;
        case Half:
            return 2;
        case Int64:
        case UInt64:
        case Double:
            return 8;
        default:
            return 4;
    }
}

template <class T>
T as(const std::byte* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

std::int64_t wholeAt(const std::byte* at, Type component) {
    switch (component) {
        case UChar:
            return std::to_integer<std::uint8_t>(*at);
        case Int:
            return as<std::int32_t>(at);
        case UInt:
            return as<std::uint32_t>(at);
        default:
            return as<std::int64_t>(at);
    }
}

bool isWhole(std::uint8_t component) {
    return component >= UChar && component <= UInt64;
}

double numberAt(const std::byte* at, Type component) {
    switch (component) {
        case Half:
            return static_cast<double>(
                static_cast<float>(Eigen::numext::bit_cast<Eigen::half>(as<std::uint16_t>(at))));
        case Double:
            return as<double>(at);
        default:
            return double{as<float>(at)};
    }
}

UsdNumbers::Kind kindOf(Type component) {
    if (component == Float || component == Half) return UsdNumbers::Kind::Single;
    return isWhole(component) ? UsdNumbers::Kind::Whole : UsdNumbers::Kind::Double;
}

}  // namespace

/// What the numbers of a type are, and how many of them an element has; 0 of what has none.
struct UsdcValues::Layout {
    Type component = Float;
    std::uint32_t count = 0;
};

UsdcValues::Layout UsdcValues::layoutOf(std::uint8_t type) {
    switch (type) {
        case Bool:
        case UChar:
            return {UChar, 1};
        case Int:
        case UInt:
        case Int64:
        case UInt64:
        case Half:
        case Float:
        case Double:
            return {static_cast<Type>(type), 1};
        case TimeCode:
            return {Double, 1};
        case Matrix2d:
            return {Double, 4};
        case Matrix3d:
            return {Double, 9};
        case Matrix4d:
            return {Double, 16};
        default:
            break;
    }
    constexpr std::array kQuats{Double, Float, Half};
    if (type >= Quatd && type <= Quath) return {kQuats[type - Quatd], 4};
    if (type < Vec2d || type > Vec4i) return {};
    constexpr std::array kVectors{Double, Float, Half, Int};
    return {kVectors[(type - Vec2d) % 4u], 2 + (type - Vec2d) / 4u};
}

Result<UsdValue> UsdcValues::valueOf(const UsdcValue& value) {
    UsdValue result;
    result.isBlock = value.type() == ValueBlock;
    // An edit of what a weaker layer has, which is told by the stage.
    if (value.isArrayEdit()) return result;
    if (value.type() == Token || value.type() == String || value.type() == AssetPath) return textsOf(value);
    const Layout layout = layoutOf(value.type());
    if (layout.count == 0) return result;
    result.components = layout.count;
    result.numbers.keep(kindOf(layout.component));
    if (value.isArray()) {
        if (auto status = readArray(value, layout, result.numbers); !status)
            return tl::unexpected(status.error());
    } else if (value.isInlined()) {
        inlined(value, layout, result.numbers);
    } else {
        if (auto status = in_.seek(value.payload(), "a value"); !status)
            return tl::unexpected(status.error());
        if (auto status = readPlain(layout, 1, result.numbers); !status)
            return tl::unexpected(status.error());
    }
    // The real part of a quaternion stands last here, and first in text.
    if (value.type() >= Quatd && value.type() <= Quath) {
        UsdNumbers& numbers = result.numbers;
        for (std::size_t i = 0; i + 3 < numbers.size(); i += 4) {
            const double real = numbers[i + 3];
            for (std::size_t k = i + 3; k > i; --k) numbers.set(k, numbers[k - 1]);
            numbers.set(i, real);
        }
    }
    return result;
}

/// Small values stand in the field itself: numbers of up to 32 bits, vectors and diagonals of whole
/// numbers of 8.
void UsdcValues::inlined(const UsdcValue& value, const Layout& layout, UsdNumbers& numbers) {
    const auto bits = static_cast<std::uint32_t>(value.payload());
    const auto small = [&](std::uint32_t index) {
        return static_cast<double>(static_cast<std::int8_t>(bits >> (8 * index) & 0xffu));
    };
    const std::byte* const at = reinterpret_cast<const std::byte*>(&bits);
    const bool isMatrix = value.type() >= Matrix2d && value.type() <= Matrix4d;
    if (isMatrix) {
        const std::uint32_t side = 2 + (value.type() - Matrix2d);
        for (std::uint32_t k = 0; k < side * side; ++k)
            numbers.push_back(k % (side + 1) == 0 ? small(k / (side + 1)) : 0.0);
    } else if (layout.count > 1) {
        for (std::uint32_t k = 0; k < layout.count; ++k) numbers.push_back(small(k));
    } else if (layout.component == Double) {
        numbers.push_back(double{as<float>(at)});
    } else if (layout.component == Int64) {
        numbers.pushWhole(as<std::int32_t>(at));
    } else if (layout.component == UInt64) {
        numbers.pushWhole(as<std::uint32_t>(at));
    } else if (isWhole(layout.component)) {
        numbers.pushWhole(wholeAt(at, layout.component));
    } else {
        numbers.push_back(numberAt(at, layout.component));
    }
}

Result<std::uint64_t> UsdcValues::arraySize(const UsdcValue& value) {
    if (auto status = in_.seek(value.payload(), "an array"); !status) return tl::unexpected(status.error());
    if (!file_.isSince(5)) {
        const auto rank = in_.read<std::uint32_t>("an array's rank");
        if (!rank) return tl::unexpected(rank.error());
    }
    if (file_.isSince(7)) return in_.read<std::uint64_t>("an array's size");
    const auto size = in_.read<std::uint32_t>("an array's size");
    if (!size) return tl::unexpected(size.error());
    return std::uint64_t{*size};
}

Status UsdcValues::readArray(const UsdcValue& value, const Layout& layout, UsdNumbers& numbers) {
    constexpr std::uint64_t kFewestCompressed = 16;
    if (value.payload() == 0) return {};
    const auto size = arraySize(value);
    if (!size) return tl::unexpected(size.error());
    if (!value.isCompressed() || *size < kFewestCompressed) return readPlain(layout, *size, numbers);
    if (layout.count != 1) return error("an array of vectors is packed", "expected plain ones");
    if (layout.component == Int || layout.component == UInt || layout.component == Int64 ||
        layout.component == UInt64)
        return readPacked(layout.component, *size, numbers);
    const auto code = in_.read<char>("how an array is packed");
    if (!code) return tl::unexpected(code.error());
    if (*code == 'i') return readPacked(Int, *size, numbers);
    if (*code != 't') return error("an array is packed in an unknown way", "expected 'i' or 't'");
    const auto entries = in_.read<std::uint32_t>("the size of a table");
    if (!entries) return tl::unexpected(entries.error());
    UsdNumbers table, places;
    places.keep(UsdNumbers::Kind::Whole);
    if (auto status = readPlain(layout, *entries, table); !status) return status;
    if (auto status = readPacked(UInt, *size, places); !status) return status;
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (places[i] >= static_cast<double>(table.size()))
            return error("a packed array names what its table does not have");
        numbers.push_back(table[static_cast<std::size_t>(places[i])]);
    }
    return {};
}

Status UsdcValues::readPlain(const Layout& layout, std::uint64_t count, UsdNumbers& numbers) {
    const std::size_t size = sizeOf(layout.component);
    if (count > in_.remaining() / (size * layout.count))
        return error(fmt::format("an array of {} elements goes beyond the end of the file", count));
    if (auto status = keep(count * layout.count); !status) return status;
    const auto bytes = file_.bytes().subspan(static_cast<std::size_t>(in_.position()),
                                             static_cast<std::size_t>(count) * size * layout.count);
    static_cast<void>(in_.seek(in_.position() + bytes.size(), "the end of an array"));
    numbers.reserve(bytes.size() / size);
    const bool whole = isWhole(layout.component);
    for (std::size_t at = 0; at < bytes.size(); at += size) {
        if (whole)
            numbers.pushWhole(wholeAt(bytes.data() + at, layout.component));
        else
            numbers.push_back(numberAt(bytes.data() + at, layout.component));
    }
    return {};
}

/// Fields may name the same bytes again and again: so many numbers of all of them together.
Status UsdcValues::keep(std::uint64_t numbers) {
    constexpr std::uint64_t kMaxNumbers = std::uint64_t{1} << 28u;
    kept_ += numbers;
    if (numbers > kMaxNumbers || kept_ > kMaxNumbers)
        return error("its values have more numbers than are kept",
                     fmt::format("expected at most {}", kMaxNumbers));
    return {};
}

Status UsdcValues::readPacked(std::uint8_t component, std::uint64_t count, UsdNumbers& numbers) {
    const auto size = in_.read<std::uint64_t>("the size of packed numbers");
    if (!size) return tl::unexpected(size.error());
    if (auto status = keep(count); !status) return status;
    if (*size > in_.remaining()) return error("packed numbers go beyond the end of the file");
    const auto packed =
        file_.bytes().subspan(static_cast<std::size_t>(in_.position()), static_cast<std::size_t>(*size));
    const auto take = [&](const auto& values) -> Status {
        if (!values) return error(values.error().problem, values.error().expected);
        numbers.reserve(values->size());
        for (const auto value : *values)
            numbers.pushWhole(component == UInt ? std::int64_t{static_cast<std::uint32_t>(value)}
                                                : std::int64_t{value});
        return {};
    };
    const bool isWide = component == Int64 || component == UInt64;
    if (auto status = isWide ? take(unpackIntegers64(packed, count)) : take(unpackIntegers32(packed, count));
        !status)
        return status;
    return in_.seek(in_.position() + packed.size(), "the end of packed numbers");
}

Result<UsdValue> UsdcValues::textsOf(const UsdcValue& value) {
    UsdValue result;
    if (!value.isArray() && value.isInlined()) {
        result.texts.push_back(value.type() == String ? file_.string(value.payload())
                                                      : file_.token(value.payload()));
        return result;
    }
    if (!value.isArray() || value.payload() == 0) return result;
    const auto count = arraySize(value);
    if (!count) return tl::unexpected(count.error());
    const auto indices = in_.readArray<std::uint32_t>(*count, "texts");
    if (!indices) return tl::unexpected(indices.error());
    for (const std::uint32_t index : *indices)
        result.texts.push_back(value.type() == Token ? file_.token(index) : file_.string(index));
    return result;
}

/// Goes where a number of bytes says that what follows stands.
Status UsdcValues::jump() {
    const std::uint64_t start = in_.position();
    const auto offset = in_.read<std::int64_t>("a jump");
    if (!offset) return tl::unexpected(offset.error());
    return in_.seek(start + static_cast<std::uint64_t>(*offset), "samples in time");
}

Status UsdcValues::readSamples(const UsdcValue& value, UsdAttribute& attribute) {
    if (value.isInlined() || value.type() != TimeSamples) return {};
    if (auto status = in_.seek(value.payload(), "samples in time"); !status) return status;
    if (auto status = jump(); !status) return status;
    const auto timesValue = in_.read<std::uint64_t>("the times of samples");
    if (!timesValue) return tl::unexpected(timesValue.error());
    const std::uint64_t behind = in_.position();
    const auto times = timesOf(UsdcValue{*timesValue});
    if (!times) return tl::unexpected(times.error());
    if (auto status = in_.seek(behind, "samples in time"); !status) return status;
    if (auto status = jump(); !status) return status;
    const auto count = in_.read<std::uint64_t>("the number of samples");
    if (!count) return tl::unexpected(count.error());
    if (*count != times->size()) return error(fmt::format("{} samples at {} times", *count, times->size()));
    const auto values = in_.readArray<std::uint64_t>(*count, "samples");
    if (!values) return tl::unexpected(values.error());
    for (std::size_t i = 0; i < values->size(); ++i) {
        auto sample = valueOf(UsdcValue{(*values)[i]});
        if (!sample) return tl::unexpected(sample.error());
        if (!std::isfinite((*times)[i])) return error("a time of a sample is not finite");
        attribute.samples.insert_or_assign((*times)[i], std::move(*sample));
    }
    return {};
}

Result<std::vector<double>> UsdcValues::timesOf(const UsdcValue& value) {
    if (value.type() == DoubleVector && !value.isInlined()) {
        if (auto status = in_.seek(value.payload(), "times"); !status) return tl::unexpected(status.error());
        const auto count = in_.read<std::uint64_t>("the number of times");
        if (!count) return tl::unexpected(count.error());
        return in_.readArray<double>(*count, "times");
    }
    auto times = valueOf(value);
    if (!times) return tl::unexpected(times.error());
    return times->numbers.doubles();
}

}  // namespace hairloom
