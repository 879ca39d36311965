// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/tables.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/parallel.h"

namespace hairloom::shading {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kRowsAtOnce = 4;
// At exactly 90 degrees there is no plane across the fibre; half a degree before, as much light as ever
// matters is left.
constexpr double kLargestTheta = 89.5 * kDegree;

double coordinate(std::size_t i, std::uint32_t count) {
    return static_cast<double>(i) / static_cast<double>(count - 1);
}

double thetaOf(std::size_t i, std::uint32_t count) {
    const double theta = std::asin(std::clamp(2 * coordinate(i, count) - 1, -1.0, 1.0));
    return std::clamp(theta, -kLargestTheta, kLargestTheta);
}

Table makeTable(std::uint32_t width, std::uint32_t height) {
    return {width, height, std::vector<float>(std::size_t{4} * width * height)};
}

template <class Row>
void forRows(const Table& table, const Row& row) {
    parallelFor(table.height, kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) row(static_cast<std::uint32_t>(y));
    });
}

/// M(lobe, column, row, θ_h) times the cosines. The middle of a Gaussian is no wider than six deviations.
template <class M>
Table bakeM(std::uint32_t size, const M& m) {
    Table table = makeTable(size, size);
    std::vector<double> thetas(size), cosines(size), sines(size);
    for (std::size_t i = 0; i < size; ++i) {
        thetas[i] = thetaOf(i, size);
        cosines[i] = std::cos(thetas[i]);
        sines[i] = std::sin(thetas[i]);
    }
    forRows(table, [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < size; ++x) {
            // cos²θ_d = (1 + cos 2θ_d)/2, without a cosine for each texel.
            const double cosDSquared = 0.5 * (1 + cosines[x] * cosines[y] + sines[x] * sines[y]);
            const double factor = cosines[x] / cosDSquared;
            float* texel = table.texel(x, y);
            for (const Lobe lobe : kLobes) {
                texel[index(lobe)] =
                    static_cast<float>(factor * m(lobe, x, y, 0.5 * (thetas[x] + thetas[y])));
            }
            texel[3] = static_cast<float>(std::abs(thetas[y] - thetas[x]) / kPi);
        }
    });
    return table;
}

/// factor(lobe, θ) at each place of a side.
template <class Factor>
std::array<std::vector<double>, 3> byLobe(std::uint32_t size, const Factor& factor) {
    std::array<std::vector<double>, 3> result;
    for (const Lobe lobe : kLobes) {
        for (std::size_t i = 0; i < size; ++i) result[index(lobe)].push_back(factor(lobe, thetaOf(i, size)));
    }
    return result;
}

struct GridPlace {
    std::size_t low;
    float part;
};

/// Where in AzimuthalProfile::Grid each column's azimuth lies.
std::vector<GridPlace> gridPlaces(std::uint32_t columns) {
    constexpr double kSteps = AzimuthalProfile::kGridSize - 1;
    std::vector<GridPlace> places;
    for (std::uint32_t x = 0; x < columns; ++x) {
        const double phi = std::acos(std::clamp(2 * coordinate(x, columns) - 1, -1.0, 1.0));
        const double at = phi / kPi * kSteps;
        const double low = std::min(std::floor(at), kSteps - 1);
        places.push_back({static_cast<std::size_t>(low), static_cast<float>(at - low)});
    }
    return places;
}

template <class Row>
float at(const Row& row, const GridPlace& place) {
    return row[place.low] + place.part * (row[place.low + 1] - row[place.low]);
}

}  // namespace

std::array<double, 4> Table::sample(double u, double v) const {
    const double x = std::clamp(u, 0.0, 1.0) * (width - 1);
    const double y = std::clamp(v, 0.0, 1.0) * (height - 1);
    const auto x0 = std::min(static_cast<std::uint32_t>(x), width - 2);
    const auto y0 = std::min(static_cast<std::uint32_t>(y), height - 2);
    const double s = x - x0;
    const double t = y - y0;
    std::array<double, 4> result{};
    for (std::size_t c = 0; c < 4; ++c) {
        const auto value = [&](std::uint32_t i, std::uint32_t j) {
            return static_cast<double>(texel(i, j)[c]);
        };
        result[c] = (1 - t) * ((1 - s) * value(x0, y0) + s * value(x0 + 1, y0)) +
                    t * ((1 - s) * value(x0, y0 + 1) + s * value(x0 + 1, y0 + 1));
    }
    return result;
}

Table bakeLongitudinal(const Marschner& model, std::uint32_t size) {
    const auto in =
        byLobe(size, [&](Lobe lobe, double theta) { return model.longitudinalLobe(lobe).factorIn(theta); });
    const auto out =
        byLobe(size, [&](Lobe lobe, double theta) { return model.longitudinalLobe(lobe).factorOut(theta); });
    return bakeM(size, [&](Lobe lobe, std::size_t x, std::size_t y, double thetaHalf) {
        const LongitudinalLobe& l = model.longitudinalLobe(lobe);
        if (std::abs(thetaHalf - l.tilt()) > 6 * l.width()) return 0.0;
        return model.scale(lobe) * in[index(lobe)][x] * out[index(lobe)][y] * l.gauss(thetaHalf);
    });
}

Table bakeLongitudinal(const SadeghiLongitudinal& model, std::uint32_t size) {
    const auto in = byLobe(size, [&](Lobe lobe, double theta) { return model.factorIn(lobe, theta); });
    const auto out = byLobe(size, [&](Lobe lobe, double theta) { return model.factorOut(lobe, theta); });
    return bakeM(size, [&](Lobe lobe, std::size_t x, std::size_t y, double thetaHalf) {
        return in[index(lobe)][x] * out[index(lobe)][y] * model.gauss(lobe, thetaHalf);
    });
}

MarschnerTables bakeMarschner(const Marschner& model, const TableSizes& sizes) {
    MarschnerTables tables = bakeAzimuthal(model, sizes);
    tables.longitudinal = bakeLongitudinal(model, sizes.longitudinal);
    return tables;
}

MarschnerTables bakeAzimuthal(const Marschner& model, const TableSizes& sizes) {
    MarschnerTables tables;
    tables.transmitted = makeTable(sizes.azimuth, sizes.inclination);
    tables.reflected = makeTable(sizes.azimuth, sizes.inclination);
    const std::vector<GridPlace> places = gridPlaces(sizes.azimuth);
    forRows(tables.transmitted, [&](std::uint32_t y) {
        const double thetaD = std::min(coordinate(y, sizes.inclination) * kPi / 2, kLargestTheta);
        const AzimuthalProfile::Grid grid = model.azimuthal(thetaD).grid();
        for (std::uint32_t x = 0; x < sizes.azimuth; ++x) {
            float* tt = tables.transmitted.texel(x, y);
            float* trt = tables.reflected.texel(x, y);
            for (std::size_t c = 0; c < 3; ++c) {
                tt[c] = at(grid.tt[c], places[x]);
                trt[c] = at(grid.trt[c], places[x]);
            }
            tt[3] = at(grid.r, places[x]);
            trt[3] = 1;
        }
    });
    return tables;
}

SadeghiTables bakeSadeghi(const SadeghiParameters& model, const TableSizes& sizes) {
    return bakeSadeghi(model, SadeghiLongitudinal(model), sizes);
}

SadeghiTables bakeSadeghi(const SadeghiParameters& model, const SadeghiLongitudinal& longitudinal,
                          const TableSizes& sizes) {
    SadeghiTables tables;
    tables.longitudinal = bakeLongitudinal(longitudinal, sizes.longitudinal);
    tables.azimuthal = makeTable(sizes.azimuth, sizes.inclination);
    forRows(tables.azimuthal, [&](std::uint32_t y) {
        const double glint = coordinate(y, sizes.inclination);
        for (std::uint32_t x = 0; x < sizes.azimuth; ++x) {
            const double phi = std::acos(std::clamp(2 * coordinate(x, sizes.azimuth) - 1, -1.0, 1.0));
            float* texel = tables.azimuthal.texel(x, y);
            for (const Lobe lobe : kLobes) {
                texel[index(lobe)] = static_cast<float>(sadeghiAzimuthal(model, lobe, phi, glint));
            }
            texel[3] = 1;
        }
    });
    return tables;
}

DualTables bakeDual(const DualScattering& model, std::uint32_t azimuth, std::uint32_t inclination) {
    DualTables tables{makeTable(azimuth, inclination), makeTable(inclination, 5), makeTable(inclination, 4)};
    const std::vector<GridPlace> places = gridPlaces(azimuth);
    forRows(tables.profile, [&](std::uint32_t y) {
        const DualScattering::Row row =
            model.at(std::min(coordinate(y, inclination) * kPi / 2, kLargestTheta));
        for (std::uint32_t x = 0; x < azimuth; ++x) {
            float* texel = tables.profile.texel(x, y);
            for (std::size_t c = 0; c < 3; ++c) texel[c] = at(row.profile[c], places[x]);
            texel[3] = 1;
        }
        const AverageScattering& a = row.average;
        const auto set = [&](std::uint32_t line, double r, double g, double b, double w) {
            float* texel = tables.averages.texel(y, line);
            texel[0] = static_cast<float>(r);
            texel[1] = static_cast<float>(g);
            texel[2] = static_cast<float>(b);
            texel[3] = static_cast<float>(w);
        };
        set(0, a.forward.x(), a.forward.y(), a.forward.z(), a.forwardVariance);
        set(1, a.backward.x(), a.backward.y(), a.backward.z(), a.backwardVariance);
        set(2, a.forwardTilt, a.backwardTilt, a.tilt(), a.variance());
        set(3, a.first.x(), a.first.y(), a.first.z(), 0);
        set(4, a.second.x(), a.second.y(), a.second.z(), 0);
        std::uint32_t line = 0;
        for (const Vec3d* moment :
             {&a.forwardVariances, &a.backwardVariances, &a.forwardTilts, &a.backwardTilts}) {
            float* texel = tables.variances.texel(y, line++);
            for (int c = 0; c < 3; ++c) texel[c] = static_cast<float>((*moment)[c]);
        }
    });
    return tables;
}

Table bakeSpreadFactors() {
    Table table = makeTable(128, 48);
    forRows(table, [&](std::uint32_t y) {
        const double width = kMinSpread + coordinate(y, table.height) * (kLargestSpread - kMinSpread);
        const LongitudinalLobe lobe(0, width);
        for (std::uint32_t x = 0; x < table.width; ++x) {
            const double theta = std::min(std::asin(coordinate(x, table.width)), kLargestTheta);
            table.texel(x, y)[0] = static_cast<float>(lobe.factorOut(theta));
        }
    });
    return table;
}

Vec3d lookUp(const MarschnerTables& tables, double sinThetaIn, double sinThetaOut, double cosPhi) {
    const auto m = tables.longitudinal.sample(0.5 * sinThetaIn + 0.5, 0.5 * sinThetaOut + 0.5);
    const double u = 0.5 * cosPhi + 0.5;
    const auto tt = tables.transmitted.sample(u, m[3]);
    const auto trt = tables.reflected.sample(u, m[3]);
    return Vec3d::Constant(m[0] * tt[3]) + m[1] * Vec3d(tt[0], tt[1], tt[2]) +
           m[2] * Vec3d(trt[0], trt[1], trt[2]);
}

Vec3d lookUp(const SadeghiTables& tables, const SadeghiParameters& model, double sinThetaIn,
             double sinThetaOut, double cosPhi, double glint) {
    const auto m = tables.longitudinal.sample(0.5 * sinThetaIn + 0.5, 0.5 * sinThetaOut + 0.5);
    const auto n = tables.azimuthal.sample(0.5 * cosPhi + 0.5, glint);
    Vec3d sum = Vec3d::Zero();
    for (const Lobe lobe : kLobes) {
        const SadeghiLobe& l = model.lobe(lobe);
        sum += m[index(lobe)] * n[index(lobe)] * l.light();
    }
    return sum;
}

}  // namespace hairloom::shading
