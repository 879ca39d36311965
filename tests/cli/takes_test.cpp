// SPDX-License-Identifier: GPL-3.0-or-later
// `takes`: what a simulation played, recorded, listed, exported and compared.

#include <gmock/gmock.h>

#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <thread>

#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class CliTakes : public CommandLineTest {
  protected:
    CliTakes() { runJson(createArguments()); }
    /// Standard output of another program, run in the test's folder.
    std::string shellOutput(const std::string& command) const {
        return run("--version > /dev/null; (" + command + ")").output;
    }
};

TEST_F(CliTakes, RecordsWhatSimulateRecords) {
    const auto report = runJson("takes hair.hairloom --record nod --motion nod --frames 20 --wind 2,0,0");
    EXPECT_EQ(report["takes"][0]["frames"], 20);
    EXPECT_LE(report["takes"][0]["max_error_mm"].get<double>(), 0.1);
    EXPECT_GT(report["takes"][0]["max_error_mm"].get<double>(), 0.05);
    EXPECT_LE(report["takes"][0]["bytes_per_point_and_frame"].get<double>(), 4);
    const auto list = runJson("takes hair.hairloom");
    ASSERT_EQ(list["takes"].size(), 1u);
    for (const char* key : {"name", "frames", "fps", "bytes", "max_error_mm"})
        EXPECT_EQ(list["takes"][0][key], report["takes"][0][key]) << key;
    EXPECT_EQ(list["takes"][0]["name"], "nod");
    EXPECT_EQ(list["takes"][0]["motion"], "nod");
    EXPECT_EQ(list["takes"][0]["groom_changed"], false);
    EXPECT_EQ(list["takes"][0]["bytes"], fs::file_size(folder / "hair.takes/nod.hltake"));

    // simulate measures the take from its own frames, which the exact record holds, too.
    const auto same = runJson(
        "simulate hair.hairloom --motion nod --frames 20 --wind 2,0,0 --against hair.takes/nod.hltake "
        "--record exact.frames");
    EXPECT_LE(same["error_mm_max"].get<double>(), 0.1);
    EXPECT_GT(same["error_mm_max"].get<double>(), 0);
    EXPECT_LT(fs::file_size(folder / "hair.takes/nod.hltake"), fs::file_size(folder / "exact.frames") / 3);
}

TEST_F(CliTakes, AreTheSameBytesOnAnyNumberOfThreads) {
    runJson("takes hair.hairloom --record one --motion spin --frames 12 --threads 1");
    runJson("takes hair.hairloom --record many --motion spin --frames 12 --threads 5");
    EXPECT_EQ(readText(folder / "hair.takes/one.hltake"), readText(folder / "hair.takes/many.hltake"));
    EXPECT_EQ(runJson("takes hair.hairloom --compare one many")["max_mm"], 0);
}

TEST_F(CliTakes, ExportsAsOtherFormats) {
    runJson("takes hair.hairloom --record nod --motion nod --frames 10");
    for (const char* format : {"abc", "usdc", "usda"}) {
        const auto report = runJson(std::string("takes hair.hairloom --export nod --range 2,6 --format ") +
                                    format + " -o nod." + format);
        EXPECT_EQ(report["frames"], 5) << format;
        EXPECT_LT(report["max_error_mm"].get<double>(), 0.1) << format;
        EXPECT_GT(fs::file_size(folder / (std::string("nod.") + format)), 1000u);
    }
    EXPECT_EQ(runJson("takes hair.hairloom --export nod --format frames -o nod.frames")["frames"], 10);
    EXPECT_EQ(runJson("simulate hair.hairloom --motion nod --frames 10 --against nod.frames")["error_mm_max"],
              runJson("simulate hair.hairloom --motion nod --frames 10 --against hair.takes/nod.hltake")
                  ["error_mm_max"]);
    // The jobs that read records read takes.
    runJson("export hair.hairloom --format abc --record hair.takes/nod.hltake --frames 0,9 -o all.abc");
    EXPECT_GT(fs::file_size(folder / "all.abc"), fs::file_size(folder / "nod.abc"));
}

TEST_F(CliTakes, ExportsAClipForGames) {
    runJson("takes hair.hairloom --record nod --motion nod --frames 40 --wind 3,0,0");
    const auto report =
        runJson("takes hair.hairloom --export nod --format runtime --range 4,33 --loop -o nod.hairrt");
    EXPECT_EQ(report["frames"], 30);
    const auto info = runJson("info nod.hairrt")["asset"];
    EXPECT_EQ(info["version"], "1.4");
    EXPECT_EQ(info["clip"]["name"], "nod");
    EXPECT_EQ(info["clip"]["frames"], 30);
    EXPECT_EQ(info["clip"]["fps"], 60);
    EXPECT_EQ(info["clip"]["loops"], true);
    EXPECT_LE(info["clip"]["max_error_mm"].get<double>(), 0.1);
    EXPECT_LE(info["clip"]["bytes"].get<double>() / (30 * report["points"].get<double>()), 4);
    EXPECT_THAT(run("validate nod.hairrt").output, HasSubstr("'nod' of 30 frames"));
    // Without a take there is no clip.
    runJson("export hair.hairloom --format runtime -o plain.hairrt");
    const auto plain = runJson("info plain.hairrt")["asset"];
    EXPECT_EQ(plain["version"], "1.4");
    EXPECT_TRUE(plain["clip"].is_null());
    runJson(
        "takes hair.hairloom --export nod --format runtime --range 4,33 --loop --threads 1 -o one.hairrt");
    EXPECT_EQ(readText(folder / "one.hairrt"), readText(folder / "nod.hairrt"));
}

TEST_F(CliTakes, ExportsAFilm) {
    runJson("takes hair.hairloom --record nod --motion nod --frames 6");
    runJson("takes hair.hairloom --export nod --format webp --size 64x64 -o nod.webp");
    const std::string film = readText(folder / "nod.webp");
    EXPECT_EQ(film.substr(0, 4), "RIFF");
    std::size_t images = 0;
    for (std::size_t at = film.find("ANMF"); at != std::string::npos; at = film.find("ANMF", at + 4))
        ++images;
    EXPECT_EQ(images, 3u) << "30 a second";
    EXPECT_THAT(run("takes hair.hairloom --export nod --format webp --size 16000x16000 -o big.webp").errors,
                HasSubstr("of memory"));
}

bool hasVideo() {
    return fs::exists(fs::path(HAIRLOOM_CLI).parent_path() / "hairloom-video-writer");
}

// Read by FFmpeg's own programs: what the stream says of itself, and each decoded frame against the PNG of
// the same frame.
TEST_F(CliTakes, ExportsAVideoThatOtherProgramsRead) {
    if (!hasVideo()) GTEST_SKIP() << "built without libavcodec";
    runJson("takes hair.hairloom --record nod --motion spin --frames 9");
    const auto report = runJson("takes hair.hairloom --export nod --format mp4 --size 95x64 -o nod.mp4");
    EXPECT_EQ(report["fps"], 60) << "all frames";
    EXPECT_EQ(report["pictures"], 9);
    const auto probe = shellOutput(
        "ffprobe -v error -count_frames -show_entries "
        "stream=codec_name,profile,width,height,pix_fmt,color_range,"
        "color_space,color_transfer,color_primaries,r_frame_rate,nb_read_frames,duration -of default=nw=1 "
        "nod.mp4");
    for (const char* said : {"codec_name=h264", "width=96", "height=64", "pix_fmt=yuv420p", "color_range=tv",
                             "color_space=bt709", "color_transfer=iec61966-2-1", "color_primaries=bt709",
                             "r_frame_rate=60/1", "nb_read_frames=9", "duration=0.150000"})
        EXPECT_THAT(probe, HasSubstr(said));

    runJson("render hair.hairloom --record hair.takes/nod.hltake --frames 0,8 --size 95x64 -o still.png");
    shellOutput(
        "ffmpeg -v error -i nod.mp4 -vf "
        "scale=flags=accurate_rnd+full_chroma_int:in_color_matrix=bt709:in_range=tv -pix_fmt rgba "
        "-f rawvideo video.raw 2>&1");
    shellOutput("ffmpeg -v error -i still_%04d.png -pix_fmt rgba -f rawvideo stills.raw");
    const std::string decoded = readText(folder / "video.raw"), stills = readText(folder / "stills.raw");
    constexpr std::size_t kWide = 96, kWidth = 95, kHeight = 64;
    ASSERT_EQ(decoded.size(), 9 * kWide * kHeight * 4);
    ASSERT_EQ(stills.size(), 9 * kWidth * kHeight * 4);
    for (std::size_t f = 0; f < 9; ++f) {
        double sum = 0;
        std::array<double, 3> bias{};
        for (std::size_t y = 0; y < kHeight; ++y) {
            for (std::size_t x = 0; x < kWidth; ++x) {
                for (std::size_t c = 0; c < 3; ++c) {
                    const auto is =
                        static_cast<std::uint8_t>(decoded[4 * ((f * kHeight + y) * kWide + x) + c]);
                    const auto was =
                        static_cast<std::uint8_t>(stills[4 * ((f * kHeight + y) * kWidth + x) + c]);
                    const double off = static_cast<double>(is) - static_cast<double>(was);
                    sum += off * off;
                    bias[c] += off;
                }
            }
        }
        // Chroma of hair is halved in both directions.
        EXPECT_LT(std::sqrt(sum / (3 * kWidth * kHeight)), 6) << "root mean square of 255, frame " << f;
        for (const double off : bias) EXPECT_LT(std::abs(off) / (kWidth * kHeight), 1.0) << "frame " << f;
    }

    runJson("takes hair.hairloom --export nod --format mp4 --size 95x64 -o again.mp4");
    EXPECT_EQ(readText(folder / "nod.mp4"), readText(folder / "again.mp4"));
    runJson(
        "render hair.hairloom --turntable 4 --milliseconds 40 --size 32x32 --animation turn.mp4 -o turn.png");
    EXPECT_THAT(
        shellOutput("ffprobe -v error -show_entries stream=r_frame_rate,nb_frames -of default=nw=1 turn.mp4"),
        AllOf(HasSubstr("r_frame_rate=25/1"), HasSubstr("nb_frames=4")));
}

TEST_F(CliTakes, SaysWhyThereIsNoVideo) {
    runJson("takes hair.hairloom --record nod --frames 3");
    // The same program without the one that writes videos beside it.
    fs::create_directory(folder / "alone");
    fs::copy_file(HAIRLOOM_CLI, folder / "alone/hairloom-cli");
    const auto said = shellOutput(
        "./alone/hairloom-cli takes hair.hairloom --export nod --format mp4 --size 64x64 -o nod.mp4 2>&1; "
        "echo exit $?");
    EXPECT_THAT(said, AllOf(HasSubstr("libavcodec"), HasSubstr("WebP"), HasSubstr("exit 1")));
    EXPECT_FALSE(fs::exists(folder / "nod.mp4"));
    if (!hasVideo()) return;
    EXPECT_THAT(run("takes hair.hairloom --export nod --format mp4 --size 9000x64 -o nod.mp4").errors,
                HasSubstr("8192"));
}

TEST_F(CliTakes, MeasuresTheDistanceOfTwo) {
    runJson("takes hair.hairloom --record calm --motion nod --frames 15");
    runJson("takes hair.hairloom --record windy --motion nod --frames 15 --wind 6,0,0");
    const auto report = runJson("takes hair.hairloom --compare calm windy");
    EXPECT_EQ(report["by_frame"].size(), 15u);
    EXPECT_GT(report["max_mm"].get<double>(), 1);
    EXPECT_GE(report["max_mm"].get<double>(), report["rms_mm"].get<double>());
    const auto worst = report["worst_frame"].get<std::size_t>();
    EXPECT_EQ(report["by_frame"][worst]["max_mm"], report["max_mm"]);
}

TEST_F(CliTakes, SaysWhatIsWrong) {
    runJson("takes hair.hairloom --record nod --motion nod --frames 9");
    const auto errors = [&](const std::string& arguments, int exitCode) {
        const Outcome outcome = run("takes hair.hairloom " + arguments);
        EXPECT_EQ(outcome.exitCode, exitCode) << arguments << "\n" << outcome.errors;
        return outcome.errors;
    };
    EXPECT_THAT(errors("--record a/b --frames 2", 2), HasSubstr("'a/b' cannot name a take: it has '/'"));
    EXPECT_THAT(errors("--record '' --frames 2", 2), HasSubstr("--record has no value"));
    EXPECT_THAT(errors("--record nod --frames 2", 1),
                AllOf(HasSubstr("there is a take 'nod' already"), HasSubstr("--force")));
    EXPECT_THAT(errors("--export none --format abc -o x.abc", 1), HasSubstr("expected one of: nod"));
    EXPECT_THAT(errors("--export nod --format abc", 2), HasSubstr("-o"));
    EXPECT_THAT(errors("--export nod --format mp4 -o x.webp", 2), HasSubstr("expected -o F.mp4"));
    EXPECT_THAT(errors("--export nod --format webp -o x.png", 2), HasSubstr("expected -o F.webp"));
    EXPECT_THAT(errors("--export nod --format abc --loop -o x.abc", 2), HasSubstr("--format runtime"));
    EXPECT_THAT(errors("--export nod --format abc --range 3,9 -o x.abc", 2), HasSubstr("has 9 frames"));
    EXPECT_THAT(errors("--export nod --format abc --range 5,3 -o x.abc", 2), HasSubstr("runs backwards"));
    EXPECT_THAT(errors("--delete none", 1), HasSubstr("there is no take 'none'"));
    EXPECT_THAT(errors("--frames 3", 2), HasSubstr("--record"));
    EXPECT_THAT(errors("--delete nod --compare nod nod", 2), HasSubstr("exclude each other"));
    EXPECT_THAT(errors("--rename nod ../nod", 2), HasSubstr("cannot name a take"));
    EXPECT_FALSE(fs::exists(folder / "x.abc"));
    EXPECT_EQ(runJson("takes hair.hairloom --record nod --frames 4 --force")["takes"][0]["frames"], 4);
    runJson("takes hair.hairloom --rename nod calm");
    EXPECT_EQ(runJson("takes hair.hairloom --delete calm")["takes"].size(), 0u);
    EXPECT_FALSE(fs::exists(folder / "hair.takes"));
}

TEST_F(CliTakes, TellsOfAGroomThatHasChanged) {
    runJson("takes hair.hairloom --record nod --frames 9");
    std::ofstream(folder / "trim.json")
        << R"({"hairloom_script": 1, "operations": [{"op": "curl", "radius": 0.01, "frequency": 9}]})";
    runJson("groom hair.hairloom --script trim.json -o hair.hairloom");
    EXPECT_EQ(runJson("takes hair.hairloom")["takes"][0]["groom_changed"], true);
    EXPECT_THAT(run("takes hair.hairloom --export nod --format abc -o nod.abc").errors,
                HasSubstr("before the groom or its head changed shape"));
    runJson(createArguments("--force", 7, 9));
    const Outcome other = run("takes hair.hairloom --export nod --format abc -o other.abc");
    EXPECT_EQ(other.exitCode, 1);
    EXPECT_THAT(other.errors, HasSubstr("this groom has 2700, "));
}

#ifndef _WIN32
TEST_F(CliTakes, AreRecoveredAfterAKill) {
    for (const char* signal : {"KILL", "TERM"}) {
        // Behind the first command the shell is in the folder, and $! is the program itself.
        run(std::string(
                "--version > /dev/null; '" HAIRLOOM_CLI
                "' takes hair.hairloom --record long --motion nod --frames 20000 & pid=$!; "
                "for i in $(seq 600); do sleep 0.05; "
                "[ -n \"$(find hair.takes -name '.*part' -size +40k 2> /dev/null)\" ] && break; done; "
                "kill -") +
            signal + " $pid; wait $pid");
        const auto list = runJson("takes hair.hairloom");
        ASSERT_EQ(list["recovered"].size(), 1u) << signal;
        EXPECT_EQ(list["recovered"][0], "long");
        EXPECT_GE(list["takes"][0]["frames"].get<int>(), 8);
        EXPECT_EQ(list["takes"][0]["frames"].get<int>() % 8, 0);
        EXPECT_EQ(list["takes"][0]["finished"], false);
        const auto same =
            runJson("simulate hair.hairloom --motion nod --frames 8 --against hair.takes/long.hltake");
        EXPECT_LE(same["error_mm_max"].get<double>(), 0.1);
        runJson("takes hair.hairloom --delete long");
    }
}

TEST_F(CliTakes, ADiskThatFillsLeavesWhatWasWhole) {
    const Outcome full = run("--version > /dev/null; ulimit -f 100; '" HAIRLOOM_CLI
                             "' takes hair.hairloom --record long --motion spin --frames 2000");
    EXPECT_EQ(full.exitCode, 1);
    EXPECT_THAT(full.errors, HasSubstr("cannot be written"));
    const auto list = runJson("takes hair.hairloom");
    ASSERT_EQ(list["recovered"].size(), 1u);
    EXPECT_GE(list["takes"][0]["frames"].get<int>(), 8);
}
#endif

}  // namespace
}  // namespace hairloom::test
