// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/clump.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/curve.h"
#include "core/operations/clump_centres.h"
#include "core/operations/length_constraint.h"
#include "core/operations/operation.h"
#include "core/operations/reshape.h"
#include "core/operations/strand_frames.h"

namespace hairloom {
namespace {

using S = ClumpSettings;

constexpr std::size_t kMostLevels = 3;
constexpr Field<S> kFields[] = {
    field<&S::spacing>("spacing", "m", 0.0005, 1,
                       "distance between clump centres: larger gives fewer clumps"),
    field<&S::strength>("strength", "", 0, 1,
                        "how far the tip moves to the clump centre, as a share of the distance"),
    field<&S::profile>("profile", "", 0.1, 10,
                       "how the pull grows from the root: 1 linearly, above 1 nearer to the tip"),
    field<&S::variation>("variation", "", 0, 1, "largest random reduction of the pull per strand or clump"),
    field<&S::noise>("noise", "m", 0, 0.1, "how far the tip of each clump wanders as a whole"),
    field<&S::noiseFrequency>("noiseFrequency", "1/m", 0, 1000,
                              "bends per metre of that wandering, limited to one per four segments"),
    field<&S::levels>("levels", "", 1, kMostLevels, "clumps within clumps: 2 and 3 add smaller ones"),
    field<&S::spacing2>("spacing2", "m", 0.0005, 1, "distance between the smaller clumps of level 2"),
    field<&S::strength2>("strength2", "", 0, 1, "how tight the clumps of level 2 are"),
    field<&S::noise2>("noise2", "m", 0, 0.1, "how far the tip of each clump of level 2 wanders"),
    field<&S::spacing3>("spacing3", "m", 0.0005, 1, "distance between the smallest clumps of level 3"),
    field<&S::strength3>("strength3", "", 0, 1, "how tight the clumps of level 3 are"),
    field<&S::noise3>("noise3", "m", 0, 0.1, "how far the tip of each clump of level 3 wanders"),
    clearanceField<&S::clearance>(),
    seedField<&S::seed>("seed", "random seed of the clump centres"),
};
constexpr const char* kFormulaFields[] = {"strength",  "profile", "variation", "noise",
                                          "strength2", "noise2",  "strength3", "noise3"};

struct Level {
    float spacing, strength, noise;
};
std::array<Level, kMostLevels> levelsOf(const S& settings) {
    return {{{settings.spacing, settings.strength, settings.noise},
             {settings.spacing2, settings.strength2, settings.noise2},
             {settings.spacing3, settings.strength3, settings.noise3}}};
}

/// Who leads whom on each level, and where a clump wanders.
class Clumps {
  public:
    Clumps(const Groom& groom, const S& settings)
        : groom_(groom),
          ids_(groom.strandAttributes.view<std::uint32_t>(attribute::kStrandId)),
          seed_(settings.seed),
          frequency_(settings.noiseFrequency) {
        const auto levels = levelsOf(settings);
        for (std::uint32_t i = 0; i < settings.levels; ++i)
            leaders_.push_back(chooseCentres(groom, levels[i].spacing, i == 0 ? seed_ : streamOf(i)));
    }

    std::size_t levels() const { return leaders_.size(); }
    std::uint32_t leader(std::size_t level, std::uint32_t strand) const { return leaders_[level][strand]; }
    std::span<const Vec3f> shape(std::uint32_t strand) const { return groom_.strand(strand); }
    /// 0 … 1, the same for all that a strand leads.
    float chance(std::uint32_t strand) const { return Random(seed_, idOf(strand)).uniform(); }

    struct Course {
        std::uint64_t stream;
        float waves;  ///< over the whole length
        Vec3f at(float t) const { return t * (waveAt(stream, t * waves) - waveAt(stream, 0)); }
    };
    Course courseOf(std::size_t level, std::uint32_t leader) const {
        constexpr float kSegmentsPerWave = 4;
        const auto points = shape(leader);
        const float finest = static_cast<float>(points.size() - 1) / kSegmentsPerWave;
        return {Random(streamOf(level) ^ seed_, idOf(leader)).next(),
                std::min(frequency_ * polylineLength(points), finest)};
    }

  private:
    std::uint64_t streamOf(std::size_t level) const { return Random::mix(seed_ + 0x636c756d70 + level); }
    std::uint64_t idOf(std::uint32_t strand) const { return strand < ids_.size() ? ids_[strand] : strand; }

    const Groom& groom_;
    std::span<const std::uint32_t> ids_;
    std::uint64_t seed_;
    float frequency_;
    std::vector<std::vector<std::uint32_t>> leaders_;  ///< by level, the largest clumps first
};

/// From the smallest clump to the largest: a strand goes to its leader, the leader with all that it leads to
/// its own. Restores no lengths. False where nothing moves.
bool gather(const Clumps& clumps, const S& settings, std::uint32_t strand, std::span<Vec3f> points) {
    const auto levels = levelsOf(settings);
    std::uint32_t follower = strand;
    bool moved = false;
    for (std::size_t level = clumps.levels(); level-- > 0;) {
        const std::uint32_t leader = clumps.leader(level, follower);
        const float noise = levels[level].noise;
        if (leader == follower && !(noise > 0)) continue;
        const auto from = clumps.shape(follower), to = clumps.shape(leader);
        const float pull = levels[level].strength * (1 - settings.variation * clumps.chance(follower));
        const Clumps::Course course = clumps.courseOf(level, leader);
        for (std::size_t i = 1; i < points.size(); ++i) {
            const float t = static_cast<float>(i) / static_cast<float>(points.size() - 1);
            const Vec3f at = follower == strand ? from[i] : pointAlong(from, t);
            points[i] += pull * std::pow(t, settings.profile) * (pointAlong(to, t) - at);
            if (noise > 0) points[i] += noise * course.at(t);
        }
        moved = true;
        follower = leader;
    }
    return moved;
}

}  // namespace

std::span<const Field<S>> fieldsOf(const S&) {
    return kFields;
}

namespace {

Result<std::size_t> clumpVaried(Groom& groom, const Varied<S>& varied, const Region& region) {
    if (auto status = checkFields("clump", varied.base()); !status) return tl::unexpected(status.error());
    const Groom before = groom;
    const Clumps clumps(before, varied.base());
    return editStrands(groom, region, {varied.base().clearance}, [&](StrandEdit& strand) {
        if (gather(clumps, varied.at(strand.index), static_cast<std::uint32_t>(strand.index), strand.points))
            restoreLengths(strand.points, strand.lengths);
    });
}

}  // namespace

Result<std::size_t> clump(Groom& groom, const S& settings, const Region& region) {
    return clumpVaried(groom, settings, region);
}

Operation clumpOperation() {
    return variedOperation<S, clumpVaried, kFormulaFields>(
        "clump", 30, "pulls strands together into clumps, and into clumps of clumps");
}

}  // namespace hairloom
