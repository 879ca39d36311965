// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "core/base/smooth_step.h"
#include "core/operations/lay_along.h"
#include "core/operations/length_constraint.h"
#include "core/operations/operation.h"
#include "core/operations/strand_frames.h"

namespace hairloom {
namespace {

struct BraidSettings {
    float width = 0.03f;
    float widthTip = 0.018f;
    float crossing = 0.045f;
    float lift = 0.004f;
    float reach = 0;
    float tail = 0.05f;
    float loose = 0.15f;
    float clearance = 0.001f;
    std::uint64_t seed = 1;
    DrawnCurve curve;
};
using S = BraidSettings;

constexpr Field<S> kFields[] = {
    field<&S::width>("width", "m", 0.002, 0.3, "radius of the braid at its start"),
    field<&S::widthTip>("widthTip", "m", 0.002, 0.3, "radius of the braid at its tie"),
    field<&S::crossing>("crossing", "m", 0.005, 1,
                        "length of braid in which each lock crosses over and back"),
    field<&S::lift>("lift", "m", 0, 0.1, "height above the skin of hair on its way to the braid"),
    field<&S::reach>("reach", "m", 0, kAnywhere,
                     "largest distance of a root from the start of the braid: 0 braids all strands"),
    field<&S::tail>("tail", "m", 0, 1, "length of loose hair after the tie"),
    field<&S::loose>("loose", "", 0, 1, "how far strands may stray from their lock, at random"),
    clearanceField<&S::clearance>(),
    seedField<&S::seed>("seed", "random seed of the positions within a lock"),
};
std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

constexpr int kLocks = 3;
constexpr float kStep = 0.0025f;     ///< metres of a path along the braid
constexpr float kGather = 0.5f;      ///< of the width: length over which locks part where the braid begins
constexpr float kTied = 0.35f;       ///< of the width at the tie
constexpr float kTieReach = 0.6f;    ///< of the width: length over which the braid is drawn in at the tie
constexpr float kLockWidth = 0.25f;  ///< radius of a lock, of the braid's width
constexpr float kLockDepth = 0.19f;  ///< the same to the front and the back
constexpr float kSwing = 0.27f;      ///< how far the middle of a lock swings aside, of the width
constexpr float kDepth = 0.15f;      ///< how far it swings to the front and the back

/// Frames along the curve: sideways, out of the back of the head, along.
class BraidLine {
  public:
    BraidLine(const S& settings, const Vec3f& outward) : settings_(settings), line_(settings.curve) {
        const std::size_t count = std::max<std::size_t>(2, static_cast<std::size_t>(line_.length() / kStep));
        for (std::size_t i = 0; i <= count; ++i) {
            arcs_.push_back(line_.length() * static_cast<float>(i) / static_cast<float>(count));
            middle_.push_back(line_.at(arcs_.back()));
        }
        frames_ = strandFrames(middle_, outward);
    }
    const Vec3f& start() const { return middle_[0]; }
    const StrandFrame& frame() const { return frames_[0]; }

    /// Of a hair of lock 0, 1, 2 from left to right, at a place (±1, ±1) in it.
    std::vector<Vec3f> path(int lock, const Vec2f& place, float spread) const {
        std::vector<Vec3f> path;
        for (std::size_t i = 0; i < middle_.size(); ++i) path.push_back(at(i, lock, place));
        // The tail fans out behind the tie.
        const Vec3f fan = frames_.back().lateral * place.x() + frames_.back().outward * place.y();
        constexpr int kTailSteps = 8;
        for (int k = 1; k <= kTailSteps; ++k) {
            const float t = static_cast<float>(k) / kTailSteps;
            path.push_back(path[middle_.size() - 1] + frames_.back().along * (settings_.tail * t) +
                           fan * (0.5f * spread * settings_.widthTip * std::sin(kPi * 0.5f * t)));
        }
        return path;
    }

  private:
    Vec3f at(std::size_t i, int lock, const Vec2f& place) const {
        const float arc = arcs_[i], total = arcs_.back();
        const float width = settings_.width + (settings_.widthTip - settings_.width) * arc / total;
        const float begins = smoothStep(0, kGather * width, arc);
        const float ends = smoothStep(0, kTieReach * width, total - arc);
        const float full = width * (kTied + (1 - kTied) * std::min(begins, ends));
        const float phase = 2 * kPi * (arc / settings_.crossing + static_cast<float>(kPhase[lock]) / kLocks);
        const float aside = kSwing * std::sin(phase) + kLockWidth * place.x();
        const float front = kDepth * std::sin(2 * phase) + kLockDepth * place.y();
        return middle_[i] + full * (aside * frames_[i].lateral + front * frames_[i].outward);
    }

    static constexpr int kPhase[kLocks] = {2, 0, 1};  ///< so that they begin left, in the middle, right
    const S& settings_;
    CurveLine line_;
    std::vector<float> arcs_;
    std::vector<Vec3f> middle_;
    std::vector<StrandFrame> frames_;
};

/// Roots by how far to the side they lie make three locks of as many strands.
std::vector<int> locksOf(const Groom& groom, const std::vector<std::uint32_t>& strands,
                         const BraidLine& line) {
    std::vector<std::pair<float, std::uint32_t>> bySide;
    for (const std::uint32_t s : strands)
        bySide.emplace_back((groom.strand(s)[0] - line.start()).dot(line.frame().lateral), s);
    std::sort(bySide.begin(), bySide.end());
    std::vector<int> locks(groom.strandCount(), 0);
    for (std::size_t k = 0; k < bySide.size(); ++k)
        locks[bySide[k].second] = static_cast<int>(kLocks * k / bySide.size());
    return locks;
}

Result<std::size_t> braid(Groom& groom, const S& settings, const Region& region) {
    if (auto status = checkFields("braid", settings); !status) return tl::unexpected(status.error());
    if (!CurveLine::isDrawn(settings.curve)) return std::size_t{0};
    if (!groom.scalp) return fail("braid: the groom has no scalp", "bind it to one first");
    const auto skin = sharedSkin(groom.scalp);
    const BraidLine line(settings, skin->skin().distanceAt(settings.curve.points[0]).outward);
    std::vector<std::uint32_t> strands = strandsToEdit(groom, region);
    const auto reaches = [&](const Vec3f& root) {
        return !(settings.reach > 0) || (root - line.start()).norm() <= settings.reach;
    };
    std::erase_if(strands, [&](std::uint32_t s) { return !reaches(groom.strand(s)[0]); });
    const std::vector<int> locks = locksOf(groom, strands, line);
    return editStrands(groom, region, {settings.clearance, Turns::asMade, true}, [&](StrandEdit& strand) {
        if (!reaches(strand.points[0])) return;
        Random random = strand.random(settings.seed);
        const float angle = kPi * random.uniform(-1, 1);
        const float out = std::sqrt(random.uniform()) * (1 + settings.loose * random.uniform());
        const Vec2f place(out * std::cos(angle), out * std::sin(angle));
        const std::vector<Vec3f> along = line.path(locks[strand.index], place, 1 + random.uniform());
        std::vector<Vec3f> path = pathOverHead(*strand.outside, strand.points[0], along[0], settings.lift);
        path.insert(path.end(), along.begin() + 1, along.end());
        layAlong(strand.points, strand.lengths, std::move(path));
    });
}

}  // namespace

Operation braidOperation() {
    return operation<S, braid>("braid", 72, "braids three locks along a curve that you draw");
}

}  // namespace hairloom
