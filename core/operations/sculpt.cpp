// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/sculpt.h"

#include <algorithm>
#include <cassert>

#include "core/geometry/curve.h"

namespace hairloom {
namespace {

constexpr float kNoDirection = 1e-9f;  ///< metres; shorter segments point nowhere
constexpr float kNoLength = 1e-6f;     ///< metres; offsets of shorter segments are shares of kStandIn
constexpr float kStandIn = 1e-3f;      ///< metres

/// A frame that turns with the segments, by the shortest way from each to the next.
class SegmentFrame {
  public:
    void follow(const Vec3f& segment) {
        const float length = segment.norm();
        scale_ = length > kNoLength ? length : kStandIn;
        if (!(length > kNoDirection)) return;
        const Vec3f direction = segment / length;
        turn_ = (shortestArc(direction_, direction) * turn_).normalized();
        direction_ = direction;
    }
    /// Metres, for a share in the frame, and back.
    Vec3f fromFrame(const Vec3f& offset) const { return turn_ * Vec3f(offset * scale_); }
    Vec3f toFrame(const Vec3f& difference) const { return (turn_.conjugate() * difference) / scale_; }

  private:
    Vec3f direction_ = Vec3f::UnitY();
    Quatf turn_ = Quatf::Identity();
    float scale_ = kStandIn;
};

/// The segment turned and lengthened by a share of the way to `whole`.
Vec3f partOf(const Vec3f& segment, const Vec3f& whole, float weight) {
    if (weight >= 1) return whole;
    const Vec3f between = segment + weight * (whole - segment);
    const float length = segment.norm() + weight * (whole.norm() - segment.norm());
    const float norm = between.norm();
    return norm > kNoDirection ? Vec3f(between * (length / norm)) : between;
}

}  // namespace

void applySculpt(std::span<const Vec3f> input, std::span<const Vec3f> offsets, float weight,
                 std::span<Vec3f> output) {
    assert(input.size() == offsets.size() && input.size() == output.size());
    SegmentFrame frame;
    output[0] = input[0];
    bool moved = false;
    for (std::size_t i = 1; i < input.size(); ++i) {
        const Vec3f segment = input[i] - input[i - 1];
        frame.follow(segment);
        moved = moved || !offsets[i].isZero(0);
        const Vec3f whole = segment + frame.fromFrame(offsets[i]);
        output[i] = moved ? Vec3f(output[i - 1] + partOf(segment, whole, weight)) : input[i];
    }
}

void measureSculpt(std::span<const Vec3f> input, std::span<const Vec3f> wanted, std::span<Vec3f> offsets) {
    assert(input.size() == wanted.size() && input.size() == offsets.size());
    SegmentFrame frame;
    offsets[0] = Vec3f::Zero();
    // What has been reached so far, so that rounding does not add up along the strand.
    Vec3f reached = input[0];
    bool moved = false;
    for (std::size_t i = 1; i < input.size(); ++i) {
        const Vec3f segment = input[i] - input[i - 1];
        frame.follow(segment);
        moved = moved || wanted[i] != input[i];
        offsets[i] = moved ? frame.toFrame(wanted[i] - reached - segment) : Vec3f(Vec3f::Zero());
        reached = moved ? Vec3f(reached + (segment + frame.fromFrame(offsets[i]))) : input[i];
    }
}

}  // namespace hairloom
