// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/flip.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/math.h"
#include "core/base/parallel.h"
#include "core/render/tone_map.h"

namespace hairloom::render {
namespace {

constexpr double kColourExponent = 0.7;   // q_c
constexpr double kFeatureExponent = 0.5;  // q_f
constexpr double kCompressed = 0.4;       // p_c
constexpr double kCompressedTo = 0.95;    // p_t
constexpr double kFeatureWidth = 0.082;   // degrees
constexpr std::size_t kRowsAtOnce = 4;

/// One value or colour a pixel.
template <class T>
struct Plane {
    int width = 0;
    int height = 0;
    std::vector<T> values;

    Plane(int w, int h, const T& value)
        : width(w), height(h), values(static_cast<std::size_t>(w) * h, value) {}
    std::size_t place(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
    /// The border's pixel beyond it.
    const T& at(int x, int y) const {
        return values[place(std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1))];
    }
};
using Colours = Plane<Vec3d>;

const Eigen::Matrix3d& xyzFromRgb() {
    static const Eigen::Matrix3d kMatrix =
        (Eigen::Matrix3d() << 10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794,
         2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897, 1425312.0 / 73733382,
         8788810.0 / 73733382, 70074185.0 / 73733382)
            .finished();
    return kMatrix;
}
const Vec3d& white() {
    static const Vec3d kWhite = xyzFromRgb() * Vec3d::Ones();
    return kWhite;
}

/// Linear colours to the opponent space YyCxCz, in which eyes blur.
Vec3d opponentOf(const Vec3d& rgb) {
    const Vec3d c = (xyzFromRgb() * rgb).cwiseQuotient(white());
    return {116 * c.y() - 16, 500 * (c.x() - c.y()), 200 * (c.y() - c.z())};
}
Vec3d rgbOf(const Vec3d& opponent) {
    const double y = (opponent.x() + 16) / 116;
    const Vec3d xyz = Vec3d(y + opponent.y() / 500, y, y - opponent.z() / 200).cwiseProduct(white());
    return xyzFromRgb().inverse() * xyz;
}

/// CIELAB, its chroma less where it is dark (Hunt).
Vec3d huntLabOf(const Vec3d& rgb) {
    const Vec3d c = (xyzFromRgb() * rgb).cwiseQuotient(white());
    const Vec3d f = c.unaryExpr([](double t) {
        constexpr double kDelta = 6.0 / 29;
        return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
    });
    const double lightness = 116 * f.y() - 16;
    return {lightness, 0.01 * lightness * 500 * (f.x() - f.y()), 0.01 * lightness * 200 * (f.y() - f.z())};
}

/// Eq. 6.
double hyab(const Vec3d& a, const Vec3d& b) {
    return std::abs(a.x() - b.x()) + (a - b).tail<2>().norm();
}

/// A sum of two Gaussians, what eyes make of a point in each of the three channels (section 4.1.1, Table 1).
struct ContrastFilter {
    struct Gaussian {
        double weight, spread;
    };
    std::array<std::array<Gaussian, 2>, 3> channels{
        {{{{1, 0.0047}, {0, 1e-5}}}, {{{1, 0.0053}, {0, 1e-5}}}, {{{34.1, 0.04}, {13.5, 0.025}}}}};
    int radius;
    std::vector<Vec3d> weights;  ///< rows of a square, sum 1 in each channel

    explicit ContrastFilter(double pixelsPerDegree) {
        radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * std::numbers::pi * std::numbers::pi)) * pixelsPerDegree));
        Vec3d sum = Vec3d::Zero();
        for (int y = -radius; y <= radius; ++y) {
            for (int x = -radius; x <= radius; ++x) {
                const double squared = (x * x + y * y) / (pixelsPerDegree * pixelsPerDegree);
                Vec3d w = Vec3d::Zero();
                for (int c = 0; c < 3; ++c) {
                    for (const auto& [weight, spread] : channels[static_cast<std::size_t>(c)])
                        w[c] += weight * std::sqrt(std::numbers::pi / spread) * std::exp(-std::numbers::pi * std::numbers::pi * squared / spread);
                }
                weights.push_back(w);
                sum += w;
            }
        }
        for (Vec3d& w : weights) w = w.cwiseQuotient(sum);
    }
};

template <class Row>
void forRows(int height, const Row& row) {
    parallelFor(static_cast<std::size_t>(height), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) row(static_cast<int>(y));
    });
}

Colours opponents(const Image& image) {
    Colours result(static_cast<int>(image.width), static_cast<int>(image.height), Vec3d::Zero());
    for (std::size_t i = 0; i < result.values.size(); ++i) {
        Vec3d rgb;
        for (std::size_t c = 0; c < 3; ++c) {
            const float encoded = static_cast<float>(image.rgba[4 * i + c]) / 255;
            rgb[static_cast<int>(c)] = static_cast<double>(decodeSrgb(encoded));
        }
        result.values[i] = opponentOf(rgb);
    }
    return result;
}

/// What eyes see of it at that distance, in the space in which differences are measured.
Colours seen(const Colours& image, const ContrastFilter& filter) {
    Colours result(image.width, image.height, Vec3d::Zero());
    forRows(image.height, [&](int y) {
        for (int x = 0; x < image.width; ++x) {
            Vec3d sum = Vec3d::Zero();
            std::size_t k = 0;
            for (int j = -filter.radius; j <= filter.radius; ++j) {
                for (int i = -filter.radius; i <= filter.radius; ++i)
                    sum += filter.weights[k++].cwiseProduct(image.at(x + i, y + j));
            }
            result.values[image.place(x, y)] = huntLabOf(rgbOf(sum).cwiseMax(0.0).cwiseMin(1.0));
        }
    });
    return result;
}

/// The Gaussian's first or second derivative along x, times the Gaussian along y; positive and negative
/// weights sum up to 1 each (section 4.2.1).
struct FeatureFilter {
    int radius;
    std::vector<double> along, across;

    FeatureFilter(double pixelsPerDegree, bool points) {
        const double deviation = 0.5 * kFeatureWidth * pixelsPerDegree;
        radius = static_cast<int>(std::ceil(3 * deviation));
        double positive = 0, negative = 0, all = 0;
        for (int x = -radius; x <= radius; ++x) {
            const double gauss = std::exp(-0.5 * x * x / (deviation * deviation));
            const double w = points ? (x * x / (deviation * deviation) - 1) * gauss : -x * gauss;
            along.push_back(w);
            across.push_back(gauss);
            (w > 0 ? positive : negative) += std::abs(w);
            all += gauss;
        }
        for (double& w : along) w /= w > 0 ? positive : negative;
        for (double& w : across) w /= all;
    }
};

Plane<double> filtered(const Plane<double>& image, const std::vector<double>& weights, int dx, int dy) {
    Plane<double> result(image.width, image.height, 0.0);
    const int count = static_cast<int>(weights.size()), radius = count / 2;
    forRows(image.height, [&](int y) {
        for (int x = 0; x < image.width; ++x) {
            double sum = 0;
            for (int k = 0; k < count; ++k) {
                const int off = k - radius;
                sum += weights[static_cast<std::size_t>(k)] * image.at(x + off * dx, y + off * dy);
            }
            result.values[image.place(x, y)] = sum;
        }
    });
    return result;
}

/// How strong the edge, or the point, of each pixel is.
Plane<double> features(const Plane<double>& lightness, const FeatureFilter& filter) {
    const auto x = filtered(filtered(lightness, filter.along, 1, 0), filter.across, 0, 1);
    const auto y = filtered(filtered(lightness, filter.along, 0, 1), filter.across, 1, 0);
    Plane<double> result(lightness.width, lightness.height, 0.0);
    for (std::size_t i = 0; i < result.values.size(); ++i)
        result.values[i] = std::hypot(x.values[i], y.values[i]);
    return result;
}

Plane<double> lightnessOf(const Colours& opponent) {
    Plane<double> result(opponent.width, opponent.height, 0.0);
    for (std::size_t i = 0; i < result.values.size(); ++i)
        result.values[i] = (opponent.values[i].x() + 16) / 116;
    return result;
}

/// Eq. 7 and 8: differences of colour, most of the range for those that are small.
double colourDifference(const Vec3d& a, const Vec3d& b) {
    static const double kMax =
        std::pow(hyab(huntLabOf(Vec3d(0, 1, 0)), huntLabOf(Vec3d(0, 0, 1))), kColourExponent);
    const double difference = std::pow(hyab(a, b), kColourExponent);
    const double limit = kCompressed * kMax;
    if (difference < limit) return kCompressedTo / limit * difference;
    return kCompressedTo + (difference - limit) / (kMax - limit) * (1 - kCompressedTo);
}

}  // namespace

Result<FlipDifference> flipDifference(const Image& reference, const Image& test, double pixelsPerDegree) {
    const std::size_t pixels = std::size_t{reference.width} * reference.height;
    if (pixels == 0 || reference.rgba.size() != 4 * pixels) return fail("a picture without pixels");
    if (test.width != reference.width || test.height != reference.height ||
        test.rgba.size() != reference.rgba.size()) {
        return fail(fmt::format("a picture of {}x{} pixels beside one of {}x{}", test.width, test.height,
                                reference.width, reference.height));
    }
    const ContrastFilter contrast(pixelsPerDegree);
    const Colours a = opponents(reference), b = opponents(test);
    const Colours seenA = seen(a, contrast), seenB = seen(b, contrast);
    const FeatureFilter edges(pixelsPerDegree, false), points(pixelsPerDegree, true);
    const auto lightA = lightnessOf(a), lightB = lightnessOf(b);
    const auto edgesA = features(lightA, edges), edgesB = features(lightB, edges);
    const auto pointsA = features(lightA, points), pointsB = features(lightB, points);

    FlipDifference result;
    result.map = {reference.width, reference.height, std::vector<std::uint8_t>(4 * pixels, 255)};
    for (std::size_t i = 0; i < pixels; ++i) {
        // Eq. 9 and 11.
        const double feature = std::pow(std::max(std::abs(edgesA.values[i] - edgesB.values[i]),
                                                 std::abs(pointsA.values[i] - pointsB.values[i])) /
                                            std::sqrt(2.0),
                                        kFeatureExponent);
        const double colour = std::min(colourDifference(seenA.values[i], seenB.values[i]), 1.0);
        const double flip = std::pow(colour, 1 - std::min(feature, 1.0));
        result.mean += flip / static_cast<double>(pixels);
        result.largest = std::max(result.largest, flip);
        const Vec3d shown = Vec3d(1.5 * flip, 2 * flip - 0.6, 0.4 * flip).cwiseMax(0.0).cwiseMin(1.0);
        for (std::size_t c = 0; c < 3; ++c)
            result.map.rgba[4 * i + c] =
                static_cast<std::uint8_t>(std::lround(255 * shown[static_cast<int>(c)]));
    }
    return result;
}

}  // namespace hairloom::render
