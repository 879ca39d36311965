// SPDX-License-Identifier: MIT
#pragma once
// Follow hairs: many hairs from few simulated guides (Rünz 2012, §4.2). A hair is a blend of two ways to
// follow:
//  - a wisp: the hair's own guide, moved within the cross-section of a wisp around it. The cross-section lies
//  in
//    the scalp at the root and is carried along the guide without twist. Wisps widen with speed (Eqs. 22,
//    23).
//  - a root triangle: the weighted mean of three guides.
// Bindings (which guides, which weights) come from outside; this evaluates them every frame.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "hairloom/host.h"
#include "hairloom/math.h"
#include "hairloom/memory.h"

namespace hairloom::runtime {

/// The plane of the scalp at a root: an orthonormal frame, right-handed.
struct RootPlane {
    Float3 x, y;    ///< span the plane
    Float3 normal;  ///< out of the scalp
};
static_assert(sizeof(RootPlane) == 3 * sizeof(Float3));

/// How wisps answer to speed (Choe et al. 2005; thesis Eq. 22, 23): at arc share s of a guide that moves at v
/// a wisp's radius is ξ = min(1 + σ s |v|, limit) times that at rest, and its centre lags by what it gained.
struct WispMotion {
    float spread = 0.15f;  ///< σ at the tip, s/m, 0 … kMostSpread; 0: wisps keep their width
    float limit = 10.0f;   ///< greatest ξ, 1 … kMostWidening
};
inline constexpr float kMostSpread = 10.0f, kMostWidening = 100.0f;

/// Guide strands and how hairs are bound to them. Arrays per hair are in the order of the hairs. With b the
/// blend, o the wisp offset, w the weights, u the root weights, d the root shift, p_k[i] point i of guide k
/// and X, Y the axes of guide 0's cross-section, point i of a hair lies at
///     (1 − b) (c[i] + ξ r[i] (o.x X[i] + o.y Y[i])) + b Σ w_k p_k[i] + b Σ (u_k − w_k) p_k[0] + R d,
/// where Eq. 22 gives ξ, Eq. 23 c, and R is the root plane turned with the scalp.
struct FollowView {
    std::span<const std::uint32_t> guideOffsets;  ///< guide count + 1, ascending from 0; guide g owns points
                                                  ///< [offsets[g], offsets[g + 1]), two or more of them
    /// Guides at rest, metres: read only for guides whose point count is not `pointsPerHair`, which are
    /// resampled at even shares of their length at rest. May be empty where there is no such guide.
    std::span<const Float3> guideRestPositions_ss;
    std::span<const RootPlane> rootPlanes_ss;  ///< per guide, at rest

    std::uint32_t pointsPerHair = 0;                       ///< 2 … 2²⁰
    std::span<const float> radii;                          ///< per point of a hair: r, metres, ≥ 0
    std::span<const std::array<std::uint32_t, 3>> guides;  ///< per hair, its own guide first
    std::span<const Float3> weights;                       ///< ≥ 0, sum 1
    std::span<const Float3> rootWeights;                   ///< ≥ 0, sum 1: the same for the root alone
    std::span<const std::array<float, 2>> wispOffsets;     ///< in units of the radius
    std::span<const float> blends;                         ///< 0 wisp … 1 root triangle
    std::span<const Float3> rootShifts;                    ///< metres, in the own guide's root plane
    WispMotion wisps = {};
};

/// The guides at one moment, guide after guide in the order of the offsets.
struct GuideMotion {
    std::span<const Float3> positions_ws;   ///< metres
    std::span<const Float3> velocities_ws;  ///< m/s; empty for guides at rest
    /// Per guide: turn of the scalp at its root since rest (a RootFrame's rotation divided by that at rest);
    /// need not be of unit length. Empty, or what is no rotation, stands for none.
    std::span<const Quat> rootRotations_ws;
};

/// Owns packed bindings and the memory of a frame. Evaluation allocates nothing and gives the same bits for
/// any number of threads; of instruction sets, for all that have fused multiply-add and all that have not.
class FollowHairs {
  public:
    struct Result;
    /// Errors, in words: arrays whose sizes do not match, a guide that is not there, point counts out of
    /// range, weights that do not sum to 1, anything that is not finite.
    static Result make(const FollowView& view);

    /// A copy has memory of its own.
    FollowHairs(const FollowHairs& other);
    FollowHairs(FollowHairs&&) noexcept;
    FollowHairs& operator=(FollowHairs&&) noexcept;
    ~FollowHairs();

    std::uint32_t hairCount() const;
    std::uint32_t pointsPerHair() const;
    /// Memory that it holds.
    std::size_t bytes() const;
    /// At most, of as many guides and hairs.
    static std::size_t bytesFor(std::size_t guides, std::size_t hairs, std::uint32_t pointsPerHair);

    /// Fills `hairs_ws` (hair after hair, pointsPerHair() each; metres). False, and nothing is written, where
    /// a size is not that of what make() was given. A point of a guide that is not finite makes that point of
    /// the hairs that take part of the guide not finite, and no other; a root that is not finite, the hairs
    /// that take part of the root. Not to be called on one object from two threads at a time.
    bool evaluate(const GuideMotion& guides, std::span<Float3> hairs_ws, const Host& host = {});
    /// The same of some hairs alone, in their order. Group g has the hairs groups[g] … groups[g + 1] - 1, of
    /// which the first taken[g + 1] - taken[g] are wanted; both begin at 0, and all hairs are in a group.
    bool evaluateSome(const GuideMotion& guides, std::span<const std::uint32_t> groups,
                      std::span<const std::uint32_t> taken, std::span<Float3> hairs_ws,
                      const Host& host = {});
    /// Takes hairs as they are evaluated, some at a time and from whatever threads; `first` counts wanted
    /// ones.
    using Sink = std::function<void(std::size_t first, std::size_t count, const Float3* hairs_ws)>;
    /// The same without room for all at a time: each run of hairs is handed to `sink`, which may be empty,
    /// after it was written to `hairs_ws`, or to a few KB of the stack where that is null. False, too, where
    /// hairs have more than kMaxShownPoints points.
    bool showSome(const GuideMotion& guides, std::span<const std::uint32_t> groups,
                  std::span<const std::uint32_t> taken, Float3* hairs_ws, const Sink& sink,
                  const Host& host = {});
    static constexpr std::uint32_t kMaxShownPoints = 512;

  private:
    struct Impl;
    explicit FollowHairs(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// A position along a guide: between point `segment` and the next.
struct GuideSample {
    std::uint32_t segment;
    float share;
};
/// Appends `count` ≥ 2 samples at even shares of the length of a guide of two points or more.
void sampleEvenly(std::span<const Float3> guide, std::uint32_t count, Vector<GuideSample>& samples);

struct FollowHairs::Result {
    std::optional<FollowHairs> hairs;
    std::string error;  ///< empty when there are hairs
};

}  // namespace hairloom::runtime
