// SPDX-License-Identifier: GPL-3.0-or-later
// Hair on a face that talks, as the command line has it: simulated, recorded, taken, exported, on a time
// line.

#include <gmock/gmock.h>

#include <fstream>

#include "core/documents/motions.h"
#include "core/operations/stack.h"
#include "core/simulation/frame_record.h"
#include "tests/cli/command.h"
#include "tests/support/talking_skin.h"

namespace hairloom::test {
namespace {

using testing::HasSubstr;

class CliFaces : public CommandLineTest {
  protected:
    CliFaces() {
        std::ofstream(folder / "talking.glb", std::ios::binary) << talkingBust(bustFile());
        runJson(
            "create --mesh talking.glb --scalp material:face --count 150 --placement dart --length 0.02 "
            "--points 5 "
            "--seed 3 -o hair.hairloom");
        auto loaded = openProject((folder / "hair.hairloom").string());
        if (!loaded) throw std::runtime_error(loaded.error().message());
        groom = std::move(*loaded);
        auto character = loadActor((folder / "talking.glb").string(), groom);
        if (!character) throw std::runtime_error(character.error().message());
        actor = std::move(*character);
    }
    double offSkinIn(const std::string& record, std::uint64_t frame, const FaceAt& face) const {
        const auto read = readFrame(folder / record, groom, frame);
        EXPECT_TRUE(read) << read.error().message();
        return read ? offSkin(groom, *actor, read->positions_ws, face) : 1;
    }
    Groom groom;
    std::shared_ptr<const Actor> actor;
};

TEST_F(CliFaces, RootsOfRecordsAndTakesStayOnTheSkin) {
    const auto report = runJson("simulate hair.hairloom --motion clip:talk --frames 30 --record talk.frames");
    runJson("takes hair.hairloom --record talk --motion clip:talk --frames 30");
    double farthest = 0;
    for (std::uint64_t f = 0; f < 30; ++f) {
        const FaceAt now = talkAt(static_cast<double>(f + 1) / 60);
        EXPECT_LT(offSkinIn("talk.frames", f, now), 2e-5) << f;
        EXPECT_LT(offSkinIn("hair.takes/talk.hltake", f, now), 1e-4) << f;
        farthest = std::max(farthest, offSkinIn("talk.frames", f, {0, 0, now.radians}));
    }
    EXPECT_GT(farthest, 0.008);
    EXPECT_GT(report["morph_targets"]["farthest_mm"], 8);
    EXPECT_TRUE(report["morph_targets"]["collider"].is_null());
    EXPECT_TRUE(
        runJson("simulate hair.hairloom --motion clip:nod_and_turn --frames 2")["morph_targets"].is_null());
    EXPECT_EQ(runJson("simulate hair.hairloom --motion clip:talk --frames 30 --threads 1")["state_hash"],
              runJson("simulate hair.hairloom --motion clip:talk --frames 30 --threads 3")["state_hash"]);
}

TEST_F(CliFaces, TakesExportTheFaceAsTheyPlayIt) {
    runJson("takes hair.hairloom --record talk --motion clip:talk --frames 20");
    for (const char* format : {"abc", "usdc", "runtime"}) {
        const auto report = runJson(std::string("takes hair.hairloom --export talk --format ") + format +
                                    " -o talk." + (std::string(format) == "runtime" ? "hairrt" : format));
        EXPECT_EQ(report["frames"], 20) << format;
        EXPECT_LE(report["max_error_mm"].get<double>(), 0.1) << format;
    }
    runJson("takes hair.hairloom --export talk --format frames -o talk.frames");
    EXPECT_LT(offSkinIn("talk.frames", 14, talkAt(0.25)), 1e-4);
}

TEST_F(CliFaces, ATimeLineBlendsWeightsOfClips) {
    std::ofstream(folder / "line.json") << R"({"time_line": {"end": 1, "clips": [{"name": "talk"},
        {"name": "frown", "start": 0.3, "blend": 0.2}]}})";
    runJson("timeline hair.hairloom --from line.json -o line.hairloom");
    runJson("simulate line.hairloom --motion timeline --frames 36 --record line.frames");
    for (const std::uint64_t f : {5u, 20u, 23u, 26u, 35u}) {
        const double time = static_cast<double>(f + 1) / 60, since = time - 0.3;
        const double t = std::clamp(since / 0.2, 0.0, 1.0);
        const FaceAt now =
            since < 0 ? talkAt(time) : between(talkAt(time), frownAt(since), t * t * (3 - 2 * t));
        EXPECT_LT(offSkinIn("line.frames", f, now), 2e-5) << f;
    }
}

TEST_F(CliFaces, TheReportSaysThatTheSkinColliderFollowsBones) {
    runJson("colliders hair.hairloom --fit field -o skin.hairloom");
    const auto report = runJson("simulate skin.hairloom --motion clip:talk --frames 20");
    EXPECT_EQ(report["morph_targets"]["collider"], "bones");
    const double out = report["morph_targets"]["out_mm"];
    EXPECT_GT(out, 0.5);
    EXPECT_LT(out, report["morph_targets"]["farthest_mm"]);
    EXPECT_THAT(report["notes"].dump(), HasSubstr("the skin collider follows bones alone"));
    EXPECT_EQ(report["nan_count"], 0);
    EXPECT_EQ(runJson("simulate skin.hairloom --motion clip:nod_and_turn --frames 5").count("notes"), 0u);
}

}  // namespace
}  // namespace hairloom::test
