// SPDX-License-Identifier: GPL-3.0-or-later
// `render --show`: what its charts hold, against formulas of the papers that are written here anew.
#include <gmock/gmock.h>

#include <cmath>
#include <complex>
#include <fstream>
#include <numbers>
#include <set>

#include "tests/cli/show_job.h"

namespace hairloom::test {
namespace {

using testing::HasSubstr;

const std::vector<std::string> kNames{"curves",      "tables",      "kajiya-m",
                                      "marschner-m", "marschner-n", "marschner-tables",
                                      "sadeghi-m",   "sadeghi-n",   "sadeghi-tables"};

TEST_F(ShowJob, NamesWhatThereIsInHelpAndErrors) {
    const std::string help = run("render --help").output;
    const Outcome unknown = run("render --show moon -o moon.png");
    EXPECT_EQ(unknown.exitCode, 2);
    for (const std::string& name : kNames) {
        EXPECT_THAT(help, HasSubstr(name));
        EXPECT_THAT(unknown.errors, HasSubstr(name));
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "moon.png"));
}

TEST_F(ShowJob, DrawsEachAsAnImageOfTheSizeAskedFor) {
    std::set<std::string> images;
    for (const std::string& name : kNames) {
        const auto report = shown(name, "--shading " +
                                            std::string(name.starts_with("kajiya")    ? "kajiya"
                                                        : name.starts_with("sadeghi") ? "sadeghi"
                                                                                      : "marschner") +
                                            " --size 700x500");
        EXPECT_EQ(report["show"], name);
        EXPECT_EQ(sizeOf(name + ".png"), std::pair(700u, 500u)) << name;
        images.insert(readText(folder / (name + ".png")));
    }
    // `tables` are those of Marschner here.
    EXPECT_EQ(images.size(), kNames.size() - 1);
    shown("marschner-n");
    EXPECT_EQ(sizeOf("marschner-n.png"), std::pair(1280u, 860u));
    const std::string first = readText(folder / "marschner-n.png");
    shown("marschner-n", "--threads 1");
    EXPECT_EQ(readText(folder / "marschner-n.png"), first);
}

/// Smooth glass: N_R = ¼ F cos(φ/2), for a mirror turns light by 2γ and h = sin γ.
TEST_F(ShowJob, ReflectionAroundSmoothFibresIsThatOfGlass) {
    for (const double ior : {1.3, 1.55, 2.0}) {
        const auto report =
            shown("marschner-n",
                  material(R"("azimuthalRoughness": 0.01, "indexOfRefraction": )" + std::to_string(ior)));
        const Curve r = curve(report, "R");
        ASSERT_EQ(r.x.size(), 361u);
        for (int phi = -178; phi <= 178; ++phi) {
            const double half = 0.5 * std::abs(phi) * kRadians;
            const double expected =
                0.25 * fresnelOfGlass(report["parameters"]["index_of_refraction"], half) * std::cos(half);
            ASSERT_NEAR(r.at(phi), expected, 1e-5) << ior << " " << phi;
        }
    }
}

/// Light that goes straight through meets both walls and 2 radii of pigment.
TEST_F(ShowJob, LightStraightThroughIsDimmedByWallsAndPigment) {
    for (const double eumelanin : {0.0, 0.3, 1.3}) {
        const auto report = shown("marschner-n", material(R"("azimuthalRoughness": 0.01, "eumelanin": )" +
                                                          std::to_string(eumelanin)));
        const double ior = report["parameters"]["index_of_refraction"];
        const double wall = 1 - fresnelOfGlass(ior, 0);
        const char* const names[] = {"TT red", "TT green", "TT blue"};
        for (std::size_t c = 0; c < 3; ++c) {
            const double sigma = report["parameters"]["absorption_per_radius"][c];
            // φ = π + 2γ_t − 2γ_i, so dh/dφ = 1/(2/η − 2) there.
            const double density = 0.5 / (2 - 2 / ior);
            EXPECT_NEAR(curve(report, names[c]).at(180), density * wall * wall * std::exp(-2 * sigma), 2e-4)
                << eumelanin << names[c];
        }
    }
}

TEST_F(ShowJob, NoMoreLightComesOutAroundThanGoesIn) {
    for (const std::string roughness : {"0.01", "0.3", "0.9"}) {
        const auto report =
            shown("marschner-n",
                  "--inclination 20" + material(R"("eumelanin": 0, "azimuthalRoughness": )" + roughness));
        double sum = 0;
        for (const char* const name : {"R", "TT red", "TRT red"}) {
            const Curve n = curve(report, name);
            for (std::size_t i = 0; i + 1 < n.x.size(); ++i) sum += n.y[i] * kRadians;
        }
        EXPECT_LT(sum, 1.02) << roughness;
        EXPECT_GT(sum, 0.95) << roughness;
    }
}

/// All light of a lobe comes out: ∫ M cos²θ_o / cos²θ_d dθ_o is 1, less what lobes together would have
/// above 1.
TEST_F(ShowJob, EachLobeAlongTheFibreSendsOutItsLight) {
    for (const int light : {-50, 0, 30, 60}) {
        const auto report = shown("marschner-m", "--inclination " + std::to_string(light));
        for (const char* const name : {"R", "TT", "TRT"}) {
            const Curve m = curve(report, name);
            double sum = 0;
            for (std::size_t i = 0; i < m.x.size(); ++i) {
                const double ratio =
                    std::cos(m.x[i] * kRadians) / std::cos(0.5 * (m.x[i] - light) * kRadians);
                sum += m.y[i] * ratio * ratio * 0.5 * kRadians;
            }
            EXPECT_GT(sum, 0.93) << light << name;
            EXPECT_LT(sum, 1.02) << light << name;
        }
    }
}

/// Highlights stand opposite the light, moved by twice their tilt.
TEST_F(ShowJob, HighlightsMoveWithTheTiltOfTheScales) {
    const auto peak = [](const Curve& c) {
        return c.x[static_cast<std::size_t>(std::ranges::max_element(c.y) - c.y.begin())];
    };
    for (const double tilt : {0.0, 3.0, -5.0}) {
        const auto report = shown(
            "marschner-m", "--inclination 20" + material(R"("scaleTiltDegrees": )" + std::to_string(tilt)));
        EXPECT_NEAR(peak(curve(report, "R")), -20 - 2 * tilt, 2) << tilt;
    }
}

/// Eq. 52 and 53, with θ_h in place of the printed θ_d.
TEST_F(ShowJob, SadeghisLobesAreThoseOfThePaper) {
    const std::string hair =
        material(R"("shadingModel": "sadeghi", "energy": "published", "glintIntensity": 2,
        "glintWidthDegrees": 12, "glintNearDegrees": 40, "glintFarDegrees": 60, "rWidth": 1.5, "ttShiftDegrees": 4)");
    const auto g = [](double x, double width) { return std::exp(-kPi * x * x / (width * width)); };
    const auto along = shown("sadeghi-m", "--inclination 25" + hair);
    const char* const lobes[] = {"R", "TT", "TRT"};
    for (std::size_t p = 0; p < 3; ++p) {
        const Curve m = curve(along, lobes[p]);
        const double shift = along["parameters"]["shift_deg"][p], width = along["parameters"]["width_deg"][p];
        for (int view = -90; view <= 90; view += 5)
            EXPECT_NEAR(m.at(view), g(0.5 * (25 + view) - shift, width), 1e-9) << lobes[p] << view;
    }
    const auto around = shown("sadeghi-n", hair);
    const auto& p = around["parameters"];
    EXPECT_DOUBLE_EQ(p["glint_width_deg"], 12);
    EXPECT_DOUBLE_EQ(p["bounded"], 0);
    for (int phi = -180; phi <= 180; phi += 3) {
        const double turned = std::abs(phi), round = std::cos(0.5 * turned * kRadians);
        EXPECT_NEAR(curve(around, "R").at(phi), round, 1e-9);
        EXPECT_NEAR(curve(around, "TT").at(phi), g(180 - turned, p["tt_azimuthal_width_deg"]), 1e-9);
        EXPECT_NEAR(curve(around, "TRT").at(phi),
                    round + p["glint_intensity"].get<double>() * g(50 - turned, 12), 1e-9);
    }
}

/// The cone of mirrored light, Eq. 25, over its own 2 ∫ sin^(m+2).
TEST_F(ShowJob, KajiyaKaysHighlightsAreConesAcrossTheFibre) {
    const auto report =
        shown("kajiya-m", "--inclination 30" + material(R"("scaleTiltDegrees": 0, "shininess": 40)"));
    const Curve first = curve(report, "first highlight");
    const double m = report["parameters"]["exponent"][0], strength = report["parameters"]["specular"][0];
    EXPECT_DOUBLE_EQ(m, 60);
    double reflectance = 0;
    for (int i = 0; i < 20'000; ++i)
        reflectance += 2 * std::pow(std::sin((i + 0.5) * kPi / 20'000), m + 2) * kPi / 20'000;
    for (int view = -80; view <= 80; view += 4) {
        // The angle between the view and the mirrored ray is θ_o + θ_i.
        const double c = std::max(0.0, std::cos((view + 30) * kRadians));
        EXPECT_NEAR(first.at(view), strength * std::pow(c, m) * std::cos(30 * kRadians) / kPi / reflectance,
                    1e-7);
    }
}

TEST_F(ShowJob, TablesHoldWhatTheThesisSays) {
    const auto report = shown("marschner-tables", material(R"("azimuthalRoughness": 0.01)"));
    ASSERT_EQ(report["tables"].size(), 3u);
    const auto& m = report["tables"][0];
    const std::vector<double> x = m["x"], y = m["y"], difference = m["channels"]["2|θ_d|/π"];
    ASSERT_EQ(difference.size(), x.size() * y.size());
    for (std::size_t j = 1; j + 1 < y.size(); j += 7) {
        for (std::size_t i = 1; i + 1 < x.size(); i += 5)
            EXPECT_NEAR(difference[j * x.size() + i], std::abs(std::asin(y[j]) - std::asin(x[i])) / kPi,
                        1e-5);
    }
    const auto& n = report["tables"][1];
    const std::vector<double> cosines = n["x"], reflected = n["channels"]["N_R"];
    for (std::size_t i = 3; i < cosines.size(); i += 4) {
        const double half = 0.5 * std::acos(cosines[i]);
        EXPECT_NEAR(reflected[i], 0.25 * fresnelOfGlass(1.55, half) * std::cos(half), 2e-4) << cosines[i];
    }
    const auto lobes = shown("sadeghi-tables", material(R"("glintNearDegrees": 20, "glintFarDegrees": 70)"));
    const auto& table = lobes["tables"][1];
    const std::vector<double> glints = table["y"], trt = table["channels"]["N'_TRT"];
    const auto& p = lobes["parameters"];
    for (std::size_t j = 0; j < glints.size(); j += 5) {
        for (std::size_t i = 0; i < cosines.size(); i += 9) {
            const double phi = std::acos(cosines[i]) / kRadians;
            const double away = (20 + 50 * glints[j] - phi) / p["glint_width_deg"].get<double>();
            EXPECT_NEAR(trt[j * cosines.size() + i],
                        std::cos(0.5 * phi * kRadians) +
                            p["glint_intensity"].get<double>() * std::exp(-kPi * away * away),
                        1e-5);
        }
    }
}

TEST_F(ShowJob, OpacityMapsHoldTheFibresThatTheLightMeets) {
    // Each way of cutting the depth of hair counts the same fibres.
    runJson("create --mesh '" + bustFile() +
            "' --scalp material:scalp --count 400 --length 0.1 --points 6 -o hair.hairloom");
    const auto totals = [&](const std::string& what) {
        const auto report = runJson("render hair.hairloom --shadow-resolution 64 -o a.png --show " + what);
        const auto& table = report["tables"][0];
        std::vector<double> sums(table["x"].size() * table["y"].size());
        std::size_t layers = 0;
        for (const auto& [name, values] : table["channels"].items()) {
            ++layers;
            for (std::size_t i = 0; i < sums.size(); ++i) {
                EXPECT_GE(values[i], 0);
                sums[i] += values[i].get<double>();
            }
        }
        EXPECT_EQ(report["parameters"]["layers"], layers) << what;
        return std::pair(layers, sums);
    };
    const auto [three, expected] = totals("deep-opacity-map");
    EXPECT_EQ(three, 3u);
    EXPECT_EQ(expected.size(), 64u * 64u);
    EXPECT_GT(*std::ranges::max_element(expected), 0.1);
    EXPECT_EQ(std::ranges::count(expected, 0) > 100, true) << "light passes beside the hair";
    const std::string picture = readText(folder / "a.png");
    const std::pair<const char*, std::size_t> ways[] = {
        {"deep-opacity-map --shadow-layers 11 --layer-ends growing", 11},
        {"deep-opacity-map --shadow-layers 7 --layer-ends linear", 7},
        {"opacity-maps", 4},
        {"opacity-maps --shadow-slices 9", 9}};
    for (const auto& [way, layers] : ways) {
        const auto [count, sums] = totals(way);
        EXPECT_EQ(count, layers) << way;
        for (std::size_t i = 0; i < sums.size(); ++i)
            ASSERT_NEAR(sums[i], expected[i], 0.001 * static_cast<double>(layers)) << way << " " << i;
        EXPECT_NE(readText(folder / "a.png"), picture) << way;
    }
    const Outcome none = run("render --show deep-opacity-map -o b.png");
    EXPECT_EQ(none.exitCode, 1);
    EXPECT_THAT(none.errors, HasSubstr("no hair"));
    EXPECT_FALSE(std::filesystem::exists(folder / "b.png"));
}

TEST_F(ShowJob, TakesTheHairOfAGroomAMaterialAViewAndTheModelAskedFor) {
    runJson("create --mesh '" + bustFile() +
            "' --scalp material:scalp --count 20 --length 0.1 --points 4 -o hair.hairloom");
    runJson(
        "set hair.hairloom material.indexOfRefraction=1.8 material.shadingModel=sadeghi -o other.hairloom");
    const auto ior = [](const nlohmann::json& report) { return report["parameters"]["index_of_refraction"]; };
    EXPECT_EQ(runJson("render hair.hairloom --show marschner-n -o a.png"), [&] {
        auto same = runJson("render --show marschner-n -o a.png");
        return same;
    }());
    EXPECT_NEAR(ior(runJson("render other.hairloom --show marschner-n -o a.png")), 1.8, 1e-6);
    std::ofstream(folder / "view.json") << R"({"hair": {"ior": 1.4}})";
    EXPECT_NEAR(ior(runJson("render other.hairloom --view view.json --show marschner-n -o a.png")), 1.4,
                1e-6);
    EXPECT_TRUE(
        runJson("render other.hairloom --show curves -o a.png")["parameters"].contains("glint_intensity"));
    EXPECT_NEAR(ior(runJson("render other.hairloom --shading marschner --show curves -o a.png")), 1.8, 1e-6);
    EXPECT_EQ(runJson("render other.hairloom --show tables -o a.png")["tables"].size(), 2u);
    const std::string usual = readText(folder / "a.png");
    runJson("set other.hairloom material.glintFarDegrees=120 material.ttAzimuthalWidth=3 -o other.hairloom");
    runJson("render other.hairloom --show tables -o a.png");
    EXPECT_NE(readText(folder / "a.png"), usual);
}

TEST_F(ShowJob, GivesItsNumbersToProgramsAlone) {
    const Outcome outcome = run("render --show curves -o a.png");
    EXPECT_EQ(outcome.exitCode, 0);
    EXPECT_LT(outcome.output.size(), 200u) << outcome.output;
    EXPECT_GT(shown("curves").dump().size(), 10'000u);
}

TEST_F(ShowJob, SaysWhatCannotBeShown) {
    const auto says = [&](const std::string& arguments, const std::string& what) {
        const Outcome outcome = run("render -o a.png " + arguments);
        EXPECT_NE(outcome.exitCode, 0) << arguments;
        EXPECT_THAT(outcome.errors, HasSubstr(what)) << arguments;
        EXPECT_FALSE(std::filesystem::exists(folder / "a.png")) << arguments;
    };
    says("--show sadeghi-n --shading marschner",
         "sadeghi-n is of sadeghi, but the shading model is marschner");
    says("--show tables", "Kajiya-Kay looks up no tables");
    says("--show marschner-n --size 100x100", "320x240");
    says("--show marschner-n --size 16384x16384", "pixels");
    says("--show marschner-n --inclination 90", "-85");
    says("--inclination 10", "--show");
    says("--show marschner-n --motion spin", "--motion");
    says("--show marschner-n --turntable 4", "--turntable");
    says("", "groom");
    says("missing.hairloom --show marschner-n", "missing.hairloom");
}

}  // namespace
}  // namespace hairloom::test
