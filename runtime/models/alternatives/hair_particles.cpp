// SPDX-License-Identifier: MIT
#include "hairloom/alternatives/hair_particles.h"

#include <atomic>
#include <cmath>
#include <numbers>

#include "engine/in_parallel.h"
#include "models/alternatives/hair_spacing.h"

namespace hairloom::runtime {
namespace {

constexpr float kSpacings = 2.5f;  // of the hair, in a radius that nobody gave
constexpr std::size_t kPerJob = 256;
constexpr float kCourant = 0.4f;

/// The cubic spline of Monaghan 1992 and its slope over the distance, (dW/dr)/r, for q = 2 r/radius below 2.
struct Kernel {
    float inverseHalf, scale, slopeScale;

    explicit Kernel(float radius)
        : inverseHalf(2.0f / radius),
          scale(inverseHalf * inverseHalf * inverseHalf / std::numbers::pi_v<float>),
          slopeScale(scale * inverseHalf * inverseHalf) {}
    float at(float q) const {
        const float left = 2.0f - q;
        return scale * (q < 1.0f ? 1.0f - q * q * (1.5f - 0.75f * q) : 0.25f * left * left * left);
    }
    float slopeOver(float q) const {
        const float left = 2.0f - q;
        return slopeScale * (q < 1.0f ? -3.0f + 2.25f * q : -0.75f * left * left / q);
    }
};

}  // namespace

HairParticles::Result HairParticles::make(const StrandsView& strands, const HairParticleSettings& settings,
                                          Host host) {
    std::string error;
    refuseOutside(error, "radius", static_cast<double>(settings.radius), 0.0, 1.0);
    refuseOutside(error, "stiffness", static_cast<double>(settings.stiffness), 0.0, 1000.0);
    refuseOutside(error, "friction", static_cast<double>(settings.friction), 0.0, 1000.0);
    if (error.empty()) error = validationError(strands);
    if (error.empty() && strands.restPositions_ss.empty()) error = "no strands; expected one at least";
    if (!error.empty()) return {std::nullopt, std::move(error)};
    HairParticles made;
    made.settings_ = settings;
    made.host_ = std::move(host);
    made.masses_ = massesOf(strands);
    made.radius_ = settings.radius > 0.0f ? settings.radius : kSpacings * spacingOf(strands);
    made.radius_ = std::max(made.radius_, 1e-5f);
    made.speeds_.resize(made.masses_.size());
    made.pushes_.resize(made.masses_.size());
    made.sort(strands.restPositions_ss);
    made.measure(strands.restPositions_ss, made.restDensities_);
    return {std::move(made), {}};
}

void HairParticles::sort(std::span<const Float3> positions) {
    cells_.sort(positions, radius_, [&](std::size_t i) { return countsIn(positions[i], speeds_[i]); });
}

void HairParticles::measure(std::span<const Float3> positions, std::vector<float>& densities) {
    densities.assign(positions.size(), 0.0f);
    const Kernel kernel(radius_);
    inParallel(host_, positions.size(), kPerJob, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!cells_.has(i)) continue;
            float sum = 0.0f;
            cells_.around(i, [&](std::size_t j) {
                const float q = length(positions[j] - positions[i]) * kernel.inverseHalf;
                if (q < 2.0f) sum += masses_[j] * kernel.at(q);
            });
            densities[i] = sum;
        }
    });
}

HairParticles::Report HairParticles::apply(std::span<const Float3> positions_ws,
                                           std::span<Float3> velocities_ws, float dt) {
    Report report;
    if (!(dt > 0.0f) || !std::isfinite(dt) || positions_ws.size() != masses_.size() ||
        velocities_ws.size() != masses_.size())
        return report;
    speeds_.assign(velocities_ws.begin(), velocities_ws.end());
    sort(positions_ws);
    measure(positions_ws, densities_);
    for (std::size_t i = 0; i < masses_.size(); ++i) {
        const float density = densities_[i], rest = restDensities_[i];
        const float above = rest > 0.0f ? std::clamp(density / rest - 1.0f, 0.0f, 1.0f) : 0.0f;
        pushes_[i] = density > 0.0f ? rest * above / (density * density) : 0.0f;
        if (!cells_.has(i)) ++report.leftOut;
    }
    const float fastest = kCourant * radius_ / dt;
    const float push = std::min(settings_.stiffness, fastest * fastest) * dt;
    const float share = std::min(-std::expm1(-settings_.friction * dt), 0.5f);
    const Kernel kernel(radius_);
    std::atomic<std::uint64_t> pairs{0};
    inParallel(host_, masses_.size(), kPerJob, [&](std::size_t begin, std::size_t end) {
        std::uint64_t found = 0;
        for (std::size_t i = begin; i < end; ++i) {
            if (!cells_.has(i)) continue;
            Float3 change;
            cells_.around(i, [&](std::size_t j) {
                const Float3 away = positions_ws[i] - positions_ws[j];
                const float q = length(away) * kernel.inverseHalf;
                if (j == i || !(q < 2.0f)) return;
                ++found;
                const float mass = masses_[j];
                // At one place there is no direction to push in.
                if (q > 0.0f)
                    change = change - away * (push * mass * (pushes_[i] + pushes_[j]) * kernel.slopeOver(q));
                const float smooth = share * mass * kernel.at(q) * 2.0f / (densities_[i] + densities_[j]);
                change = change + (speeds_[j] - speeds_[i]) * smooth;
            });
            velocities_ws[i] = speeds_[i] + change;
        }
        pairs.fetch_add(found, std::memory_order_relaxed);
    });
    report.pairs = pairs.load();
    return report;
}

std::size_t HairParticles::bytes() const {
    const std::size_t floats =
        masses_.size() + densities_.size() + restDensities_.size() + pushes_.size() + 3 * speeds_.size();
    return sizeof(HairParticles) + 4 * floats + cells_.bytes();
}

}  // namespace hairloom::runtime
