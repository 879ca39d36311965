// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/strip.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hairloom::cards {
namespace {

// Of a square distance: what one across or along the strip counts beside one off its surface.
constexpr float kAcross = 0.10f;
constexpr float kAlong = 0.15f;
// At the roots both count so much, fading over the first part of the strip: hair of a card grows side by
// side, or the card would span the skin between.
constexpr float kAtRoots = 0.5f, kOfRoots = 0.3f;
float besideAt(std::size_t station, std::size_t stations, float farther) {
    const float share = static_cast<float>(station) / (kOfRoots * static_cast<float>(stations - 1));
    return std::max(farther, kAtRoots * (1 - share));
}
// How strongly the strip keeps to the scalp's plane where strands do not say what is across; a share of their
// spread.
constexpr float kPrior = 0.5f;
constexpr float kMostBend = 0.5f;      // height of the bend by the half width
constexpr float kLeastHalf = 0.0005f;  // metres

Vec3f perpendicular(const Vec3f& v, const Vec3f& unit) {
    const Vec3f rest = v - v.dot(unit) * unit;
    const float norm = rest.norm();
    return norm > 1e-6f ? Vec3f(rest / norm) : unit.unitOrthogonal();
}

void setAlong(Strip& strip) {
    const std::size_t n = strip.stations();
    strip.along.resize(n);
    for (std::size_t k = 0; k < n; ++k) {
        const Vec3f step = strip.centre[std::min(k + 1, n - 1)] - strip.centre[k == 0 ? 0 : k - 1];
        const float norm = step.norm();
        strip.along[k] = norm > 1e-9f ? Vec3f(step / norm) : k > 0 ? strip.along[k - 1] : Vec3f(0, -1, 0);
    }
}

/// The scalp's normal carried along the centre without a twist.
std::vector<Vec3f> carriedNormals(const Strip& strip, const Vec3f& first) {
    std::vector<Vec3f> normals(strip.stations());
    normals[0] = perpendicular(first, strip.along[0]);
    for (std::size_t k = 1; k < normals.size(); ++k)
        normals[k] = perpendicular(normals[k - 1], strip.along[k]);
    return normals;
}

/// Second moments of the strands around the centre at a station, in the plane of (across, outwards).
struct Moments {
    double xx = 0, xy = 0, yy = 0;
};

template <class Share = float, class At>
void smooth(std::size_t count, At at) {
    if (count < 3) return;
    auto before = at(0);
    for (std::size_t k = 1; k + 1 < count; ++k) {
        const auto here = at(k);
        at(k) = Share(0.25) * before + Share(0.5) * here + Share(0.25) * at(k + 1);
        before = here;
    }
}

}  // namespace

float Strip::length() const {
    float sum = 0;
    for (std::size_t k = 1; k < centre.size(); ++k) sum += (centre[k] - centre[k - 1]).norm();
    return sum;
}

Vec3f Strip::at(std::size_t k, float x) const {
    const float across = x * halfWidth[k];
    return centre[k] + across * cross[k] + bend[k] * (across * across - spread[k]) * normal[k];
}

namespace {

/// Cross directions from the moments of the points that `visit(k, f)` gives as f(point, weight), and bends.
template <class Visit>
void fitAcross(Strip& strip, const Vec3f& rootNormal, const Visit& visit) {
    const std::size_t n = strip.stations();
    setAlong(strip);
    const auto normals = carriedNormals(strip, rootNormal);
    std::vector<Vec2f> axis(n);  // of twice the angle, so that opposite directions are the same
    strip.cross.resize(n);
    strip.normal.resize(n);
    for (std::size_t k = 0; k < n; ++k) {
        const Vec3f& outwards = normals[k];
        const Vec3f across = outwards.cross(strip.along[k]);
        Moments m;
        visit(k, [&](const Vec3f& point, float weight) {
            const Vec3f d = point - strip.centre[k];
            const float x = d.dot(across), y = d.dot(outwards);
            m.xx += static_cast<double>(weight * x * x);
            m.xy += static_cast<double>(weight * x * y);
            m.yy += static_cast<double>(weight * y * y);
        });
        const double prior = static_cast<double>(kPrior) * (m.xx + m.yy) + 1e-30;
        axis[k] = Vec2f(static_cast<float>(m.xx + prior - m.yy), static_cast<float>(2 * m.xy));
    }
    for (int pass = 0; pass < 3; ++pass) smooth(n, [&](std::size_t k) -> Vec2f& { return axis[k]; });
    for (std::size_t k = 0; k < n; ++k) {
        const float angle = 0.5f * std::atan2(axis[k].y(), axis[k].x());
        const Vec3f across = normals[k].cross(strip.along[k]);
        strip.cross[k] = std::cos(angle) * across + std::sin(angle) * normals[k];
        strip.normal[k] = strip.along[k].cross(strip.cross[k]);
    }
    strip.bend.assign(n, 0);
    strip.spread.assign(n, 0);
    strip.halfWidth.assign(n, kLeastHalf);
    std::vector<double> covariance(n, 0), variance(n, 0);
    for (std::size_t k = 0; k < n; ++k) {
        double w = 0, q = 0, qq = 0, qz = 0, z = 0;
        visit(k, [&](const Vec3f& point, float weight) {
            const Vec3f d = point - strip.centre[k];
            const auto square = static_cast<double>(d.dot(strip.cross[k]) * d.dot(strip.cross[k]));
            const auto off = static_cast<double>(d.dot(strip.normal[k]));
            const auto share = static_cast<double>(weight);
            w += share, q += share * square, qq += share * square * square;
            z += share * off, qz += share * square * off;
        });
        if (!(w > 0)) continue;
        strip.spread[k] = static_cast<float>(q / w);
        variance[k] = qq - q * q / w, covariance[k] = qz - q * z / w;
        strip.halfWidth[k] = std::max(kLeastHalf, 2 * std::sqrt(strip.spread[k]));
    }
    // By sums, so that stations of few points follow their neighbours.
    for (int pass = 0; pass < 4; ++pass) {
        smooth<double>(n, [&](std::size_t k) -> double& { return covariance[k]; });
        smooth<double>(n, [&](std::size_t k) -> double& { return variance[k]; });
    }
    for (std::size_t k = 0; k < n; ++k) {
        const float most = kMostBend / strip.halfWidth[k];
        if (variance[k] > 0)
            strip.bend[k] = std::clamp(static_cast<float>(covariance[k] / variance[k]), -most, most);
    }
}

Vec3f meanNormal(std::span<const std::uint32_t> strands, std::span<const Vec3f> rootNormals_ws) {
    Vec3f sum = Vec3f::Zero();
    for (const std::uint32_t s : strands) sum += rootNormals_ws[s];
    return sum.norm() > 1e-6f ? Vec3f(sum.normalized()) : Vec3f::UnitY();
}

}  // namespace

Strip fitStrip(const EvenHair& hair, std::span<const std::uint32_t> strands,
               std::span<const Vec3f> rootNormals_ws) {
    const std::size_t n = hair.stations;
    std::vector<Vec3d> sums(n, Vec3d::Zero());
    double weights = 0;
    for (const std::uint32_t s : strands) {
        const auto points = hair.strand(s);
        const double weight = static_cast<double>(hair.weights[s]) + 1e-12;
        weights += weight;
        for (std::size_t k = 0; k < n; ++k) sums[k] += weight * points[k].cast<double>();
    }
    Strip strip;
    for (const Vec3d& sum : sums) strip.centre.push_back((sum / weights).cast<float>());
    fitAcross(strip, meanNormal(strands, rootNormals_ws), [&](std::size_t k, const auto& take) {
        for (const std::uint32_t s : strands) take(hair.points_ws[s * n + k], hair.weights[s] + 1e-12f);
    });
    return strip;
}

float offStrip(const Strip& strip, std::span<const Vec3f> points_ws, float enough) {
    const std::size_t n = strip.stations();
    const float limit = enough * static_cast<float>(n);
    float sum = 0;
    // Ends first: they tell strands of another part of the head soonest.
    for (std::size_t i = 0; i < n && sum <= limit; ++i) {
        const std::size_t k = i % 2 == 0 ? i / 2 : n - 1 - i / 2;
        const Vec3f d = points_ws[k] - strip.centre[k];
        const float x = d.dot(strip.cross[k]), t = d.dot(strip.along[k]);
        const float off = d.dot(strip.normal[k]) - strip.bend[k] * (x * x - strip.spread[k]);
        sum += off * off + besideAt(k, n, kAcross) * x * x + besideAt(k, n, kAlong) * t * t;
    }
    return sum / static_cast<float>(n);
}

void residual(const Strip& strip, std::span<const Vec3f> points_ws, std::span<float> out) {
    const std::size_t n = strip.stations();
    for (std::size_t k = 0; k < n; ++k) {
        const Vec3f d = points_ws[k] - strip.centre[k];
        out[3 * k] = d.dot(strip.normal[k]);
        out[3 * k + 1] = std::sqrt(besideAt(k, n, kAcross)) * d.dot(strip.cross[k]);
        out[3 * k + 2] = std::sqrt(besideAt(k, n, kAlong)) * d.dot(strip.along[k]);
    }
}

namespace {

/// The foot nearest along the centre to `guess`, a station: that of the point before is a good one. In
/// stations, beyond the ends for points there.
float footOn(const Strip& strip, const Vec3f& point_ws, std::size_t guess) {
    constexpr std::size_t kBack = 3, kAhead = 5;  // stations that the next point of a strand may be off by
    const std::size_t last = strip.stations() - 1;
    const std::size_t begin = guess > kBack ? guess - kBack : 0, end = std::min(guess + kAhead, last);
    float nearest = std::numeric_limits<float>::infinity(), foot = 0;
    for (std::size_t k = begin; k < end; ++k) {
        const Vec3f step = strip.centre[k + 1] - strip.centre[k], d = point_ws - strip.centre[k];
        const float share = d.dot(step) / std::max(step.squaredNorm(), 1e-12f);
        const float distance = (d - std::clamp(share, 0.0f, 1.0f) * step).squaredNorm();
        if (distance >= nearest) continue;
        nearest = distance;
        // Only the ends of the strip go on beyond their last station.
        foot = static_cast<float>(k) + std::clamp(share, k == 0 ? -1.0f : 0.0f, k + 1 == last ? 2.0f : 1.0f);
    }
    return foot;
}

StripPlace placeAt(const Strip& strip, const Vec3f& point_ws, float foot) {
    const std::size_t last = strip.stations() - 1;
    StripPlace place;
    place.station = std::min(static_cast<std::size_t>(std::max(foot, 0.0f)), last - 1);
    const std::size_t k = place.station;
    place.share = std::clamp(foot - static_cast<float>(k), -1.0f, 2.0f);
    const float t = std::clamp(place.share, 0.0f, 1.0f);
    const auto mixed = [&](const std::vector<Vec3f>& v) -> Vec3f { return (1 - t) * v[k] + t * v[k + 1]; };
    const Vec3f d = point_ws - ((1 - place.share) * strip.centre[k] + place.share * strip.centre[k + 1]);
    place.across = d.dot(mixed(strip.cross).normalized());
    place.off = d.dot(mixed(strip.normal).normalized());
    place.along = (static_cast<float>(k) + place.share) / static_cast<float>(last);
    return place;
}

/// The way that the strip takes over the scalp. Its centre moves aside there where roots at one side begin
/// before those at the other: that is no way along it.
Vec3f alongRoots(const Strip& strip) {
    constexpr std::size_t kOneIn = 4;  // of the stations, the first
    Vec3f cross = Vec3f::Zero();
    for (std::size_t k = 0; k <= (strip.stations() - 1) / kOneIn; ++k) cross += strip.cross[k];
    return cross.norm() > 0 ? perpendicular(strip.along[0], cross.normalized()) : strip.along[0];
}

}  // namespace

std::vector<StripPlace> placesOn(const Strip& strip, std::span<const Vec3f> points_ws) {
    constexpr float kByWay = 0.4f;  // of the strip, that strands are placed along it by their own way, fading
    const auto last = static_cast<float>(strip.stations() - 1);
    const float length = std::max(strip.length(), 1e-9f), reach = kByWay * length;
    const float root = (points_ws[0] - strip.centre[0]).dot(alongRoots(strip));
    std::vector<StripPlace> places;
    places.reserve(points_ws.size());
    std::size_t guess = 0;
    float way = 0;
    for (std::size_t p = 0; p < points_ws.size(); ++p) {
        if (p > 0) way += (points_ws[p] - points_ws[p - 1]).norm();
        float foot = footOn(strip, points_ws[p], guess);
        guess = std::min(static_cast<std::size_t>(std::max(foot, 0.0f)), strip.stations() - 2);
        if (way < reach) {
            const float t = way / reach, fade = t * t * (3 - 2 * t);
            foot = (1 - fade) * last * (root + way) / length + fade * foot;
        }
        places.push_back(placeAt(strip, points_ws[p], foot));
    }
    return places;
}

namespace {

/// The value that a share of the sorted values stays below.
float quantile(std::vector<float>& values, float share) {
    const auto at = static_cast<std::size_t>(share * static_cast<float>(values.size() - 1) + 0.5f);
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
    return values[at];
}

/// `count` points at even distances along a polyline.
std::vector<Vec3f> evenly(const std::vector<Vec3f>& points, std::size_t count) {
    std::vector<float> lengths{0};
    for (std::size_t i = 1; i < points.size(); ++i)
        lengths.push_back(lengths.back() + (points[i] - points[i - 1]).norm());
    std::vector<Vec3f> even;
    std::size_t i = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const float wanted = lengths.back() * static_cast<float>(k) / static_cast<float>(count - 1);
        while (i + 2 < points.size() && lengths[i + 1] < wanted) ++i;
        const float step = lengths[i + 1] - lengths[i];
        const float t = step > 0 ? std::clamp((wanted - lengths[i]) / step, 0.0f, 1.0f) : 0.0f;
        even.push_back((1 - t) * points[i] + t * points[i + 1]);
    }
    return even;
}

/// The centre, longer at both ends by what most strands stand out. Strands rise from the scalp at an angle,
/// their roots lie on it: there it goes on along the scalp.
std::vector<Vec3f> extended(const EvenHair& hair, std::span<const std::uint32_t> strands, const Strip& fitted,
                            const Vec3f& rootNormal) {
    constexpr float kHolds = 0.98f;
    constexpr float kLongest = 0.05f;  // metres
    std::vector<float> before, behind;
    const std::size_t last = fitted.stations() - 1;
    const Vec3f back = -perpendicular(fitted.along[0], rootNormal);
    for (const std::uint32_t s : strands) {
        const auto points = hair.strand(s);
        before.push_back((points.front() - fitted.centre[0]).dot(back));
        behind.push_back((points.back() - fitted.centre[last]).dot(fitted.along[last]));
    }
    // Hair that stands up has no way back along the scalp.
    const float upright = std::abs(fitted.along[0].dot(rootNormal));
    const float flat = std::min(1.0f, 2 * std::sqrt(std::max(0.0f, 1 - upright * upright)));
    const float longest = flat * std::min(kLongest, 0.3f * fitted.length());
    const float atRoot = std::clamp(quantile(before, kHolds), 0.0f, longest);
    const float atTip = std::clamp(quantile(behind, kHolds), 0.0f, longest);
    std::vector<Vec3f> centre = fitted.centre;
    centre.insert(centre.begin(), fitted.centre.front() + (atRoot + 1e-5f) * back);
    centre.push_back(fitted.centre.back() + (atTip + 1e-5f) * fitted.along.back());
    return centre;
}

struct NearPoint {
    Vec3f point;
    float weight;
};
using NearPoints = std::vector<std::vector<NearPoint>>;

/// Points of the strands by the station that they are nearest to; a station without any has its neighbour's.
NearPoints nearPoints(const EvenHair& hair, std::span<const std::uint32_t> strands, const Strip& strip) {
    const std::size_t stations = strip.stations();
    NearPoints near(stations);
    for (const std::uint32_t s : strands) {
        const auto points = hair.strand(s);
        const auto places = placesOn(strip, points);
        for (std::size_t p = 0; p < points.size(); ++p)
            near[places[p].nearest()].push_back({points[p], hair.weights[s] + 1e-12f});
    }
    for (std::size_t k = 1; k < stations; ++k)
        if (near[k].empty()) near[k] = near[k - 1];
    for (std::size_t k = stations - 1; k-- > 0;)
        if (near[k].empty()) near[k] = near[k + 1];
    return near;
}

/// Frames that follow the centre, from those of another strip of as many stations or others.
void setFrames(Strip& strip, const Strip& like) {
    setAlong(strip);
    const std::size_t stations = strip.stations();
    strip.cross.resize(stations), strip.normal.resize(stations);
    for (std::size_t k = 0; k < stations; ++k) {
        strip.cross[k] =
            perpendicular(like.cross[k * (like.stations() - 1) / (stations - 1)], strip.along[k]);
        strip.normal[k] = strip.along[k].cross(strip.cross[k]);
    }
}

/// Width and middle from where nearly all points lie.
void setWidths(Strip& strip, const NearPoints& near) {
    constexpr float kHolds = 0.995f;
    const std::size_t stations = strip.stations();
    std::vector<float> middle(stations), half(stations);
    for (std::size_t k = 0; k < stations; ++k) {
        std::vector<float> places;
        for (std::size_t i = k == 0 ? 0 : k - 1; i < std::min<std::size_t>(k + 2, stations); ++i) {
            for (const NearPoint& n : near[i])
                places.push_back((n.point - strip.centre[i]).dot(strip.cross[i]));
        }
        const float low = quantile(places, 1 - kHolds), high = quantile(places, kHolds);
        middle[k] = 0.5f * (low + high);
        half[k] = std::max(0.5f * (high - low), kLeastHalf);
    }
    for (int pass = 0; pass < 3; ++pass) {
        smooth(stations, [&](std::size_t k) -> float& { return middle[k]; });
        smooth(stations, [&](std::size_t k) -> float& { return half[k]; });
    }
    for (std::size_t k = 0; k < stations; ++k) {
        // Moving the middle moves the bowl of the bend along.
        strip.centre[k] += middle[k] * strip.cross[k];
        strip.halfWidth[k] = half[k];
        strip.spread[k] = std::max(0.0f, strip.spread[k] - middle[k] * middle[k]);
        const float most = kMostBend / half[k];
        strip.bend[k] = std::clamp(strip.bend[k], -most, most);
    }
    const Strip before = strip;
    setFrames(strip, before);
}

/// Moves the strip outwards to where what is seen of the strands lies, and at the root clear of the scalp.
void lift(Strip& strip, const NearPoints& near, const Vec3f& rootNormal) {
    constexpr float kSeen = 0.8f;      // of the strands lie below
    constexpr float kClear = 0.0025f;  // metres, fading over the first third
    const std::size_t stations = strip.stations();
    std::vector<float> heights(stations);
    for (std::size_t k = 0; k < stations; ++k) {
        std::vector<float> offs;
        for (const NearPoint& n : near[k]) {
            const Vec3f d = n.point - strip.centre[k];
            const float x = d.dot(strip.cross[k]);
            offs.push_back(d.dot(strip.normal[k]) - strip.bend[k] * (x * x - strip.spread[k]));
        }
        heights[k] = quantile(offs, kSeen);
    }
    for (int pass = 0; pass < 4; ++pass)
        smooth(stations, [&](std::size_t k) -> float& { return heights[k]; });
    for (std::size_t k = 0; k < stations; ++k) {
        const float fade = std::max(0.0f, 1 - 3 * static_cast<float>(k) / static_cast<float>(stations - 1));
        strip.centre[k] += heights[k] * strip.normal[k] + fade * kClear * rootNormal;
    }
    const Strip before = strip;
    setFrames(strip, before);
}

}  // namespace

Strip framed(Strip strip) {
    const Strip given = strip;
    setFrames(strip, given);
    return strip;
}

Strip finishStrip(const EvenHair& hair, std::span<const std::uint32_t> strands, const Strip& fitted,
                  std::uint32_t stations, std::span<const Vec3f> rootNormals_ws) {
    const Vec3f rootNormal = meanNormal(strands, rootNormals_ws);
    Strip strip;
    strip.centre = evenly(extended(hair, strands, fitted, rootNormal), stations);
    // No crease where it leaves the scalp.
    for (int pass = 0; pass < 2; ++pass)
        smooth(stations, [&](std::size_t k) -> Vec3f& { return strip.centre[k]; });
    setFrames(strip, fitted);
    const NearPoints near = nearPoints(hair, strands, strip);
    fitAcross(strip, rootNormal, [&](std::size_t k, const auto& take) {
        for (const NearPoint& n : near[k]) {
            const Vec3f d = n.point - strip.centre[k];
            take(n.point - d.dot(strip.along[k]) * strip.along[k], n.weight);
        }
    });
    setWidths(strip, near);
    lift(strip, near, rootNormal);
    return strip;
}

Strip crossingStrip(const EvenHair& hair, std::span<const std::uint32_t> strands, const Strip& by,
                    const Strip& on) {
    const auto upright = [](Strip strip) {
        for (std::size_t k = 0; k < strip.stations(); ++k) {
            const Vec3f outwards = strip.normal[k];
            strip.normal[k] = -strip.cross[k], strip.cross[k] = outwards;
            strip.bend[k] = strip.spread[k] = 0;
        }
        return strip;
    };
    Strip thick = upright(by), crossing = upright(on);
    setWidths(thick, nearPoints(hair, strands, by));
    for (std::size_t k = 0; k < on.stations(); ++k) {
        crossing.centre[k] += (thick.centre[k] - by.centre[k]).dot(by.normal[k]) * on.normal[k];
        crossing.halfWidth[k] = thick.halfWidth[k];
    }
    return framed(std::move(crossing));
}

}  // namespace hairloom::cards
