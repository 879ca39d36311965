// SPDX-License-Identifier: GPL-3.0-or-later
// Hair written as polygons: ribbons and tubes of unlike length and of any number of sides.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "tests/importers/strands_files.h"

namespace hairloom {
namespace {

using namespace strand_files;
using testing::HasSubstr;

enum class Ends { Open, Lids, FanLids, Tip };

/// Middle of row r of strand s.
Vec3f middleOf(std::size_t s, std::size_t r) {
    return {0.02f * static_cast<float>(s), 1.5f + 0.01f * static_cast<float>(r),
            0.02f * std::sin(0.7f * static_cast<float>(r))};
}

/// Tubes of `sides`, strand s of rows(s) rows, ring after ring or column after column.
std::string tubes(std::size_t strands, std::size_t sides, bool byRing, Ends ends, bool triangles,
                  std::size_t (*rowsOf)(std::size_t)) {
    std::string vertices, faces;
    std::size_t base = 1;
    for (std::size_t s = 0; s < strands; ++s) {
        const std::size_t rows = rowsOf(s);
        const auto at = [&](std::size_t r, std::size_t c) {
            return base + (byRing ? r * sides + c : c * rows + r);
        };
        std::vector<Vec3f> places(rows * sides);
        for (std::size_t r = 0; r < rows; ++r) {
            for (std::size_t c = 0; c < sides; ++c) {
                const float turn = 2 * kPi * static_cast<float>(c) / static_cast<float>(sides);
                places[at(r, c) - base] = middleOf(s, r) + 0.0005f * Vec3f(std::cos(turn), 0, std::sin(turn));
            }
        }
        if (ends == Ends::FanLids) places.push_back(middleOf(s, 0));
        if (ends == Ends::FanLids) places.push_back(middleOf(s, rows - 1));
        if (ends == Ends::Tip) places.push_back(middleOf(s, rows));
        for (const Vec3f& p : places)
            vertices += fmt::format("v {:.9g} {:.9g} {:.9g}\n", p.x(), p.y(), p.z());
        for (std::size_t r = 0; r + 1 < rows; ++r) {
            for (std::size_t c = 0; c < sides; ++c) {
                const std::size_t n = (c + 1) % sides;
                const auto a = at(r, c), b = at(r, n), d = at(r + 1, n), e = at(r + 1, c);
                faces += triangles ? fmt::format("f {} {} {}\nf {} {} {}\n", a, b, d, a, d, e)
                                   : fmt::format("f {} {} {} {}\n", a, b, d, e);
            }
        }
        const std::size_t alone = base + rows * sides;
        for (std::size_t c = 0; c < sides; ++c) {
            const std::size_t n = (c + 1) % sides;
            if (ends == Ends::FanLids)
                faces += fmt::format("f {} {} {}\nf {} {} {}\n", at(0, n), at(0, c), alone, at(rows - 1, c),
                                     at(rows - 1, n), alone + 1);
            if (ends == Ends::Tip)
                faces += fmt::format("f {} {} {}\n", at(rows - 1, c), at(rows - 1, n), alone);
        }
        if (ends == Ends::Lids) {
            for (const std::size_t r : {std::size_t{0}, rows - 1}) {
                faces += "f";
                for (std::size_t c = 0; c < sides; ++c) faces += fmt::format(" {}", at(r, c));
                faces += "\n";
            }
        }
        base += places.size();
    }
    return vertices + faces;
}

std::size_t unlike(std::size_t s) {
    return 6 + s;
}

TEST(StrandTubes, OfAnyNumberOfSidesAndUnlikeLengthAreStrands) {
    for (const std::size_t sides : {3u, 4u, 5u, 6u, 8u, 12u, 16u}) {
        for (const bool byRing : {true, false}) {
            for (const Ends ends : {Ends::Open, Ends::Lids, Ends::FanLids, Ends::Tip}) {
                for (const bool triangles : {false, true}) {
                    const auto imported = read(tubes(5, sides, byRing, ends, triangles, unlike));
                    const auto what = fmt::format("{} sides, rings {}, ends {}, triangles {}", sides, byRing,
                                                  static_cast<int>(ends), triangles);
                    ASSERT_TRUE(imported) << what << ": " << imported.error().message();
                    ASSERT_EQ(imported->groom.strandCount(), 5u) << what;
                    for (std::size_t s = 0; s < 5; ++s) {
                        const std::size_t rows = unlike(s) + (ends == Ends::Tip ? 1 : 0);
                        const auto strand = imported->groom.strand(s);
                        ASSERT_EQ(strand.size(), rows) << what;
                        for (std::size_t r = 0; r < rows; ++r)
                            ASSERT_LT((strand[r] - middleOf(s, r)).norm(), 2e-6f) << what << ", row " << r;
                    }
                    const auto radii = imported->groom.pointAttributes.view<float>(attribute::kRadius);
                    ASSERT_FALSE(radii.empty()) << what;
                    EXPECT_NEAR(radii[0], 0.0005f, 1e-5f) << what;
                    ASSERT_TRUE(imported->ribbons);
                    EXPECT_EQ(imported->ribbons->sides, sides) << what;
                }
            }
        }
    }
}

TEST(StrandTubes, RibbonsOfUnlikeLengthInEachOrder) {
    for (const RibbonOrder order :
         {RibbonOrder::Interleaved, RibbonOrder::EdgeAfterEdge, RibbonOrder::Around}) {
        std::string vertices, faces;
        std::size_t base = 0;
        for (const std::size_t segments : {1u, 3u, 11u, 4u}) {
            std::string text = ribbonObj(1, segments, order);
            for (std::size_t begin = 0; begin < text.size();) {
                const std::size_t end = text.find('\n', begin) + 1;
                std::string line = text.substr(begin, end - begin);
                begin = end;
                if (line[0] == 'v') vertices += line;
                if (line[0] != 'f') continue;
                std::istringstream words(line.substr(1));
                faces += "f";
                for (std::size_t index = 0; words >> index;) faces += fmt::format(" {}", index + base);
                faces += "\n";
            }
            base += 2 * (segments + 1);
        }
        const auto imported = read(vertices + faces);
        ASSERT_TRUE(imported) << imported.error().message();
        EXPECT_EQ(imported->format, "Cinema 4D hair OBJ");
        ASSERT_EQ(imported->groom.strandCount(), 4u);
        const std::size_t points[] = {2, 4, 12, 5};
        for (std::size_t s = 0; s < 4; ++s) {
            ASSERT_EQ(imported->groom.strand(s).size(), points[s]);
            EXPECT_EQ(imported->groom.strand(s).back(), curlPoint(0, points[s] - 1, points[s]));
        }
        EXPECT_EQ(imported->ribbons->order, order);
        EXPECT_EQ(imported->ribbons->fewestSegments, 1u);
        EXPECT_EQ(imported->ribbons->mostSegments, 11u);
    }
}

TEST(StrandTubes, WithoutFacesSegmentsAndOrderAreFoundByDistances) {
    for (const RibbonOrder order :
         {RibbonOrder::Interleaved, RibbonOrder::EdgeAfterEdge, RibbonOrder::Around}) {
        for (const std::size_t segments : {5u, 12u}) {
            const std::size_t rows = segments + 1;
            std::string text;
            const auto left = [](std::size_t s, std::size_t r) {
                const auto along = static_cast<float>(r);
                return Vec3f(0.05f * static_cast<float>(s), -0.02f * along, 0.004f * std::sin(along));
            };
            for (std::size_t s = 0; s < 9; ++s) {
                for (std::size_t v = 0; v < 2 * rows; ++v) {
                    const bool isRight = order == RibbonOrder::Interleaved ? v % 2 == 1 : v >= rows;
                    const std::size_t row = order == RibbonOrder::Interleaved         ? v / 2
                                            : order == RibbonOrder::Around && isRight ? 2 * rows - 1 - v
                                                                                      : v % rows;
                    const Vec3f p = left(s, row) + Vec3f(isRight ? 0.003f : 0.0f, 0, 0);
                    text += fmt::format("v {:.9g} {:.9g} {:.9g}\n", p.x(), p.y(), p.z());
                }
            }
            const auto imported = read(text);
            ASSERT_TRUE(imported) << imported.error().message();
            ASSERT_TRUE(imported->ribbons);
            EXPECT_EQ(imported->ribbons->order, order);
            ASSERT_EQ(imported->groom.strandCount(), 9u);
            for (std::size_t r = 0; r < rows; ++r) EXPECT_EQ(imported->groom.strand(4)[r], left(4, r));
        }
    }
}

TEST(StrandTubes, BallsAndOtherMeshesAreNoHair) {
    // A drum: two rows as far apart as it is wide.
    const auto drum = read(
        "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 1 0\nv 1 1 0\nv 1 1 1\nv 0 1 1\n"
        "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    ASSERT_FALSE(drum);
    EXPECT_THAT(drum.error().message(), HasSubstr("units long and"));
    // A ribbon of one piece has this order of vertices, but also a border.
    const auto tetrahedron =
        read("v 0 0 0\nv 17 0 0\nv 0 17 0\nv 0 0 17\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    ASSERT_FALSE(tetrahedron);
    EXPECT_THAT(tetrahedron.error().message(), HasSubstr("open a head as a head"));
    std::string disc = "v 0 0 0\n", faces;
    for (int i = 0; i < 12; ++i) disc += fmt::format("v {} {} 0\n", std::cos(i), std::sin(i));
    for (int i = 0; i < 11; ++i) faces += fmt::format("f 1 {} {}\n", i + 2, i + 3);
    EXPECT_FALSE(read(disc + faces));
    EXPECT_THAT(read("v 0 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\nv 9 9 9\nf 1 2 3 4\n").error().message(),
                HasSubstr("vertex 5 belongs to no face"));
}

}  // namespace
}  // namespace hairloom
