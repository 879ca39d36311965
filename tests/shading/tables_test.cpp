// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shading/tables.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/parallel.h"
#include "core/base/random.h"

namespace hairloom::shading {
namespace {

constexpr double kPi = std::numbers::pi;

MarschnerParameters blond() {
    MarschnerParameters parameters;
    parameters.azimuthal.absorption = Vec3d(0.1257, 0.2091, 0.411);
    parameters.azimuthal.width = 0.2125;
    parameters.azimuthal.causticWidth = 0;
    return parameters;
}

/// Root mean square of (table − model) over all of the sphere's pairs of directions, over that of the model.
double tableError(const Marschner& model, const TableSizes& sizes) {
    const MarschnerTables tables = bakeMarschner(model, sizes);
    Random random(31);
    double wrong = 0, all = 0;
    for (int i = 0; i < 1500; ++i) {
        const double sinIn = random.uniform(-0.98f, 0.98f);
        // Near the highlight, where there is anything to see.
        const double thetaOut = std::clamp(-std::asin(sinIn) + random.uniform(-0.6f, 0.6f), -1.4, 1.4);
        const double phi = random.uniform(0, static_cast<float>(kPi));
        const Vec3d expected = model(std::asin(sinIn), thetaOut, phi) * std::sqrt(1 - sinIn * sinIn);
        wrong += (lookUp(tables, sinIn, std::sin(thetaOut), std::cos(phi)) - expected).squaredNorm();
        all += expected.squaredNorm();
    }
    return std::sqrt(wrong / all);
}

TEST(Tables, AgreeWithTheModelTheBetterTheLarger) {
    const Marschner model(blond());
    const double small = tableError(model, {64, 64, 16});
    const double middle = tableError(model, {128, 128, 32});
    const double large = tableError(model, {});
    RecordProperty("error_64", std::to_string(small));
    RecordProperty("error_128", std::to_string(middle));
    RecordProperty("error_256", std::to_string(large));
    EXPECT_LT(large, 0.01);
    EXPECT_LT(large, 0.5 * middle);
    EXPECT_LT(middle, 0.6 * small);
}

TEST(Tables, TexelsAreTheModel) {
    const Marschner model(blond());
    const MarschnerTables tables = bakeMarschner(model, {33, 17, 9});
    const double sinIn = 2 * 10.0 / 32 - 1, sinOut = 2 * 25.0 / 32 - 1;
    const double in = std::asin(sinIn), out = std::asin(sinOut), d = 0.5 * (out - in);
    const float* m = tables.longitudinal.texel(10, 25);
    for (const Lobe lobe : kLobes) {
        EXPECT_NEAR(static_cast<double>(m[index(lobe)]),
                    model.longitudinal(lobe, in, out) * std::cos(in) / std::pow(std::cos(d), 2), 1e-5);
    }
    EXPECT_NEAR(static_cast<double>(m[3]), 2 * std::abs(d) / kPi, 1e-6);
    const double phi = std::acos(2 * 3.0 / 16 - 1);
    const AzimuthalProfile profile = model.azimuthal(5.0 / 8 * kPi / 2);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(static_cast<double>(tables.transmitted.texel(3, 5)[c]), profile(Lobe::TT, phi)[c], 2e-4);
        EXPECT_NEAR(static_cast<double>(tables.reflected.texel(3, 5)[c]), profile(Lobe::TRT, phi)[c], 2e-4);
    }
    EXPECT_NEAR(static_cast<double>(tables.transmitted.texel(3, 5)[3]), profile(Lobe::R, phi).x(), 2e-5);
}

TEST(Tables, AreFiniteToTheirEdges) {
    for (const double width : {0.0, 0.3}) {
        MarschnerParameters parameters = blond();
        parameters.azimuthal.width = width;
        parameters.azimuthal.axisRatio = 1.2;
        const MarschnerTables tables = bakeMarschner(Marschner(parameters), {64, 64, 32});
        for (const Table* table : {&tables.longitudinal, &tables.transmitted, &tables.reflected}) {
            for (const float value : table->rgba) {
                ASSERT_TRUE(std::isfinite(value));
                ASSERT_GE(value, 0);
                ASSERT_LT(value, 6e4f);  // what a half float holds
            }
        }
    }
}

TEST(Tables, DoNotDependOnThreads) {
    const Marschner model(blond());
    const std::size_t before = threadCount();
    setThreadCount(1);
    const MarschnerTables one = bakeMarschner(model, {64, 64, 16});
    setThreadCount(4);
    const MarschnerTables four = bakeMarschner(model, {64, 64, 16});
    setThreadCount(before);
    EXPECT_EQ(one.longitudinal.rgba, four.longitudinal.rgba);
    EXPECT_EQ(one.transmitted.rgba, four.transmitted.rgba);
    EXPECT_EQ(one.reflected.rgba, four.reflected.rgba);
}

TEST(Tables, SadeghiAgreesWithTheModel) {
    const SadeghiParameters model = sadeghiLike(Marschner(blond()));
    const SadeghiTables tables = bakeSadeghi(model);
    Random random(5);
    double wrong = 0, all = 0;
    for (int i = 0; i < 5000; ++i) {
        const double in = random.uniform(-1.3f, 1.3f);
        const double out = std::clamp(-in + random.uniform(-0.6f, 0.6f), -1.4, 1.4);
        const double phi = random.uniform(0, static_cast<float>(kPi)), glint = random.uniform();
        const Vec3d expected = evaluate(model, in, out, phi, glint) * std::cos(in);
        wrong += (lookUp(tables, model, std::sin(in), std::sin(out), std::cos(phi), glint) - expected)
                     .squaredNorm();
        all += expected.squaredNorm();
    }
    EXPECT_LT(std::sqrt(wrong / all), 0.01);
}

}  // namespace
}  // namespace hairloom::shading
