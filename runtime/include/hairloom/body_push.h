// SPDX-License-Identifier: MIT
#pragma once
// Keeps hair that is drawn out of a body: hairs between guides, and curves between points.

#include <cstdint>
#include <memory>
#include <span>

#include "hairloom/body_field.h"
#include "hairloom/engine.h"
#include "hairloom/memory.h"

namespace hairloom::runtime {

/// Which hairs may be how deep in a body: as deep as they were authored, and no deeper.
class BodyPush {
  public:
    /// `rest_ss`: points of hairs at rest, in the body's space; hair h owns [offsets[h], offsets[h + 1]), its
    /// root first.
    BodyPush(std::shared_ptr<const BodyField> body, Vector<std::uint32_t> offsets,
             std::span<const Float3> rest_ss);

    /// Moves points of hairs that are deeper out of the body, straight up, so that neither they nor the
    /// curves (uniform Catmull-Rom) between them, at quarters of their way, are. Roots stay. As many points
    /// as at rest; those that are not finite stay as they are, as do all where the body has no pose. The same
    /// bits for any number of threads.
    void apply(std::span<const BonePose> pose, std::span<Float3> points_ws, const Host& host = {}) const;

    /// Of each hair, where its points begin, and behind the last one where they end.
    std::span<const std::uint32_t> offsets() const { return offsets_; }
    /// Metres that each point keeps from the body, negative inside it, and likewise three places on the way
    /// from each to the next: ¼, ½ and ¾.
    std::span<const float> least() const { return least_; }
    std::span<const float> leastBetween() const { return leastBetween_; }

    std::size_t bytes() const {
        return offsets_.size() * sizeof(std::uint32_t) +
               (least_.size() + leastBetween_.size()) * sizeof(float);
    }

  private:
    struct Hair;
    void liftPoints(const PosedBody& body, Hair& hair) const;
    bool liftCurve(const PosedBody& body, Hair& hair) const;

    std::shared_ptr<const BodyField> body_;
    Vector<std::uint32_t> offsets_;
    Vector<float> least_, leastBetween_;
};

}  // namespace hairloom::runtime
