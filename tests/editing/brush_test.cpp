// SPDX-License-Identifier: GPL-3.0-or-later
// What holds for every brush, and what each one is for.

#include <gmock/gmock.h>

#include "core/base/parallel.h"
#include "core/editing/replay.h"
#include "core/groom/point_dye.h"
#include "core/groom/point_width.h"
#include "tests/editing/editing_samples.h"

namespace hairloom::editing {
namespace {

using testing::HasSubstr;

class EveryBrush : public testing::TestWithParam<std::string_view> {
  protected:
    void TearDown() override { setThreadCount(0); }
};
INSTANTIATE_TEST_SUITE_P(Brushes, EveryBrush, testing::ValuesIn(brushNames().begin(), brushNames().end()),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(EveryBrush, UndoAndRedoRestoreTheState) {
    Document document(hairOnHead());
    const std::uint64_t before = contentHash(document.groom());
    ASSERT_TRUE(document.replay(strokeFor(GetParam())));
    const std::uint64_t after = contentHash(document.groom());
    EXPECT_NE(after, before);
    ASSERT_EQ(document.history().size(), 1u);
    EXPECT_EQ(document.history().name(0), brushInfo(GetParam()).label);
    for (int i = 0; i < 2; ++i) {
        ASSERT_TRUE(document.undo());
        EXPECT_EQ(contentHash(document.groom()), before);
        ASSERT_TRUE(document.redo());
        EXPECT_EQ(contentHash(document.groom()), after);
    }
}

TEST_P(EveryBrush, CancelRestoresTheState) {
    Document document(hairOnHead());
    const std::uint64_t before = contentHash(document.groom());
    const Stroke stroke = strokeFor(GetParam());
    ASSERT_TRUE(document.beginStroke(stroke));
    for (const Dab& dab : stroke.dabs) ASSERT_TRUE(document.dab(dab));
    document.cancelStroke();
    EXPECT_EQ(contentHash(document.groom()), before);
    EXPECT_FALSE(document.canUndo());
    ASSERT_TRUE(document.replay(stroke));  // bounds and all else still fit
    EXPECT_NE(contentHash(document.groom()), before);
}

TEST_P(EveryBrush, KeepsRootsLengthsAndDistanceAndIsValid) {
    Document document(hairOnHead());
    const Groom before = document.groom();
    const auto touched = document.replay(strokeFor(GetParam()));
    ASSERT_TRUE(touched);
    const Groom& after = document.groom();
    EXPECT_FALSE(hasErrors(validate(after))) << validate(after).front().what;
    EXPECT_GT(nearestToSkin(after), -1e-5f);
    if (after.strandCount() != before.strandCount()) return;
    const bool rootsStay = GetParam() != "slide";
    for (std::size_t s = 0; s < before.strandCount() && rootsStay; ++s)
        EXPECT_EQ(after.strand(s)[0], before.strand(s)[0]);
    if (!brushInfo(GetParam()).keepsLengths) return;
    const auto a = segmentLengths(before);
    const auto b = segmentLengths(after);
    for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(b[i], a[i], 2e-6f);
}

TEST_P(EveryBrush, LeavesFrozenHiddenLockedAndUnselectedStrandsAlone) {
    if (GetParam() == "freeze") GTEST_SKIP() << "it must reach frozen strands to thaw them";
    Groom groom = hairOnHead();
    std::vector<std::uint8_t> frozen(300, 0), hidden(300, 0), selected(300, 1);
    std::vector<std::uint32_t> layers(300, 0);
    for (std::size_t s = 0; s < 300; ++s) {
        frozen[s] = s % 5 == 0;
        hidden[s] = s % 5 == 1;
        selected[s] = s % 5 != 2;
        layers[s] = s % 5 == 3;
    }
    groom.layers = {{"Open", true, false, 1, {}}, {"Locked", true, true, 1, {}}};
    groom.strandAttributes.set(attribute::kFrozen, frozen);
    groom.strandAttributes.set(attribute::kHidden, hidden);
    groom.strandAttributes.set(attribute::kSelected, selected);
    groom.strandAttributes.set(attribute::kLayer, layers);
    Document document(groom);
    ASSERT_TRUE(document.replay(strokeFor(GetParam())));
    const auto ids = document.groom().strandAttributes.view<std::uint32_t>(attribute::kStrandId);
    std::size_t kept = 0;
    for (std::size_t s = 0; s < document.groom().strandCount(); ++s) {
        const std::size_t old = ids[s] - 100;
        if (old >= 300 || old % 5 == 4) continue;
        ++kept;
        const auto a = groom.strand(old);
        const auto b = document.groom().strand(s);
        EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end())) << "strand " << s;
        for (const std::string_view painted : {attribute::kPointDye, attribute::kWidthChange}) {
            const auto values = document.groom().pointAttributes.view<float>(painted);
            if (values.empty()) continue;
            EXPECT_THAT(values.subspan(document.groom().offsets[s], b.size()), testing::Each(0.0f));
        }
    }
    EXPECT_EQ(kept, 240u);
}

TEST_P(EveryBrush, GivesTheSameBitsForAnyNumberOfThreadsAndFromItsRecord) {
    std::vector<std::uint64_t> hashes;
    std::string script;
    for (const std::size_t threads : {1u, 2u, 5u}) {
        setThreadCount(threads);
        Document document(hairOnHead());
        Stroke stroke = strokeFor(GetParam());
        stroke.settings.symmetric = true;
        stroke.dabs[3].pressure = 0.3f;
        ASSERT_TRUE(document.replay(stroke));
        hashes.push_back(contentHash(document.groom()));
        script = document.script().value();
    }
    const auto parsed = parseScript("s.json", script, scriptExtensions());
    ASSERT_TRUE(parsed) << parsed.error().message();
    Groom replayed = hairOnHead();
    const auto report = runScript(*parsed, replayed);
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_EQ(report->strokes, 1u);
    hashes.push_back(contentHash(replayed));
    EXPECT_THAT(hashes, testing::Each(hashes.front()));
}

TEST_P(EveryBrush, DoesNothingFarAway) {
    Document document(hairOnHead());
    Stroke stroke = strokeFor(GetParam());
    for (Dab& dab : stroke.dabs) dab.position_ss += Vec3f(0, 5, 0);
    ASSERT_TRUE(document.replay(stroke));
    EXPECT_FALSE(document.canUndo());
}

TEST_P(EveryBrush, RefusesInvalidDabs) {
    Document document(hairOnHead());
    ASSERT_TRUE(document.beginStroke(strokeFor(GetParam())));
    Dab dab = strokeFor(GetParam()).dabs[0];
    dab.position_ss.x() = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(document.dab(dab));
    dab = strokeFor(GetParam()).dabs[0];
    dab.radius = 0;
    EXPECT_FALSE(document.dab(dab));
    document.cancelStroke();
}

TEST(Comb, DragsHairAlong) {
    TopStrand top;
    const Vec3f middle = top.points()[8];
    const Vec3f tip = top.points()[15];
    ASSERT_TRUE(top.document.replay(top.at("comb", {middle, middle + Vec3f(0.01f, 0, 0)})));
    EXPECT_GT(top.points()[8].x(), middle.x() + 0.002f);
    EXPECT_GT(top.points()[15].x(), tip.x() + 0.001f);  // follows
}

TEST(Comb, EntersTheHeadOnlyWithoutCollisions) {
    for (const bool collide : {true, false}) {
        TopStrand top;
        const Vec3f middle = top.points()[8];
        Stroke stroke = top.at("comb", {}, 0.05f);
        stroke.settings.collide = collide;
        for (int i = 0; i < 12; ++i)
            stroke.dabs.push_back(
                dabAt(stroke.settings, middle - Vec3f(0, 0.01f * static_cast<float>(i), 0)));
        ASSERT_TRUE(top.document.replay(stroke));
        if (collide) {
            EXPECT_GT(nearestToSkin(top.document.groom()), 1e-4f);
        } else {
            EXPECT_LT(nearestToSkin(top.document.groom()), -0.005f);
        }
    }
}

TEST(BrushAlong, TurnsSegmentsIntoTheStroke) {
    for (const bool invert : {false, true}) {
        TopStrand top;
        const Vec3f middle = top.points()[8];
        Stroke stroke =
            top.at("brush", {middle, middle + Vec3f(0, 0, 0.002f), middle + Vec3f(0, 0, 0.004f)}, 0.04f);
        stroke.settings.invert = invert;
        ASSERT_TRUE(top.document.replay(stroke));
        const Vec3f segment = (top.points()[9] - top.points()[8]).normalized();
        EXPECT_GT(segment.z() * (invert ? -1.0f : 1.0f), 0.7f);
    }
}

TEST(Grab, ComesBackWhenCarriedToAndFro) {
    TopStrand top;
    const Vec3f middle = top.points()[8];
    const Groom before = top.document.groom();
    ASSERT_TRUE(top.document.beginStroke(top.at("grab", {})));
    const auto put = [&](const Vec3f& place) {
        ASSERT_TRUE(top.document.dab(dabAt(top.at("grab", {}).settings, place)));
    };
    put(middle);
    put(middle + Vec3f(0.02f, 0, 0.01f));
    EXPECT_GT((top.points()[8] - middle).norm(), 0.005f);
    put(middle);
    for (std::size_t p = 0; p < 16; ++p)
        EXPECT_LT((top.points()[p] - before.strand(top.strand)[p]).norm(), 1e-6f);
    top.document.endStroke();
}

TEST(Smooth, TakesBendsOut) {
    TopStrand top;
    const Vec3f middle = top.points()[8];
    ASSERT_TRUE(top.document.replay(top.at("comb", {middle, middle + Vec3f(0.02f, 0, 0)}, 0.02f)));
    const auto bend = [&] {
        float sum = 0;
        for (std::size_t i = 1; i < 15; ++i)
            sum += (top.points()[i - 1] - 2 * top.points()[i] + top.points()[i + 1]).norm();
        return sum;
    };
    const float before = bend();
    ASSERT_TRUE(top.document.replay(top.at("smooth", {top.points()[8], top.points()[8]}, 0.05f)));
    EXPECT_LT(bend(), 0.8f * before);
}

TEST(Puff, LiftsAndPresses) {
    TopStrand top;
    const Vec3f middle = top.points()[8];
    Stroke aside = top.at("comb", {middle, middle + Vec3f(0.05f, -0.02f, 0)}, 0.06f);
    ASSERT_TRUE(top.document.replay(aside));
    const float before = top.points()[15].y();
    ASSERT_TRUE(top.document.replay(top.at("puff", {top.points()[8]}, 0.06f)));
    const float lifted = top.points()[15].y();
    EXPECT_GT(lifted, before + 0.001f);
    Stroke press = top.at("puff", {top.points()[8]}, 0.06f);
    press.settings.invert = true;
    ASSERT_TRUE(top.document.replay(press));
    EXPECT_LT(top.points()[15].y(), lifted - 0.001f);
}

TEST(Pinch, DrawsTogetherAndSpreads) {
    for (const bool invert : {false, true}) {
        TopStrand top;
        const Vec3f middle = top.points()[10];
        const auto spread = [&] {
            double sum = 0;
            for (std::size_t s = 0; s < 300; ++s) {
                const Vec3f away = top.document.groom().strand(s)[10] - middle;
                if (away.norm() < 0.06f) sum += static_cast<double>(away.norm());
            }
            return sum;
        };
        const double before = spread();
        Stroke stroke = top.at("pinch", {middle}, 0.04f);
        stroke.settings.strength = 0.3f;
        stroke.settings.invert = invert;
        ASSERT_TRUE(top.document.replay(stroke));
        if (invert) {
            EXPECT_GT(spread(), before);
        } else {
            EXPECT_LT(spread(), before);
        }
    }
}

TEST(Length, GrowsAndShrinksByItsRate) {
    for (const bool rescale : {true, false}) {
        TopStrand top;
        const float before = top.length();
        Stroke grow = top.at("length", {top.points()[8]});
        grow.settings.falloff = BrushCurve::falloff("constant");
        grow.settings.parameters = {{"rate", 0.25f}, {"rescale", rescale ? 1.0f : 0.0f}};
        ASSERT_TRUE(top.document.replay(grow));
        EXPECT_NEAR(top.length(), 1.25f * before, 1e-5f);
        Stroke shrink = grow;
        shrink.settings.invert = true;
        shrink.settings.parameters["shortest"] = 0.13f;
        ASSERT_TRUE(top.document.replay(shrink));
        EXPECT_NEAR(top.length(), 0.13f, 1e-5f);
    }
}

TEST(Cut, EndsHairWhereItMeetsTheBrush) {
    TopStrand top;
    const Vec3f at = top.points()[8];
    const float toCentre = (at - top.points()[0]).norm();
    ASSERT_TRUE(top.document.replay(top.at("cut", {at}, 0.01f)));
    EXPECT_NEAR(top.length(), toCentre - 0.01f, 1e-4f);
}

TEST(CutLine, EndsHairWhereItCrossesTheLine) {
    TopStrand top;
    const float level = top.points()[6].y() + 0.001f;
    Stroke stroke = top.at("cut_line", {Vec3f(-0.3f, level, 0.5f), Vec3f(0.3f, level, 0.5f)});
    stroke.settings.depth = 1;
    for (Dab& dab : stroke.dabs) dab.direction_ss = -Vec3f::UnitZ();
    const Groom before = top.document.groom();
    ASSERT_TRUE(top.document.replay(stroke));
    std::size_t cut = 0;
    for (std::size_t s = 0; s < 300; ++s) {
        const float tip = before.strand(s)[15].y();
        if (tip > level && before.strand(s)[0].y() < level - 0.006f) {
            EXPECT_NEAR(top.document.groom().strand(s)[15].y(), level, 1e-5f);
            ++cut;
        } else if (tip < level) {
            EXPECT_EQ(top.document.groom().strand(s)[15], before.strand(s)[15]);
        }
    }
    EXPECT_GT(cut, 50u);
}

TEST(CutLine, KeepsToTheLineThatIsDrawn) {
    TopStrand top;
    const float level = top.points()[6].y();
    // A short line, seen by an eye from which the lines of sight spread.
    const Vec3f eye(0, level, 1);
    Stroke stroke = top.at("cut_line", {Vec3f(0, level, 0.5f), Vec3f(0.05f, level, 0.5f)});
    stroke.settings.depth = 1;
    for (Dab& dab : stroke.dabs) dab.direction_ss = (dab.position_ss - eye).normalized();
    const Groom before = top.document.groom();
    ASSERT_TRUE(top.document.replay(stroke));
    std::size_t cut = 0;
    for (std::size_t s = 0; s < 300; ++s) {
        const auto now = top.document.groom().strand(s);
        if (now[15] == before.strand(s)[15]) continue;
        ++cut;
        const Vec3f seen = now[15] - eye;
        EXPECT_GE(seen.x(), -1e-5f);
        EXPECT_LE(seen.x() / -seen.z(), 0.1f + 1e-5f);
    }
    EXPECT_GT(cut, 5u);
}

/// Hair that hangs before the depth at which the line was begun is cut, too; behind, the depth ends it.
TEST(CutLine, CutsAllThatHangsBeforeIt) {
    const float level = TopStrand().points()[6].y() + 0.001f;
    const auto cutAt = [&](float z) {
        TopStrand top;
        Stroke stroke = top.at("cut_line", {Vec3f(-0.3f, level, z), Vec3f(0.3f, level, z)});
        stroke.settings.depth = 0.02f;
        for (Dab& dab : stroke.dabs) dab.direction_ss = -Vec3f::UnitZ();
        const Groom before = top.document.groom();
        EXPECT_TRUE(top.document.replay(stroke));
        std::size_t cut = 0;
        for (std::size_t s = 0; s < 300; ++s)
            cut += top.document.groom().strand(s)[15] != before.strand(s)[15] ? 1 : 0;
        return cut;
    };
    EXPECT_GT(cutAt(-0.5f), 50u);
    EXPECT_EQ(cutAt(0.5f), 0u);
}

TEST(Delete, TakesStrandsByRootOrByAnyPart) {
    TopStrand top;
    const Vec3f tip = top.points()[15];
    ASSERT_TRUE(top.document.replay(top.at("delete", {tip}, 0.01f)));
    EXPECT_EQ(top.document.groom().strandCount(), 300u);
    Stroke parts = top.at("delete", {tip}, 0.01f);
    parts.settings.parameters = {{"roots", 0}};
    ASSERT_TRUE(top.document.replay(parts));
    EXPECT_LT(top.document.groom().strandCount(), 300u);
    EXPECT_GT(top.document.groom().strandCount(), 280u);
}

TEST(Freeze, FreezesAndThaws) {
    TopStrand top;
    Stroke freeze = top.at("freeze", {top.points()[8]});
    ASSERT_TRUE(top.document.replay(freeze));
    EXPECT_EQ(top.document.groom().strandAttributes.view<std::uint8_t>(attribute::kFrozen)[top.strand], 1);
    const Vec3f before = top.points()[8];
    ASSERT_TRUE(top.document.replay(top.at("comb", {before, before + Vec3f(0.02f, 0, 0)})));
    EXPECT_EQ(top.points()[8], before);
    freeze.settings.invert = true;
    ASSERT_TRUE(top.document.replay(freeze));
    EXPECT_EQ(top.document.groom().strandAttributes.view<std::uint8_t>(attribute::kFrozen)[top.strand], 0);
}

TEST(Symmetry, MovesTheMirrorImage) {
    // Two strands that are mirror images of each other.
    const auto scalp = sphereScalp(kHeadRadius, 4, kHeadCentre);
    std::vector<Vec3f> points;
    for (const float side : {-1.0f, 1.0f}) {
        const Vec3f out = Vec3f(0.6f * side, 0.8f, 0);
        for (int p = 0; p < 16; ++p)
            points.push_back(kHeadCentre + out * (kHeadRadius + 0.008f * static_cast<float>(p)));
    }
    Groom groom = makeGroom({0, 16, 32}, points);
    bindToScalp(groom, scalp, {});
    Document document(groom);
    Stroke stroke;
    stroke.tool = "comb";
    stroke.settings.radius = 0.03f;
    stroke.settings.symmetric = true;
    for (int i = 0; i < 5; ++i)
        stroke.dabs.push_back(
            dabAt(stroke.settings, points[8] + Vec3f(0, 0, 0.004f * static_cast<float>(i))));
    ASSERT_TRUE(document.replay(stroke));
    EXPECT_GT(document.groom().strand(0)[8].z(), 0.003f);
    for (std::size_t p = 0; p < 16; ++p) {
        const Vec3f left = document.groom().strand(0)[p];
        const Vec3f right = document.groom().strand(1)[p];
        EXPECT_LT((Vec3f(-left.x(), left.y(), left.z()) - right).norm(), 1e-5f);
    }
}

TEST(Profile, LimitsABrushToPartsOfStrands) {
    TopStrand top;
    Stroke stroke = top.at("puff", {top.points()[8]}, 0.2f);
    stroke.settings.profile = BrushCurve({0, 0, 0, 1});
    const std::vector<Vec3f> before(top.points().begin(), top.points().end());
    stroke.settings.invert = true;
    ASSERT_TRUE(top.document.replay(stroke));
    for (std::size_t p = 0; p <= 10; ++p) EXPECT_EQ(top.points()[p], before[p]);
}

TEST(StrokeRecord, NamesWhatIsWrong) {
    const auto problem = [](std::string_view step) {
        const auto script =
            parseScript("s.json", R"({"hairloom_script": 1, "operations": [)" + std::string(step) + "]}",
                        scriptExtensions());
        return script ? "it was parsed" : script.error().message();
    };
    EXPECT_THAT(problem(R"({"op": "stroke", "tool": "mow", "dabs": []})"), HasSubstr("no brush 'mow'"));
    EXPECT_THAT(problem(R"({"op": "stroke", "tool": "comb", "dabs": [{"at": [0, 1]}]})"),
                HasSubstr("/operations/0/dabs/0/at is not a vector"));
    EXPECT_THAT(problem(R"({"op": "stroke", "tool": "comb", "parameters": {"x": 1}, "dabs": []})"),
                HasSubstr("comb has no parameter 'x'"));
    EXPECT_THAT(problem(R"({"op": "stroke", "tool": "puff", "parameters": {"height": 9}, "dabs": []})"),
                HasSubstr("height is 9; expected 0 to 0.1 m"));
    EXPECT_THAT(problem(R"({"op": "stroke", "tool": "comb", "radius": 3, "dabs": []})"),
                HasSubstr("radius is 3; expected a number from 0.0001 to 1 m"));
    EXPECT_THAT(problem(R"({"op": "stroke", "tool": "comb", "falloff": [2], "dabs": []})"),
                HasSubstr("falloff is not a list"));
    EXPECT_THAT(
        problem(R"({"op": "stroke", "tool": "comb", "dabs": [{"at": [0, 1, 0], "view": [1, 1, 0]}]})"),
        HasSubstr("direction is 1.41"));
}

}  // namespace
}  // namespace hairloom::editing
