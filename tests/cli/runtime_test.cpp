// SPDX-License-Identifier: GPL-3.0-or-later
// Assets for games, by the command line.

#include <gmock/gmock.h>

#include <fstream>

#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class RuntimeAssetJobs : public CommandLineTest {};

TEST_F(RuntimeAssetJobs, AnAssetIsWrittenDescribedValidatedAndSimulated) {
    runJson("create --mesh " + bustFile() +
            " --scalp cap:60 --count 300 --placement dart --length 0.2 --points 24 -o g.hairloom");
    runJson("set g.hairloom interpolation.followPerGuide=100 simulation.windSpeed=2 -o g.hairloom");
    const auto exported = runJson("export g.hairloom --format runtime -o g.hairrt");
    EXPECT_EQ(exported["strands"], 300);
    EXPECT_LT(exported["max_error_mm"], 0.05);
    EXPECT_EQ(exported["bytes"], fs::file_size(folder / "g.hairrt"));
    EXPECT_LE(exported["bytes"], 150'000) << "300 guides with 30,000 hairs";
    for (const auto& left : exported["left_behind"]) EXPECT_THAT(left["what"], HasSubstr("attribute"));
    const auto info = runJson("info g.hairrt");
    EXPECT_EQ(info["strands"], 300);
    EXPECT_EQ(info["asset"]["follow_hairs"], 30'000);
    EXPECT_EQ(info["asset"]["version"], "1.4");
    EXPECT_GT(info["asset"]["sections"].size(), 8u);
    EXPECT_EQ(runJson("validate g.hairrt")["valid"], true);
    const auto played = runJson("simulate g.hairrt --frames 3 --motion nod");
    EXPECT_EQ(played["nan_count"], 0);
    const auto asked = run("export g.hairloom --format runtime --output-unit cm -o h.hairrt");
    EXPECT_EQ(asked.exitCode, 1);
    EXPECT_THAT(asked.errors, HasSubstr("metres, Y up"));
}

TEST_F(RuntimeAssetJobs, FindingsAreToldOnStandardErrorAndByValidate) {
    const auto said = [&](const std::string& mesh, const std::string& name) {
        runJson("create --mesh '" + mesh + "' --scalp material:scalp --count 20 --length 0.1 --points 8 -o " +
                name + ".hairloom");
        const auto exported = run("export " + name + ".hairloom --format runtime -o " + name + ".hairrt");
        EXPECT_EQ(exported.exitCode, 0);
        return exported.errors + runJson("validate " + name + ".hairrt")["findings"].dump();
    };
    std::string plain = bustFile();
    plain.replace(plain.rfind('.'), std::string::npos, ".obj");
    const std::string bare = said(plain, "bare");
    const auto first = bare.find("the asset has no bones");
    ASSERT_NE(first, std::string::npos) << bare;
    EXPECT_NE(bare.find("the asset has no bones", first + 1), std::string::npos) << bare;
    EXPECT_EQ(said(bustFile(), "boned").find("no bones"), std::string::npos);
}

TEST_F(RuntimeAssetJobs, ADamagedAssetIsRefusedWithItsPlace) {
    runJson("create --mesh " + bustFile() +
            " --scalp cap:40 --count 20 --length 0.1 --points 8 -o g.hairloom");
    runJson("export g.hairloom --format runtime -o g.hairrt");
    std::fstream file(folder / "g.hairrt", std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(900);
    file.write("damage", 6);
    file.close();
    const auto refused = run("validate g.hairrt");
    EXPECT_EQ(refused.exitCode, 1);
    EXPECT_THAT(refused.errors, HasSubstr("g.hairrt@"));
    EXPECT_THAT(refused.errors, HasSubstr("checksum"));
}

}  // namespace
}  // namespace hairloom::test
