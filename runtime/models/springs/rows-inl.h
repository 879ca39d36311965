// SPDX-License-Identifier: MIT
// What the solvers along a strand read of a block: in its planes, or in a copy that lies point after point.
#if defined(HAIRLOOM_RUNTIME_ROWS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HAIRLOOM_RUNTIME_ROWS_INL_H
#undef HAIRLOOM_RUNTIME_ROWS_INL_H
#else
#define HAIRLOOM_RUNTIME_ROWS_INL_H
#endif

#include <type_traits>

#include "engine/lanes-inl.h"
#include "hwy/highway.h"
#include "models/springs/spring_block.h"

HWY_BEFORE_NAMESPACE();
namespace hairloom::runtime {
namespace HWY_NAMESPACE {

/// A vector of lanes.
struct Lanes {
    float values[kWidth];
};
HWY_INLINE V load(const Lanes& from) {
    return hn::Load(D(), from.values);
}
HWY_INLINE void store(V v, Lanes& to) {
    hn::Store(v, D(), to.values);
}
struct Lanes3 {
    Lanes x, y, z;
};
HWY_INLINE V3 load3(const Lanes3& from) {
    return {load(from.x), load(from.y), load(from.z)};
}
HWY_INLINE void store3(V3 v, Lanes3& to) {
    store(v.x, to.x);
    store(v.y, to.y);
    store(v.z, to.z);
}

/// A strip of a block in the block's planes.
class PlaneRows {
  public:
    /// Of one point, and of the segment or joint of its number; members are those of SpringBlock.
    class Row {
      public:
        HWY_INLINE Row(const SpringBlock& block, std::size_t at) : block_(&block), at_(at) {}

        HWY_INLINE V halfLength() const { return all(0.5f) * one(block_->length); }
        HWY_INLINE V inverseLength() const { return one(block_->inverseLength); }
        HWY_INLINE V inverseMass() const { return one(block_->inverseMass); }
        HWY_INLINE V stiffness() const { return one(block_->stiffness); }
        HWY_INLINE V inverseDiagonal() const { return one(block_->inverseDiagonal); }
        HWY_INLINE V lower1() const { return one(block_->lower1); }
        HWY_INLINE V lower2() const { return one(block_->lower2); }
        HWY_INLINE V3 target() const { return load3(block_->target, at_); }
        HWY_INLINE V tension() const { return one(block_->tension); }
        HWY_INLINE void setTension(V tension) const { hn::Store(tension, D(), block_->tension + at_); }

        HWY_INLINE Row operator+(std::size_t n) const { return {*block_, at_ + n * kBlockLanes}; }
        HWY_INLINE void advance() { at_ += kBlockLanes; }
        HWY_INLINE void retreat() { at_ -= kBlockLanes; }

      private:
        HWY_INLINE V one(const float* plane) const { return hn::Load(D(), plane + at_); }

        const SpringBlock* block_;
        std::size_t at_;
    };

    HWY_INLINE PlaneRows(const SpringBlock& block, std::size_t lane) : block_(block), lane_(lane) {}

    HWY_INLINE Row at(std::size_t p) const { return {block_, p * kBlockLanes + lane_}; }

  private:
    const SpringBlock& block_;
    const std::size_t lane_;
};

/// What CopiedRows has of a point, as in memory.
struct CopiedPoint {
    Lanes halfLength, inverseLength, inverseMass, stiffness, inverseDiagonal, lower1, lower2, tension;
};
struct CopiedCurvedPoint : CopiedPoint {
    Lanes3 target;
};
static_assert(sizeof(CopiedCurvedPoint) == kCopiedRows * kWidth * sizeof(float));

/// The same in a copy for the time of a frame, in which all that belongs to a point lies side by side: one
/// address serves for all of it. With `kCurved` targets as well; straight hair keeps less of the
/// first-level cache busy without.
template <bool kCurved>
class CopiedRows {
  public:
    using Point = std::conditional_t<kCurved, CopiedCurvedPoint, CopiedPoint>;

    class Row {
      public:
        HWY_INLINE explicit Row(Point* point) : point_(point) {}

        HWY_INLINE V halfLength() const { return load(point_->halfLength); }
        HWY_INLINE V inverseLength() const { return load(point_->inverseLength); }
        HWY_INLINE V inverseMass() const { return load(point_->inverseMass); }
        HWY_INLINE V stiffness() const { return load(point_->stiffness); }
        HWY_INLINE V inverseDiagonal() const { return load(point_->inverseDiagonal); }
        HWY_INLINE V lower1() const { return load(point_->lower1); }
        HWY_INLINE V lower2() const { return load(point_->lower2); }
        HWY_INLINE V3 target() const { return load3(point_->target); }
        HWY_INLINE V tension() const { return load(point_->tension); }
        HWY_INLINE void setTension(V tension) const { store(tension, point_->tension); }

        HWY_INLINE Row operator+(std::size_t n) const { return Row(point_ + n); }
        HWY_INLINE void advance() { ++point_; }
        HWY_INLINE void retreat() { --point_; }

        /// Takes in what the block has.
        HWY_INLINE void fill(const PlaneRows::Row& from) const {
            store(from.halfLength(), point_->halfLength);
            store(from.inverseLength(), point_->inverseLength);
            store(from.inverseMass(), point_->inverseMass);
            store(from.stiffness(), point_->stiffness);
            store(from.inverseDiagonal(), point_->inverseDiagonal);
            store(from.lower1(), point_->lower1);
            store(from.lower2(), point_->lower2);
            store(from.tension(), point_->tension);
            if constexpr (kCurved) store3(from.target(), point_->target);
        }

      private:
        Point* point_;
    };

    HWY_INLINE CopiedRows(const SpringBlock& block, LaneFrame& lanes, std::size_t lane)
        : points_(reinterpret_cast<Point*>(springLanes(lanes).copied) + lane / kWidth * block.points) {}

    HWY_INLINE Row at(std::size_t p) const { return Row(points_ + p); }

  private:
    Point* points_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace hairloom::runtime
HWY_AFTER_NAMESPACE();
#endif
