// SPDX-License-Identifier: GPL-3.0-or-later
// Caustics of Marschner's fibres as they are authored, against rays through glass.
#include <algorithm>
#include <cmath>

#include "tests/cli/show_job.h"

namespace hairloom::test {
namespace {

using testing::HasSubstr;

/// TRT of a fibre of clear glass with light across it, by its rays: Snell's law and Fresnel's amplitudes; the
/// caustics replaced by Gaussians of what is taken away (Marschner et al. 2003, section 5.2.2). Radians.
struct ClearFibre {
    double ior, blur;  ///< standard deviation of what roughness adds; 0: smooth
    double width, fade, strength;
    bool cubic = false;
    double turnsBack = 0;  ///< caustic(), which n() finds

    /// Of light that meets the wall at the angle γ; no turns by π are left with two crossings and one mirror.
    double turn(double gamma) const {
        if (!cubic) return 4 * std::asin(std::sin(gamma) / ior) - 2 * gamma;
        const double grazing = std::asin(1 / ior);
        return (12 * grazing / kPi - 2) * gamma - 16 * grazing / std::pow(kPi, 3) * std::pow(gamma, 3);
    }
    double passed(double gamma) const {
        const double mirrored = fresnelOfGlass(ior, gamma);
        return mirrored * (1 - mirrored) * (1 - mirrored);
    }
    double caustic() const {
        double furthest = 0;
        for (int i = 0; i <= 20'000 && ior < 2; ++i)
            furthest = std::max(furthest, turn(i * kPi / 2 / 20'000));
        return furthest;
    }
    double share() const {
        const double t = fade > 0 ? std::clamp((ior - 2) / fade, 0.0, 1.0) : ior > 2 ? 1.0 : 0.0;
        return 1 - t * t * (3 - 2 * t);
    }
    double kept(double phi) const {
        double all = 1;
        for (const double side : {-1.0, 1.0})
            all *=
                1 - share() *
                        std::exp(-0.5 * std::pow(std::remainder(phi - side * turnsBack, 2 * kPi) / width, 2));
        return all;
    }
    static double gauss(double x, double deviation) {
        double sum = 0;
        for (int k = -3; k <= 3; ++k) sum += std::exp(-0.5 * std::pow((x + 2 * kPi * k) / deviation, 2));
        return sum / (deviation * std::sqrt(2 * kPi));
    }

    /// N at each of `degrees`.
    std::vector<double> n(const std::vector<double>& degrees) {
        turnsBack = caustic();
        constexpr int kRays = 4'000;
        const double step = kPi / 2 / kRays;
        std::vector<double> sums(degrees.size());
        double taken = 0;
        for (int i = 0; i < kRays; ++i) {
            const double gamma = (i + 0.5) * step, phi = turn(gamma),
                         light = passed(gamma) * std::cos(gamma) * step;
            taken += light * (1 - kept(phi));
            const double before = turn(i * step), after = turn((i + 1) * step);
            for (std::size_t d = 0; d < degrees.size(); ++d) {
                const double at = degrees[d] * kRadians;
                for (const double side : {-1.0, 1.0}) {
                    if (blur > 0) {
                        sums[d] += 0.5 * light * kept(phi) * gauss(at - side * phi, blur);
                        continue;
                    }
                    // The ray that leaves here lies between these two.
                    const double place = std::remainder(side * at - before, 2 * kPi), range = after - before;
                    if (place * range < 0 || std::abs(place) >= std::abs(range)) continue;
                    sums[d] += 0.5 * passed(gamma) * std::cos(gamma) * step / std::abs(range) * kept(at);
                }
            }
        }
        for (std::size_t d = 0; d < degrees.size(); ++d) {
            for (const double side : {-1.0, 1.0})
                sums[d] += 0.5 * strength * taken *
                           gauss(degrees[d] * kRadians - side * turnsBack, std::hypot(blur, width));
        }
        return sums;
    }
};

TEST_F(ShowJob, CausticsHaveTheWidthFadeAndStrengthThatAreAuthored) {
    struct Case {
        double roughness, ior, width, fade, strength;
        bool cubic;
    };
    for (const Case& c : {Case{0.01, 1.55, 0, 0.3, 1, false}, Case{0.01, 1.55, 4, 0.3, 1, false},
                          Case{0.01, 1.55, 25, 0.3, 6, false}, Case{0.01, 1.55, 8, 0.3, 0, true},
                          Case{0.01, 1.55, 8, 0.3, 2, true}, Case{0.3, 1.55, 6, 0.3, 1, false},
                          Case{0.3, 1.55, 20, 0.3, 5, false}, Case{0.2, 1.4, 12, 0.3, 3, true},
                          Case{0.3, 2.2, 10, 0.5, 4, false}, Case{0.3, 2.2, 10, 0, 4, false},
                          Case{0.01, 2.2, 10, 1, 3, false}}) {
        const std::string asked = nlohmann::json{{"eumelanin", 0},
                                                 {"azimuthalRoughness", c.roughness},
                                                 {"indexOfRefraction", c.ior},
                                                 {"causticWidthDegrees", c.width},
                                                 {"causticFade", c.fade},
                                                 {"causticIntensity", c.strength},
                                                 {"azimuthalSolver", c.cubic ? "cubic" : "exact"}}
                                      .dump();
        const auto report = shown("marschner-n", material(asked.substr(1, asked.size() - 2)));
        const auto& p = report["parameters"];
        EXPECT_NEAR(p["caustic_width_deg"], c.width > 0 ? c.width : 0.2 / kRadians, 1e-5);
        EXPECT_NEAR(p["caustic_fade"], c.fade, 1e-6);
        EXPECT_NEAR(p["caustic_intensity"], c.strength, 1e-6);
        EXPECT_EQ(p["cubic"], c.cubic ? 1 : 0);
        // Fibres are smooth below 2°.
        const double width = p["azimuthal_width_deg"];
        EXPECT_EQ(width > 2, c.roughness > 0.1) << asked;
        const double blur = width > 2 ? width * kRadians : 0;
        ClearFibre fibre{p["index_of_refraction"],
                         blur,
                         p["caustic_width_deg"].get<double>() * kRadians,
                         c.fade,
                         c.strength,
                         c.cubic};
        std::vector<double> places;
        for (int phi = 1; phi <= 179; phi += 2) places.push_back(phi);
        const std::vector<double> expected = fibre.n(places);
        const Curve trt = curve(report, "TRT red");
        const double peak = *std::ranges::max_element(expected);
        for (std::size_t i = 0; i < places.size(); ++i)
            EXPECT_NEAR(trt.at(places[i]), expected[i], 0.015 * peak) << asked << " at " << places[i];
    }
}

/// Straight through, dφ/dγ of the cubic is its linear term, which is not that of glass.
TEST_F(ShowJob, TheCubicTurnsLightOtherwiseThanGlass) {
    const auto straight = [&](const char* solver) {
        const auto report = shown("marschner-n", material(R"("azimuthalRoughness": 0.01, "eumelanin": 0,
            "azimuthalSolver": ")" + std::string(solver) + "\""));
        return curve(report, "TT red").at(180);
    };
    const double wall = 1 - fresnelOfGlass(1.55, 0);
    EXPECT_NEAR(straight("exact"), 0.5 / (2 - 2 / 1.55) * wall * wall, 2e-4);
    EXPECT_NEAR(straight("cubic"), 0.5 / (2 - 6 * std::asin(1 / 1.55) / kPi) * wall * wall, 2e-4);
}

TEST_F(ShowJob, AViewMaySayCausticsToo) {
    std::ofstream(folder / "view.json") << R"({"hair": {"caustic_width_deg": 7, "caustic_fade": 0.1,
        "caustic_intensity": 3, "azimuthal_solver": "cubic"}})";
    const auto seen = shown("marschner-n", "--view view.json")["parameters"];
    const auto authored = shown("marschner-n", material(R"("causticWidthDegrees": 7, "causticFade": 0.1,
        "causticIntensity": 3, "azimuthalSolver": "cubic")"))["parameters"];
    for (const char* const name : {"caustic_width_deg", "caustic_fade", "caustic_intensity", "cubic"})
        EXPECT_NEAR(seen[name], authored[name], 1e-5) << name;
    for (const char* const wrong : {R"("caustic_width_deg": 61)", R"("caustic_fade": -1)",
                                    R"("caustic_intensity": 11)", R"("azimuthal_solver": "quartic")"}) {
        std::ofstream(folder / "view.json") << R"({"hair": {)" << wrong << "}}";
        const Outcome outcome = run("render --show marschner-n --view view.json -o a.png");
        EXPECT_EQ(outcome.exitCode, 1) << wrong;
        EXPECT_THAT(outcome.errors, HasSubstr("view.json")) << wrong;
    }
}

}  // namespace
}  // namespace hairloom::test
