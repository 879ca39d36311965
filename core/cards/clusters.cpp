// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/clusters.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>
#include <tuple>

#include "core/base/parallel.h"

namespace hairloom::cards {
namespace {

constexpr int kPowerSteps = 6;
constexpr int kExchanges = 2;  // of strands between the halves of a bundle
constexpr int kReturns = 3;    // of all strands to the strip nearest to them
constexpr float kAnything = std::numeric_limits<float>::infinity();

double errorOf(const EvenHair& hair, const Cluster& cluster) {
    double sum = 0;
    for (const std::uint32_t s : cluster.strands) {
        sum += static_cast<double>(hair.weights[s]) *
               static_cast<double>(offStrip(cluster.strip, hair.strand(s), kAnything));
    }
    return sum;
}

Cluster made(const EvenHair& hair, std::vector<std::uint32_t> strands, std::span<const Vec3f> normals) {
    Cluster cluster;
    cluster.strip = fitStrip(hair, strands, normals);
    cluster.strands = std::move(strands);
    cluster.error = errorOf(hair, cluster);
    return cluster;
}

/// Of each strand, how far it lies along the direction in which the residuals differ most (power iteration).
std::vector<float> mainDirection(const EvenHair& hair, const Cluster& cluster) {
    const std::size_t size = 3 * std::size_t{hair.stations}, count = cluster.strands.size();
    std::vector<float> residuals(count * size), place(count);
    std::size_t farthest = 0;
    float most = -1;
    for (std::size_t i = 0; i < count; ++i) {
        const std::span<float> out(residuals.data() + i * size, size);
        residual(cluster.strip, hair.strand(cluster.strands[i]), out);
        const float norm = std::inner_product(out.begin(), out.end(), out.begin(), 0.0f);
        if (norm > most) most = norm, farthest = i;
    }
    const auto row = [&](std::size_t i) {
        return Eigen::Map<const Eigen::VectorXf>(residuals.data() + i * size,
                                                 static_cast<Eigen::Index>(size));
    };
    Eigen::VectorXf direction = row(farthest);
    for (int step = 0; step < kPowerSteps; ++step) {
        const float norm = direction.norm();
        if (!(norm > 0)) break;
        direction /= norm;
        Eigen::VectorXf next = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(size));
        for (std::size_t i = 0; i < count; ++i) {
            place[i] = row(i).dot(direction);
            next += hair.weights[cluster.strands[i]] * place[i] * row(i);
        }
        direction = next;
    }
    return place;
}

/// Two bundles of one that holds at least two strands.
std::pair<Cluster, Cluster> split(const EvenHair& hair, const Cluster& cluster,
                                  std::span<const Vec3f> normals) {
    const auto place = mainDirection(hair, cluster);
    std::vector<std::uint32_t> low, high;
    for (std::size_t i = 0; i < place.size(); ++i) (place[i] < 0 ? low : high).push_back(cluster.strands[i]);
    if (low.empty() || high.empty()) {  // all alike: halves
        low.assign(cluster.strands.begin(),
                   cluster.strands.begin() + static_cast<std::ptrdiff_t>(place.size() / 2));
        high.assign(cluster.strands.begin() + static_cast<std::ptrdiff_t>(place.size() / 2),
                    cluster.strands.end());
    }
    for (int step = 0; step < kExchanges; ++step) {
        const Strip a = fitStrip(hair, low, normals), b = fitStrip(hair, high, normals);
        std::vector<std::uint32_t> toA, toB;
        for (const std::uint32_t s : cluster.strands) {
            const float distance = offStrip(a, hair.strand(s), kAnything);
            (distance <= offStrip(b, hair.strand(s), distance) ? toA : toB).push_back(s);
        }
        if (toA.empty() || toB.empty()) break;
        low = std::move(toA), high = std::move(toB);
    }
    return {made(hair, std::move(low), normals), made(hair, std::move(high), normals)};
}

bool isGoodEnough(const EvenHair& hair, const Cluster& cluster, float metres) {
    double weight = 0;
    for (const std::uint32_t s : cluster.strands) weight += static_cast<double>(hair.weights[s]);
    return cluster.error <= weight * static_cast<double>(metres) * static_cast<double>(metres);
}

/// Every strand of the bundles to the strip nearest to it; none is left without strands.
void returnStrands(const EvenHair& hair, std::vector<Cluster>& clusters, std::span<const Vec3f> normals) {
    struct Member {
        std::uint32_t strand, cluster;
    };
    std::vector<Member> members;
    for (std::uint32_t c = 0; c < clusters.size(); ++c)
        for (const std::uint32_t s : clusters[c].strands) members.push_back({s, c});
    std::ranges::sort(members, {}, &Member::strand);
    parallelFor(members.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto points = hair.strand(members[i].strand);
            const std::uint32_t own = members[i].cluster;
            float best = offStrip(clusters[own].strip, points, kAnything);
            for (std::uint32_t c = 0; c < clusters.size(); ++c) {
                if (c == own) continue;
                const float distance = offStrip(clusters[c].strip, points, best);
                if (distance < best) best = distance, members[i].cluster = c;
            }
        }
    });
    std::vector<std::vector<std::uint32_t>> strands(clusters.size());
    for (const Member& member : members) strands[member.cluster].push_back(member.strand);
    parallelFor(clusters.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c)
            if (!strands[c].empty())
                clusters[c] = made(hair, std::move(strands[c]), normals);
            else
                clusters[c].strands.clear();
    });
    std::erase_if(clusters, [](const Cluster& cluster) { return cluster.strands.empty(); });
}

/// Roots of some strands by cells of a grid.
class RootCells {
  public:
    RootCells(const EvenHair& hair, std::span<const std::uint32_t> strands, float cell) : cell_(cell) {
        for (std::uint32_t i = 0; i < strands.size(); ++i) {
            at_.push_back(hair.strand(strands[i])[0]);
            sorted_.push_back({cellOf(at_.back(), Vec3f::Zero()), i});
        }
        std::ranges::sort(sorted_);
    }
    /// Calls f(i, square of the distance) for all but `of` that may be within a cell's side of it.
    template <class F>
    void forNear(std::uint32_t of, const F& f) const {
        for (int x = -1; x <= 1; ++x) {
            for (int y = -1; y <= 1; ++y) {
                // Cells along z follow each other.
                const Cell first = cellOf(at_[of], Vec3f(static_cast<float>(x), static_cast<float>(y), -1));
                const Cell last = cellOf(at_[of], Vec3f(static_cast<float>(x), static_cast<float>(y), 1));
                auto entry = std::ranges::lower_bound(sorted_, first, {}, &Entry::first);
                for (; entry != sorted_.end() && entry->first <= last; ++entry)
                    if (entry->second != of) f(entry->second, (at_[entry->second] - at_[of]).squaredNorm());
            }
        }
    }

  private:
    using Cell = std::tuple<int, int, int>;
    using Entry = std::pair<Cell, std::uint32_t>;
    Cell cellOf(const Vec3f& at, const Vec3f& aside) const {
        const Vec3f place = (at / cell_).array().floor().matrix() + aside;
        return {static_cast<int>(place.x()), static_cast<int>(place.y()), static_cast<int>(place.z())};
    }
    float cell_;
    std::vector<Vec3f> at_;
    std::vector<Entry> sorted_;
};

/// Parts the bundles that span skin, those of the most hair first, as far as `most` allows. Strays of a few
/// hairs stay: a card for each would cost more than they show.
void partByRoots(const EvenHair& hair, std::vector<Cluster>& clusters, std::span<const Vec3f> normals,
                 std::size_t most) {
    constexpr double kStray = 0.05;  // of the strands of a bundle
    struct Part {
        std::size_t cluster;
        std::vector<std::uint32_t> strands;
    };
    std::vector<Part> parts;
    for (std::size_t c = 0; c < clusters.size(); ++c) {
        auto pieces = byRoots(hair, clusters[c].strands);
        for (std::size_t i = 1; i < pieces.size(); ++i) {
            if (static_cast<double>(pieces[i].size()) >
                kStray * static_cast<double>(clusters[c].strands.size()))
                parts.push_back({c, std::move(pieces[i])});
        }
    }
    std::ranges::stable_sort(parts, std::ranges::greater{},
                             [](const Part& part) { return part.strands.size(); });
    if (clusters.size() + parts.size() > most) parts.resize(most - std::min(most, clusters.size()));
    for (Part& part : parts) {
        Cluster& whole = clusters[part.cluster];
        std::vector<std::uint32_t> rest;
        std::ranges::set_difference(whole.strands, part.strands, std::back_inserter(rest));
        whole = made(hair, std::move(rest), normals);
        clusters.push_back(made(hair, std::move(part.strands), normals));
    }
}

}  // namespace

std::vector<std::vector<std::uint32_t>> byRoots(const EvenHair& hair,
                                                std::span<const std::uint32_t> strands) {
    constexpr float kApart = 4;                       // times the median distance to the next root
    constexpr float kLeast = 0.004f, kMost = 0.012f;  // metres
    const RootCells cells(hair, strands, kMost);
    std::vector<float> next(strands.size(), kMost * kMost);
    for (std::uint32_t i = 0; i < strands.size(); ++i)
        cells.forNear(i, [&](std::uint32_t, float square) { next[i] = std::min(next[i], square); });
    std::vector<float> sorted = next;
    std::ranges::nth_element(sorted, sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2));
    const float apart = std::clamp(kApart * std::sqrt(sorted[sorted.size() / 2]), kLeast, kMost);
    std::vector<std::vector<std::uint32_t>> pieces;
    std::vector<bool> taken(strands.size(), false);
    for (std::uint32_t start = 0; start < strands.size(); ++start) {
        if (taken[start]) continue;
        std::vector<std::uint32_t> open{start};
        std::vector<std::uint32_t>& piece = pieces.emplace_back();
        taken[start] = true;
        while (!open.empty()) {
            const std::uint32_t i = open.back();
            open.pop_back();
            piece.push_back(strands[i]);
            cells.forNear(i, [&](std::uint32_t j, float square) {
                if (!taken[j] && square <= apart * apart) taken[j] = true, open.push_back(j);
            });
        }
        std::ranges::sort(piece);
    }
    std::ranges::stable_sort(pieces, std::ranges::greater{}, [](const auto& piece) { return piece.size(); });
    return pieces;
}

Result<std::vector<Cluster>> clusterHair(const EvenHair& hair, std::vector<std::uint32_t> strands,
                                         std::span<const Vec3f> rootNormals_ws, const ClusterOptions& options,
                                         Cancel cancel) {
    std::vector<Cluster> clusters;
    clusters.push_back(made(hair, std::move(strands), rootNormals_ws));
    const auto grow = [&](std::size_t most) {
        while (clusters.size() < most && !cancelled(cancel)) {
            Cluster* worst = nullptr;
            for (Cluster& cluster : clusters) {
                if (cluster.strands.size() < 2 || isGoodEnough(hair, cluster, options.goodEnough)) continue;
                if (worst == nullptr || cluster.error > worst->error) worst = &cluster;
            }
            if (worst == nullptr || !(worst->error > 0)) return;
            auto [low, high] = split(hair, *worst, rootNormals_ws);
            *worst = std::move(low);
            clusters.push_back(std::move(high));
        }
    };
    // Halves of halves keep the borders of the first cuts; strands that change over half-way mend that.
    grow(std::max<std::size_t>(1, options.most / 2));
    returnStrands(hair, clusters, rootNormals_ws);
    // Some are left for bundles that span skin.
    constexpr std::uint32_t kOneIn = 20;
    grow(options.most - options.most / kOneIn);
    for (int step = 0; step < kReturns && !cancelled(cancel); ++step)
        returnStrands(hair, clusters, rootNormals_ws);
    if (cancelled(cancel)) return stopped();
    partByRoots(hair, clusters, rootNormals_ws, options.most);
    grow(options.most);
    std::ranges::sort(clusters, {}, [](const Cluster& cluster) { return cluster.strands.front(); });
    return clusters;
}

}  // namespace hairloom::cards
