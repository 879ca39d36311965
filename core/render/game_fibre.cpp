// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/game_fibre.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/parallel.h"
#include "core/shading/absorption_layers.h"
#include "runtime/shaders/hair_types.h"

namespace hairloom::render {
namespace {

using shading::Lobe;

// At exactly 90 degrees there is no plane across the fibre.
constexpr double kSteepest = 89.5 * shading::kDegree;

double shareOf(std::size_t i, std::size_t count) {
    return static_cast<double>(i) / static_cast<double>(count - 1);
}

/// What lies at the place 0…1 of values that are evenly apart.
template <class Values>
float entryAt(const Values& values, double place) {
    const double at = place * static_cast<double>(values.size() - 1);
    const auto low = std::min(static_cast<std::size_t>(at), values.size() - 2);
    const auto part = static_cast<float>(at - static_cast<double>(low));
    return values[low] + part * (values[low + 1] - values[low]);
}

/// Fills them one by one.
class GameFibre {
  public:
    explicit GameFibre(const shading::MarschnerParameters& fibre)
        : fibre_(fibre), values_(HAIR_TABLE_FLOATS) {}

    std::vector<std::uint16_t> halves() {
        along();
        around();
        averages();
        spread();
        std::vector<std::uint16_t> halves;
        halves.reserve(values_.size());
        for (const float value : values_)
            halves.push_back(Eigen::half(std::clamp(value, -65000.0f, 65000.0f)).x);
        return halves;
    }

  private:
    void along() {
        const shading::Marschner model(fibre_);
        for (const Lobe lobe : shading::kLobes) {
            const shading::LongitudinalLobe& l = model.longitudinalLobe(lobe);
            float* const in = &values_[shading::index(lobe) * HAIR_ALONG];
            for (std::size_t i = 0; i < HAIR_ALONG; ++i) {
                const double theta =
                    std::clamp((shareOf(i, HAIR_ALONG) - 0.5) * std::numbers::pi, -kSteepest, kSteepest);
                in[i] = static_cast<float>(l.factorIn(theta));
                in[3 * HAIR_ALONG + i] = static_cast<float>(l.factorOut(theta));
            }
        }
    }

    void around() {
        for (std::uint32_t first = 0; first < HAIR_ABSORPTIONS; first += 3) {
            shading::MarschnerParameters three = fibre_;
            for (int c = 0; c < 3; ++c)
                three.azimuthal.absorption[c] =
                    shading::absorptionOfLayer(first + static_cast<std::uint32_t>(c));
            const shading::Marschner model(three);
            parallelFor(HAIR_INCLINATIONS, 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t y = begin; y < end; ++y) aroundRow(model, first, y);
            });
        }
    }

    void aroundRow(const shading::Marschner& model, std::size_t first, std::size_t y) {
        const double thetaD = std::min(shareOf(y, HAIR_INCLINATIONS) * std::numbers::pi / 2, kSteepest);
        const shading::AzimuthalProfile::Grid grid = model.azimuthal(thetaD).grid();
        for (std::size_t x = 0; x < HAIR_AROUND; ++x) {
            const double phi = shareOf(x, HAIR_AROUND);
            for (std::size_t c = 0; c < 3; ++c) {
                float* const n = &values_[HAIR_TABLE_AROUND +
                                          (((first + c) * HAIR_INCLINATIONS + y) * HAIR_AROUND + x) * 2];
                n[0] = entryAt(grid.tt[c], phi);
                n[1] = entryAt(grid.trt[c], phi);
            }
            values_[HAIR_TABLE_REFLECTED + y * HAIR_AROUND + x] = entryAt(grid.r, phi);
        }
    }

    void averages() {
        const shading::DualLayers layers = shading::bakeDualLayers(fibre_, 64, HAIR_INCLINATIONS);
        std::copy(layers.averages.rgba.begin(), layers.averages.rgba.end(),
                  values_.begin() + HAIR_TABLE_AVERAGES);
    }

    void spread() {
        for (std::size_t y = 0; y < HAIR_WIDTHS; ++y) {
            const double width = shading::kMinSpread +
                                 shareOf(y, HAIR_WIDTHS) * (shading::kLargestSpread - shading::kMinSpread);
            const shading::LongitudinalLobe lobe(0, width);
            for (std::size_t x = 0; x < HAIR_SPREAD; ++x)
                values_[HAIR_TABLE_SPREAD + y * HAIR_SPREAD + x] = static_cast<float>(
                    lobe.factorOut(std::min(std::asin(shareOf(x, HAIR_SPREAD)), kSteepest)));
        }
    }

    shading::MarschnerParameters fibre_;
    std::vector<float> values_;
};

}  // namespace

std::vector<std::uint16_t> gameFibreTables(const shading::MarschnerParameters& fibre) {
    return GameFibre(fibre).halves();
}

}  // namespace hairloom::render
