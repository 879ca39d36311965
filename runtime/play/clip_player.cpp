// SPDX-License-Identifier: MIT
#include "play/clip_player.h"

#include <algorithm>
#include <cmath>

#include "asset/asset_error.h"
#include "asset/clip_bits.h"
#include "engine/in_parallel.h"

namespace hairloom::runtime {
namespace {

constexpr std::size_t kPlayedStrandsPerJob = 64;

}  // namespace

ClipMoment clipMoment(const asset::Clip& clip, double seconds, bool loops) {
    const double frames = double{clip.framesPerSecond} * seconds, count = clip.frames;
    if (loops) {
        double at = std::fmod(frames, count);
        if (at < 0) at += count;
        // A small negative number plus the count may round to the count.
        const auto from = static_cast<std::uint32_t>(at < count ? at : 0);
        return {from, from + 1 < clip.frames ? from + 1 : 0,
                at < count ? static_cast<float>(at - static_cast<double>(from)) : 0.0f, clip.frames > 1};
    }
    const double at = std::clamp(frames, 0.0, count - 1);
    const auto from = static_cast<std::uint32_t>(at);
    return {from, std::min(from + 1, clip.frames - 1), static_cast<float>(at - static_cast<double>(from)),
            frames >= 0 && frames < count - 1};
}

std::size_t ClipPlayer::bytesFor(std::size_t strands, std::size_t points) {
    return strands * (sizeof(std::uint64_t) + sizeof(std::uint32_t) + 1) + sizeof(std::uint32_t) +
           (points - strands) * 9 * sizeof(std::int32_t) + sizeof(ClipPlayer);
}

std::size_t ClipPlayer::bytes() const {
    return offsets_.empty() ? sizeof(ClipPlayer) : bytesFor(offsets_.size() - 1, offsets_.back());
}

void ClipPlayer::take(const Asset& asset) {
    identity_ = {};
    Asset::Strands rest = asset.strandsAtRest();
    rest_ = clipRest(rest, asset.clip()->gridBits);
    offsets_ = std::move(rest.offsets);
    for (auto& cells : cells_) cells.assign(rest_.size(), 0);
    bits_.assign(asset.strands.size(), 0);
    damaged_.assign(asset.strands.size(), 0);
    step_ = std::ldexp(1.0f, -static_cast<int>(asset.clip()->gridBits));
    forget();
    identity_ = asset.identity();
}

/// Frames come one after another, and a new one takes the place of the one before the last.
ClipPlayer::Plan ClipPlayer::planOf(const asset::Clip& clip, const ClipMoment& moment) const {
    const std::uint32_t perBlock = clip.framesPerBlock, known = frames_[last_];
    Plan plan;
    const std::uint32_t block = moment.from / perBlock, inBlock = moment.from % perBlock;
    if (known != moment.from) {
        const bool follows = known != kNoFrame && known / perBlock == block && known < moment.from;
        const std::uint32_t from = follows ? known % perBlock + 1 : 0;
        plan.runs[plan.count++] = {block, from, inBlock + 1 - from};
    }
    if (moment.to == moment.from) return plan;
    if (moment.to / perBlock != block || moment.to < moment.from) {
        plan.runs[plan.count++] = {moment.to / perBlock, 0, 1};
    } else if (plan.count > 0) {
        ++plan.runs[0].count;
    } else {
        plan.runs[plan.count++] = {block, inBlock + 1, 1};
    }
    return plan;
}

bool ClipPlayer::decodeStrand(const Asset& asset, const Plan& plan, std::uint32_t strand) {
    const std::size_t first = 3 * (std::size_t{offsets_[strand]} - strand);
    const std::size_t count = 3 * (std::size_t{offsets_[strand + 1]} - offsets_[strand] - 1);
    const auto rest = std::span(rest_).subspan(first, count);
    std::size_t last = last_;
    for (std::size_t r = 0; r < plan.count; ++r) {
        const Run& run = plan.runs[r];
        ClipBits bits(clipStrandBytes(asset, run.block, strand), run.from == 0 ? 0 : bits_[strand]);
        for (std::uint32_t f = run.from; f < run.from + run.count; ++f) {
            const auto before = std::span(cells_[last]).subspan(first, count);
            const auto cells = std::span(cells_[1 - last]).subspan(first, count);
            if (!readClipFrame(bits, f, rest, before, cells, cells)) return false;
            last = 1 - last;
        }
        bits_[strand] = bits.at();
    }
    return true;
}

std::optional<AssetError> ClipPlayer::decode(const Asset& asset, const ClipMoment& moment,
                                             std::span<const std::uint32_t> strands, std::uint32_t level,
                                             const Host& host) {
    if (!isSame(asset)) take(asset);
    // At another level other strands were decoded.
    if (level != level_) forget();
    level_ = level;
    const auto knows = [&](std::uint32_t frame) { return frames_[0] == frame || frames_[1] == frame; };
    if (!knows(moment.from) || !knows(moment.to)) {
        const asset::Clip& clip = *asset.clip();
        const Plan plan = planOf(clip, moment);
        inParallel(host, strands.size(), kPlayedStrandsPerJob, [&](std::size_t begin, std::size_t end) {
            for (std::size_t s = begin; s < end; ++s)
                damaged_[strands[s]] = decodeStrand(asset, plan, strands[s]) ? 0 : 1;
        });
        std::uint32_t decoded = 0;
        for (std::size_t r = 0; r < plan.count; ++r) {
            const Run& run = plan.runs[r];
            for (std::uint32_t f = run.from; f < run.from + run.count; ++f, ++decoded) {
                last_ = 1 - last_;
                frames_[last_] = run.block * clip.framesPerBlock + f;
            }
        }
        for (const std::uint32_t strand : strands) {
            if (damaged_[strand] == 0) continue;
            forget();
            const std::uint32_t block = plan.runs[plan.count - 1].block;
            const auto bytes = clipStrandBytes(asset, block, strand);
            return damaged(asset.placeOf(bytes.data() ? bytes.data() : asset.clipFrames().data()),
                           "the clip's bits of strand " + number(strand) + " near frame " +
                               number(moment.from) + " are no motion");
        }
    }
    from_ = frames_[0] == moment.from ? 0 : 1;
    to_ = frames_[0] == moment.to ? 0 : 1;
    return std::nullopt;
}

}  // namespace hairloom::runtime
