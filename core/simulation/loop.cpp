// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/simulation/rest_positions.h"

namespace hairloom {
namespace {

constexpr double kMillimetres = 1e3;
constexpr std::uint64_t kFramesAtSeam = 2;  ///< that a seam is measured from
constexpr float kNoLength = 1e-9f;          ///< metres

/// 6t⁵ − 15t⁴ + 10t³ of Perlin (Improving Noise, 2002, Equation 1b): neither speed nor acceleration at both
/// ends.
float smootherStep(float t) {
    return t * t * t * (t * (6 * t - 15) + 10);
}

std::vector<Vec3f> differences(std::span<const Vec3f> a, std::span<const Vec3f> b) {
    std::vector<Vec3f> result(a.size());
    for (std::size_t p = 0; p < a.size(); ++p) result[p] = a[p] - b[p];
    return result;
}

double largestNorm(std::span<const Vec3f> vectors) {
    float largest = 0;
    for (const Vec3f& vector : vectors) largest = std::max(largest, vector.squaredNorm());
    return std::sqrt(static_cast<double>(largest));
}

/// Of the last frame and the one before, from their counterparts.
LoopSeam seamOf(std::span<const Vec3f> last, std::span<const Vec3f> before, double framesPerSecond) {
    const double off = largestNorm(last);
    // What leads into the seam is `off` behind or ahead of what led there: so is the step across it.
    const double step = std::max(off, largestNorm(differences(last, before)));
    return {kMillimetres * off, kMillimetres * step * framesPerSecond};
}

}  // namespace

LoopCloser::LoopCloser(std::span<const std::uint32_t> offsets, std::uint64_t frames, std::uint64_t blend,
                       float framesPerSecond)
    : offsets_(offsets.begin(), offsets.end()), framesPerSecond_(static_cast<double>(framesPerSecond)) {
    assert(frames >= kFramesAtSeam && blend <= frames);
    report_.frames = frames;
    report_.blend = blend;
}

std::uint64_t LoopCloser::leads(std::uint64_t blend) {
    return std::max(blend, kFramesAtSeam);
}

void LoopCloser::lead(std::span<const Vec3f> positions_ws) {
    if (earlier_.size() < leads(report_.blend)) {
        earlier_.emplace_back();
    } else {
        std::rotate(earlier_.begin(), earlier_.begin() + 1, earlier_.end());
    }
    earlier_.back().assign(positions_ws.begin(), positions_ws.end());
}

std::optional<LoopSeam> LoopCloser::endRepeat() {
    assert(earlier_.size() >= kFramesAtSeam);
    std::vector<std::vector<Vec3f>> ends(earlier_.end() - static_cast<std::ptrdiff_t>(kFramesAtSeam),
                                         earlier_.end());
    std::swap(ends, ends_);
    if (ends.empty()) return std::nullopt;
    return seamOf(differences(ends_[1], ends[1]), differences(ends_[0], ends[0]), framesPerSecond_);
}

const std::vector<Vec3f>& LoopCloser::counterpart(std::uint64_t frame) const {
    return earlier_[earlier_.size() - (report_.frames - frame)];
}

void LoopCloser::blend(std::span<const Vec3f> target, float share) {
    for (std::size_t s = 0; s + 1 < offsets_.size(); ++s) {
        const std::uint32_t root = offsets_[s], end = offsets_[s + 1];
        if (root == end) continue;
        Vec3f own = closed_[root];  // where the point before was
        closed_[root] += (target[root] - own) * share;
        for (std::uint32_t p = root + 1; p < end; ++p) {
            const Vec3f ownSegment = closed_[p] - own, otherSegment = target[p] - target[p - 1];
            const Vec3f segment = ownSegment + (otherSegment - ownSegment) * share;
            const float ownLength = ownSegment.norm(), otherLength = otherSegment.norm();
            const float length = ownLength + (otherLength - ownLength) * share;
            const float drawn = segment.norm();
            own = closed_[p];
            // Opposite segments have no direction half-way.
            closed_[p] =
                closed_[p - 1] + (drawn > kNoLength ? Vec3f(segment * (length / drawn)) : otherSegment);
        }
    }
}

void LoopCloser::measure(std::span<const Vec3f> positions_ws) {
    const auto& there = counterpart(next_);
    auto before = differences(positions_ws, there), after = differences(closed_, there);
    if (next_ + 1 == report_.frames) {
        report_.before = seamOf(before, offBefore_, framesPerSecond_);
        report_.after = seamOf(after, offAfter_, framesPerSecond_);
        for (std::size_t s = 0; s + 1 < offsets_.size(); ++s) {
            if (offsets_[s] == offsets_[s + 1]) continue;
            const double off = kMillimetres * static_cast<double>(before[offsets_[s]].norm());
            report_.headMm = std::max(report_.headMm, off);
        }
    }
    offBefore_ = std::move(before);
    offAfter_ = std::move(after);
}

std::span<const Vec3f> LoopCloser::close(std::span<const Vec3f> positions_ws) {
    assert(earlier_.size() >= leads(report_.blend) && next_ < report_.frames);
    closed_.assign(positions_ws.begin(), positions_ws.end());
    const std::uint64_t left = report_.frames - next_;
    if (left <= report_.blend) {
        if (left == 1) {
            closed_ = counterpart(next_);
        } else {
            const auto step = static_cast<float>(report_.blend + 1 - left);
            blend(counterpart(next_), smootherStep(step / static_cast<float>(report_.blend)));
        }
        std::vector<Vec3f> moved = differences(closed_, positions_ws);
        if (moved_.empty()) moved_.assign(moved.size(), Vec3f::Zero());
        const double faster = largestNorm(differences(moved, moved_)) * framesPerSecond_;
        report_.blendMmPerSecond = std::max(report_.blendMmPerSecond, kMillimetres * faster);
        moved_ = std::move(moved);
    }
    if (left <= kFramesAtSeam) measure(positions_ws);
    ++next_;
    return closed_;
}

Status checkHeadRepeats(const HeadMotion& motion, const Groom& groom, const FramePace& pace,
                        std::uint64_t frames) {
    // Hair at rest on the head is moved by all that moves roots.
    const auto shapeAt = [&](float seconds) {
        return posedPositions(groom, inWorld(motion.poseAt(seconds)));
    };
    const auto timeOf = [&](std::uint64_t frame) {
        return pace.timeOf(static_cast<float>(frame), pace.steps());
    };
    const auto expected = "expected as many frames as the motion takes to come back to its start";
    const auto last = differences(shapeAt(timeOf(2 * frames)), shapeAt(timeOf(frames)));
    const auto before = differences(shapeAt(timeOf(2 * frames - 1)), shapeAt(timeOf(frames - 1)));
    const LoopSeam seam = seamOf(last, before, static_cast<double>(pace.framesPerSecond));
    if (!seam.isClosed())
        return fail(fmt::format("the head does not repeat every {} frames: it ends {:.1f} mm and {:.0f} mm/s "
                                "from where it ended before",
                                frames, seam.mm, seam.mmPerSecond),
                    expected);
    // So short that nothing but a jump goes half a millimetre. The end of a repeat is the start of the next
    // one in some motions, and in others not.
    const float end = timeOf(frames), moment = pace.dt() / 1024;
    const double jump = kMillimetres * largestNorm(differences(shapeAt(end + moment), shapeAt(end - moment)));
    if (jump > LoopSeam::kClosedMm)
        return fail(fmt::format("the head jumps {:.1f} mm where the motion starts again", jump),
                    "expected a motion whose last frame leads to its first");
    return {};
}

}  // namespace hairloom
