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

/// A sum of Gaussians, what eyes make of a point in each of the three channels (section 4.1.1, Table 1). A
/// Gaussian of the distance is one along x times one along y, so that rows and columns are blurred in turn.
struct ContrastFilter {
    struct Gaussian {
        std::size_t channel;
        double weight, spread;
        std::vector<double> along = {};  ///< from −radius to radius, along each axis
        double share = 0;                ///< factor of the product: weights of a channel sum up to 1
    };
    std::array<Gaussian, 4> gaussians{{{0, 1, 0.0047}, {1, 1, 0.0053}, {2, 34.1, 0.04}, {2, 13.5, 0.025}}};
    int radius;

    explicit ContrastFilter(double pixelsPerDegree) {
        constexpr double kPi = std::numbers::pi, kWidest = 0.04;
        radius = static_cast<int>(std::ceil(3 * std::sqrt(kWidest / (2 * kPi * kPi)) * pixelsPerDegree));
        Vec3d sums = Vec3d::Zero();
        for (Gaussian& g : gaussians) {
            double sum = 0;
            for (int x = -radius; x <= radius; ++x) {
                const double squared = x * x / (pixelsPerDegree * pixelsPerDegree);
                sum += g.along.emplace_back(std::exp(-kPi * kPi * squared / g.spread));
            }
            g.share = g.weight * std::sqrt(kPi / g.spread);
            sums[static_cast<int>(g.channel)] += g.share * sum * sum;
        }
        for (Gaussian& g : gaussians) g.share /= sums[static_cast<int>(g.channel)];
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
    forRows(result.height, [&](int y) {
        for (std::size_t i = result.place(0, y); i < result.place(0, y + 1); ++i) {
            Vec3d rgb;
            for (std::size_t c = 0; c < 3; ++c) {
                const float encoded = static_cast<float>(image.rgba[4 * i + c]) / 255;
                rgb[static_cast<int>(c)] = static_cast<double>(decodeSrgb(encoded));
            }
            result.values[i] = opponentOf(rgb);
        }
    });
    return result;
}

/// Sums of `weights` times the values from −radius to radius along an axis, in that order. Beyond the border
/// lies the border's value.
Plane<double> filtered(const Plane<double>& image, const std::vector<double>& weights, bool alongX) {
    using Row = Eigen::Map<Eigen::ArrayXd>;
    using ConstRow = Eigen::Map<const Eigen::ArrayXd>;
    Plane<double> result(image.width, image.height, 0.0);
    const int count = static_cast<int>(weights.size()), radius = count / 2;
    forRows(image.height, [&](int y) {
        Row sum(&result.values[image.place(0, y)], image.width);
        Eigen::ArrayXd padded;
        if (alongX) {
            padded.resize(image.width + 2 * radius);
            for (int x = 0; x < image.width + 2 * radius; ++x) padded[x] = image.at(x - radius, y);
        }
        // In pieces that stay in registers.
        constexpr Eigen::Index kPiece = 16;
        for (Eigen::Index x = 0; x < image.width; x += kPiece) {
            const auto add = [&](auto& piece) {
                for (int k = 0; k < count; ++k) {
                    const double w = weights[static_cast<std::size_t>(k)];
                    if (alongX) {
                        piece += w * padded.segment(x + k, piece.size());
                    } else {
                        const int from = std::clamp(y + k - radius, 0, image.height - 1);
                        piece += w * ConstRow(&image.values[image.place(0, from)], image.width)
                                         .segment(x, piece.size());
                    }
                }
                sum.segment(x, piece.size()) = piece;
            };
            if (x + kPiece <= image.width) {
                Eigen::Array<double, kPiece, 1> piece = Eigen::Array<double, kPiece, 1>::Zero();
                add(piece);
            } else {
                Eigen::ArrayXd piece = Eigen::ArrayXd::Zero(image.width - x);
                add(piece);
            }
        }
    });
    return result;
}

/// What eyes see of it at that distance, in the space in which differences are measured.
Colours seen(const Colours& image, const ContrastFilter& filter) {
    Colours result(image.width, image.height, Vec3d::Zero());
    Plane<double> channel(image.width, image.height, 0.0);
    std::size_t held = 3;
    for (const ContrastFilter::Gaussian& g : filter.gaussians) {
        if (held != g.channel) {
            for (std::size_t i = 0; i < channel.values.size(); ++i)
                channel.values[i] = image.values[i][static_cast<int>(g.channel)];
            held = g.channel;
        }
        const auto blurred = filtered(filtered(channel, g.along, true), g.along, false);
        for (std::size_t i = 0; i < blurred.values.size(); ++i)
            result.values[i][static_cast<int>(g.channel)] += g.share * blurred.values[i];
    }
    forRows(image.height, [&](int y) {
        for (std::size_t i = result.place(0, y); i < result.place(0, y + 1); ++i)
            result.values[i] = huntLabOf(rgbOf(result.values[i]).cwiseMax(0.0).cwiseMin(1.0));
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

/// How strong the edge, or the point, of each pixel is.
Plane<double> features(const Plane<double>& lightness, const FeatureFilter& filter) {
    const auto x = filtered(filtered(lightness, filter.along, true), filter.across, false);
    const auto y = filtered(filtered(lightness, filter.along, false), filter.across, true);
    Plane<double> result(lightness.width, lightness.height, 0.0);
    forRows(lightness.height, [&](int row) {
        for (std::size_t i = result.place(0, row); i < result.place(0, row + 1); ++i)
            result.values[i] = std::hypot(x.values[i], y.values[i]);
    });
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
    if (pixels == 0 || reference.rgba.size() != 4 * pixels) return fail("an image without pixels");
    if (test.width != reference.width || test.height != reference.height ||
        test.rgba.size() != reference.rgba.size()) {
        return fail(fmt::format("an image of {}x{} pixels beside one of {}x{}", test.width, test.height,
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
    Plane<double> flips(a.width, a.height, 0.0);
    forRows(a.height, [&](int y) {
        for (std::size_t i = a.place(0, y); i < a.place(0, y + 1); ++i) {
            // Eq. 9 and 11.
            const double feature = std::pow(std::max(std::abs(edgesA.values[i] - edgesB.values[i]),
                                                     std::abs(pointsA.values[i] - pointsB.values[i])) /
                                                std::sqrt(2.0),
                                            kFeatureExponent);
            const double colour = std::min(colourDifference(seenA.values[i], seenB.values[i]), 1.0);
            const double flip = flips.values[i] = std::pow(colour, 1 - std::min(feature, 1.0));
            const Vec3d shown = Vec3d(1.5 * flip, 2 * flip - 0.6, 0.4 * flip).cwiseMax(0.0).cwiseMin(1.0);
            for (std::size_t c = 0; c < 3; ++c)
                result.map.rgba[4 * i + c] =
                    static_cast<std::uint8_t>(std::lround(255 * shown[static_cast<int>(c)]));
        }
    });
    for (const double flip : flips.values) {
        result.mean += flip / static_cast<double>(pixels);
        result.largest = std::max(result.largest, flip);
    }
    return result;
}

}  // namespace hairloom::render
