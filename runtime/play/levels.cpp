// SPDX-License-Identifier: MIT
#include "play/levels.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hairloom::runtime {
namespace {

/// Of the levels between the finest and the rigid one.
struct Thinning {
    std::uint32_t guides, points;  // one in so many
    bool oneSubstep;
};
constexpr std::array<Thinning, HL_LEVEL_RIGID - 1> kThinning{{{2, 1, false}, {4, 2, false}, {8, 3, true}}};
constexpr std::uint32_t kFewestPoints = 4;
/// Sources are looked for among so many simulated guides before and after a guide along the curve.
constexpr std::size_t kWindow = 12;

/// Bits of x, two zeros behind each.
std::uint64_t spread(std::uint32_t x) {
    std::uint64_t bits = 0;
    for (unsigned b = 0; b < 16; ++b) bits |= std::uint64_t{(x >> b) & 1u} << (3 * b);
    return bits;
}

/// All guides along a curve that fills space (Morton 1966), so that neighbours on it are neighbours on the
/// head.
Vector<std::uint32_t> alongCurve(const Asset::Strands& strands, std::size_t guides) {
    Float3 low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
    const auto root = [&](std::size_t g) { return strands.positions_ss[strands.offsets[g]]; };
    for (std::size_t g = 0; g < guides; ++g) {
        const Float3 p = root(g);
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const float size = std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-6f});
    Vector<std::uint64_t> codes(guides);
    for (std::size_t g = 0; g < guides; ++g) {
        const Float3 p = (root(g) - low) * (65535.0f / size);
        const auto whole = [](float v) { return static_cast<std::uint32_t>(std::clamp(v, 0.0f, 65535.0f)); };
        codes[g] = spread(whole(p.x)) | spread(whole(p.y)) << 1u | spread(whole(p.z)) << 2u;
    }
    Vector<std::uint32_t> order(guides);
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return codes[a] != codes[b] ? codes[a] < codes[b] : a < b;
    });
    return order;
}

/// The three nearest of some simulated guides, by the inverse square of their distance; a simulated guide is
/// its own.
Level::Sources sourcesOf(const Asset::Strands& strands, std::uint32_t guide, const Level& level,
                         std::span<const std::uint32_t> candidates) {
    const auto root = [&](std::uint32_t g) { return strands.positions_ss[strands.offsets[g]]; };
    std::array<float, 3> distances{1e30f, 1e30f, 1e30f};
    Level::Sources sources{{candidates[0], candidates[0], candidates[0]}, {1, 0, 0}};
    for (const std::uint32_t candidate : candidates) {
        const Float3 apart = root(level.guides[candidate]) - root(guide);
        float distance = dot(apart, apart);
        std::uint32_t here = candidate;
        for (std::size_t i = 0; i < 3; ++i) {
            if (distance >= distances[i]) continue;
            std::swap(distance, distances[i]);
            std::swap(here, sources.guides[i]);
        }
    }
    if (level.guides[sources.guides[0]] == guide || !(distances[1] < 1e30f)) return sources;
    float sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        sources.shares[i] = distances[i] < 1e30f ? 1 / (distances[i] + 1e-8f) : 0;
        sum += sources.shares[i];
    }
    for (float& share : sources.shares) share /= sum;
    return sources;
}

Level makeLevel(const Asset::Strands& strands, std::span<const std::uint32_t> order, std::uint32_t number) {
    const Thinning& thinning = kThinning[number - 1];
    Level level;
    level.oneSubstep = thinning.oneSubstep;
    Vector<bool> taken(order.size());
    for (std::size_t i = thinning.guides / 2; i < order.size(); i += thinning.guides) taken[order[i]] = true;
    if (!order.empty() && order.size() <= thinning.guides / 2) taken[order[0]] = true;
    level.offsets.push_back(0);
    Vector<std::uint32_t> placeOf(order.size());
    for (std::uint32_t g = 0; g < order.size(); ++g) {
        if (!taken[g]) continue;
        placeOf[g] = static_cast<std::uint32_t>(level.guides.size());
        level.guides.push_back(g);
        const std::size_t first = strands.offsets[g], count = strands.offsets[g + 1] - first;
        const std::uint32_t points = pointsOfLevel(number, static_cast<std::uint32_t>(count));
        for (std::uint32_t p = 0; p < points; ++p)
            level.positions_ss.push_back(
                sampleAt(std::span(strands.positions_ss).subspan(first, count), p, points));
        level.offsets.push_back(static_cast<std::uint32_t>(level.positions_ss.size()));
    }
    Vector<std::uint32_t> curve;  // places of simulated guides along it
    for (const std::uint32_t g : order)
        if (taken[g]) curve.push_back(placeOf[g]);
    level.sources.resize(order.size());
    std::size_t passed = 0;  // simulated guides before this one
    for (const std::uint32_t g : order) {
        const std::size_t begin = passed > kWindow ? passed - kWindow : 0;
        const std::size_t end = std::min(curve.size(), passed + kWindow);
        level.sources[g] = sourcesOf(strands, g, level,
                                     std::span<const std::uint32_t>(curve).subspan(
                                         std::min(begin, end - 1), end - std::min(begin, end - 1)));
        if (taken[g]) ++passed;
    }
    return level;
}

}  // namespace

std::uint32_t pointsOfLevel(std::uint32_t level, std::uint32_t points) {
    const std::uint32_t less = (points + kThinning[level - 1].points - 1) / kThinning[level - 1].points;
    return std::min(points, std::max(less, kFewestPoints));
}

std::uint32_t guidesOfLevel(std::uint32_t level, std::uint32_t guides) {
    const std::uint32_t each = kThinning[level - 1].guides;
    return guides > each / 2 ? (guides - each / 2 + each - 1) / each : 1;
}

namespace {

template <class T>
T sampled(std::span<const T> values, std::size_t p, std::size_t count) {
    if (values.size() == count) return values[p];
    const float at = static_cast<float>(p * (values.size() - 1)) / static_cast<float>(count - 1);
    const std::size_t before = std::min(static_cast<std::size_t>(at), values.size() - 2);
    const float share = at - static_cast<float>(before);
    return values[before] * (1 - share) + values[before + 1] * share;
}

}  // namespace

Float3 sampleAt(std::span<const Float3> values, std::size_t p, std::size_t count) {
    return sampled(values, p, count);
}

float sampleAt(std::span<const float> values, std::size_t p, std::size_t count) {
    return sampled(values, p, count);
}

std::size_t Level::bytes() const {
    return (guides.size() + offsets.size()) * sizeof(std::uint32_t) + positions_ss.size() * sizeof(Float3) +
           sources.size() * sizeof(Sources);
}

LevelSet::LevelSet(const Asset::Strands& strands) : offsets(strands.offsets), rest(strands.positions_ss) {
    const std::size_t guides = offsets.size() - 1;
    for (std::size_t g = 0; g < guides; ++g) {
        const Float3 root = strands.positions_ss[offsets[g]];
        for (std::size_t p = offsets[g]; p < offsets[g + 1]; ++p) rest[p] = rest[p] - root;
    }
    const Vector<std::uint32_t> order = alongCurve(strands, guides);
    for (std::uint32_t number = 1; number < HL_LEVEL_RIGID; ++number)
        coarser.push_back(makeLevel(strands, order, number));
}

std::size_t LevelSet::bytes() const {
    std::size_t bytes = offsets.size() * sizeof(std::uint32_t) + rest.size() * sizeof(Float3);
    for (const Level& level : coarser) bytes += level.bytes();
    return bytes;
}

void showGuides(const LevelSet& set, const Level& level, const Standing& standing,
                std::span<const RootFrame> roots_ws, std::span<const Float3> simulated_ws,
                std::span<Float3> moved, std::span<Float3> positions_ws) {
    for (std::size_t s = 0; s < level.guides.size(); ++s) {
        const RootFrame& root = roots_ws[level.guides[s]];
        const Quat back = conjugate(root.rotation);
        const Float3 rest = level.positions_ss[level.offsets[s]];
        for (std::size_t p = level.offsets[s]; p < level.offsets[s + 1]; ++p) {
            const Float3 stood =
                standing.simulated.empty() ? level.positions_ss[p] - rest : standing.simulated[p];
            moved[p] = rotate(back, simulated_ws[p] - root.position) - stood;
        }
    }
    for (std::size_t g = 0; g < roots_ws.size(); ++g) {
        const Level::Sources& sources = level.sources[g];
        const std::size_t first = set.offsets[g], count = set.offsets[g + 1] - first;
        for (std::size_t p = 0; p < count; ++p) {
            Float3 away{};
            for (std::size_t i = 0; i < 3; ++i) {
                if (sources.shares[i] == 0) continue;
                const std::size_t s = sources.guides[i];
                const auto strand = moved.subspan(level.offsets[s], level.offsets[s + 1] - level.offsets[s]);
                away = away + sampleAt(strand, p, count) * sources.shares[i];
            }
            positions_ws[first + p] =
                roots_ws[g].position + rotate(roots_ws[g].rotation, standing.all[first + p] + away);
        }
    }
}

void showRigid(const LevelSet& set, const Standing& standing, std::span<const RootFrame> roots_ws,
               std::span<Float3> positions_ws) {
    for (std::size_t g = 0; g < roots_ws.size(); ++g) {
        for (std::size_t p = set.offsets[g]; p < set.offsets[g + 1]; ++p)
            positions_ws[p] = roots_ws[g].position + rotate(roots_ws[g].rotation, standing.all[p]);
    }
}

}  // namespace hairloom::runtime
