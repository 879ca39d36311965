// SPDX-License-Identifier: GPL-3.0-or-later
// Sweeps: many runs of one job, here and as jobs of a queue.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <optional>
#include <thread>

#include "core/base/output_file.h"
#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

class Sweep : public CommandLineTest {
  protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        runJson(createArguments("", 7, 6));
    }
    void write(const std::string& name, const json& content) const {
        std::ofstream(folder / name) << content.dump(1);
    }
    /// Six storms of two settings in three parts each.
    static json storms() {
        return {{"hairloom_sweep", 1},
                {"job", "stability"},
                {"arguments",
                 {{"groom", "{groom}"}, {"output", "{out}"}, {"storms", 2}, {"first-storm", "{first}"}}},
                {"over",
                 {{{"name", "groom"}, {"values", {"hair.hairloom", "hair.hairloom"}}},
                  {{"name", "first"}, {"from", 0}, {"to", 4}, {"step", 2}}}}};
    }
    /// Two records of three frames.
    static json caches() {
        return {{"hairloom_sweep", 1},
                {"job", "simulate"},
                {"gather", true},
                {"arguments",
                 {{"groom", "hair.hairloom"},
                  {"frames", 3},
                  {"motion", "{shot.motion}"},
                  {"record", "{out}/{shot.name}.{part}.frames"}}},
                {"over",
                 {{{"name", "shot"},
                   {"values", {{{"name", "a"}, {"motion", "nod"}}, {{"name", "b"}, {"motion", "spin"}}}}}}}};
    }
    std::string errorOf(const json& sweep) const {
        write("bad.json", sweep);
        const Outcome outcome = run("sweep bad.json -o bad");
        EXPECT_EQ(outcome.exitCode, 1);
        EXPECT_FALSE(fs::exists(folder / "bad/merged.json"));
        return outcome.errors;
    }
};

TEST_F(Sweep, StormsInPartsGiveTheCertificateOfAll) {
    json one = storms();
    one["over"][0]["values"] = {"hair.hairloom"};
    write("storms.json", one);
    const json report = runJson("sweep storms.json");
    EXPECT_EQ(report["parts"], 3);
    EXPECT_EQ(report["done"], 3);
    EXPECT_EQ(report["failed"], 0);
    const json whole = runJson("stability hair.hairloom -o whole --storms 6")["certificate"];
    const json joined = json::parse(readText(folder / "storms/certificates.json"));
    ASSERT_EQ(joined.size(), 1u);
    EXPECT_EQ(joined[0]["certificate"], whole);
    EXPECT_EQ(joined[0]["values"], json({{"groom", "hair.hairloom"}}));
    EXPECT_TRUE(fs::exists(folder / "storms/report.html"));
}

TEST_F(Sweep, MergedResultsHaveTheSameBitsWhereverPartsRan) {
    write("caches.json", caches());
    runJson("sweep caches.json -o a --threads 2");
    runJson("sweep caches.json -o b --parts 1");
    runJson("--threads 1 sweep caches.json -o b --parts 0-1:1");
    runJson("sweep caches.json -o b --merge");
    for (const char* name : {"merged.json", "manifest.json", "manifest.xxh3", "table.csv",
                             "files/a.0000.frames", "files/b.0001.frames"})
        EXPECT_EQ(readText(folder / "a" / name), readText(folder / "b" / name)) << name;
    EXPECT_THAT(readText(folder / "a/table.csv"), HasSubstr("shot.motion"));
    EXPECT_NE(readText(folder / "a/files/a.0000.frames"), readText(folder / "a/files/b.0001.frames"));
}

TEST_F(Sweep, RunsOnlyWhatIsMissingOrChanged) {
    write("caches.json", caches());
    EXPECT_EQ(runJson("sweep caches.json -o out")["kept"], 0);
    const fs::path state = folder / "out/state/0000.json";
    const auto before = fs::last_write_time(state);
    EXPECT_EQ(runJson("sweep caches.json -o out")["kept"], 2);
    EXPECT_EQ(fs::last_write_time(state), before);
    // An output that is damaged, a result that is half there, another input: each is made again.
    const std::string merged = readText(folder / "out/merged.json");
    std::ofstream(folder / "out/parts/0000/a.0000.frames", std::ios::app) << "x";
    EXPECT_EQ(runJson("sweep caches.json -o out --status")["done"], 1);
    EXPECT_EQ(runJson("sweep caches.json -o out")["kept"], 1);
    std::ofstream(folder / "out/state/0001.json") << "{\"input\": ";
    EXPECT_EQ(runJson("sweep caches.json -o out")["kept"], 1);
    EXPECT_EQ(readText(folder / "out/merged.json"), merged);
    runJson(createArguments("", 8, 6));
    const json status = runJson("sweep caches.json -o out --status");
    EXPECT_EQ(status["missing"], 2);
    EXPECT_EQ(status["done"], 0);
}

TEST_F(Sweep, APartThatFailsCostsItselfAlone) {
    json sweep = storms();
    sweep["over"][0]["values"] = {"hair.hairloom", "none.hairloom"};
    write("storms.json", sweep);
    const Outcome outcome = run("sweep storms.json -o out --json");
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_THAT(outcome.errors, HasSubstr("3 of 6 parts are not done, and 3 of these failed"));
    EXPECT_THAT(outcome.errors, HasSubstr("part 0003 (groom none.hairloom, first 0): none.hairloom"));
    EXPECT_THAT(readText(folder / "out/report.html"), HasSubstr("none.hairloom"));
    EXPECT_FALSE(fs::exists(folder / "out/merged.json"));
    const json status = runJson("sweep storms.json -o out --status");
    EXPECT_EQ(status["done"], 3);
    EXPECT_EQ(status["failed"], 3);
    fs::copy(folder / "hair.hairloom", folder / "none.hairloom");
    const json again = runJson("sweep storms.json -o out");
    EXPECT_EQ(again["kept"], 3);
    EXPECT_EQ(again["failed"], 0);
    EXPECT_TRUE(again["failures"].empty());
}

TEST_F(Sweep, BadFilesAreErrorsBeforeAnythingRuns) {
    EXPECT_THAT(run("sweep none.json").errors, HasSubstr("none.json"));
    std::ofstream(folder / "cut.json") << "{\"hairloom_sweep\": 1,";
    EXPECT_THAT(run("sweep cut.json").errors, HasSubstr("cut.json@"));
    json sweep = storms();
    sweep["job"] = "sweep";
    EXPECT_THAT(errorOf(sweep), HasSubstr("/job is 'sweep'"));
    sweep = storms();
    sweep["arguments"]["strom"] = 1;
    EXPECT_THAT(errorOf(sweep), HasSubstr("/arguments/strom is no option of stability"));
    sweep = storms();
    sweep["arguments"]["storms"] = 0;
    EXPECT_THAT(errorOf(sweep), HasSubstr("part 0000 (groom hair.hairloom, first 0)"));
    sweep = storms();
    sweep["arguments"]["output"] = "{outt}";
    EXPECT_THAT(errorOf(sweep), HasSubstr("nothing is named {outt}"));
    sweep = storms();
    sweep["over"][1]["step"] = 0;
    EXPECT_THAT(errorOf(sweep), HasSubstr("/over/1/step does not lead from 0 to 4"));
    sweep["over"][1] = {{"name", "first"}, {"from", 0}, {"to", 99'999'999}};
    EXPECT_THAT(errorOf(sweep), HasSubstr("at most 100000"));
    sweep = storms();
    sweep["over"][0]["values"] = json::array();
    EXPECT_THAT(errorOf(sweep), HasSubstr("/over/0/values is empty"));
    sweep = storms();
    sweep["over"][1]["name"] = "groom";
    EXPECT_THAT(errorOf(sweep), HasSubstr("/over/1/name is 'groom', which is empty or taken"));
    sweep = storms();
    sweep["more"] = 1;
    EXPECT_THAT(errorOf(sweep), HasSubstr("/more is not known"));
    // Somebody's folder is not ours.
    write("storms.json", storms());
    fs::create_directory(folder / "mine");
    std::ofstream(folder / "mine/letter.txt") << "hello";
    EXPECT_THAT(run("sweep storms.json -o mine").errors, HasSubstr("is no folder of a sweep"));
    EXPECT_EQ(readText(folder / "mine/letter.txt"), "hello");
}

TEST_F(Sweep, NumbersOfAnAxisReadAsPeopleWriteThem) {
    json sweep = caches();
    sweep["arguments"] = {{"groom", "hair.hairloom"},
                          {"frames", 1},
                          {"wind", "{wind},0,0"},
                          {"record", "{out}/{wind:05}.frames"}};
    sweep["over"] = {{{"name", "wind"}, {"from", -0.3}, {"to", 0.3}, {"step", 0.1}}};
    write("wind.json", sweep);
    EXPECT_EQ(runJson("sweep wind.json -o out")["done"], 7);
    std::vector<std::string> names;
    for (const auto& file : fs::directory_iterator(folder / "out/files"))
        names.push_back(file.path().filename().string());
    EXPECT_THAT(names,
                testing::UnorderedElementsAre("-00.3.frames", "-00.2.frames", "-00.1.frames", "00000.frames",
                                              "000.1.frames", "000.2.frames", "000.3.frames"));
}

TEST_F(Sweep, AFlagMayBeWhatChanges) {
    json sweep = caches();
    sweep["gather"] = false;
    sweep["arguments"] = {{"groom", "hair.hairloom"}, {"frames", 1}, {"hair-hair", "{on}"}};
    sweep["over"] = {{{"name", "on"}, {"values", {true, false}}}};
    write("flag.json", sweep);
    EXPECT_EQ(runJson("sweep flag.json -o out")["done"], 2);
    const json merged = json::parse(readText(folder / "out/merged.json"));
    EXPECT_EQ(merged["parts"][1]["values"]["on"], false);
    EXPECT_NE(merged["parts"][0]["report"], merged["parts"][1]["report"]);
    sweep["over"] = {{{"name", "on"}, {"values", {"perhaps"}}}};
    EXPECT_THAT(errorOf(sweep), HasSubstr("/arguments/hair-hair is \"perhaps\"; expected true or false"));
}

TEST_F(Sweep, ChangesOfAFileWithACommaInItsNameAreSeen) {
    fs::rename(folder / "hair.hairloom", folder / "long, dark.hairloom");
    json sweep = caches();
    sweep["arguments"]["groom"] = "long, dark.hairloom";
    write("caches.json", sweep);
    EXPECT_EQ(runJson("sweep caches.json -o out")["done"], 2);
    runJson(createArguments("", 8, 6));
    fs::rename(folder / "hair.hairloom", folder / "long, dark.hairloom");
    EXPECT_EQ(runJson("sweep caches.json -o out --status")["done"], 0);
}

TEST_F(Sweep, AFolderOfAnotherSweepIsLeftAlone) {
    write("caches.json", caches());
    write("storms.json", storms());
    runJson("sweep caches.json -o out");
    const std::string merged = readText(folder / "out/merged.json");
    const Outcome outcome = run("sweep storms.json -o out");
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_THAT(outcome.errors, HasSubstr("out: is the folder of the sweep \"caches\" (\"simulate\")"));
    EXPECT_EQ(readText(folder / "out/merged.json"), merged);
    EXPECT_EQ(runJson("sweep caches.json -o out")["kept"], 2);
}

TEST_F(Sweep, APartThatAnotherProcessDoesIsLeftToIt) {
    write("caches.json", caches());
    runJson("sweep caches.json -o out --parts 1");
    // What the other process holds while it works.
    const auto held = OutputFile::open(folder / "out/state/0000.json", {}, Replacing::Anything);
    ASSERT_TRUE(held);
    const Outcome outcome = run("sweep caches.json -o out --progress lines");
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_THAT(outcome.errors, HasSubstr("0 failed, 1 done by another process"));
    EXPECT_THAT(
        outcome.errors,
        HasSubstr(
            "1 of 2 parts are not done, of which another process does 1 now; wait for the other process"));
    EXPECT_THAT(run("sweep caches.json -o out --parts 0").errors,
                HasSubstr("1 of 1 parts are not done, of which another process does 1 now; run them again"));
    EXPECT_EQ(runJson("sweep caches.json -o out --status")["failed"], 0);
}

TEST_F(Sweep, JoiningWaitsForAnotherThatJoins) {
    write("caches.json", caches());
    runJson("sweep caches.json -o out --parts 0,1");
    auto held = std::make_optional(OutputFile::open(folder / "out/state/merge", {}, Replacing::Anything));
    ASSERT_TRUE(held->has_value());
    std::thread other([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(700));
        held.reset();
    });
    EXPECT_EQ(runJson("sweep caches.json -o out --merge")["done"], 2);
    other.join();
    EXPECT_TRUE(fs::exists(folder / "out/merged.json"));
}

TEST_F(Sweep, StepsAreKeptBesideLargeNumbers) {
    json sweep = storms();
    sweep["over"][1] = {{"name", "first"}, {"from", 999'998}, {"to", 1'000'000}};
    sweep["arguments"]["storms"] = 1;
    write("large.json", sweep);
    const json report = runJson("sweep large.json -o out --slurm --write-only");
    EXPECT_EQ(report["parts"], 6);
    sweep["over"][1] = {{"name", "first"}, {"from", 1e9}, {"to", 1e9 + 1}, {"step", 0.01}};
    EXPECT_THAT(errorOf(sweep), HasSubstr("/over/1/step is 0.01, too small beside 1000000001"));
}

TEST_F(Sweep, ListsOfPartsAreThoseOfQueues) {
    write("storms.json", storms());
    EXPECT_EQ(runJson("sweep storms.json -o out --parts 5-5")["parts"], 1);
    EXPECT_EQ(runJson("sweep storms.json -o out --parts 0-4:2,5,1")["parts"], 5);
    for (const char* list : {"6", "x", "1-", "3-1", "1:0", "1,,2", "''"})
        EXPECT_EQ(run(std::string("sweep storms.json -o out --parts ") + list).exitCode, 2) << list;
    EXPECT_EQ(run("sweep storms.json -o out --part 6").exitCode, 2);
    EXPECT_EQ(run("sweep storms.json -o out --part 1 --merge").exitCode, 2);
}

TEST_F(Sweep, NamesThatTwoPartsGatherAreAnError) {
    json sweep = caches();
    sweep["arguments"]["record"] = "{out}/hair.frames";
    write("caches.json", sweep);
    EXPECT_THAT(run("sweep caches.json -o out").errors, HasSubstr("both write hair.frames"));
}

TEST_F(Sweep, QueuesGetScriptsAndTemplates) {
    write("storms.json", storms());
    const json slurm = runJson("sweep storms.json -o out --slurm --write-only --chunk 4");
    EXPECT_EQ(slurm["tasks"], 2);
    const std::string script = readText(slurm["script"].get<std::string>());
    EXPECT_THAT(script, HasSubstr("#SBATCH --array=0-1\n"));
    EXPECT_THAT(script, HasSubstr("#SBATCH --open-mode=append\n"));
    // The script is a shell's, whatever queue runs it.
    const std::string task = "SLURM_ARRAY_TASK_ID=1 bash '" + slurm["script"].get<std::string>() + "'";
    ASSERT_EQ(std::system((task + " > /dev/null 2>&1").c_str()), 0);
    EXPECT_EQ(runJson("sweep storms.json -o out --status")["done"], 2);
    // Without Slurm, or with its programs and no controller.
    const Outcome none = run("sweep storms.json -o out --slurm --sbatch=--clusters=none");
    EXPECT_EQ(none.exitCode, 1);
    EXPECT_THAT(none.errors, testing::AnyOf(HasSubstr("there is no queue: the program sbatch was not found"),
                                            HasSubstr("Slurm takes no job: ")));

    const json openjd = runJson("sweep storms.json -o out --openjd queue --chunk 4");
    const json content = json::parse(readText(folder / "queue/template.json"));
    EXPECT_EQ(content["steps"][0]["parameterSpace"]["taskParameterDefinitions"][0]["range"], "0-5");
    EXPECT_EQ(content["steps"][1]["dependencies"][0]["dependsOn"], "Parts");
}

TEST_F(Sweep, ProgressIsToldInLines) {
    write("caches.json", caches());
    EXPECT_THAT(run("sweep caches.json -o out --progress lines").errors,
                HasSubstr("2 of 2 parts done, 0 failed"));
    EXPECT_THAT(run("sweep caches.json -o other --progress openjd").output,
                HasSubstr("openjd_progress: 100.0"));
}

}  // namespace
}  // namespace hairloom::test
