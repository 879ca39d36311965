// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of other simulators.
#include "core/accuracy/peers.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace hairloom {
namespace {

using testing::HasSubstr;

const std::string kHead =
    "peer,version,setting,strands,ms_per_frame,ms_lowest,ms_highest,error_rms_mm,error_max_mm,"
    "stretch_mean_percent,stretch_max_percent,cantilever_mm,converged,doubt_mm,machine,date,load\n";

TEST(Peers, ATableIsReadCellByCell) {
    const auto runs =
        parsePeers(kHead +
                       "Knot,1.2,4 substeps × 2,300,1.5,1.25,2e0,0.75,3,0.5,1.5,2.5,\"64, then 128\",0.01,"
                       "\"a \"\"quiet\"\" one, 2 threads\",2026-01-02,0.5\r\n"
                       "Knot,1.2,1 substep,300,9,9,9,nan,nan,1,1,1,64,0.01,m,2026-01-02,1\n",
                   "t.csv");
    ASSERT_TRUE(runs.has_value()) << runs.error().message();
    ASSERT_EQ(runs->size(), 2u);
    const PeerRun& run = runs->front();
    EXPECT_EQ(run.name, "Knot");
    EXPECT_EQ(run.version, "1.2");
    EXPECT_EQ(run.setting, "4 substeps × 2");
    EXPECT_EQ(run.strands, 300u);
    EXPECT_EQ(run.milliseconds, 1.5);
    EXPECT_EQ(run.lowestMs, 1.25);
    EXPECT_EQ(run.highestMs, 2);
    EXPECT_EQ(run.errorMm, 0.75);
    EXPECT_EQ(run.errorMaxMm, 3);
    EXPECT_EQ(run.stretchPercent, 0.5);
    EXPECT_EQ(run.stretchMaxPercent, 1.5);
    EXPECT_EQ(run.cantileverMm, 2.5);
    EXPECT_EQ(run.reference, "64, then 128");
    EXPECT_EQ(run.referenceUncertaintyMm, 0.01);
    EXPECT_EQ(run.machine, "a \"quiet\" one, 2 threads");
    EXPECT_EQ(run.date, "2026-01-02");
    EXPECT_EQ(run.load, 0.5);
    EXPECT_TRUE(std::isnan((*runs)[1].errorMm)) << "a run that broke";
}

TEST(Peers, OtherTablesAreRefusedWithTheirPlace) {
    const std::string row = "K,1,s,300,1,1,1,1,1,1,1,1,64,0.01,m,2026-01-02,1\n";
    const std::pair<std::string, const char*> wrong[] = {
        {"", "t.csv: has no run"},
        {kHead, "t.csv: has no run"},
        {"a,b\n" + row, "t.csv:1: is no table of simulators"},
        {kHead + row + "K,1\n", "t.csv:3: has 2 cells; expected 17"},
        {kHead + "K,1,s,300,fast" + row.substr(11), "t.csv:2: 'fast' is not a number"},
        {kHead + "K,1,s,-3" + row.substr(9), "t.csv:2: is of -3 strands"}};
    for (const auto& [csv, words] : wrong) {
        const auto runs = parsePeers(csv, "t.csv");
        ASSERT_FALSE(runs.has_value()) << csv;
        EXPECT_THAT(runs.error().message(), HasSubstr(words));
        EXPECT_FALSE(runs.error().expected.empty()) << csv;
    }
}

TEST(Peers, TheRecordedOnesHaveOursAndOthersOnTheSameHair) {
    std::set<std::string> names;
    for (const PeerRun& run : recordedPeers()) {
        names.insert(run.name);
        EXPECT_EQ(run.strands, 300u);
        EXPECT_GT(run.milliseconds, 0) << run.name << ", " << run.setting;
        EXPECT_LE(run.lowestMs, run.milliseconds);
        EXPECT_GE(run.highestMs, run.milliseconds);
        EXPECT_FALSE(run.machine.empty());
    }
    EXPECT_GE(names.size(), 3u);
    EXPECT_TRUE(names.contains("Hairloom"));
}

}  // namespace
}  // namespace hairloom
