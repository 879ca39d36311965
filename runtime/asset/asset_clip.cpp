// SPDX-License-Identifier: MIT
// The clip of an asset: whether its records fit each other, and its frames out of their bits.
#include <algorithm>
#include <atomic>
#include <cmath>

#include "asset/asset_error.h"
#include "asset/clip_bits.h"
#include "engine/in_parallel.h"

namespace hairloom::runtime {

using namespace asset;

namespace {

constexpr std::size_t kClipStrandsPerJob = 64;
constexpr std::uint64_t kNoStrand = ~std::uint64_t{0};

std::int64_t unzigzag(std::uint32_t value) {
    return static_cast<std::int64_t>(value >> 1u) ^ -static_cast<std::int64_t>(value & 1u);
}

}  // namespace

bool ClipBits::isAtEnd() const {
    const std::uint64_t end = 8 * std::uint64_t{bytes_.size()};
    if (!isGood() || end - at_ >= 8) return false;
    if (at_ == end) return true;
    return (std::to_integer<std::uint32_t>(bytes_.back()) >> (8 - (end - at_))) == 0;
}

Vector<std::int32_t> clipRest(const Asset::Strands& rest, std::uint32_t gridBits) {
    Vector<std::int32_t> cells;
    const double perMetre = std::ldexp(1.0, static_cast<int>(gridBits));
    for (std::size_t s = 0; s + 1 < rest.offsets.size(); ++s) {
        const Float3 root = rest.positions_ss[rest.offsets[s]];
        for (std::size_t p = rest.offsets[s] + 1; p < rest.offsets[s + 1]; ++p) {
            const Float3 at = rest.positions_ss[p];
            for (const double away : {double{at.x} - double{root.x}, double{at.y} - double{root.y},
                                      double{at.z} - double{root.z}}) {
                const double cell =
                    std::clamp(away * perMetre, -double{kFarthestClipCell}, double{kFarthestClipCell});
                cells.push_back(static_cast<std::int32_t>(std::llround(cell)));
            }
        }
    }
    return cells;
}

namespace {

/// A coordinate of a frame whose residuals are differences of order `kAlong` between points and of order
/// `kTime` between frames. False where a cell is out of range.
template <std::uint32_t kTime, std::uint32_t kAlong>
bool readAxis(ClipBits& bits, std::uint32_t low, std::size_t axis, ConstClipCells rest, ConstClipCells last,
              ConstClipCells beforeLast, ClipCells cells) {
    std::int64_t before = 0, second = 0;
    for (std::size_t at = axis; at < cells.size(); at += 3) {
        std::int64_t left = low == kNoClipResiduals ? 0 : unzigzag(bits.takeNumber(low));
        if constexpr (kAlong == 1) left += before;
        if constexpr (kAlong == 2) left += 2 * before - second;
        std::int64_t cell = left;
        if constexpr (kTime == 0) cell += rest[at];
        if constexpr (kTime == 1) cell += last[at];
        if constexpr (kTime == 2) cell += 2 * std::int64_t{last[at]} - beforeLast[at];
        if (cell < -kFarthestClipCell || cell > kFarthestClipCell) return false;
        cells[at] = static_cast<std::int32_t>(cell);
        second = before;
        before = left;
    }
    return true;
}

using ReadAxis = bool (*)(ClipBits&, std::uint32_t, std::size_t, ConstClipCells, ConstClipCells,
                          ConstClipCells, ClipCells);
static_assert(kClipOrders == 3);
constexpr ReadAxis kReadAxis[kClipOrders][kClipOrders] = {
    {readAxis<0, 0>, readAxis<0, 1>, readAxis<0, 2>},
    {readAxis<1, 0>, readAxis<1, 1>, readAxis<1, 2>},
    {readAxis<2, 0>, readAxis<2, 1>, readAxis<2, 2>},
};

}  // namespace

bool readClipFrame(ClipBits& bits, std::uint32_t number, ConstClipCells rest, ConstClipCells last,
                   ConstClipCells beforeLast, ClipCells cells) {
    const std::uint32_t way = bits.take(4);
    const std::uint32_t time = way / kClipOrders, along = way % kClipOrders;
    if (time > std::min(number, kClipOrders - 1)) return false;
    std::uint32_t low[3];
    for (std::uint32_t& axis : low) axis = bits.take(4);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!kReadAxis[time][along](bits, low[axis], axis, rest, last, beforeLast, cells)) return false;
    }
    return bits.isGood();
}

std::span<const std::byte> clipStrandBytes(const Asset& asset, std::size_t block, std::size_t strand) {
    const auto places = asset.clipPlaces();
    const auto frames = asset.clipFrames();
    const std::size_t record = block * asset.strands.size() + strand;
    if (record + 1 >= places.size()) return {};
    const std::size_t first = places[record], end = places[record + 1];
    return first <= end && end <= frames.size() ? frames.subspan(first, end - first)
                                                : std::span<const std::byte>();
}

std::optional<AssetError> Asset::checkClip() const {
    const auto clips = recordsOf<Clip>(kClip);
    if (clips.empty()) return std::nullopt;
    const Clip& c = clips[0];
    const auto wrong = [&](const std::string& words) { return damaged(placeOf(&c), "the clip " + words); };
    if (clips.size() != 1) return wrong("has " + number(clips.size()) + " records; expected one");
    if (c.name.at > texts.size() || c.name.bytes > texts.size() - c.name.at) return wrong("has no name");
    if (!(c.framesPerSecond >= 1 && c.framesPerSecond <= kMostClipRate))
        return wrong("has a rate that is not from 1 to 1000 frames a second");
    if (c.frames < 1 || c.frames > kMostClipFrames)
        return wrong("has " + number(c.frames) + " frames; expected 1 to " + number(kMostClipFrames));
    if (c.framesPerBlock < 1 || c.framesPerBlock > kMostFramesPerBlock)
        return wrong("has blocks of " + number(c.framesPerBlock) + " frames; expected 1 to " +
                     number(kMostFramesPerBlock));
    if (c.gridBits < kMinClipGridBits || c.gridBits > kMaxClipGridBits)
        return wrong("has a grid of " + number(c.gridBits) + " bits; expected 8 to 20");
    if (c.loops > 1) return wrong("neither loops nor ends");
    if (!(c.largestError >= 0 && c.largestError <= 1)) return wrong("has an error that is no length");
    const auto places = clipPlaces();
    const std::uint64_t expected = std::uint64_t{clipBlocks(c)} * strands.size() + 1;
    if (places.size() != expected)
        return wrong("has " + number(places.size()) + " places of bits; expected " + number(expected));
    if (places.front() != 0 || places.back() != clipFrames().size())
        return damaged(placeOf(places.data()), "the clip's bits are not all of their section");
    for (std::size_t i = 1; i < places.size(); ++i) {
        if (places[i] < places[i - 1])
            return damaged(placeOf(&places[i]), "the clip's bits end before they begin");
    }
    return std::nullopt;
}

std::optional<AssetError> Asset::checkClipFrames(const Host& host) const {
    const Clip* const c = clip();
    if (!c) return std::nullopt;
    const Strands rest = strandsAtRest();
    const Vector<std::int32_t> cells = clipRest(rest, c->gridBits);
    const std::uint32_t blocks = clipBlocks(*c);
    // The lowest one, whichever thread finds one first.
    std::atomic<std::uint64_t> first = kNoStrand;
    inParallel(host, strands.size(), kClipStrandsPerJob, [&](std::size_t begin, std::size_t end) {
        Vector<std::int32_t> frames[3];
        for (std::size_t s = begin; s < end; ++s) {
            const std::size_t from = 3 * (rest.offsets[s] - s), count = 3 * (strands[s].points - 1u);
            for (auto& frame : frames) frame.assign(count, 0);
            for (std::uint32_t b = 0; b < blocks; ++b) {
                ClipBits bits(clipStrandBytes(*this, b, s));
                bool sound = true;
                const std::uint32_t inBlock =
                    std::min<std::uint32_t>(c->framesPerBlock, c->frames - b * c->framesPerBlock);
                for (std::uint32_t f = 0; f < inBlock && sound; ++f)
                    sound = readClipFrame(bits, f, std::span(cells).subspan(from, count), frames[(f + 2) % 3],
                                          frames[(f + 1) % 3], frames[f % 3]);
                if (sound && bits.isAtEnd()) continue;
                std::uint64_t place = std::uint64_t{b} * strands.size() + s, known = first;
                while (place < known && !first.compare_exchange_weak(known, place)) {
                }
                break;
            }
        }
    });
    if (first == kNoStrand) return std::nullopt;
    const auto record = static_cast<std::size_t>(first.load());
    return damaged(placeOf(clipFrames().data()) + clipPlaces()[record],
                   "the clip's bits of strand " + number(record % strands.size()) + " from frame " +
                       number(record / strands.size() * c->framesPerBlock) + " on are no motion");
}

}  // namespace hairloom::runtime
