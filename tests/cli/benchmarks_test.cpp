// SPDX-License-Identifier: GPL-3.0-or-later
// How benchmarks measure; how long anything takes is not tested.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <thread>

#include "benchmarks/measurement.h"
#include "benchmarks/peak_memory.h"
#include "benchmarks/temporary_file.h"
#include "exporters/strands.h"

namespace hairloom::benchmarks {
namespace {

using namespace std::chrono_literals;

TEST(Benchmarks, AreNamedOnceAndSayWhatTheyMeasure) {
    std::set<std::string> names;
    for (const Benchmark& benchmark : benchmarks()) {
        EXPECT_TRUE(names.insert(benchmark.name).second) << benchmark.name;
        EXPECT_FALSE(benchmark.measures.empty()) << benchmark.name;
    }
    for (const char* name : {"sim", "interpolate", "gpu-sim", "render", "place", "io", "brush", "runtime",
                             "momentum", "spheres", "thesis", "contact"})
        EXPECT_TRUE(names.contains(name)) << name;
}

/// What they measure is not tested, only that all of it comes.
Outcome quick(const char* name) {
    Options options;
    options.quick = true;
    options.repetitions = 1;
    const auto outcome = std::ranges::find(benchmarks(), name, &Benchmark::name)->run(options);
    EXPECT_TRUE(outcome.has_value()) << name << ": " << outcome.error().message();
    return outcome.value_or(Outcome{});
}

std::set<std::string> filesOf(const Outcome& outcome) {
    std::set<std::string> names;
    for (const auto& [name, content] : outcome.files) {
        EXPECT_GT(content.size(), 200u) << name;
        names.insert(name);
    }
    return names;
}

TEST(Benchmarks, OfTheThesisWriteTheirFilesAndRows) {
    const Outcome momentum = quick("momentum"), spheres = quick("spheres"), thesis = quick("thesis");
    EXPECT_EQ(filesOf(momentum), (std::set<std::string>{"momentum.md", "momentum.svg"}));
    EXPECT_EQ(momentum.report["rows"].size(), 16u);
    EXPECT_EQ(filesOf(spheres), (std::set<std::string>{"spheres.md", "spheres.svg"}));
    EXPECT_EQ(spheres.report["rows"].size(), 10u);
    const std::set<std::string> made = filesOf(thesis);
    for (const char* name : {"thesis.md", "figure-25.png", "figure-26.png"})
        EXPECT_TRUE(made.contains(name)) << name;
    EXPECT_THAT(thesis.files.front().second, testing::HasSubstr("## Table 3 of the thesis, rods"));
    EXPECT_THAT(thesis.files.front().second, testing::HasSubstr("## Table 2"));
}

TEST(Benchmarks, OfContactWritesItsRows) {
    const Outcome contact = quick("contact");
    EXPECT_EQ(filesOf(contact), (std::set<std::string>{"contact.md"}));
    EXPECT_GT(contact.report["rows"].size(), 5u);
    for (const auto& row : contact.report["rows"])
        EXPECT_EQ(row["met"], row["value"].get<double>() <= row["mark"].get<double>()) << row["name"];
}

TEST(Benchmarks, RoundsLeaveOutWhatIsPaused) {
    Rounds rounds(0.01);
    int count = 0;
    while (rounds.next()) {
        ++count;
        rounds.pause();
        std::this_thread::sleep_for(20ms);
        rounds.resume();
        std::this_thread::sleep_for(5ms);
    }
    EXPECT_GE(count, 1);
    EXPECT_LE(count, 2);
    EXPECT_GE(rounds.milliseconds(), 5.0);
}

TEST(Benchmarks, TimingsRepeatAndStopAtTheFirstFailure) {
    Options options;
    options.repetitions = 3;
    options.quick = true;
    Timings good(options);
    good.measure("nothing", [](Rounds& rounds) -> Status {
        while (rounds.next()) std::this_thread::sleep_for(1ms);
        return {};
    });
    const auto outcome = good.outcome("all");
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->report["name"], "all");
    ASSERT_EQ(outcome->report["rows"].size(), 1u);
    const auto& row = outcome->report["rows"][0];
    EXPECT_EQ(row["n"], 3);
    EXPECT_LE(row["min"], row["median"]);
    EXPECT_LE(row["median"], row["max"]);
    EXPECT_EQ(row["unit"], "ms");

    Timings bad(options);
    bad.measure("broken", [](Rounds&) -> Status { return fail("it is broken"); });
    bad.measure("not reached", [](Rounds&) -> Status {
        ADD_FAILURE();
        return {};
    });
    EXPECT_FALSE(bad.outcome("all"));
}

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(Benchmarks, MemoryIsThatOfTheProgramAndImportTakesLittle) {
    EXPECT_FALSE(peakMemory({"/nonexistent/program"}));
    EXPECT_FALSE(peakMemory({HAIRLOOM_CLI, "import", "/nonexistent.abc", "-o", "/nonexistent.hairloom"}));
    constexpr double kProgram = 16e6;  // what it takes for itself
    constexpr std::uint32_t kStrands = 100'000, kPoints = 16;
    std::vector<std::uint32_t> offsets{0};
    std::vector<Vec3f> positions;
    for (std::uint32_t s = 0; s < kStrands; ++s) {
        for (std::uint32_t i = 0; i < kPoints; ++i)
            positions.emplace_back(1e-6f * static_cast<float>(s), 1.7f - 0.01f * static_cast<float>(i), 0.0f);
        offsets.push_back(static_cast<std::uint32_t>(positions.size()));
    }
    const Groom groom = makeGroom(std::move(offsets), std::move(positions));
    const TemporaryFile project("hairloom-memory-test.hairloom");
    for (const char* format : {"abc", "usdc", "usda", "ply", "tfx", "hair", "obj-lines"}) {
        const HairWriter& writer = strandWriter(format);
        const TemporaryFile file("hairloom-memory-test." + writer.suffix());
        ASSERT_TRUE(writer.write(groom, file.path, {})) << format;
        const auto taken =
            peakMemory({HAIRLOOM_CLI, "import", file.path.string(), "-o", project.path.string(), "--force"});
        ASSERT_TRUE(taken) << format;
        const auto size = static_cast<double>(std::filesystem::file_size(file.path));
        EXPECT_LT(static_cast<double>(*taken), 3 * size + kProgram) << format;
        EXPECT_GT(static_cast<double>(*taken), 0.5 * size) << format;
    }
}
#endif

}  // namespace
}  // namespace hairloom::benchmarks
