// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/take_codec.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace hairloom::take {
namespace {

constexpr std::size_t kMostBytesOfNumber = 5;  ///< a residual of third order fits 35 bits

std::uint64_t zigzag(std::int64_t value) {
    return (static_cast<std::uint64_t>(value) << 1u) ^ static_cast<std::uint64_t>(value >> 63);
}
std::int64_t unzigzag(std::uint64_t value) {
    return static_cast<std::int64_t>(value >> 1u) ^ -static_cast<std::int64_t>(value & 1u);
}

void append(std::vector<std::byte>& bytes, std::uint64_t value) {
    for (; value >= 0x80; value >>= 7u) bytes.push_back(static_cast<std::byte>((value & 0x7fu) | 0x80u));
    bytes.push_back(static_cast<std::byte>(value));
}

/// False where the bytes end in it, or it is longer than any.
bool takeNumber(std::span<const std::byte>& bytes, std::uint64_t& value) {
    value = 0;
    for (std::size_t i = 0; i < std::min(bytes.size(), kMostBytesOfNumber); ++i) {
        const auto byte = static_cast<std::uint64_t>(bytes[i]);
        value |= (byte & 0x7fu) << (7 * i);
        if ((byte & 0x80u) != 0) continue;
        bytes = bytes.subspan(i + 1);
        return true;
    }
    return false;
}

}  // namespace

Result<GridFrame> onGrid(std::span<const Vec3f> vectors) {
    GridFrame frame;
    frame.reserve(3 * vectors.size());
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const double cells = static_cast<double>(vectors[i][c]) / static_cast<double>(kGrid);
            if (!(std::abs(cells) <= kFarthest))
                return fail(fmt::format("position {} is at ({}, {}, {}) m", i, vectors[i].x(), vectors[i].y(),
                                        vectors[i].z()),
                            "expected positions within 100 km of the origin");
            frame.push_back(static_cast<std::int32_t>(std::llround(cells)));
        }
    }
    return frame;
}

Vec3f offGrid(const std::int32_t* coordinates) {
    Vec3f vector;
    for (int c = 0; c < 3; ++c)
        vector[c] = static_cast<float>(static_cast<double>(coordinates[c]) * static_cast<double>(kGrid));
    return vector;
}

/// Orders of the differences that are left: in time, and along the vectors behind a start.
struct Predictor::Way {
    std::uint32_t time = 0, along = 0;
    static constexpr std::uint32_t kOrders = 3;
};

Predictor::Predictor(std::vector<std::uint32_t> starts, std::size_t vectors) : placeInRun_(vectors, 2) {
    for (const std::uint32_t start : starts) {
        if (start < vectors) placeInRun_[start] = 0;
        if (start + 1 < vectors) placeInRun_[start + 1] = 1;
    }
    for (const std::uint32_t start : starts) {
        if (start < vectors) placeInRun_[start] = 0;  // where the run before has one vector
    }
}

void Predictor::beginBlock() {
    last_.clear();
    beforeLast_.clear();
}

std::size_t Predictor::mostBytes(std::size_t vectors) {
    return 1 + 3 * kMostBytesOfNumber * vectors;
}

std::int64_t Predictor::inTime(std::size_t coordinate, std::uint32_t order) const {
    if (order == 0) return 0;
    if (order == 1) return last_[coordinate];
    return 2 * std::int64_t{last_[coordinate]} - beforeLast_[coordinate];
}

/// What the way leaves of each coordinate: x of all, then y, then z.
template <class Visit>
void Predictor::eachResidual(const GridFrame& frame, Way way, Visit&& visit) const {
    for (std::size_t c = 0; c < 3; ++c) {
        std::int64_t before = 0, second = 0;
        for (std::size_t i = 0; i < placeInRun_.size(); ++i) {
            const std::size_t at = 3 * i + c;
            const std::int64_t left = frame[at] - inTime(at, way.time);
            // A start is held against the vector before it, which stands somewhere near.
            const std::uint32_t order = std::min(way.along, std::max(placeInRun_[i], 1u));
            visit(order == 0 ? left : order == 1 ? left - before : left - 2 * before + second);
            second = before;
            before = left;
        }
    }
}

std::uint64_t Predictor::cost(const GridFrame& frame, Way way) const {
    std::uint64_t bits = 0;
    eachResidual(frame, way, [&](std::int64_t left) { bits += std::bit_width(zigzag(left)); });
    return bits;
}

void Predictor::write(const GridFrame& frame, std::vector<std::byte>& bytes) {
    const std::uint32_t orders = last_.empty() ? 1 : beforeLast_.empty() ? 2 : Way::kOrders;
    Way best;
    std::uint64_t least = ~std::uint64_t{0};
    for (std::uint32_t time = 0; time < orders; ++time) {
        if (time == 0 && orders > 1) continue;  // never the best behind another frame
        for (std::uint32_t along = 0; along < Way::kOrders; ++along) {
            const std::uint64_t bits = cost(frame, {time, along});
            if (bits >= least) continue;
            least = bits;
            best = {time, along};
        }
    }
    bytes.push_back(static_cast<std::byte>(best.time * Way::kOrders + best.along));
    eachResidual(frame, best, [&](std::int64_t left) { append(bytes, zigzag(left)); });
    beforeLast_ = std::exchange(last_, frame);
}

Result<GridFrame> Predictor::read(std::span<const std::byte>& bytes) {
    if (bytes.empty()) return fail("ends before a frame");
    const auto number = static_cast<std::uint32_t>(bytes.front());
    bytes = bytes.subspan(1);
    const Way way{number / Way::kOrders, number % Way::kOrders};
    const std::uint32_t orders = last_.empty() ? 1 : beforeLast_.empty() ? 2 : Way::kOrders;
    if (way.time >= orders) return fail(fmt::format("predicts a frame in way {}", number));
    GridFrame frame(3 * placeInRun_.size());
    for (std::size_t c = 0; c < 3; ++c) {
        std::int64_t before = 0, second = 0;
        for (std::size_t i = 0; i < placeInRun_.size(); ++i) {
            const std::size_t at = 3 * i + c;
            std::uint64_t coded = 0;
            if (!takeNumber(bytes, coded)) return fail("ends in a frame");
            const std::uint32_t order = std::min(way.along, std::max(placeInRun_[i], 1u));
            const std::int64_t left = unzigzag(coded) + (order == 0   ? 0
                                                         : order == 1 ? before
                                                                      : 2 * before - second);
            const std::int64_t coordinate = left + inTime(at, way.time);
            if (coordinate < -kFarthest || coordinate > kFarthest)
                return fail("has a position beyond 100 km");
            frame[at] = static_cast<std::int32_t>(coordinate);
            second = before;
            before = left;
        }
    }
    beforeLast_ = std::exchange(last_, frame);
    return frame;
}

Result<std::vector<std::byte>> packed(std::span<const std::byte> bytes) {
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    std::vector<std::byte> result(size);
    const int code = compress2(reinterpret_cast<Bytef*>(result.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()),
                               Z_DEFAULT_COMPRESSION);
    if (code != Z_OK) return fail("frames cannot be compressed: memory ran out");
    result.resize(size);
    return result;
}

Result<std::vector<std::byte>> unpacked(std::span<const std::byte> bytes, std::size_t size) {
    std::vector<std::byte> result(size);
    auto got = static_cast<uLongf>(size);
    const int code =
        uncompress(reinterpret_cast<Bytef*>(result.data()), &got,
                   reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()));
    if (code != Z_OK || got != size) return fail("cannot be unpacked");
    return result;
}

}  // namespace hairloom::take
