// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Charts of `render --show`, and their numbers.

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <vector>

#include "tests/cli/command.h"

namespace hairloom::test {

inline constexpr double kPi = std::numbers::pi, kRadians = kPi / 180;

struct Curve {
    std::vector<double> x, y;

    double at(double place) const {
        for (std::size_t i = 0; i < x.size(); ++i) {
            if (std::abs(x[i] - place) < 1e-9) return y[i];
        }
        ADD_FAILURE() << "no value at " << place;
        return 0;
    }
};

class ShowJob : public CommandLineTest {
  protected:
    nlohmann::json shown(const std::string& name, const std::string& more = "") const {
        return runJson("render --show " + name + " -o " + name + ".png " + more);
    }
    /// A file for --material.
    std::string material(const std::string& fields) const {
        std::ofstream(folder / "material.json") << R"({"material": {)" << fields << "}}";
        return " --material material.json";
    }
    static Curve curve(const nlohmann::json& report, const std::string& name) {
        for (const auto& one : report["curves"]) {
            if (one["name"] == name) return {one["x"], one["y"]};
        }
        ADD_FAILURE() << "no curve " << name;
        return {};
    }
    /// Width and height in the head of a PNG.
    std::pair<std::uint32_t, std::uint32_t> sizeOf(const std::string& file) const {
        const std::string bytes = readText(folder / file);
        const auto number = [&](std::size_t at) {
            std::uint32_t value = 0;
            for (std::size_t i = 0; i < 4; ++i)
                value = value << 8u | static_cast<unsigned char>(bytes[at + i]);
            return value;
        };
        EXPECT_THAT(bytes.substr(1, 3), "PNG");
        return {number(16), number(20)};
    }
};

/// Of unpolarised light that meets glass at an angle, by Snell's law and complex amplitudes.
inline double fresnelOfGlass(double ior, double angle) {
    const double cosine = std::cos(angle), sine = std::sin(angle) / ior;
    const double inside = std::sqrt(1 - sine * sine);
    const double s = (cosine - ior * inside) / (cosine + ior * inside);
    const double p = (ior * cosine - inside) / (ior * cosine + inside);
    return 0.5 * (s * s + p * p);
}

}  // namespace hairloom::test
