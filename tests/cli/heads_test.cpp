// SPDX-License-Identifier: GPL-3.0-or-later
// Heads of other units and axes, hair of other programs on them, and projects that find their head again.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

using testing::HasSubstr;

/// A head that is wider than deep and higher than wide, with a nose along +Z, as an OBJ: in other units, with
/// Z up, or turned about the vertical by quarters.
void writeHead(const std::filesystem::path& file, double scale = 1, bool zUp = false, int quarters = 0) {
    std::ofstream out(file);
    constexpr int kRings = 24, kSides = 32;
    const auto put = [&](double x, double y, double z) {
        for (int q = 0; q < quarters; ++q) std::swap(x, z), z = -z;
        if (zUp)
            out << "v " << scale * x << ' ' << -scale * z << ' ' << scale * y << '\n';
        else
            out << "v " << scale * x << ' ' << scale * y << ' ' << scale * z << '\n';
    };
    out.precision(9);
    for (int r = 0; r <= kRings; ++r) {
        const double polar = M_PI * r / kRings, high = std::cos(polar);
        for (int s = 0; s < kSides; ++s) {
            const double turn = 2 * M_PI * s / kSides, side = std::sin(polar);
            const double nose = std::max(0.0, std::sin(turn) - 0.9) * std::max(0.0, 1 - 4 * high * high);
            put(0.075 * side * std::cos(turn), 1.7 + 0.13 * high, 0.095 * side * std::sin(turn) + 0.3 * nose);
        }
    }
    for (int r = 0; r < kRings; ++r) {
        for (int s = 0; s < kSides; ++s) {
            const int a = r * kSides + s + 1, b = r * kSides + (s + 1) % kSides + 1;
            out << "f " << a << ' ' << b << ' ' << b + kSides << ' ' << a + kSides << '\n';
        }
    }
}

class HeadsTest : public CommandLineTest {
  protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        writeHead(folder / "head.obj");
        runJson(
            "create --mesh head.obj --scalp above:0.6 --count 150 --length 0.1 --points 8 --seed 3 -o "
            "h.hairloom");
    }
    double farthest(const nlohmann::json& report) const { return report["max_root_error_mm"].get<double>(); }
};

TEST_F(HeadsTest, UnitAndAxisAreFoundForEveryJobThatTakesAHead) {
    writeHead(folder / "cm.obj", 100);
    writeHead(folder / "z.obj", 1, true);
    writeHead(folder / "mm_z.obj", 1000, true);
    for (const auto& [file, unit, up] : {std::tuple("cm.obj", 0.01, "y"), std::tuple("z.obj", 0.0, "z"),
                                         std::tuple("mm_z.obj", 0.001, "z")}) {
        const auto made =
            runJson(std::string("create --mesh ") + file + " --scalp above:0.6 --count 20 -o a.hairloom");
        EXPECT_EQ(made["head"]["up"], up) << file;
        if (unit > 0) {
            EXPECT_NEAR(made["head"]["metres_per_unit"].get<double>(), unit, 1e-6) << file;
        }
        EXPECT_FALSE(made["head"]["warnings"].empty()) << file;
        const auto moved = runJson(std::string("transfer h.hairloom --to ") + file + " -o b.hairloom");
        EXPECT_NEAR(moved["scale"].get<double>(), 1, 0.02) << file;
        EXPECT_LT(farthest(moved), 1) << file;
        runJson("export h.hairloom --format obj-lines -o strands.obj");
        const auto bound = runJson(std::string("import strands.obj --mesh ") + file + " -o c.hairloom");
        EXPECT_LT(bound["root_distance"]["max_mm"].get<double>(), 1) << file;
    }
    const Outcome asItIs =
        run("create --mesh z.obj --up y --scalp above:0.6 --count 20 -o a.hairloom --json");
    ASSERT_EQ(asItIs.exitCode, 0);
    EXPECT_EQ(asItIs.json()["head"]["up"], "y");
}

TEST_F(HeadsTest, AHeadThatLooksAwayIsTurnedAndOneOfNoSizeRefused) {
    for (const int quarters : {1, 2, 3}) {
        writeHead(folder / "away.obj", 1, false, quarters);
        const Outcome moved = run("transfer h.hairloom --to away.obj -o b.hairloom --json");
        ASSERT_EQ(moved.exitCode, 0) << moved.errors;
        EXPECT_EQ(moved.json()["head"]["turn"].get<double>(), 360 - 90 * quarters);
        EXPECT_THAT(moved.errors, HasSubstr("--turn 0"));
        EXPECT_LT(farthest(moved.json()), 1);
        const auto kept = runJson("transfer h.hairloom --to away.obj --turn 0 -o b.hairloom");
        EXPECT_EQ(kept["head"]["turn"].get<double>(), 0);
    }
    writeHead(folder / "same.obj", 1.1);
    EXPECT_EQ(runJson("transfer h.hairloom --to same.obj -o b.hairloom")["head"]["turn"].get<double>(), 0);
    writeHead(folder / "cm.obj", 100);
    const Outcome wig = run("transfer h.hairloom --to cm.obj --unit m -o wig.hairloom");
    EXPECT_EQ(wig.exitCode, 1);
    EXPECT_THAT(wig.errors, HasSubstr("differ by no more than five times"));
    EXPECT_FALSE(std::filesystem::exists(folder / "wig.hairloom"));
}

TEST_F(HeadsTest, AUnitThatSizeAloneDoesNotTellIsFoundByTheOldHead) {
    // 2.6 m: a tall human's size, and a head's in decimetres.
    for (const bool zUp : {false, true}) {
        writeHead(folder / "dm.obj", 10, zUp);
        const Outcome moved = run("transfer h.hairloom --to dm.obj -o b.hairloom --json");
        ASSERT_EQ(moved.exitCode, 0) << moved.errors;
        EXPECT_NEAR(moved.json()["head"]["metres_per_unit"].get<double>(), 0.1, 1e-6) << moved.errors;
        EXPECT_EQ(moved.json()["head"]["up"], zUp ? "z" : "y");
        EXPECT_NEAR(moved.json()["scale"].get<double>(), 1, 0.02);
        EXPECT_LT(farthest(moved.json()), 1);
        EXPECT_THAT(moved.errors, HasSubstr("dm were taken"));
    }
    // In no unit of a head's size: taken, with a word.
    writeHead(folder / "feet.obj", 1 / 0.3048);
    const Outcome large = run("transfer h.hairloom --to feet.obj -o b.hairloom --json");
    ASSERT_EQ(large.exitCode, 0) << large.errors;
    EXPECT_THAT(large.errors, HasSubstr(" times as large as the head that the hair grows on"));
    EXPECT_NEAR(large.json()["scale"].get<double>(), 3.28, 0.2);
    const Outcome asked = run("transfer h.hairloom --to dm.obj --unit m -o b.hairloom --json");
    EXPECT_EQ(asked.exitCode, 1) << "ten times as large";
}

TEST_F(HeadsTest, HairOfAnotherAxisIsToldItsOwn) {
    runJson("export h.hairloom --format obj-lines --up z --output-unit inch -o strands.obj");
    const Outcome far = run("import strands.obj --mesh head.obj -o a.hairloom");
    EXPECT_EQ(far.exitCode, 1);
    EXPECT_THAT(far.errors, HasSubstr("the unit inch and Z up (--unit inch --up z)"));
    const auto near = runJson("import strands.obj --mesh head.obj --unit inch --up z -o a.hairloom");
    EXPECT_LT(near["root_distance"]["max_mm"].get<double>(), 1);
}

TEST_F(HeadsTest, AScalpMayLieInAFileOfItsOwn) {
    // The upper part of the head, a millimetre off it.
    std::ifstream in(folder / "head.obj");
    std::ofstream out(folder / "scalp.obj");
    std::string line;
    while (std::getline(in, line)) {
        if (line[0] == 'v') {
            out << line << '\n';
            continue;
        }
        const int first = std::stoi(line.substr(2));
        if (first <= 7 * 32) out << line << '\n';
    }
    out.close();
    const auto some = runJson("create --mesh head.obj --scalp-mesh scalp.obj --count 50 -o a.hairloom");
    const auto all = runJson("create --mesh head.obj --count 50 -o b.hairloom");
    EXPECT_LT(some["scalp_area_cm2"].get<double>(), 0.5 * all["scalp_area_cm2"].get<double>());
    const Outcome none =
        run("create --mesh head.obj --scalp-mesh head.obj --scalp above:0.99 --count 5 -o c.hairloom");
    EXPECT_EQ(none.exitCode, 0) << none.errors;
    writeHead(folder / "large.obj", 2);
    const Outcome away = run("create --mesh head.obj --scalp-mesh large.obj --count 5 -o c.hairloom");
    EXPECT_EQ(away.exitCode, 1);
    EXPECT_THAT(away.errors, HasSubstr("no face of the head lies on this scalp"));
}

TEST_F(HeadsTest, GuidesMayLieInAFileOfTheirOwn) {
    runJson(
        "create --mesh head.obj --scalp above:0.6 --count 12 --length 0.1 --points 6 --seed 9 -o g.hairloom");
    runJson("export h.hairloom --format obj-lines -o hairs.obj");
    runJson("export g.hairloom --format obj-lines -o guides.obj");
    const auto both = runJson("import hairs.obj --guides guides.obj --mesh head.obj -o both.hairloom");
    EXPECT_EQ(both["strands"].get<int>(), 162);
    EXPECT_EQ(both["guides"].get<int>(), 12);
    EXPECT_EQ(runJson("info both.hairloom")["guides"].get<int>(), 12);
}

TEST_F(HeadsTest, AProjectFindsItsHeadFromAnyFolder) {
    std::filesystem::create_directory(folder / "shot");
    runJson("create --mesh head.obj --scalp above:0.6 --count 20 -o shot/a.hairloom");
    const auto there = runJson("info shot/a.hairloom");
    EXPECT_TRUE(there["missing"].empty());
    EXPECT_EQ(std::filesystem::path(there["scalp"]["character"].get<std::string>()),
              std::filesystem::canonical(folder) / "head.obj");
    // Both move together.
    std::filesystem::create_directories(folder / "elsewhere/deep");
    std::filesystem::rename(folder / "shot", folder / "elsewhere/deep/shot");
    std::filesystem::copy_file(folder / "head.obj", folder / "elsewhere/deep/head.obj");
    std::filesystem::rename(folder / "head.obj", folder / "gone.obj");
    EXPECT_TRUE(runJson("info elsewhere/deep/shot/a.hairloom")["missing"].empty());
    // The head lies beside the project now.
    std::filesystem::rename(folder / "elsewhere/deep/head.obj", folder / "elsewhere/deep/shot/head.obj");
    EXPECT_TRUE(runJson("info elsewhere/deep/shot/a.hairloom")["missing"].empty());
    std::filesystem::remove(folder / "elsewhere/deep/shot/head.obj");
    const Outcome missing = run("info elsewhere/deep/shot/a.hairloom --json");
    ASSERT_EQ(missing.exitCode, 0);
    ASSERT_EQ(missing.json()["missing"].size(), 1u);
    EXPECT_EQ(missing.json()["missing"][0]["what"], "character");
    EXPECT_THAT(missing.errors, HasSubstr("was not found"));
    runJson("set elsewhere/deep/shot/a.hairloom --character gone.obj -o found.hairloom");
    EXPECT_TRUE(runJson("info found.hairloom")["missing"].empty());
}

}  // namespace
}  // namespace hairloom::test
