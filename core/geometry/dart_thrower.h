// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Hierarchical dart throwing on triangles (Cline, Jeschke, White, Razdan and Wonka 2009), and more roots in
// the widest gaps that it leaves. Private to core/geometry.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/base/random.h"
#include "core/geometry/placement.h"

namespace hairloom {

/// Roots by position, in cells two radii wide, so that a search of one radius reads at most eight. Cells lie
/// in blocks that exist only where the surface goes.
class DartGrid {
  public:
    struct Entry {
        Vec3f position;
        float radius;  ///< local radius, metres
    };
    DartGrid(const Vec3f& origin, float cell) : origin_(origin), perCell_(1 / cell) {}

    void add(const Entry& entry);
    /// Calls visit(entry) for at least all entries within `range` of `center`, until it returns true.
    template <class Visit>
    bool search(const Vec3f& center, float range, Visit visit) const;

  private:
    static constexpr std::uint32_t kNone = ~0u;
    static constexpr int kBits = 4;  ///< a block is 16 cells wide
    static constexpr std::size_t kChunk = 5;
    struct Chunk {
        std::array<Entry, kChunk> entries;
        std::uint32_t count = 0;
        std::uint32_t next = kNone;
    };
    using Block = std::array<std::uint32_t, std::size_t{1} << (3 * kBits)>;  ///< first chunk of each cell
    using Cell = Eigen::Vector3i;

    Cell cellOf(const Vec3f& p) const { return ((p - origin_) * perCell_).array().floor().cast<int>(); }
    static std::uint64_t keyOf(const Cell& block) {
        const auto part = [](int value) { return static_cast<std::uint64_t>(value + (1 << 20)) & 0x1fffffu; };
        return part(block.x()) << 42u | part(block.y()) << 21u | part(block.z());
    }
    static std::size_t slotOf(const Cell& cell) {
        constexpr int kMask = (1 << kBits) - 1;
        return static_cast<std::size_t>(((cell.z() & kMask) << (2 * kBits)) | ((cell.y() & kMask) << kBits) |
                                        (cell.x() & kMask));
    }
    std::uint32_t blockIndex(const Cell& cell) const;
    /// Calls visit for the entries of a cell until it returns true.
    template <class Visit>
    bool visitCell(std::uint32_t firstChunk, Visit visit) const;

    Vec3f origin_;
    float perCell_;
    std::vector<Chunk> chunks_;
    std::vector<Block> blocks_;
    std::unordered_map<std::uint64_t, std::uint32_t> blockOf_;
    mutable std::uint64_t lastKey_ = ~std::uint64_t{0};
    mutable std::uint32_t lastBlock_ = kNone;
};

class DartThrower {
  public:
    DartThrower(const ScalpMesh& mesh, const FaceSet& faces, std::span<const float> mask, float radius,
                std::uint64_t seed);

    /// Throws until the set is maximal (true), or until it would hold more than `maximum` roots (false).
    bool run(std::size_t maximum);

    /// After a run that ended maximal: puts a root where the surface is farthest from all, again and again,
    /// until there are `count`. Returns the distance that roots keep then, metres, for which the set is
    /// maximal again; nothing where the gaps are too small for so many.
    std::optional<float> fillWidestGaps(std::size_t count);

    std::vector<SurfacePoint> takeRoots() { return std::move(roots_); }
    std::size_t rootCount() const { return roots_.size(); }

  private:
    /// Part of a triangle.
    struct Fragment {
        std::array<Vec2f, 3> corners;    ///< second and third barycentric, exact at any depth used
        std::array<Vec3f, 3> positions;  ///< metres
        std::uint32_t triangle;
    };
    /// A fragment in work. Per corner, bit i tells that root i of near_ is within reach, for the first
    /// `known` roots.
    struct Part : Fragment {
        std::array<std::uint64_t, 3> reached{};
        std::size_t known = 0;
    };
    struct Spacing {
        float radius, widest;  ///< smallest and largest local radius in the fragment
        bool bare;             ///< the mask is 0 all over the fragment
    };

    static Vec3f barycentric(const Vec2f& part) {
        return {std::max(0.0f, 1 - part.x() - part.y()), part.x(), part.y()};
    }
    float densityAt(std::uint32_t triangle, const Vec3f& weights) const;
    float localRadius(float density) const;
    Spacing spacingOf(const Fragment& fragment) const;
    Fragment wholeFace(std::uint32_t face) const;
    /// Random darts on the whole selection: cheap while most of it is free.
    void throwAnywhere(std::size_t maximum);
    /// Fills the parts of a face that are small enough for fill().
    void fillParts(const Fragment& fragment, std::size_t maximum);
    /// Throws one dart at the fragment, checked against near_, which it may have to gather.
    void throwDart(const Fragment& fragment, bool gather);
    void fill(const Fragment& fragment, std::size_t maximum);
    void gatherNear(const Vec3f& center, float range);
    /// All roots that matter to the fragment.
    void gatherAround(const Fragment& fragment);
    bool coveredByNear(Part& part) const;
    std::uint64_t rootsReached(const Vec3f& position, std::size_t first) const;
    void splitAndKeep(const Part& part);

    /// How far a part of the surface is from its roots, as a share of the distance that the two have to keep.
    struct Gap : Fragment {
        float widest;         ///< no point of the part is farther
        float middle;         ///< of the part's middle; 0 where nothing may grow
        std::uint64_t order;  ///< in which they were found

        bool operator<(const Gap& other) const {
            return widest < other.widest || (widest == other.widest && order > other.order);
        }
    };
    /// Puts those of a part that may be wide enough to be filled into the heap.
    void listGaps(const Fragment& fragment);
    void refineGaps(const Fragment& fragment);
    /// Against the roots of near_, which gatherAround() gathered for the fragment or one around it.
    Gap gapByNear(const Fragment& fragment) const;
    void pushGap(Gap gap);

    const ScalpMesh& mesh_;
    std::span<const float> mask_;
    float radius_;
    float apart_;  ///< the radius plus what rounding of a measured distance may take away
    Random random_;
    DartGrid grid_;
    FaceSet faces_;
    std::vector<Part> small_;  ///< parts of the fragment in work
    std::vector<SurfacePoint> roots_;
    std::vector<DartGrid::Entry> near_;
    std::vector<Gap> gaps_;  ///< a heap, the widest on top
    std::uint64_t foundGaps_ = 0;
};

}  // namespace hairloom
