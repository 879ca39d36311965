// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/usdc_packing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace hairloom {
namespace {

/// More than curve files have; the packed form of so many that are alike takes a kilobyte a million.
constexpr std::uint64_t kMaxIntegers = std::uint64_t{1} << 28u;
/// One byte of LZ4 stands for at most 255 of what it packs.
constexpr std::uint64_t kMaxPerByte = 255;

tl::unexpected<Error> damaged() {
    return fail("packed bytes are damaged", "expected blocks of LZ4");
}

/// A length of four bits, and more bytes of it where they are all set.
bool takeLength(std::span<const std::byte>& in, std::size_t& length) {
    if (length != 15) return true;
    for (std::uint8_t more = 255; more == 255;) {
        if (in.empty()) return false;
        more = std::to_integer<std::uint8_t>(in.front());
        length += more;
        in = in.subspan(1);
    }
    return true;
}

/// One block as the LZ4 block format has it: literals and copies from at most 65,535 bytes before, in turns.
Status unpackBlock(std::span<const std::byte> in, std::uint64_t size, std::vector<std::byte>& out) {
    const std::size_t start = out.size();
    while (!in.empty()) {
        const auto token = std::to_integer<std::uint8_t>(in.front());
        in = in.subspan(1);
        std::size_t literals = token >> 4u;
        if (!takeLength(in, literals) || literals > in.size() || literals > size - out.size())
            return damaged();
        out.insert(out.end(), in.begin(), in.begin() + static_cast<std::ptrdiff_t>(literals));
        in = in.subspan(literals);
        if (in.empty()) return {};
        if (in.size() < 2) return damaged();
        const std::size_t back = std::to_integer<std::size_t>(in[0]) | std::to_integer<std::size_t>(in[1])
                                                                           << 8u;
        in = in.subspan(2);
        std::size_t copied = token & 15u;
        if (!takeLength(in, copied)) return damaged();
        copied += 4;
        if (back == 0 || back > out.size() - start || copied > size - out.size()) return damaged();
        // A copy may reach into what it makes.
        for (std::size_t i = 0; i < copied; ++i) out.push_back(out[out.size() - back]);
    }
    return {};
}

template <class T>
T valueAt(std::span<const std::byte> bytes, std::size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/// Two bits a number say how its difference stands: the common one, or in a quarter, a half or all of T's
/// bytes.
template <class T, class Quarter, class Half>
Result<std::vector<T>> unpackIntegers(std::span<const std::byte> packed, std::uint64_t count) {
    if (count == 0) return std::vector<T>();
    if (count > packed.size() * kMaxPerByte * 4 || count > kMaxIntegers)
        return fail(fmt::format("{} whole numbers in {} bytes", count, packed.size()),
                    "expected a count that fits");
    const std::size_t codes = static_cast<std::size_t>((count * 2 + 7) / 8);
    const auto bytes = unpackBytes(packed, sizeof(T) + codes + count * sizeof(T));
    if (!bytes) return tl::unexpected(bytes.error());
    if (bytes->size() < sizeof(T) + codes) return damaged();
    const T common = valueAt<T>(*bytes, 0);
    std::vector<T> values(static_cast<std::size_t>(count));
    std::size_t at = sizeof(T) + codes;
    using Unsigned = std::make_unsigned_t<T>;
    Unsigned previous = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto code = std::to_integer<unsigned>((*bytes)[sizeof(T) + i / 4]) >> (2 * (i % 4)) & 3u;
        constexpr std::size_t kSizes[] = {0, sizeof(Quarter), sizeof(Half), sizeof(T)};
        if (kSizes[code] > bytes->size() - at) return damaged();
        const T difference = code == 0   ? common
                             : code == 1 ? T{valueAt<Quarter>(*bytes, at)}
                             : code == 2 ? T{valueAt<Half>(*bytes, at)}
                                         : valueAt<T>(*bytes, at);
        at += kSizes[code];
        previous += static_cast<Unsigned>(difference);
        values[i] = static_cast<T>(previous);
    }
    return values;
}

}  // namespace

Result<std::vector<std::byte>> unpackBytes(std::span<const std::byte> packed, std::uint64_t size) {
    if (packed.empty()) return damaged();
    std::vector<std::byte> out;
    out.reserve(static_cast<std::size_t>(std::min(size, packed.size() * kMaxPerByte)));
    const auto blocks = std::to_integer<unsigned>(packed.front());
    packed = packed.subspan(1);
    if (blocks == 0) {
        if (auto status = unpackBlock(packed, size, out); !status) return tl::unexpected(status.error());
        return out;
    }
    for (unsigned block = 0; block < blocks; ++block) {
        if (packed.size() < sizeof(std::int32_t)) return damaged();
        const auto length = valueAt<std::int32_t>(packed, 0);
        packed = packed.subspan(sizeof length);
        if (length < 0 || static_cast<std::size_t>(length) > packed.size()) return damaged();
        const auto part = packed.first(static_cast<std::size_t>(length));
        if (auto status = unpackBlock(part, size, out); !status) return tl::unexpected(status.error());
        packed = packed.subspan(part.size());
    }
    return out;
}

Result<std::vector<std::int32_t>> unpackIntegers32(std::span<const std::byte> packed, std::uint64_t count) {
    return unpackIntegers<std::int32_t, std::int8_t, std::int16_t>(packed, count);
}
Result<std::vector<std::int64_t>> unpackIntegers64(std::span<const std::byte> packed, std::uint64_t count) {
    return unpackIntegers<std::int64_t, std::int16_t, std::int32_t>(packed, count);
}

}  // namespace hairloom
