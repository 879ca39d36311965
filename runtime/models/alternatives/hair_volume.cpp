// SPDX-License-Identifier: MIT
#include "hairloom/alternatives/hair_volume.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "engine/checks.h"
#include "engine/in_parallel.h"

namespace hairloom::runtime {
namespace {

constexpr float kFastest = 1000.0f;  // m/s that a component adds at most to a sum
constexpr std::uint32_t kShares = 256;
constexpr std::int64_t kMassUnits = std::int64_t{kShares} * kShares * kShares;

bool counts(Float3 position, Float3 velocity) {
    return isFinite(velocity) && std::abs(position.x) <= kFarthest && std::abs(position.y) <= kFarthest &&
           std::abs(position.z) <= kFarthest;
}

std::array<float, 3> components(Float3 v) {
    return {v.x, v.y, v.z};
}

Float3 componentMin(Float3 a, Float3 b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
Float3 componentMax(Float3 a, Float3 b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

void add(std::int64_t& sum, std::int64_t value) {
#ifdef __cpp_lib_atomic_ref
    std::atomic_ref<std::int64_t>(sum).fetch_add(value, std::memory_order_relaxed);
#else
    __atomic_fetch_add(&sum, value, __ATOMIC_RELAXED);  // a library older than the language, with clang
#endif
}

/// Weight of one of the eight corners; they sum to kMassUnits.
std::int64_t weightOf(const std::array<std::uint32_t, 3>& share, unsigned corner) {
    std::int64_t weight = 1;
    for (unsigned axis = 0; axis < 3; ++axis) {
        weight *= (corner >> axis & 1u) ? share[axis] : kShares - share[axis];
    }
    return weight;
}

}  // namespace

HairVolume::Result HairVolume::make(const HairVolumeSettings& settings, Host host) {
    std::string error;
    const auto check = [&](const char* name, float value, float low, float high) {
        refuseOutside(error, name, static_cast<double>(value), static_cast<double>(low),
                      static_cast<double>(high));
    };
    check("cellSize", settings.cellSize, 1e-4f, 10.0f);
    refuseOutside(error, "maxNodes", settings.maxNodes, 125.0, 1e7);
    check("targetDensity", settings.targetDensity, 1.0f, 1e12f);
    check("repulsion", settings.repulsion, 0.0f, 1000.0f);
    check("friction", settings.friction, 0.0f, 1000.0f);
    if (!error.empty()) return {std::nullopt, std::move(error)};
    HairVolume volume;
    volume.settings_ = settings;
    volume.host_ = std::move(host);
    volume.nodes_.resize(settings.maxNodes);
    volume.fields_.resize(settings.maxNodes);
    return {std::move(volume), {}};
}

/// body(chunk, begin, end) for kChunks pieces that do not depend on the host.
template <class Body>
void HairVolume::forChunks(std::size_t count, const Body& body) {
    const auto chunks = [&](std::size_t first, std::size_t last) {
        for (std::size_t c = first; c < last; ++c) {
            body(c, count * c / kChunks, count * (c + 1) / kChunks);
        }
    };
    inParallel(host_, kChunks, 1, chunks);
}

HairVolume::Report HairVolume::apply(std::span<const Float3> positions_ws, std::span<Float3> velocities_ws,
                                     float dt) {
    size_ = {};
    if (!(dt > 0.0f) || !std::isfinite(dt) || positions_ws.size() != velocities_ws.size()) return {};
    const Box box = measure(positions_ws, velocities_ws);
    Report report{0.0f, 0, positions_ws.size() - box.points};
    if (box.points == 0) return report;
    layOut(box);
    accumulate(positions_ws, velocities_ws);
    resolve();
    const float share = -std::expm1(-settings_.friction * dt);
    forChunks(positions_ws.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (counts(positions_ws[i], velocities_ws[i]))
                changeVelocity(positions_ws[i], velocities_ws[i], share, dt);
        }
    });
    report.cellSize = cell_;
    report.nodes = size_[0] * size_[1] * size_[2];
    return report;
}

HairVolume::Box HairVolume::measure(std::span<const Float3> positions, std::span<const Float3> velocities) {
    const Box empty{{kFarthest, kFarthest, kFarthest}, {-kFarthest, -kFarthest, -kFarthest}, 0.0f, 0};
    forChunks(positions.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        Box box = empty;
        for (std::size_t i = begin; i < end; ++i) {
            if (!counts(positions[i], velocities[i])) continue;
            box.low = componentMin(box.low, positions[i]);
            box.high = componentMax(box.high, positions[i]);
            for (const float v : components(velocities[i])) {
                box.fastest = std::max(box.fastest, std::min(std::abs(v), kFastest));
            }
            ++box.points;
        }
        boxes_[chunk] = box;
    });
    Box sum = empty;
    for (const Box& box : boxes_) {
        sum.low = componentMin(sum.low, box.low);
        sum.high = componentMax(sum.high, box.high);
        sum.fastest = std::max(sum.fastest, box.fastest);
        sum.points += box.points;
    }
    return sum;
}

/// Nodes stand at whole multiples of the cell in the world, so that hair that rests in a growing box feels
/// the same grid; one more node than needed on each side carries the gradient.
void HairVolume::layOut(const Box& box) {
    const std::array<float, 3> low = components(box.low), high = components(box.high);
    for (double cell = static_cast<double>(settings_.cellSize);; cell *= 2.0) {
        double nodes = 1.0;
        std::array<double, 3> first{}, count{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            first[axis] = std::floor(static_cast<double>(low[axis]) / cell) - 1.0;
            count[axis] = std::floor(static_cast<double>(high[axis]) / cell) + 3.0 - first[axis];
            nodes *= count[axis];
        }
        if (nodes > static_cast<double>(settings_.maxNodes)) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            origin_[axis] = static_cast<std::int64_t>(first[axis]);
            size_[axis] = static_cast<std::uint32_t>(count[axis]);
        }
        cell_ = static_cast<float>(cell);
        break;
    }
    // points · kMassUnits · fastest/unit stays below 2⁶².
    const int bits = 62 - 24 - static_cast<int>(std::bit_width(box.points));
    velocityUnit_ = std::exp2(std::ceil(std::log2(std::max(static_cast<double>(box.fastest), 1e-30))) - bits);
}

HairVolume::Place HairVolume::placeOf(Float3 position) const {
    Place place;
    const std::array<float, 3> at = components(position);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double cells =
            static_cast<double>(at[axis]) / static_cast<double>(cell_) - static_cast<double>(origin_[axis]);
        const std::uint32_t steps = static_cast<std::uint32_t>(std::lround(cells * kShares));
        place.corner[axis] = steps / kShares;
        place.share[axis] = steps % kShares;
    }
    return place;
}

std::size_t HairVolume::nodeOf(const Place& place, unsigned corner) const {
    const std::size_t x = place.corner[0] + (corner & 1u), y = place.corner[1] + (corner >> 1 & 1u),
                      z = place.corner[2] + (corner >> 2);
    return (z * size_[1] + y) * size_[0] + x;
}

void HairVolume::accumulate(std::span<const Float3> positions, std::span<const Float3> velocities) {
    std::fill_n(nodes_.begin(), std::size_t{size_[0]} * size_[1] * size_[2], Node{});
    const auto whole = [&](float v) {
        return static_cast<std::int64_t>(
            std::llround(static_cast<double>(std::clamp(v, -kFastest, kFastest)) / velocityUnit_));
    };
    forChunks(positions.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!counts(positions[i], velocities[i])) continue;
            const Place place = placeOf(positions[i]);
            const std::int64_t x = whole(velocities[i].x), y = whole(velocities[i].y),
                               z = whole(velocities[i].z);
            for (unsigned corner = 0; corner < 8; ++corner) {
                const std::int64_t weight = weightOf(place.share, corner);
                if (weight == 0) continue;
                Node& node = nodes_[nodeOf(place, corner)];
                add(node.mass, weight);
                add(node.x, weight * x);
                add(node.y, weight * y);
                add(node.z, weight * z);
            }
        }
    });
}

float HairVolume::pressureAt(std::size_t node) const {
    const double cell = static_cast<double>(cell_);
    const double density =
        static_cast<double>(nodes_[node].mass) / (static_cast<double>(kMassUnits) * cell * cell * cell);
    const double above = density / static_cast<double>(settings_.targetDensity) - 1.0;
    return settings_.repulsion * static_cast<float>(std::max(above, 0.0));
}

/// The outermost nodes hold no hair and stay without a field.
void HairVolume::resolve() {
    const std::size_t row = size_[0], slice = row * size_[1];
    forChunks(size_[2], [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t z = begin; z < end; ++z) {
            for (std::size_t i = z * slice; i < (z + 1) * slice; ++i) {
                fields_[i] = {};
                const std::size_t x = i % row, y = i / row % size_[1];
                const Node& node = nodes_[i];
                if (node.mass == 0 || x == 0 || y == 0 || z == 0 || x + 1 == row || y + 1 == size_[1] ||
                    z + 1 == size_[2])
                    continue;
                const double speed = velocityUnit_ / static_cast<double>(node.mass);
                fields_[i].velocity = {static_cast<float>(static_cast<double>(node.x) * speed),
                                       static_cast<float>(static_cast<double>(node.y) * speed),
                                       static_cast<float>(static_cast<double>(node.z) * speed)};
                fields_[i].push =
                    Float3{pressureAt(i - 1) - pressureAt(i + 1), pressureAt(i - row) - pressureAt(i + row),
                           pressureAt(i - slice) - pressureAt(i + slice)} *
                    (0.5f / cell_);
            }
        }
    });
}

void HairVolume::changeVelocity(Float3 position, Float3& velocity, float share, float dt) const {
    const Place place = placeOf(position);
    Float3 around, push;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const float weight =
            static_cast<float>(weightOf(place.share, corner)) * (1.0f / static_cast<float>(kMassUnits));
        const Field& field = fields_[nodeOf(place, corner)];
        around = around + field.velocity * weight;
        push = push + field.push * weight;
    }
    const float limit = 0.5f * cell_ / dt, kick = length(push) * dt;
    velocity = velocity + (around - velocity) * share;
    if (kick > 0.0f) velocity = velocity + push * (dt * std::min(1.0f, limit / kick));
}

HairVolume::Totals HairVolume::totals() const {
    Totals totals;
    const std::size_t count = std::size_t{size_[0]} * size_[1] * size_[2];
    for (std::size_t i = 0; i < count; ++i) {
        const double unit = 1.0 / static_cast<double>(kMassUnits);
        totals.mass += static_cast<double>(nodes_[i].mass) * unit;
        totals.momentum[0] += static_cast<double>(nodes_[i].x) * velocityUnit_ * unit;
        totals.momentum[1] += static_cast<double>(nodes_[i].y) * velocityUnit_ * unit;
        totals.momentum[2] += static_cast<double>(nodes_[i].z) * velocityUnit_ * unit;
    }
    return totals;
}

std::size_t HairVolume::bytes() const {
    return nodes_.size() * sizeof(Node) + fields_.size() * sizeof(Field) + sizeof(HairVolume);
}

}  // namespace hairloom::runtime
