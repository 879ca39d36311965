// SPDX-License-Identifier: GPL-3.0-or-later
// Loops, and takes that are made of takes.

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

/// Points of all frames of a record, as docs/formats/frames.md describes it; metres.
class Recorded {
  public:
    explicit Recorded(const fs::path& path) : bytes_(readText(path)) {
        frames = at<std::uint64_t>(16);
        points = at<std::uint64_t>(24);
        const bool hasBody = at<std::uint32_t>(8) > 1;
        start_ = hasBody ? 56 : 48;
        const auto bones = hasBody ? at<std::uint64_t>(48) : 0;
        perFrame_ = 8 + 12 * (points + at<std::uint64_t>(32) + at<std::uint64_t>(40) + 4 * bones);
    }
    /// Coordinates of the points, three each.
    std::vector<float> frame(std::uint64_t number) const {
        std::vector<float> values(3 * points);
        std::memcpy(values.data(), bytes_.data() + start_ + number * perFrame_ + 8, 4 * values.size());
        return values;
    }
    std::uint64_t frames = 0, points = 0;

  private:
    template <class T>
    T at(std::size_t offset) const {
        T value;
        std::memcpy(&value, bytes_.data() + offset, sizeof(T));
        return value;
    }
    std::string bytes_;
    std::uint64_t start_ = 0, perFrame_ = 0;
};

/// Millimetres, of a point: |a − b − (c − d)|, without c and d |a − b|.
double largest(const std::vector<float>& a, const std::vector<float>& b, const std::vector<float>& c = {},
               const std::vector<float>& d = {}) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); i += 3) {
        double squares = 0;
        for (std::size_t k = i; k < i + 3; ++k) {
            const double off = double{a[k]} - double{b[k]} - (c.empty() ? 0 : double{c[k]} - double{d[k]});
            squares += off * off;
        }
        most = std::max(most, std::sqrt(squares));
    }
    return 1e3 * most;
}

class CliLoops : public CommandLineTest {
  protected:
    CliLoops() { runJson(createArguments()); }
};

// The simulation that continues without a loop says what leads into the first frame.
TEST_F(CliLoops, EndWhereTheSimulationCameFrom) {
    constexpr std::uint64_t kFrames = 48, kBlend = 10;  // a nod of 1.25 Hz
    const auto report = runJson(
        "simulate hair.hairloom --motion nod --frames 48 --loop --loop-blend 10 --loop-repeats 3 --record "
        "loop.frames");
    const auto& loop = report["loop"];
    EXPECT_EQ(loop["frames"], kFrames);
    EXPECT_EQ(loop["blend"], kBlend);
    EXPECT_EQ(loop["closed"], true);
    EXPECT_EQ(report["frames"], kFrames);
    const auto repeats = loop["repeats"].get<std::uint64_t>();
    ASSERT_GE(repeats, 2u);
    ASSERT_LE(repeats, 3u);
    runJson("simulate hair.hairloom --motion nod --frames " + std::to_string((repeats + 1) * kFrames) +
            " --record long.frames");
    const Recorded closed(folder / "loop.frames"), on(folder / "long.frames");
    ASSERT_EQ(closed.frames, kFrames);
    const std::uint64_t first = repeats * kFrames;
    for (std::uint64_t f = 0; f < kFrames - kBlend; ++f)
        ASSERT_EQ(closed.frame(f), on.frame(first + f)) << "as simulated, frame " << f;

    const auto seamOf = [&](const Recorded& record, std::uint64_t begin) {
        const auto last = record.frame(begin + kFrames - 1), before = record.frame(begin + kFrames - 2);
        const auto earlier = on.frame(first - 1), twoEarlier = on.frame(first - 2);
        const double mm = largest(last, earlier);
        return std::pair(mm, 60 * std::max(mm, largest(last, before, earlier, twoEarlier)));
    };
    const auto [before, beforeSpeed] = seamOf(on, first);
    EXPECT_NEAR(loop["seam_before_blend_mm"].get<double>(), before, 1e-3);
    EXPECT_NEAR(loop["seam_before_blend_mm_s"].get<double>(), beforeSpeed, 0.06);
    const auto [after, afterSpeed] = seamOf(closed, 0);
    EXPECT_EQ(loop["seam_mm"].get<double>(), after);
    EXPECT_NEAR(loop["seam_mm_s"].get<double>(), afterSpeed, 0.06);
    EXPECT_LE(after, 0.5);
    EXPECT_LE(afterSpeed, 20);
    EXPECT_LE(loop["head_mm"].get<double>(), 0.5);
    // A step across the seam is one as the simulation makes.
    EXPECT_LE(largest(closed.frame(0), closed.frame(kFrames - 1), on.frame(first), on.frame(first - 1)), 0.5);
}

TEST_F(CliLoops, RepeatsSettleHairWithoutABlend) {
    const auto report = runJson("simulate hair.hairloom --motion nod --frames 48 --loop --loop-blend 0");
    EXPECT_EQ(report["loop"]["seam_mm"], report["loop"]["seam_before_blend_mm"]);
    EXPECT_EQ(report["loop"]["blend_mm_s"], 0);
    EXPECT_EQ(report["loop"]["closed"], true) << report["loop"];
    EXPECT_LT(report["loop"]["repeats"], 12);
}

TEST_F(CliLoops, ATakeThatLoopsIsAClipThatDoes) {
    const auto report = runJson("takes hair.hairloom --record nod --motion nod --frames 48 --loop");
    EXPECT_EQ(report["loop"]["closed"], true);
    EXPECT_EQ(report["takes"][0]["loops"], true);
    EXPECT_EQ(report["takes"][0]["frames"], 48);
    runJson("takes hair.hairloom --export nod --format runtime -o nod.hairrt");
    EXPECT_EQ(runJson("info nod.hairrt")["asset"]["clip"]["loops"], true);
    runJson("takes hair.hairloom --export nod --range 0,40 --format runtime -o part.hairrt");
    EXPECT_EQ(runJson("info part.hairrt")["asset"]["clip"]["loops"], false) << "a part of it is none";
}

TEST_F(CliLoops, AnyTakeIsClosedByABlend) {
    runJson("takes hair.hairloom --record long --motion nod --frames 120");
    const auto report = runJson("takes hair.hairloom --close long --range 60,107 --loop-blend 12 --to loop");
    const auto& loop = report["loop"];
    EXPECT_EQ(loop["first"], 60);
    EXPECT_EQ(loop["last"], 107);
    EXPECT_EQ(loop["closed"], true) << loop;
    EXPECT_EQ(report["takes"][0]["name"], "loop");
    EXPECT_EQ(report["takes"][0]["loops"], true);
    runJson("takes hair.hairloom --export long --format frames -o long.frames");
    runJson("takes hair.hairloom --export loop --format frames -o loop.frames");
    const Recorded all(folder / "long.frames"), closed(folder / "loop.frames");
    ASSERT_EQ(closed.frames, 48u);
    for (std::uint64_t f = 0; f < 36; ++f) ASSERT_EQ(closed.frame(f), all.frame(60 + f)) << f;
    // The grid of takes is 0.1 mm.
    EXPECT_LE(largest(closed.frame(47), all.frame(59)), 0.1);
    EXPECT_NEAR(loop["seam_before_blend_mm"].get<double>(), largest(all.frame(107), all.frame(59)), 1e-3);

    // Two frames bridge nothing of that size.
    const Outcome open =
        run("takes hair.hairloom --close long --range 60,107 --loop-blend 2 --to open --json");
    EXPECT_EQ(open.json()["loop"]["closed"], false);
    EXPECT_THAT(open.errors, HasSubstr("the loop is not closed"));
    runJson("takes hair.hairloom --delete open");

    const auto errors = [&](const std::string& arguments, int exitCode) {
        const Outcome outcome = run("takes hair.hairloom " + arguments);
        EXPECT_EQ(outcome.exitCode, exitCode) << arguments << "\n" << outcome.errors;
        return outcome.errors;
    };
    EXPECT_THAT(errors("--close long --range 60,100 --to x", 1), HasSubstr("repeats every 41 frames"));
    EXPECT_THAT(errors("--close long --range 5,52 --to x", 1), HasSubstr("frame 5 has 5 frames before it"));
    EXPECT_THAT(errors("--close long --range 60,65 --to x", 1), HasSubstr("no longer blend"));
    EXPECT_THAT(errors("--close long --to x", 1), HasSubstr("the take is of the motion 'nod'"));
    EXPECT_THAT(errors("--close long --range 60,107", 2), HasSubstr("--to is missing"));
    EXPECT_THAT(errors("--close long --range 60,107 --to long", 1), HasSubstr("--force"));
    EXPECT_THAT(errors("--to x", 2), HasSubstr("--close"));
    EXPECT_THAT(errors("--record x --motion nod --frames 40 --loop", 1),
                HasSubstr("does not repeat every 40 frames"));
    EXPECT_THAT(errors("--record x --motion nod --frames 48 --loop-blend 5", 2), HasSubstr("--loop"));
    EXPECT_THAT(run("simulate hair.hairloom --frames 8 --loop").errors, HasSubstr("--loop-blend 12"));
    EXPECT_EQ(runJson("takes hair.hairloom")["takes"].size(), 2u);
}

TEST_F(CliLoops, ATimeLineClosesItsLastRepeat) {
    std::ofstream(folder / "line.json")
        << R"({"time_line": {"framesPerSecond": 60, "start": 0, "end": 0.5, "loop": false,
        "head": [{"t": 0, "degrees": 0, "axis": [0, 1, 0], "interpolate": "smooth"},
                 {"t": 0.25, "degrees": 25, "axis": [0, 1, 0], "interpolate": "smooth"},
                 {"t": 0.5, "degrees": 0, "axis": [0, 1, 0], "interpolate": "smooth"}]}})";
    runJson("timeline hair.hairloom --from line.json -o hair.hairloom --force");
    const auto report = runJson("takes hair.hairloom --record turn --motion timeline --loop");
    EXPECT_EQ(report["loop"]["frames"], 30) << "as its range says, and repeated whatever it says";
    EXPECT_EQ(report["loop"]["closed"], true) << report["loop"];
    EXPECT_EQ(runJson("timeline hair.hairloom")["time_line"]["loop"], false);
}

TEST_F(CliLoops, AreTheSameBytesOnAnyNumberOfThreads) {
    for (const char* threads : {"1", "5"})
        runJson(std::string("simulate hair.hairloom --motion nod --frames 48 --loop --threads ") + threads +
                " --record " + threads + ".frames");
    EXPECT_EQ(readText(folder / "1.frames"), readText(folder / "5.frames"));
}

// The take itself says what comes behind the frame, as long as nothing has changed.
TEST_F(CliLoops, ATakeIsSimulatedAnewFromAFrame) {
    runJson("takes hair.hairloom --record nod --motion nod --frames 60");
    const auto same = runJson("takes hair.hairloom --resimulate nod --at 29 --to same");
    EXPECT_EQ(same["kept"], 30);
    EXPECT_EQ(same["simulated"], 30);
    EXPECT_LE(same["head_mm"].get<double>(), 0.1);
    EXPECT_EQ(same["takes"][0]["frames"], 60);
    EXPECT_EQ(same["takes"][0]["motion"], "nod");
    const auto apart = runJson("takes hair.hairloom --compare nod same")["by_frame"];
    double largestSwing = 0;
    runJson("takes hair.hairloom --export nod --format frames -o nod.frames");
    const Recorded nod(folder / "nod.frames");
    for (std::uint64_t f = 30; f < 60; ++f)
        largestSwing = std::max(largestSwing, largest(nod.frame(f), nod.frame(29)));
    for (std::size_t f = 0; f < 60; ++f) {
        if (f < 30) {
            EXPECT_EQ(apart[f]["max_mm"], 0) << f;
        }
        EXPECT_LE(apart[f]["rms_mm"].get<double>(), 0.01 * largestSwing) << f;
    }

    // Wind is felt from the next frame on, and not before.
    runJson("set hair.hairloom simulation.windSpeed=8 -o hair.hairloom --force");
    runJson("takes hair.hairloom --resimulate nod --at 29 --frames 10 --to windy");
    const auto windy = runJson("takes hair.hairloom --compare nod windy");
    EXPECT_EQ(windy["frames"], 40);
    EXPECT_EQ(windy["by_frame"][29]["max_mm"], 0);
    EXPECT_GT(windy["by_frame"][39]["max_mm"].get<double>(), 5);

    const auto errors = [&](const std::string& arguments, int exitCode) {
        const Outcome outcome = run("takes hair.hairloom " + arguments);
        EXPECT_EQ(outcome.exitCode, exitCode) << arguments << "\n" << outcome.errors;
        return outcome.errors;
    };
    EXPECT_THAT(errors("--resimulate nod --at 60 --to x", 1), HasSubstr("has 60 frames"));
    EXPECT_THAT(errors("--resimulate nod --at 59 --to x", 1), HasSubstr("is the last one"));
    EXPECT_THAT(errors("--resimulate nod --to x", 2), HasSubstr("--at is missing"));
    EXPECT_THAT(errors("--resimulate nod --at 3", 2), HasSubstr("--to is missing"));
    EXPECT_THAT(errors("--at 3", 2), HasSubstr("--resimulate or --shape"));
    EXPECT_EQ(runJson("takes hair.hairloom")["takes"].size(), 3u);
}

TEST_F(CliLoops, AFrameOfATakeBecomesTheShape) {
    runJson("takes hair.hairloom --record nod --motion nod --frames 20 --wind 5,0,0");
    const auto report = runJson("takes hair.hairloom --shape nod --at 19 -o shaped.hairloom");
    EXPECT_EQ(report["frame"], 19);
    EXPECT_LT(report["sag"]["max_mm"].get<double>(), 1);
    runJson("simulate hair.hairloom --motion nod --frames 20 --wind 5,0,0 --take -o taken.hairloom");
    const auto changed = [&](const char* other) {
        double most = 0;
        const auto difference = runJson(std::string("info --diff shaped.hairloom ") + other);
        for (const auto& change : difference["differences"])
            if (change.contains("max_mm")) most = std::max(most, change["max_mm"].get<double>());
        return most;
    };
    EXPECT_GT(changed("hair.hairloom"), 5);
    EXPECT_LT(changed("taken.hairloom"), 1.5) << "the grid of 0.1 mm at each of eleven segments adds up";
    EXPECT_THAT(run("takes hair.hairloom --shape nod --at 20 -o x.hairloom").errors, HasSubstr("20"));
    EXPECT_EQ(run("takes hair.hairloom --shape nod -o x.hairloom").exitCode, 2);
    EXPECT_FALSE(fs::exists(folder / "x.hairloom"));
}

TEST_F(CliLoops, FollowHairsOfATakeAreExported) {
    runJson("set hair.hairloom interpolation.followPerGuide=3 -o hair.hairloom --force");
    runJson("takes hair.hairloom --record nod --motion nod --frames 8");
    const auto guides = runJson("takes hair.hairloom --export nod --format abc -o guides.abc");
    const auto hairs =
        runJson("takes hair.hairloom --export nod --range 2,7 --format abc --what hairs -o h.abc");
    EXPECT_EQ(hairs["strands"].get<int>(), 3 * guides["strands"].get<int>());
    EXPECT_EQ(hairs["frames"], 6);
    // The job for all options writes the same hairs; wisps widen by the speed, which it knows one frame
    // later.
    runJson(
        "export hair.hairloom --format abc --what hairs --record hair.takes/nod.hltake --frames 1,7 -o "
        "all.abc");
    EXPECT_GT(fs::file_size(folder / "all.abc"), fs::file_size(folder / "h.abc"));
    EXPECT_THAT(run("takes hair.hairloom --export nod --format runtime --what hairs -o x.hairrt").errors,
                AllOf(HasSubstr("--what hairs"), HasSubstr("animation")));
    EXPECT_THAT(run("takes hair.hairloom --export nod --format abc --what all -o x.abc").errors,
                HasSubstr("does not keep guides apart"));
}

}  // namespace
}  // namespace hairloom::test
