// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/clusters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

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

}  // namespace

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
    grow(options.most);
    for (int step = 0; step < kReturns && !cancelled(cancel); ++step)
        returnStrands(hair, clusters, rootNormals_ws);
    if (cancelled(cancel)) return stopped();
    std::ranges::sort(clusters, {}, [](const Cluster& cluster) { return cluster.strands.front(); });
    return clusters;
}

}  // namespace hairloom::cards
