// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/asset_clip.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "asset/clip_bits.h"
#include "core/base/parallel.h"
#include "hairloom/hairloom.h"
#include "play/head_turn.h"
#include "play/root_poses.h"

namespace hairloom {
namespace {

/// A point is at most 0.027 mm from where the frame has it, half a diagonal of a cell.
constexpr std::uint8_t kClipGridBits = 15;
/// So many are decoded for the last of them where a game jumps to it.
constexpr std::uint16_t kClipFramesPerBlock = 16;
/// Metres, of floats within 100 m of the origin.
constexpr double kFloatError = 8e-6;
constexpr std::size_t kStrandsPerPiece = 64;

using Cells = std::vector<std::int32_t>;

std::uint32_t zigzag(std::int64_t value) {
    return static_cast<std::uint32_t>((static_cast<std::uint64_t>(value) << 1u) ^
                                      static_cast<std::uint64_t>(value >> 63));
}

class BitWriter {
  public:
    /// The lowest `count` bits, up to 32.
    void put(std::uint32_t value, std::uint32_t count) {
        held_ |= std::uint64_t{value} << count_;
        count_ += count;
        for (; count_ >= 8; count_ -= 8, held_ >>= 8u) bytes.push_back(static_cast<std::byte>(held_ & 255u));
    }
    void putNumber(std::uint32_t value, std::uint32_t low) {
        const std::uint32_t ones = value >> low;
        if (ones >= asset::kMostClipOnes) {
            put((1u << asset::kMostClipOnes) - 1, asset::kMostClipOnes);
            return put(value, 32);
        }
        put((1u << ones) - 1, ones + 1);
        put(value & ((1u << low) - 1), low);
    }
    void finish() {
        if (count_ > 0) bytes.push_back(static_cast<std::byte>(held_ & 255u));
    }
    std::vector<std::byte> bytes;

  private:
    std::uint64_t held_ = 0;
    std::uint32_t count_ = 0;
};

std::uint64_t bitsOf(std::span<const std::uint32_t> numbers, std::uint32_t low) {
    std::uint64_t bits = 0;
    for (const std::uint32_t number : numbers) {
        const std::uint32_t ones = number >> low;
        bits += ones >= asset::kMostClipOnes ? asset::kMostClipOnes + 32 : ones + 1 + low;
    }
    return bits;
}

/// Numbers of one axis, and how they are written.
struct AxisCode {
    std::vector<std::uint32_t> numbers;
    std::uint32_t low = asset::kNoClipResiduals;
    std::uint64_t bits = 0;

    void choose() {
        std::uint64_t sum = 0;
        for (const std::uint32_t number : numbers) sum += number;
        low = asset::kNoClipResiduals;
        bits = 0;
        if (sum == 0) return;
        // The best is near the binary logarithm of the mean.
        const auto near = static_cast<std::uint32_t>(std::bit_width(sum / numbers.size()));
        bits = std::numeric_limits<std::uint64_t>::max();
        for (std::uint32_t tried = near < 2 ? 0 : near - 2;
             tried <= std::min(near + 1, asset::kMostClipLowBits); ++tried) {
            const std::uint64_t cost = bitsOf(numbers, tried);
            if (cost < bits) bits = cost, low = tried;
        }
        if (bits == std::numeric_limits<std::uint64_t>::max()) {
            low = asset::kMostClipLowBits;
            bits = bitsOf(numbers, low);
        }
    }
};

/// A strand's frame in one way of prediction.
struct FrameCode {
    std::uint32_t way = 0;
    std::array<AxisCode, 3> axes;
    std::uint64_t bits = 0;

    void make(std::uint32_t time, std::uint32_t along, std::span<const std::int32_t> rest,
              std::span<const std::int32_t> last, std::span<const std::int32_t> beforeLast,
              std::span<const std::int32_t> cells) {
        way = time * asset::kClipOrders + along;
        bits = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            axes[axis].numbers.clear();
            std::int64_t before = 0, second = 0;
            for (std::size_t at = axis; at < cells.size(); at += 3) {
                const std::int64_t predicted = time == 0   ? rest[at]
                                               : time == 1 ? last[at]
                                                           : 2 * std::int64_t{last[at]} - beforeLast[at];
                const std::int64_t left = cells[at] - predicted;
                axes[axis].numbers.push_back(zigzag(along == 0   ? left
                                                    : along == 1 ? left - before
                                                                 : left - 2 * before + second));
                second = before;
                before = left;
            }
            axes[axis].choose();
            bits += axes[axis].bits;
        }
    }
    void write(BitWriter& writer) const {
        writer.put(way, 4);
        for (const AxisCode& axis : axes) writer.put(axis.low, 4);
        for (const AxisCode& axis : axes) {
            if (axis.low == asset::kNoClipResiduals) continue;
            for (const std::uint32_t number : axis.numbers) writer.putNumber(number, axis.low);
        }
    }
};

/// Frames of a strand in a block, each in the way that takes the fewest bits.
std::vector<std::byte> encodeStrand(std::span<const Cells> frames, std::span<const std::int32_t> rest,
                                    std::size_t first) {
    BitWriter writer;
    FrameCode best, tried;
    const auto of = [&](std::size_t frame) { return std::span(frames[frame]).subspan(first, rest.size()); };
    for (std::size_t f = 0; f < frames.size(); ++f) {
        const auto last = of(f > 0 ? f - 1 : 0), beforeLast = of(f > 1 ? f - 2 : 0);
        best.bits = std::numeric_limits<std::uint64_t>::max();
        const auto orders = static_cast<std::uint32_t>(std::min<std::size_t>(f + 1, asset::kClipOrders));
        for (std::uint32_t time = 0; time < orders; ++time) {
            for (std::uint32_t along = 0; along < asset::kClipOrders; ++along) {
                tried.make(time, along, rest, last, beforeLast, of(f));
                if (tried.bits < best.bits) std::swap(tried, best);
            }
        }
        best.write(writer);
    }
    writer.finish();
    return std::move(writer.bytes);
}

runtime::Float3 toFloat3(const Vec3f& v) {
    return {v.x(), v.y(), v.z()};
}

runtime::Matrix34 rowsOf(const Eigen::Isometry3f& head) {
    runtime::Matrix34 rows{};
    for (std::size_t i = 0; i < rows.size(); ++i)
        rows[i] = head(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4));
    return rows;
}

std::vector<float> scalpOf(const ClipToWrite::Frame& frame, std::span<const std::uint32_t> scalpVertices) {
    std::vector<float> values;
    if (frame.scalpPositions_ws.empty()) return values;
    for (const std::uint32_t vertex : scalpVertices) {
        const Vec3f& at = frame.scalpPositions_ws[vertex];
        values.insert(values.end(), {at.x(), at.y(), at.z()});
    }
    return values;
}

Status checkFrame(const ClipToWrite::Frame& frame, const Groom& groom, std::uint64_t number) {
    const std::size_t vertices = groom.scalp ? groom.scalp->vertexCount() : 0;
    if (frame.positions_ws.size() == groom.pointCount() &&
        (frame.scalpPositions_ws.empty() || frame.scalpPositions_ws.size() == vertices))
        return {};
    return fail(fmt::format("frame {} has {} points and {} vertices of the head", number,
                            frame.positions_ws.size(), frame.scalpPositions_ws.size()),
                fmt::format("expected {} and {}, or no vertices", groom.pointCount(), vertices));
}

/// Frames on the grid.
class ClipGrid {
  public:
    ClipGrid(const PreparedStrands& strands, const Groom& groom, const runtime::Asset& plain,
             std::span<const std::uint32_t> scalpVertices)
        : strands_(strands),
          groom_(groom),
          scalpVertices_(scalpVertices),
          rest_(plain.strandsAtRest()),
          poses_(plain, rest_),
          roots_(strands.strandCount()) {}

    double largestError() const { return largest_; }
    const runtime::Asset::Strands& rest() const { return rest_; }

    Result<Cells> cellsOf(const ClipToWrite::Frame& frame, std::uint64_t number) {
        if (auto status = checkFrame(frame, groom_, number); !status) return tl::unexpected(status.error());
        const std::vector<float> scalp = scalpOf(frame, scalpVertices_);
        if (poses_.hasScalp() && !scalp.empty())
            poses_.followScalp(scalp, roots_);
        else
            poses_.followHead(rowsOf(frame.head_ws), roots_);
        const runtime::Quat back = runtime::conjugate(runtime::headTurn(poses_.restRoots(), roots_));
        const double perMetre = std::ldexp(1.0, kClipGridBits);
        Cells cells;
        cells.reserve(3 * (strands_.positions.size() - strands_.strandCount()));
        for (std::size_t s = 0; s < strands_.strandCount(); ++s) {
            const std::size_t from = groom_.offsets[strands_.sources[s]];
            const std::size_t points = strands_.offsets[s + 1] - strands_.offsets[s];
            for (std::size_t p = 1; p < points; ++p) {
                const runtime::Float3 away =
                    runtime::rotate(back, toFloat3(frame.positions_ws[from + p]) - roots_[s].position);
                double squared = 0;
                for (const float axis : {away.x, away.y, away.z}) {
                    const double cell = double{axis} * perMetre;
                    if (!(std::abs(cell) <= double{asset::kFarthestClipCell}))
                        return fail(fmt::format("frame {} has point {} of strand {} far from its root",
                                                number, p, strands_.sources[s]),
                                    "expected it within 256 m");
                    const double rounded = std::round(cell);
                    cells.push_back(static_cast<std::int32_t>(rounded));
                    squared += (cell - rounded) * (cell - rounded);
                }
                largest_ = std::max(largest_, std::sqrt(squared) / perMetre);
            }
        }
        return cells;
    }

  private:
    const PreparedStrands& strands_;
    const Groom& groom_;
    std::span<const std::uint32_t> scalpVertices_;
    runtime::Asset::Strands rest_;
    runtime::RootPoses poses_;
    std::vector<runtime::RootFrame> roots_;
    double largest_ = 0;
};

Status checkClipToWrite(const ClipToWrite& clip) {
    if (clip.frames == 0 || clip.frames > asset::kMostClipFrames)
        return fail(fmt::format("{} frames", clip.frames),
                    fmt::format("expected 1 to {}: export a range", asset::kMostClipFrames));
    if (!(clip.framesPerSecond >= 1 && clip.framesPerSecond <= asset::kMostClipRate))
        return fail(fmt::format("{} frames a second", clip.framesPerSecond),
                    fmt::format("expected 1 to {}", asset::kMostClipRate));
    return {};
}

}  // namespace

Result<AssetClip> encodeClip(const ClipToWrite& clip, const PreparedStrands& strands, const Groom& groom,
                             const runtime::Asset& plain, std::span<const std::uint32_t> scalpVertices,
                             const WorkWatch& watch) {
    if (auto status = checkClipToWrite(clip); !status) return tl::unexpected(status.error());
    ClipGrid grid(strands, groom, plain, scalpVertices);
    const auto atRest = runtime::clipRest(grid.rest(), kClipGridBits);
    const Cells rest(atRest.begin(), atRest.end());
    AssetClip encoded;
    encoded.places.push_back(0);
    std::vector<std::vector<std::byte>> bits(strands.strandCount());
    for (std::uint64_t first = 0; first < clip.frames; first += kClipFramesPerBlock) {
        std::vector<Cells> frames;
        for (std::uint64_t f = first; f < std::min<std::uint64_t>(first + kClipFramesPerBlock, clip.frames);
             ++f) {
            const auto frame = clip.frame(f);
            if (!frame) return tl::unexpected(frame.error());
            auto cells = grid.cellsOf(*frame, f);
            if (!cells) return tl::unexpected(cells.error());
            frames.push_back(std::move(*cells));
            if (auto status = watch.at(static_cast<double>(f) / static_cast<double>(clip.frames)); !status)
                return tl::unexpected(status.error());
        }
        parallelFor(strands.strandCount(), kStrandsPerPiece, [&](std::size_t begin, std::size_t end) {
            for (std::size_t s = begin; s < end; ++s) {
                const std::size_t from = 3 * (strands.offsets[s] - s);
                const std::size_t count = 3 * (strands.offsets[s + 1] - strands.offsets[s] - 1);
                bits[s] = encodeStrand(frames, std::span(rest).subspan(from, count), from);
            }
        });
        for (const std::vector<std::byte>& strand : bits) {
            encoded.frames.insert(encoded.frames.end(), strand.begin(), strand.end());
            if (encoded.frames.size() > std::numeric_limits<std::uint32_t>::max())
                return fail(fmt::format("the first {} of {} frames take 4 GB", first, clip.frames),
                            "expected a clip that fits: export a range");
            encoded.places.push_back(static_cast<std::uint32_t>(encoded.frames.size()));
        }
    }
    encoded.record.framesPerSecond = static_cast<float>(clip.framesPerSecond);
    encoded.record.frames = static_cast<std::uint32_t>(clip.frames);
    encoded.record.framesPerBlock = kClipFramesPerBlock;
    encoded.record.gridBits = kClipGridBits;
    encoded.record.loops = clip.loops ? 1 : 0;
    encoded.record.largestError = static_cast<float>(grid.largestError() + kFloatError);
    return encoded;
}

Result<double> playedClipError(const ClipToWrite& clip, const PreparedStrands& strands, const Groom& groom,
                               std::span<const std::byte> file, std::span<const std::uint32_t> scalpVertices,
                               const WorkWatch& watch) {
    hl_error error{};
    hl_asset opened;
    hl_instance* made = nullptr;
    const auto refused = [&] { return fail(fmt::format("the clip is not played: {}", error.words)); };
    if (hl_asset_open(&opened, file.data(), file.size(), &error) != HL_OK ||
        hl_instance_make(&opened, HL_GUIDES, nullptr, &made, &error) != HL_OK)
        return refused();
    const std::unique_ptr<hl_instance, void (*)(hl_instance*)> hair(made, hl_instance_free);
    std::vector<Vec3f> points(strands.positions.size());
    hl_play play;
    hl_play_init(&play);
    double largest = 0;
    for (std::uint64_t f = 0; f < clip.frames; ++f) {
        const auto frame = clip.frame(f);
        if (!frame) return tl::unexpected(frame.error());
        const std::vector<float> scalp = scalpOf(*frame, scalpVertices);
        const runtime::Matrix34 head = rowsOf(frame->head_ws);
        hl_frame placed;
        hl_frame_init(&placed);
        placed.head = head.data();
        placed.scalp = scalp.empty() ? nullptr : scalp.data();
        placed.scalp_count = scalp.size() / 3;
        play.time = static_cast<double>(f) / static_cast<double>(static_cast<float>(clip.framesPerSecond));
        const hl_out positions{points.data(), points.size() * sizeof(Vec3f), sizeof(Vec3f)};
        if (hl_instance_play(hair.get(), &opened, &placed, &play, &error) != HL_OK ||
            hl_instance_read_guides(hair.get(), positions, {}, {}, &error) != HL_OK)
            return refused();
        for (std::size_t s = 0; s < strands.strandCount(); ++s) {
            const std::size_t from = groom.offsets[strands.sources[s]], to = strands.offsets[s];
            for (std::size_t p = 1; p < strands.offsets[s + 1] - to; ++p)
                largest = std::max(largest, double{(points[to + p] - frame->positions_ws[from + p]).norm()});
        }
        if (auto status = watch.at(static_cast<double>(f) / static_cast<double>(clip.frames)); !status)
            return tl::unexpected(status.error());
    }
    return largest;
}

}  // namespace hairloom
