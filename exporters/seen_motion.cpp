// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/seen_motion.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace hairloom {
namespace {

constexpr std::size_t kSectors = 8;          ///< around the head, each an upper and a lower part
constexpr std::size_t kMostOutlined = 4096;  ///< points that outlines are of
constexpr std::size_t kMostFollowed = 192;   ///< points of a layer whose motion is looked at
constexpr std::size_t kOutlineEvery = 6, kShapeEvery = 2;  ///< frames
constexpr std::size_t kFewest = 20;                        ///< points of a direction that make an outline
constexpr double kWithin = 0.95;  ///< of the points of a direction: single strands are no outline
constexpr double kDoubled = 1.4125375446227544;  ///< 3 dB
constexpr double kLoud = 4;                      ///< how much motion counts whose strength is another

/// At most `most` of 0 … count − 1, evenly.
std::vector<std::uint32_t> evenly(std::size_t count, std::size_t most) {
    const std::size_t taken = std::min(count, most);
    std::vector<std::uint32_t> some;
    for (std::size_t i = 0; i < taken; ++i) some.push_back(static_cast<std::uint32_t>(i * count / taken));
    return some;
}

}  // namespace

SeenMotion::SeenMotion(std::span<const std::uint32_t> offsets, std::span<const Vec3f> rest_ws,
                       std::span<const std::uint32_t> layers)
    : offsets_(offsets.begin(), offsets.end()) {
    const std::size_t strands = offsets.size() - 1;
    assert(layers.size() == strands && rest_ws.size() == offsets.back());
    Vec3f head_ws = Vec3f::Zero();
    for (std::size_t s = 0; s < strands; ++s) head_ws += rest_ws[offsets[s]] / static_cast<float>(strands);
    for (const Vec3f& p : rest_ws) middle_ws += p / static_cast<float>(rest_ws.size());
    const std::size_t layerCount = strands > 0 ? 1 + *std::ranges::max_element(layers) : 0;
    strandsOf_.resize(layerCount * 2 * kSectors);
    stations_.assign(strandsOf_.size() * kStations, Eigen::Vector3d::Zero());
    std::vector<std::vector<std::uint32_t>> movable(layerCount);
    for (std::size_t s = 0; s < strands; ++s) {
        const Vec3f away = rest_ws[offsets[s]] - head_ws;
        const double turn =
            0.5 +
            0.5 * std::atan2(static_cast<double>(away.z()), static_cast<double>(away.x())) / std::numbers::pi;
        const auto sector = std::min(static_cast<std::size_t>(turn * kSectors), kSectors - 1);
        parts_.push_back(
            static_cast<std::uint32_t>((2 * layers[s] + (away.y() > 0 ? 1 : 0)) * kSectors + sector));
        ++strandsOf_[parts_.back()];
        for (std::uint32_t p = offsets[s] + 1; p < offsets[s + 1]; ++p) movable[layers[s]].push_back(p);
    }
    outlined_ = evenly(rest_ws.size(), kMostOutlined);
    for (const std::vector<std::uint32_t>& points : movable) {
        followed_.emplace_back();
        for (const std::uint32_t i : evenly(points.size(), kMostFollowed))
            followed_.back().push_back(points[i]);
    }
    paths_.resize(layerCount);
}

void SeenMotion::add(std::span<const Vec3f> positions_ws) {
    assert(positions_ws.size() == offsets_.back());
    if (frames_ % kShapeEvery == 0) addShape(positions_ws);
    if (frames_ % kOutlineEvery == 0) addOutline(positions_ws);
    for (std::size_t layer = 0; layer < paths_.size(); ++layer)
        for (const std::uint32_t p : followed_[layer]) paths_[layer].push_back(positions_ws[p]);
    ++frames_;
}

void SeenMotion::addShape(std::span<const Vec3f> positions_ws) {
    for (std::size_t s = 0; s < parts_.size(); ++s) {
        const std::size_t first = offsets_[s], last = offsets_[s + 1] - 1;
        for (std::size_t k = 0; k < kStations; ++k) {
            const float at = static_cast<float>(k * (last - first)) / static_cast<float>(kStations - 1);
            const std::size_t before = first + std::min(static_cast<std::size_t>(at), last - first);
            const float share = at - static_cast<float>(before - first);
            const Vec3f point =
                positions_ws[before] * (1 - share) + positions_ws[std::min(before + 1, last)] * share;
            stations_[parts_[s] * kStations + k] += point.cast<double>();
        }
    }
}

void SeenMotion::addOutline(std::span<const Vec3f> positions_ws) {
    Outline outline;
    for (std::size_t view = 0; view < kViews; ++view) {
        const double angle = std::numbers::pi * static_cast<double>(view) / kViews;
        const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
        std::array<std::vector<float>, kDirections> reach;
        for (const std::uint32_t p : outlined_) {
            const Vec3f away = positions_ws[p] - middle_ws;
            const float x = c * away.x() + s * away.z();
            const double turn = 0.5 + 0.5 *
                                          std::atan2(static_cast<double>(away.y()), static_cast<double>(x)) /
                                          std::numbers::pi;
            const auto direction = std::min(static_cast<std::size_t>(turn * kDirections), kDirections - 1);
            reach[direction].push_back(std::sqrt(x * x + away.y() * away.y()));
        }
        for (std::size_t d = 0; d < kDirections; ++d) {
            float& to = outline[view * kDirections + d];
            to = -1;
            if (reach[d].size() < kFewest) continue;
            const auto inside =
                static_cast<std::ptrdiff_t>(kWithin * static_cast<double>(reach[d].size() - 1));
            std::nth_element(reach[d].begin(), reach[d].begin() + inside, reach[d].end());
            to = reach[d][static_cast<std::size_t>(inside)];
        }
    }
    outlines_.push_back(outline);
}

/// Of each octave above one swing in all frames: metres, root mean square over the points.
std::vector<double> SeenMotion::amplitudes(std::size_t layer) const {
    const std::size_t points = followed_[layer].size();
    std::vector<double> cosines, sines, window;
    double weight = 0;
    for (std::size_t f = 0; f < frames_; ++f) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(f) / static_cast<double>(frames_);
        cosines.push_back(std::cos(angle));
        sines.push_back(std::sin(angle));
        window.push_back(0.5 - 0.5 * std::cos(2 * std::numbers::pi * (static_cast<double>(f) + 0.5) /
                                              static_cast<double>(frames_)));
        weight += window.back() * window.back();
    }
    std::vector<double> powers;
    for (std::size_t swings = 1; 2 * swings <= frames_ / 2; swings *= 2) powers.push_back(0);
    std::vector<double> values(frames_);
    for (std::size_t p = 0; p < points; ++p) {
        for (int axis = 0; axis < 3; ++axis) {
            double mean = 0;
            for (std::size_t f = 0; f < frames_; ++f) {
                values[f] = static_cast<double>(paths_[layer][f * points + p][axis]);
                mean += values[f] / static_cast<double>(frames_);
            }
            for (std::size_t f = 0; f < frames_; ++f) values[f] = (values[f] - mean) * window[f];
            for (std::size_t band = 0; band < powers.size(); ++band) {
                for (std::size_t swings = std::size_t{1} << band; swings < std::size_t{2} << band; ++swings) {
                    double real = 0, imaginary = 0;
                    std::size_t at = 0;
                    for (std::size_t f = 0; f < frames_; ++f) {
                        real += values[f] * cosines[at];
                        imaginary += values[f] * sines[at];
                        at += swings;
                        if (at >= frames_) at -= frames_;
                    }
                    powers[band] += 2 * (real * real + imaginary * imaginary);
                }
            }
        }
    }
    for (double& power : powers)
        power = std::sqrt(power / (weight * static_cast<double>(frames_) * static_cast<double>(points)));
    return powers;
}

SeenMotion::Difference SeenMotion::between(const SeenMotion& a, const SeenMotion& b, double moves) {
    assert(a.frames_ == b.frames_ && a.offsets_ == b.offsets_);
    Difference difference;
    if (a.frames_ == 0 || a.parts_.empty()) return difference;
    double squares = 0, count = 0;
    for (std::size_t i = 0; i < a.outlines_.size(); ++i) {
        for (std::size_t d = 0; d < a.outlines_[i].size(); ++d) {
            if (a.outlines_[i][d] < 0 || b.outlines_[i][d] < 0) continue;
            const auto apart = static_cast<double>(a.outlines_[i][d] - b.outlines_[i][d]);
            squares += apart * apart, ++count;
        }
    }
    if (count > 0) difference.outline = static_cast<float>(std::sqrt(squares / count));
    squares = count = 0;
    const auto shapes = static_cast<double>((a.frames_ + kShapeEvery - 1) / kShapeEvery);
    for (std::size_t part = 0; part < a.strandsOf_.size(); ++part) {
        const double strands = a.strandsOf_[part];
        if (strands == 0) continue;
        for (std::size_t k = part * kStations; k < (part + 1) * kStations; ++k) {
            squares += strands * ((a.stations_[k] - b.stations_[k]) / (strands * shapes)).squaredNorm();
            count += strands;
        }
    }
    difference.shape = static_cast<float>(std::sqrt(squares / count));
    for (std::size_t layer = 0; layer < a.paths_.size(); ++layer) {
        if (a.followed_[layer].empty()) continue;
        const std::vector<double> ofA = a.amplitudes(layer), ofB = b.amplitudes(layer);
        for (std::size_t band = 0; band < ofA.size(); ++band) {
            const double more = std::max(ofA[band], ofB[band]), less = std::min(ofA[band], ofB[band]);
            const double off = more > kDoubled * less ? kLoud * more : more - less;
            difference.motion = std::max(difference.motion, static_cast<float>(off));
            if (more < moves) continue;
            const double ratio = 20 * std::log10(more / std::max(less, 1e-9));
            difference.decibels = std::max(difference.decibels, static_cast<float>(ratio));
        }
    }
    return difference;
}

}  // namespace hairloom
