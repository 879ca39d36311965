// SPDX-License-Identifier: GPL-3.0-or-later
// OBJ polylines and Cinema 4D ribbons (thesis §4.1).

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/importers/strands_files.h"

namespace hairloom {

void PrintTo(RibbonOrder order, std::ostream* out) {
    constexpr const char* kNames[] = {"detect", "interleaved", "edge after edge", "around"};
    *out << kNames[static_cast<std::size_t>(order)];
}

namespace strand_files {

void PrintTo(RibbonFaces faces, std::ostream* out) {
    constexpr const char* kNames[] = {"no faces", "quads", "triangles"};
    *out << kNames[static_cast<std::size_t>(faces)];
}

}  // namespace strand_files

namespace {

using namespace strand_files;
using testing::HasSubstr;

/// A square scalp of one metre at height y, facing up.
ScalpMesh plate(float y) {
    PolygonSoup soup;
    soup.positions = {{-0.5f, y, -0.5f}, {-0.5f, y, 0.5f}, {0.5f, y, 0.5f}, {0.5f, y, -0.5f}};
    soup.corners = {0, 1, 2, 3};
    soup.offsets = {0, 4};
    return ScalpMesh::make(soup).value();
}

class Ribbons : public testing::TestWithParam<std::tuple<RibbonOrder, std::size_t, RibbonFaces>> {};

TEST_P(Ribbons, AreFoundWhateverTheirOrder) {
    const auto& [order, segments, faces] = GetParam();
    const std::size_t strands = 5;
    StrandImportOptions options;
    if (faces == RibbonFaces::None) options.ribbonSegments = static_cast<std::uint32_t>(segments);
    const auto imported = read(ribbonObj(strands, segments, order, faces), options);
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_EQ(imported->format, "Cinema 4D hair OBJ");
    // Thesis §4.1 prints 2n/n_v strands; there are n_v/(2n).
    ASSERT_EQ(imported->groom.strandCount(), strands);
    for (std::size_t s = 0; s < strands; ++s) {
        const auto strand = imported->groom.strand(s);
        ASSERT_EQ(strand.size(), segments + 1);
        for (std::size_t i = 0; i <= segments; ++i) {
            EXPECT_EQ(strand[i], curlPoint(s, i, segments + 1)) << "strand " << s << " point " << i;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Orders, Ribbons,
                         testing::Combine(testing::Values(RibbonOrder::Interleaved,
                                                          RibbonOrder::EdgeAfterEdge, RibbonOrder::Around),
                                          testing::Values(1, 2, 3, 8, 31),
                                          testing::Values(RibbonFaces::Quads, RibbonFaces::Triangles,
                                                          RibbonFaces::None)));

TEST(StrandsRibbons, OrderAndParticleCanBeChosen) {
    StrandImportOptions options;
    options.ribbonOrder = RibbonOrder::EdgeAfterEdge;
    options.ribbonParticle = RibbonParticle::Centre;
    const auto imported = read(ribbonObj(2, 4, RibbonOrder::EdgeAfterEdge), options);
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_TRUE(imported->groom.strand(1)[2].isApprox(curlPoint(1, 2, 5) + Vec3f(0, 0, 0.0005f), 1e-6f));
    const auto wrong = read(ribbonObj(2, 4, RibbonOrder::Interleaved), options);
    ASSERT_FALSE(wrong);
    EXPECT_THAT(wrong.error().message(), HasSubstr("is not between neighbouring"));
}

TEST(StrandsRibbons, RemaindersAreErrors) {
    StrandImportOptions options;
    options.ribbonSegments = 4;
    const auto given = read(ribbonObj(3, 5, RibbonOrder::Interleaved, RibbonFaces::None), options);
    ASSERT_FALSE(given);
    EXPECT_THAT(given.error().message(), HasSubstr("36 vertices are not a multiple of 10"));

    const auto loose = read(ribbonObj(3, 5, RibbonOrder::Interleaved) + "v 0 0 0\n");
    ASSERT_FALSE(loose);
    EXPECT_THAT(loose.error().message(), HasSubstr("vertex 37 belongs to no face"));

    const auto none = read(ribbonObj(1, 5, RibbonOrder::Interleaved, RibbonFaces::None));
    ASSERT_FALSE(none);
    EXPECT_THAT(none.error().message(), HasSubstr("number of segments"));
}

TEST(StrandsRibbons, AMeshIsNoHair) {
    const auto cube = read(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
        "f 1 2 3 4\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    ASSERT_FALSE(cube);
    EXPECT_THAT(cube.error().message(), HasSubstr("hair ribbon"));
}

TEST(StrandsRibbons, RootIsTheEndNearTheScalp) {
    const ScalpMesh below = plate(1.49f);
    StrandImportOptions options;
    options.scalp = &below;
    const auto imported = read(ribbonObj(4, 6, RibbonOrder::Interleaved), options);
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_EQ(imported->groom.strand(3).front(), curlPoint(3, 6, 7));
    EXPECT_EQ(imported->groom.strand(3).back(), curlPoint(3, 0, 7));
}

TEST(StrandsLines, KeepTheOrderTheyAreListedIn) {
    const auto imported = read("v 0 0 0\nv 0 .1 0\nv 0 .2 0\nl 1 2 3\nl 3 2 1\nl -3/1 -2/2 -1/3\n");
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_EQ(imported->format, "OBJ lines");
    ASSERT_EQ(imported->groom.strandCount(), 3u);
    EXPECT_EQ(imported->groom.strand(0).front(), Vec3f(0, 0, 0));
    EXPECT_EQ(imported->groom.strand(1).front(), Vec3f(0, 0.2f, 0));
    EXPECT_EQ(imported->groom.strand(2).back(), Vec3f(0, 0.2f, 0));
}

TEST(StrandsLines, AFileThatIsCutShortSaysSo) {
    std::string text;
    for (int v = 0; v < 30; ++v) text += fmt::format("v {} {} 0\n", v / 10, 0.01 * (v % 10));
    for (int s = 0; s < 3; ++s) {
        text += "l";
        for (int v = 1; v <= 10; ++v) text += fmt::format(" {}", 10 * s + v);
        text += "\n";
    }
    const auto tells = [](const ImportedStrands& imported) {
        return std::ranges::any_of(imported.warnings, [](const Finding& finding) {
            return finding.what.find("are in no line") != std::string::npos ||
                   finding.what.find("without lines") != std::string::npos;
        });
    };
    const auto whole = read(bytesOf(text));
    ASSERT_TRUE(whole);
    EXPECT_FALSE(tells(*whole));
    // But for the last line's end nothing is lost unseen.
    for (std::size_t size = 0; size + 1 < text.size(); ++size) {
        const auto cut = read(bytesOf(text.substr(0, size)));
        if (!cut) continue;
        EXPECT_TRUE(tells(*cut)) << size << " of " << text.size() << " bytes";
    }
}

TEST(StrandsLines, MostRootsAtTheOtherEndTurnTheWholeFile) {
    const ScalpMesh scalp = plate(0);
    StrandImportOptions options;
    options.scalp = &scalp;
    const std::string vertices = "v 0 0.001 0\nv 0 .1 0\nv 0 .2 0\n";
    const auto turned = read(vertices + "l 3 2 1\nl 3 2 1\nl 3 2 1\n", options);
    ASSERT_TRUE(turned) << turned.error().message();
    for (std::size_t s = 0; s < 3; ++s) EXPECT_EQ(turned->groom.strand(s).front(), Vec3f(0, 0.001f, 0));
    // A few that touch the head with their tips say nothing against the file's order.
    const auto kept = read(vertices + "l 1 2 3\nl 3 2 1\nl 1 2 3\n", options);
    ASSERT_TRUE(kept);
    EXPECT_EQ(kept->groom.strand(1).front(), Vec3f(0, 0.2f, 0));
    EXPECT_EQ(kept->groom.strand(2).front(), Vec3f(0, 0.001f, 0));
}

TEST(StrandsLines, RootsMetresOffTheHeadAreAnErrorWithTheUnitThatFits) {
    const ScalpMesh scalp = plate(0);
    StrandImportOptions options;
    options.scalp = &scalp;
    const auto far = read("v 1 300 0\nv 1 400 0\nl 1 2\n", options);
    ASSERT_FALSE(far);
    EXPECT_THAT(far.error().message(), HasSubstr("m from the head (median); with the unit mm"));
    options.metresPerUnit = 0.001f;
    EXPECT_TRUE(read("v 1 300 0\nv 1 400 0\nl 1 2\n", options));
}

TEST(StrandsLines, TwoPointLinesAreChainedInAnyOrderAndDirection) {
    const std::string vertices = "v 0 0 0\nv 0 .1 0\nv 0 .2 0\nv 0 .3 0\nv 1 0 0\nv 1 .1 0\n";
    for (const char* lines : {"l 1 2\nl 2 3\nl 3 4\nl 5 6\n", "l 3 4\nl 5 6\nl 1 2\nl 2 3\n"}) {
        const auto imported = read(vertices + lines);
        ASSERT_TRUE(imported) << imported.error().message();
        ASSERT_EQ(imported->groom.strandCount(), 2u);
        ASSERT_EQ(imported->groom.strand(0).size(), 4u);
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_EQ(imported->groom.strand(0)[i], Vec3f(0, static_cast<float>(i) * 0.1f, 0).eval());
        }
    }
    const auto descending = read(vertices + "l 2 1\nl 3 2\nl 4 3\n");
    ASSERT_TRUE(descending);
    EXPECT_EQ(descending->groom.strand(0).front(), Vec3f(0, 0.3f, 0));
}

TEST(StrandsLines, CurvesOfAnyDegreeAreEvaluated) {
    const std::string vertices = "v 0 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\n";
    // A parabola: (t², 1 − (1 − t)²) of its three control points, at even steps of t.
    const auto parabola = read(vertices + "cstype bezier\ndeg 2\ncurv 0 1 -4 -3 -2\nparm u 0 1\nend\n");
    ASSERT_TRUE(parabola) << parabola.error().message();
    ASSERT_EQ(parabola->groom.strand(0).size(), 3u);
    EXPECT_LT((parabola->groom.strand(0)[1] - Vec3f(0.25f, 0.75f, 0)).norm(), 1e-6f);
    // The same cubic as Bézier and as B-spline with the knots of one.
    const auto bezier = read(vertices + "cstype bezier\ndeg 3\ncurv 0 1 1 2 3 4\nparm u 0 1\nend\n");
    const auto spline = read(vertices +
                             "cstype bspline\ndeg 3\ncurv 0 1 1 2 3 4\nparm u 0 0 0 0 1 1 1 1\nend\n"
                             "v 9 9 9\nv 9 9 8\nl -1 -2\n");
    ASSERT_TRUE(bezier && spline);
    ASSERT_EQ(bezier->groom.strand(0).size(), 4u);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_LT((bezier->groom.strand(0)[i] - spline->groom.strand(0)[i]).norm(), 1e-6f);
    EXPECT_LT((bezier->groom.strand(0)[1] - Vec3f(7 / 27.0f, 2 / 3.0f, 0)).norm(), 1e-6f);
    EXPECT_EQ(spline->groom.strand(1).front(), Vec3f(9, 9, 8)) << "indices of the file stay its own";
    // Two points of a circle's quarter and the corner between them at √½.
    const auto arc = read(
        "v 1 0 0 1\nv 1 1 0 0.70710678\nv 0 1 0 1\ncstype rat bezier\ndeg 2\n"
        "curv 0 1 1 2 3\nend\n");
    ASSERT_TRUE(arc);
    for (const Vec3f& point : arc->groom.strand(0)) EXPECT_NEAR(point.norm(), 1, 1e-6f);
    const auto taylor = read(vertices + "cstype taylor\ndeg 3\ncurv 0 1 1 2 3 4\nend\n");
    ASSERT_TRUE(taylor);
    EXPECT_EQ(taylor->groom.strand(0)[1], Vec3f(0, 1, 0));
    EXPECT_THAT(taylor->warnings.front().what, HasSubstr("type 'taylor'"));
}

TEST(StrandsLines, BranchesAndLoopsAreDropped) {
    const std::string vertices = "v 0 0 0\nv 0 .1 0\nv 0 .2 0\nv 0 .3 0\nv .1 0 0\nv .1 .1 0\n";
    const auto branch = read(vertices + "l 1 2\nl 2 3\nl 2 4\nl 5 6\n");
    ASSERT_TRUE(branch) << branch.error().message();
    EXPECT_EQ(branch->groom.strandCount(), 1u);
    ASSERT_FALSE(branch->dropped.empty());
    EXPECT_EQ(branch->dropped[0].reason, DropReason::Branches);
    const auto loop = read(vertices + "l 1 2\nl 2 3\nl 3 1\nl 5 6\n");
    ASSERT_TRUE(loop) << loop.error().message();
    ASSERT_EQ(loop->dropped.size(), 1u);
    EXPECT_EQ(loop->dropped[0].reason, DropReason::ClosedLoop);
}

TEST(StrandsLines, ReadsContinuationLinesCarriageReturnsAndPolylineCurves) {
    const auto imported = read(
        "\xEF\xBB\xBF# a comment \\\nwith more\r\nv 0 0 0\r\nv 0 .1 0\r\nv 0 .2 \\\r\n0\r\n"
        "cstype bspline\r\ndeg 1\r\ncurv 0.0 1.0 -3 -2 \\\r\n -1\r\nend\r\n");
    ASSERT_TRUE(imported) << imported.error().message();
    ASSERT_EQ(imported->groom.strandCount(), 1u);
    EXPECT_EQ(imported->groom.strand(0).size(), 3u);
}

TEST(StrandsLines, ReadsLinesAsTheMeshReaderDoes) {
    for (const std::string_view text :
         {"v 0 0 0 # root\nv +0 .1 0\nv 0 2e-1 0\nl 1/7 2//3 3/1/1 # all\n",
          "v 0 0 0\rv 0 .1 0\rv 0 .2 0\rl 1 2 3", "v 0\t0\f0\nv 0 .1 0\nv 0 .2 0\nl 1 +2 \\ \n-1"}) {
        const auto imported = read(text);
        ASSERT_TRUE(imported) << imported.error().message();
        ASSERT_EQ(imported->groom.strandCount(), 1u);
        ASSERT_EQ(imported->groom.strand(0).size(), 3u);
        EXPECT_EQ(imported->groom.strand(0)[2], Vec3f(0, 0.2f, 0));
    }
}

TEST(StrandsLines, ErrorsNameTheLine) {
    const auto messageOf = [](std::string_view text) {
        const auto imported = read(text);
        return imported ? std::string() : imported.error().message();
    };
    EXPECT_THAT(messageOf("v 0 0 0\nv 0 1\nl 1 2\n"), HasSubstr("test:2: a vertex has 2 coordinates"));
    EXPECT_THAT(messageOf("v 0 0 x\n"), HasSubstr("test:1: 'x' is not a number"));
    EXPECT_THAT(messageOf("v 0 0 0\nl 1 2\n"), HasSubstr("test:2: a line refers to vertex 2"));
    EXPECT_THAT(messageOf("v 0 0 0\nl 1 0\n"), HasSubstr("refers to vertex 0"));
    EXPECT_THAT(messageOf("v 0 0 0\nf 1 -2 1\n"), HasSubstr("a face refers to vertex -2"));
    EXPECT_THAT(messageOf("v 0 0 0\n\nl 1 \\\n1.5\n"), HasSubstr("test:3: '1.5' in a line is not an index"));
    EXPECT_THAT(messageOf("hello"), HasSubstr("without a vertex"));
}

}  // namespace
}  // namespace hairloom
