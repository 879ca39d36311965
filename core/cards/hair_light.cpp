// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/cards/hair_light.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace hairloom::cards {
namespace {

constexpr float kFinest = 0.004f;     // metres of a cell
constexpr int kMostCells = 64;        // along a side
constexpr float kExtinction = 0.35f;  // of what meets a fibre; the rest goes on through the hair
constexpr float kHeadBlocks = 3;      // optical depth of a cell of the head
constexpr float kAmbient = 0.55f;
constexpr float kLamp = 1.9f;

/// Sums hair up in cells; order of strands, so that no thread has a say.
std::vector<float> densities(const Hair& hair, const Vec3f& low, float cell, const std::array<int, 3>& size) {
    std::vector<float> sums(static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
                            static_cast<std::size_t>(size[2]));
    const float volume = cell * cell * cell;
    for (std::size_t s = 0; s < hair.strandCount(); ++s) {
        for (std::size_t p = hair.offsets[s]; p + 1 < hair.offsets[s + 1]; ++p) {
            const Vec3f &a = hair.positions_ws[p], &b = hair.positions_ws[p + 1];
            const float length = (b - a).norm();
            const int pieces = 1 + static_cast<int>(std::min(length / cell, 1000.0f));
            const float area = length * (hair.radii[p] + hair.radii[p + 1]) / static_cast<float>(pieces);
            for (int i = 0; i < pieces; ++i) {
                const float t = (static_cast<float>(i) + 0.5f) / static_cast<float>(pieces);
                const Vec3f at = (a + t * (b - a) - low) / cell;
                const auto x = static_cast<std::size_t>(at.x()), y = static_cast<std::size_t>(at.y()),
                           z = static_cast<std::size_t>(at.z());
                sums[(z * static_cast<std::size_t>(size[1]) + y) * static_cast<std::size_t>(size[0]) + x] +=
                    area / volume;
            }
        }
    }
    return sums;
}

}  // namespace

Result<HairLight> HairLight::make(const Hair& hair, Cancel cancel) {
    HairLight light;
    Box3f box;
    for (const Vec3f& point : hair.positions_ws) box.extend(point);
    light.cell_ = std::max(kFinest, box.sizes().maxCoeff() / static_cast<float>(kMostCells - 4));
    light.low_ = box.min() - Vec3f::Constant(2 * light.cell_);
    for (int i = 0; i < 3; ++i) {
        light.size_[static_cast<std::size_t>(i)] =
            std::min(kMostCells, 5 + static_cast<int>(box.sizes()[i] / light.cell_));
    }
    light.density_ = densities(hair, light.low_, light.cell_, light.size_);
    std::vector<float> blocked(light.density_.size());
    for (std::size_t i = 0; i < blocked.size(); ++i) blocked[i] = kExtinction * light.density_[i];
    for (std::size_t t = 0; t + 2 < hair.headIndices.size(); t += 3) {
        Vec3f middle = Vec3f::Zero();
        for (std::size_t k = 0; k < 3; ++k) middle += hair.headPositions_ws[hair.headIndices[t + k]] / 3;
        const Vec3f at = (middle - light.low_) / light.cell_;
        const std::array<int, 3> c{static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y())),
                                   static_cast<int>(std::floor(at.z()))};
        bool inside = true;
        for (std::size_t k = 0; k < 3; ++k) inside = inside && c[k] >= 0 && c[k] < light.size_[k];
        if (inside) blocked[light.index(c[0], c[1], c[2])] += kHeadBlocks / light.cell_;
    }
    std::vector<Vec3f> around;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (x != 0 || y != 0 || z != 0)
                    around.push_back(
                        Vec3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z))
                            .normalized());
    light.open_.resize(blocked.size()), light.lit_.resize(blocked.size());
    const auto rows = static_cast<std::size_t>(light.size_[1] * light.size_[2]);
    parallelFor(rows, 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end && !cancelled(cancel); ++row) {
            const int y = static_cast<int>(row) % light.size_[1], z = static_cast<int>(row) / light.size_[1];
            for (int x = 0; x < light.size_[0]; ++x) {
                const Vec3f from(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
                float sum = 0;
                for (const Vec3f& step : around) sum += std::exp(-light.depthAlong(blocked, from, step));
                const std::size_t i = light.index(x, y, z);
                light.open_[i] = sum / static_cast<float>(around.size());
                light.lit_[i] = std::exp(-light.depthAlong(blocked, from, toLamp_ws()));
            }
        }
    });
    if (cancelled(cancel)) return stopped();
    return light;
}

float HairLight::depthAlong(const std::vector<float>& blocked, const Vec3f& from, const Vec3f& step) const {
    float sum = 0;
    Vec3f at = from + Vec3f::Constant(0.5f) + 1.5f * step;
    for (;; at += step) {
        const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y())),
                  z = static_cast<int>(std::floor(at.z()));
        if (x < 0 || y < 0 || z < 0 || x >= size_[0] || y >= size_[1] || z >= size_[2]) return sum * cell_;
        sum += blocked[index(x, y, z)];
    }
}

float HairLight::at(const std::vector<float>& values, const Vec3f& place_ws) const {
    Vec3f at = (place_ws - low_) / cell_ - Vec3f::Constant(0.5f);
    std::array<int, 3> c{};
    for (int k = 0; k < 3; ++k) {
        const int most = size_[static_cast<std::size_t>(k)] - 2;
        at[k] = std::clamp(at[k], 0.0f, static_cast<float>(most) + 1);
        c[static_cast<std::size_t>(k)] = std::min(static_cast<int>(at[k]), most);
        at[k] -= static_cast<float>(c[static_cast<std::size_t>(k)]);
    }
    float sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
        const float weight =
            (x ? at.x() : 1 - at.x()) * (y ? at.y() : 1 - at.y()) * (z ? at.z() : 1 - at.z());
        sum += weight * values[index(c[0] + x, c[1] + y, c[2] + z)];
    }
    return sum;
}

Vec3f toLamp_ws() {
    return Vec3f(0.45f, 0.75f, 0.48f).normalized();
}

// Kajiya and Kay 1989, Eq. 14 and 16.
Vec3f reflected(const Reflection& fibre, const Vec3f& albedo, const Vec3f& along_ws, const Vec3f& toEye_ws,
                float open, float lit) {
    const float cosLight = along_ws.dot(toLamp_ws()), cosEye = along_ws.dot(toEye_ws);
    const float sinLight = std::sqrt(std::max(0.0f, 1 - cosLight * cosLight));
    const float sinEye = std::sqrt(std::max(0.0f, 1 - cosEye * cosEye));
    const float mirror = std::max(0.0f, sinLight * sinEye - cosLight * cosEye);
    const float shine = fibre.specular * std::pow(mirror, fibre.shininess);
    return albedo * (kAmbient * open + kLamp / kPi * lit * sinLight) +
           Vec3f::Constant(kLamp / kPi * lit * shine);
}

}  // namespace hairloom::cards
