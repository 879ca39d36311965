// SPDX-License-Identifier: GPL-3.0-or-later
// Classes of curl, as shapes of new strands and as operators of hair that is there.
#include <gmock/gmock.h>

#include <map>

#include "core/groom/file/project_file.h"
#include "tests/cli/command.h"

namespace hairloom::test {
namespace {

using testing::HasSubstr;

class CurlClassJob : public CommandLineTest {
  protected:
    std::string creating(const std::string& more) const {
        return "create --mesh '" + bustFile() +
               "' --scalp material:scalp --count 60 --length 0.2 -o hair.hairloom " + more;
    }
    Groom groom(const std::string& file = "hair.hairloom") const {
        auto read = readProjectFile(folder / file);
        EXPECT_TRUE(read);
        return read ? std::move(*read) : Groom();
    }
    /// Of the strands' outer three quarters, by how often the segments' side direction turns over.
    static double turnsPerMetre(const Groom& groom) {
        double turns = 0, metres = 0;
        for (std::size_t s = 0; s < groom.strandCount(); ++s) {
            const auto points = groom.strand(s);
            const Vec3f along = (points.back() - points.front()).normalized();
            const Vec3f side = along.unitOrthogonal();
            float before = 0;
            for (std::size_t i = points.size() / 4; i < points.size(); ++i) {
                const Vec3f segment = points[i] - points[i - 1];
                metres += static_cast<double>(segment.norm());
                const float now = segment.dot(side);
                turns += now * before < 0 ? 0.5 : 0;
                before = now;
            }
        }
        return turns / metres;
    }
    /// Distance between the ends over the length; 1: straight.
    static double reach(const Groom& groom) {
        double sum = 0;
        for (std::size_t s = 0; s < groom.strandCount(); ++s) {
            const auto points = groom.strand(s);
            double length = 0;
            for (std::size_t i = 1; i < points.size(); ++i)
                length += static_cast<double>((points[i] - points[i - 1]).norm());
            sum += static_cast<double>((points.back() - points.front()).norm()) / length;
        }
        return sum / static_cast<double>(groom.strandCount());
    }
};

TEST_F(CurlClassJob, NewStrandsHaveTheCurlOfTheirClass) {
    const std::string help = run("create --help").output;
    std::map<std::string, double> turns, reaches;
    for (const char* const name : {"straight", "wavy", "curly", "woolly"}) {
        EXPECT_THAT(help, HasSubstr(name));
        runJson(creating(std::string("--curl ") + name));
        turns[name] = turnsPerMetre(groom());
        reaches[name] = reach(groom());
    }
    EXPECT_NEAR(reaches["straight"], 1, 1e-5);
    EXPECT_NEAR(turns["wavy"], 20, 8);
    EXPECT_NEAR(turns["curly"], 40, 14);
    EXPECT_GT(turns["woolly"], 70);
    EXPECT_LT(reaches["wavy"], 0.995);
    EXPECT_LT(reaches["curly"], reaches["wavy"]);
    EXPECT_LT(reaches["woolly"], reaches["curly"]);
    runJson(creating("--curl straight"));
    EXPECT_TRUE(groom().operators.empty());
}

TEST_F(CurlClassJob, CurlsGetThePointsThatTheyNeedUnlessGiven) {
    const auto points = [&](const std::string& more) {
        const auto report = runJson(creating(more));
        return report["points"].get<std::size_t>() / report["strands"].get<std::size_t>();
    };
    EXPECT_EQ(points(""), 16u);
    EXPECT_EQ(points("--curl straight"), 16u);
    EXPECT_EQ(points("--curl woolly"), 193u);
    EXPECT_EQ(points("--curl woolly --points 20"), 20u);
    EXPECT_EQ(run(creating("--curl kinky")).exitCode, 2);
}

TEST_F(CurlClassJob, AStackHasOneClassAtATime) {
    runJson(creating("--points 193"));
    const Groom straight = groom();
    const auto operators = [&](const std::string& file) {
        std::vector<std::string> names;
        for (const Operator& one : groom(file).operators) names.push_back(one.op);
        return names;
    };
    runJson("stack hair.hairloom --curl curly -o a.hairloom");
    EXPECT_THAT(operators("a.hairloom"), testing::ElementsAre("clump", "curl", "frizz"));
    runJson("stack a.hairloom --curl woolly -o b.hairloom");
    EXPECT_THAT(operators("b.hairloom"), testing::ElementsAre("curl", "frizz"));
    EXPECT_GT(turnsPerMetre(groom("b.hairloom")), 1.3 * turnsPerMetre(groom("a.hairloom")));
    runJson("stack b.hairloom --curl straight -o c.hairloom");
    EXPECT_TRUE(operators("c.hairloom").empty());
    const Groom back = groom("c.hairloom");
    for (std::size_t i = 0; i < back.positions().size(); ++i)
        EXPECT_NEAR((back.positions()[i] - straight.positions()[i]).norm(), 0, 1e-6f);
    EXPECT_EQ(run("stack hair.hairloom --curl curly").exitCode, 2) << "needs -o";
}

}  // namespace
}  // namespace hairloom::test
