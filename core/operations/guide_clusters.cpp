// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/operations/guide_clusters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/parallel.h"
#include "core/geometry/curve.h"

namespace hairloom {
namespace {

constexpr std::size_t kPlaces = 8;  ///< along a strand, without the root
constexpr int kColumns = 3 + 3 * static_cast<int>(kPlaces);
constexpr std::size_t kGrain = 256;
constexpr int kMostSteps = 20;
using Rows = Eigen::Matrix<float, Eigen::Dynamic, kColumns, Eigen::RowMajor>;

/// Roots and shapes, so that the squared distance of two rows is what clusterGuides() says.
Rows featuresOf(const Groom& groom, std::span<const std::uint32_t> strands, float rootWeight) {
    Rows rows(static_cast<Eigen::Index>(strands.size()), kColumns);
    const float share = 1 / std::sqrt(static_cast<float>(kPlaces));
    parallelFor(strands.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const auto points = groom.strand(strands[k]);
            const std::vector<Vec3f> even = resampleEvenly(points, kPlaces + 1);
            const auto row = static_cast<Eigen::Index>(k);
            rows.block<1, 3>(row, 0) = rootWeight * points[0].transpose();
            for (std::size_t i = 1; i <= kPlaces; ++i)
                rows.block<1, 3>(row, 3 * static_cast<Eigen::Index>(i)) =
                    share * (even[i] - points[0]).transpose();
        }
    });
    return rows;
}

/// For each row the nearest of the middles, the first of equally near ones, and its squared distance.
void assign(const Rows& rows, const Rows& middles, std::vector<std::uint32_t>& nearest,
            std::vector<float>& squares) {
    nearest.resize(static_cast<std::size_t>(rows.rows()));
    squares.resize(nearest.size());
    const Eigen::VectorXf lengths = middles.rowwise().squaredNorm();
    parallelFor(nearest.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        const auto first = static_cast<Eigen::Index>(begin), count = static_cast<Eigen::Index>(end - begin);
        const Eigen::MatrixXf products = middles * rows.middleRows(first, count).transpose();
        for (Eigen::Index k = 0; k < count; ++k) {
            Eigen::Index best = 0;
            (lengths - 2 * products.col(k)).minCoeff(&best);
            nearest[begin + static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(best);
            squares[begin + static_cast<std::size_t>(k)] =
                (rows.row(first + k) - middles.row(best)).squaredNorm();
        }
    });
}

/// k-means++: each next middle is a row, drawn by the squared distance from those that there are.
template <class Told>
Rows firstMiddles(const Rows& rows, std::size_t count, std::uint64_t seed, const Told& told) {
    Random random(seed, 0);
    Rows middles(static_cast<Eigen::Index>(count), kColumns);
    std::vector<float> squares(static_cast<std::size_t>(rows.rows()), std::numeric_limits<float>::max());
    std::size_t next = random.below(static_cast<std::uint32_t>(squares.size()));
    for (std::size_t k = 0; k < count; ++k) {
        middles.row(static_cast<Eigen::Index>(k)) = rows.row(static_cast<Eigen::Index>(next));
        parallelFor(squares.size(), 16 * kGrain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                squares[i] = std::min(squares[i], (rows.row(static_cast<Eigen::Index>(i)) -
                                                   middles.row(static_cast<Eigen::Index>(k)))
                                                      .squaredNorm());
        });
        double sum = 0;
        for (const float square : squares) sum += static_cast<double>(square);
        double left = sum * static_cast<double>(random.uniform());
        for (next = 0; next + 1 < squares.size(); ++next) {
            left -= static_cast<double>(squares[next]);
            if (left < 0) break;
        }
        told(static_cast<double>(k + 1) / static_cast<double>(count));
    }
    return middles;
}

/// The mean of the rows of each; one without rows stays where it is.
void moveToMeans(const Rows& rows, const std::vector<std::uint32_t>& nearest, Rows& middles) {
    Eigen::Matrix<double, Eigen::Dynamic, kColumns, Eigen::RowMajor> sums =
        Eigen::Matrix<double, Eigen::Dynamic, kColumns, Eigen::RowMajor>::Zero(middles.rows(), kColumns);
    std::vector<std::size_t> counts(static_cast<std::size_t>(middles.rows()), 0);
    for (std::size_t i = 0; i < nearest.size(); ++i) {
        sums.row(nearest[i]) += rows.row(static_cast<Eigen::Index>(i)).cast<double>();
        ++counts[nearest[i]];
    }
    for (std::size_t k = 0; k < counts.size(); ++k) {
        const auto row = static_cast<Eigen::Index>(k);
        if (counts[k] > 0) middles.row(row) = (sums.row(row) / static_cast<double>(counts[k])).cast<float>();
    }
}

/// The row nearest to the middle of each cluster, ascending, each once.
std::vector<std::uint32_t> medoids(const std::vector<std::uint32_t>& nearest,
                                   const std::vector<float>& squares, std::size_t count) {
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> best(count, kNone);
    for (std::uint32_t i = 0; i < nearest.size(); ++i) {
        std::uint32_t& own = best[nearest[i]];
        if (own == kNone || squares[i] < squares[own]) own = i;
    }
    std::erase(best, kNone);
    std::ranges::sort(best);
    return best;
}

constexpr Field<GuidesSettings> kFields[] = {
    field<&GuidesSettings::count>("count", "", 1, 100'000,
                                  "number of guides; fewer if there are fewer strands"),
    field<&GuidesSettings::rootWeight>(
        "rootWeight", "", 0, 100,
        "weight of the distance between roots, relative to the difference in shape"),
    boolField<&GuidesSettings::alone>(
        "alone", "true keeps only the guides and represents the other strands by follow hairs"),
    seedField<&GuidesSettings::seed>("seed", "random seed of the clusters"),
};

}  // namespace

std::span<const Field<GuidesSettings>> fieldsOf(const GuidesSettings&) {
    return kFields;
}

GuideClusters clusterGuides(const Groom& groom, std::span<const std::uint32_t> strands,
                            const GuidesSettings& settings, const std::function<void(double)>& progress) {
    GuideClusters clusters;
    const auto tell = [&](double share) {
        if (progress) progress(share);
    };
    if (strands.size() <= settings.count) {
        clusters.guides.assign(strands.begin(), strands.end());
        clusters.guideOf = clusters.guides;
        return clusters;
    }
    const std::size_t count = settings.count;
    const Rows rows = featuresOf(groom, strands, settings.rootWeight);
    constexpr double kBegun = 0.1;  // share of the work that the first middles are
    Rows middles = firstMiddles(rows, count, settings.seed, [&](double share) { tell(kBegun * share); });
    std::vector<std::uint32_t> nearest, last;
    std::vector<float> squares;
    for (int step = 0; step < kMostSteps; ++step) {
        assign(rows, middles, nearest, squares);
        if (nearest == last) break;
        last = nearest;
        moveToMeans(rows, nearest, middles);
        tell(kBegun + (1 - kBegun) * (step + 1) / (kMostSteps + 2));
    }
    assign(rows, middles, nearest, squares);
    const std::vector<std::uint32_t> chosen = medoids(nearest, squares, count);
    Rows models(static_cast<Eigen::Index>(chosen.size()), kColumns);
    for (std::size_t k = 0; k < chosen.size(); ++k)
        models.row(static_cast<Eigen::Index>(k)) = rows.row(chosen[k]);
    assign(rows, models, nearest, squares);
    for (const std::uint32_t row : chosen) clusters.guides.push_back(strands[row]);
    const float perPlace = std::sqrt(static_cast<float>(kPlaces));
    for (std::size_t i = 0; i < strands.size(); ++i) {
        clusters.guideOf.push_back(clusters.guides[nearest[i]]);
        double sum = 0;
        for (Eigen::Index p = 3; p < kColumns; p += 3)
            sum += static_cast<double>(perPlace * (rows.block<1, 3>(static_cast<Eigen::Index>(i), p) -
                                                   models.block<1, 3>(nearest[i], p))
                                                      .norm());
        const double mm = 1e3 * sum / static_cast<double>(kPlaces);
        clusters.meanMm += mm / static_cast<double>(strands.size());
        clusters.maxMm = std::max(clusters.maxMm, mm);
    }
    tell(1);
    return clusters;
}

}  // namespace hairloom
