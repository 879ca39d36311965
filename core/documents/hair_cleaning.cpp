// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/hair_cleaning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/base/hash.h"
#include "core/base/parallel.h"
#include "core/base/smooth_step.h"
#include "core/geometry/curve.h"
#include "core/groom/strand_subset.h"
#include "core/operations/collide.h"
#include "core/operations/resample.h"
#include "core/operations/skin.h"

namespace hairloom {
namespace {

constexpr std::size_t kGrain = 64;
constexpr float kShortest = 0.003f;  ///< metres
constexpr float kJump = 8;  ///< a segment this many times as long as the strand's usual one is a jump
constexpr float kSmallestJump = 0.01f;
constexpr std::size_t kLoopPlaces = 128;  ///< at which a strand is looked at for loops
constexpr std::size_t kSmallestLoop = 6;  ///< steps of these; less is a bend
constexpr float kMeets = 0.75f;           ///< of such a step: so near a strand meets itself
constexpr float kLeast = 0.4f;            ///< of a strand that has to be left of it

enum class Fate : std::uint8_t { Kept, Short, Loop, Far };

/// What of a strand is kept: points by their number in the strand, in order from the root.
struct Kept {
    std::vector<std::uint32_t> points;
    Fate fate = Fate::Kept;
    bool isBroken = false, hasLoops = false, isTurned = false;
};

float median(std::vector<float> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

std::vector<Vec3f> gathered(std::span<const Vec3f> strand, std::span<const std::uint32_t> points) {
    std::vector<Vec3f> some;
    for (const std::uint32_t point : points) some.push_back(strand[point]);
    return some;
}

/// Cuts at the first step that is far longer than the others; the longer part stays.
void cutJumps(std::span<const Vec3f> strand, Kept& kept) {
    std::vector<float> steps;
    for (std::size_t i = 1; i < strand.size(); ++i) steps.push_back((strand[i] - strand[i - 1]).norm());
    if (steps.size() < 4) return;
    const float longest = std::max(kSmallestJump, kJump * median(steps));
    std::size_t begin = 0, best = 0, bestEnd = 0;
    for (std::size_t i = 0; i <= steps.size(); ++i) {
        if (i < steps.size() && steps[i] <= longest) continue;
        if (i + 1 - begin > bestEnd - best) {
            best = begin;
            bestEnd = i + 1;
        }
        begin = i + 1;
    }
    kept.isBroken = bestEnd - best < strand.size();
    kept.points.assign(kept.points.begin() + static_cast<std::ptrdiff_t>(best),
                       kept.points.begin() + static_cast<std::ptrdiff_t>(bestEnd));
}

/// Leaves out what lies between two places where the strand meets itself.
void cutLoops(std::span<const Vec3f> strand, Kept& kept) {
    const std::vector<Vec3f> line = gathered(strand, kept.points);
    if (line.size() < 4) return;
    const auto places = evenPlaces(line, kLoopPlaces);
    const std::vector<Vec3f> even = resampleEvenly(line, kLoopPlaces);
    const float near = kMeets * polylineLength(line) / static_cast<float>(kLoopPlaces - 1);
    std::vector<std::uint8_t> isOut(line.size(), 0);
    for (std::size_t i = 0; i + kSmallestLoop < even.size(); ++i) {
        for (std::size_t j = even.size() - 1; j > i + kSmallestLoop; --j) {
            if ((even[i] - even[j]).squaredNorm() > near * near) continue;
            for (std::size_t p = places[i].segment + 1; p <= places[j].segment; ++p) isOut[p] = 1;
            kept.hasLoops = true;
            i = j;
            break;
        }
    }
    if (!kept.hasLoops) return;
    std::vector<std::uint32_t> left;
    for (std::size_t p = 0; p < line.size(); ++p) {
        if (isOut[p] == 0) left.push_back(kept.points[p]);
    }
    kept.points = std::move(left);
    const std::vector<Vec3f> rest = gathered(strand, kept.points);
    if (rest.size() < 2 || polylineLength(rest) < kLeast * polylineLength(line)) kept.fate = Fate::Loop;
}

class Cleaner {
  public:
    Cleaner(Groom& groom, const HairCleaning& cleaning) : groom_(groom), cleaning_(cleaning) {
        if (!groom.scalp) return;
        skin_ = std::make_unique<const Skin>(groom.scalp);
        scalp_ = std::make_unique<const SurfaceTree>(*groom.scalp, groom.scalpSelection);
    }

    Result<CleanedHair> run() {
        std::vector<Kept> strands(groom_.strandCount());
        parallelFor(strands.size(), kGrain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t s = begin; s < end; ++s) strands[s] = kept(groom_.strand(s));
        });
        leaveOutLong(strands);
        if (auto status = keep(strands); !status) return tl::unexpected(status.error());
        if (auto sampled = resample(groom_, {cleaning_.points}); !sampled)
            return tl::unexpected(sampled.error());
        if (!groom_.scalp) return done_;
        snapRoots();
        auto pushed = collide(groom_, {cleaning_.clearance});
        if (!pushed) return tl::unexpected(pushed.error());
        done_.pushed = *pushed;
        bindToScalp(groom_, groom_.scalp, groom_.scalpSelection);
        return done_;
    }

  private:
    Kept kept(std::span<const Vec3f> strand) const {
        Kept kept;
        kept.points.resize(strand.size());
        std::iota(kept.points.begin(), kept.points.end(), 0u);
        cutJumps(strand, kept);
        cutLoops(strand, kept);
        if (kept.fate == Fate::Kept && skin_) fromScalp(strand, kept);
        if (kept.fate != Fate::Kept) return kept;
        const std::vector<Vec3f> line = gathered(strand, kept.points);
        if (line.size() < 2 || polylineLength(line) < kShortest) kept.fate = Fate::Short;
        return kept;
    }

    /// The end that is plainly nearer to the scalp comes first; what comes before the strand leaves the head
    /// goes, and so does what comes before it passes the scalp where it begins too far away.
    void fromScalp(std::span<const Vec3f> strand, Kept& kept) const {
        constexpr float kClear = 2, kOff = 0.005f;
        const auto distance = [&](std::size_t i) { return scalp_->closest(strand[kept.points[i]]).distance; };
        const float first = distance(0), last = distance(kept.points.size() - 1);
        if (first > kOff && kClear * last < first) {
            std::ranges::reverse(kept.points);
            kept.isTurned = true;
        }
        std::size_t begin = 0;
        while (begin + 2 < kept.points.size() &&
               skin_->distanceAt(strand[kept.points[begin + 1]]).distance < 0)
            ++begin;
        if (begin + 2 >= kept.points.size()) begin = 0;
        if (distance(begin) > cleaning_.reach) {
            const auto end = static_cast<std::size_t>(static_cast<float>(kept.points.size()) * (1 - kLeast));
            std::size_t nearest = begin;
            float least = distance(begin);
            for (std::size_t i = begin + 1; i < end; ++i) {
                const float off = distance(i);
                if (off >= least) continue;
                least = off;
                nearest = i;
            }
            if (least > cleaning_.reach) {
                kept.fate = Fate::Far;
                return;
            }
            begin = nearest;
        }
        kept.points.erase(kept.points.begin(), kept.points.begin() + static_cast<std::ptrdiff_t>(begin));
    }

    /// Strands far beyond the length that three quarters of them have.
    void leaveOutLong(std::vector<Kept>& strands) const {
        constexpr float kFar = 6;  ///< times the middle half's spread
        std::vector<float> lengths(strands.size(), -1), some;
        for (std::size_t s = 0; s < strands.size(); ++s) {
            if (strands[s].fate != Fate::Kept) continue;
            lengths[s] = polylineLength(gathered(groom_.strand(s), strands[s].points));
            some.push_back(lengths[s]);
        }
        if (some.size() < 8) return;
        std::ranges::sort(some);
        const float low = some[some.size() / 4], high = some[some.size() * 3 / 4];
        const float most = high + kFar * std::max(high - low, 0.05f * high);
        for (std::size_t s = 0; s < strands.size(); ++s) {
            if (lengths[s] > most) strands[s].fate = Fate::Far;
        }
    }

    Status keep(const std::vector<Kept>& strands) {
        std::vector<std::uint32_t> chosen, points, offsets{0};
        std::map<std::uint64_t, std::vector<std::uint32_t>> known;
        const auto isRepeated = [&](std::size_t s) {
            const auto own = groom_.strand(s);
            auto& alike = known[hashOf(own)];
            const bool found = std::ranges::any_of(
                alike, [&](std::uint32_t other) { return std::ranges::equal(own, groom_.strand(other)); });
            if (!found) alike.push_back(static_cast<std::uint32_t>(s));
            return found;
        };
        for (std::size_t s = 0; s < strands.size(); ++s) {
            const Kept& kept = strands[s];
            done_.shorter += kept.fate == Fate::Short ? 1 : 0;
            done_.outliers += kept.fate == Fate::Far ? 1 : 0;
            done_.loops += kept.hasLoops ? 1 : 0;
            if (kept.fate != Fate::Kept) continue;
            if (isRepeated(s)) {
                ++done_.repeated;
                continue;
            }
            done_.broken += kept.isBroken ? 1 : 0;
            done_.turned += kept.isTurned ? 1 : 0;
            chosen.push_back(static_cast<std::uint32_t>(s));
            for (const std::uint32_t point : kept.points) points.push_back(groom_.offsets[s] + point);
            offsets.push_back(static_cast<std::uint32_t>(points.size()));
        }
        if (chosen.empty())
            return fail(fmt::format("no strand is left: {} are under 3 mm, {} far away or too long, {} loops",
                                    done_.shorter, done_.outliers, done_.loops),
                        "expected hair on this head, in its unit and axes");
        groom_ = strandsOf(groom_, chosen, std::move(offsets), points);
        return {};
    }

    /// Moves each root onto the scalp and what follows it ever less, down to nothing.
    void snapRoots() {
        constexpr float kUntouched = 1e-5f, kFade = 4, kShortestFade = 0.02f;
        std::vector<float> moved(groom_.strandCount(), 0);
        std::vector<Vec3f>& positions = groom_.pointAttributes.edit<Vec3f>(attribute::kPosition);
        parallelFor(moved.size(), kGrain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t s = begin; s < end; ++s) {
                const auto strand = std::span(positions).subspan(groom_.offsets[s],
                                                                 groom_.offsets[s + 1] - groom_.offsets[s]);
                const Vec3f by = scalp_->closest(strand[0]).position - strand[0];
                moved[s] = by.norm();
                if (moved[s] < kUntouched) continue;
                const float fade = std::min(std::max(kFade * moved[s], kShortestFade),
                                            std::max(polylineLength(strand), kUntouched));
                float along = 0;
                Vec3f before = strand[0];
                for (Vec3f& point : strand) {
                    along += (point - before).norm();
                    before = point;
                    point += (1 - smoothStep(std::min(along / fade, 1.0f))) * by;
                }
            }
        });
        for (const float distance : moved) {
            done_.snapped += distance >= kUntouched ? 1 : 0;
            done_.farthestSnap = std::max(done_.farthestSnap, distance);
        }
    }

    Groom& groom_;
    const HairCleaning& cleaning_;
    std::unique_ptr<const Skin> skin_;
    std::unique_ptr<const SurfaceTree> scalp_;
    CleanedHair done_;
};

}  // namespace

Result<CleanedHair> cleanHair(Groom& groom, const HairCleaning& cleaning) {
    Groom cleaned = groom;
    dropOperators(cleaned);
    auto done = Cleaner(cleaned, cleaning).run();
    if (done) groom = std::move(cleaned);
    return done;
}

}  // namespace hairloom
