// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/importers/strands_files.h"

namespace hairloom {
namespace {

using namespace strand_files;
using testing::HasSubstr;

const std::string kVertices =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float radius\nproperty float "
    "wet\n";
const std::string kRows = "0 0 0 255 0 0 0.001 1\n0 0.1 0 0 255 0 0.002 2\n0 0.2 0 0 0 255 0.003 3\n";

void expectStrand(const std::string& element, const std::string& row) {
    const auto imported = read(kVertices + element + "end_header\n" + kRows + row);
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_EQ(imported->format, "PLY strands");
    const Groom& groom = imported->groom;
    ASSERT_EQ(groom.strandCount(), 1u);
    ASSERT_EQ(groom.pointCount(), 3u);
    EXPECT_EQ(groom.positions()[2], Vec3f(0, 0.2f, 0));
    EXPECT_FLOAT_EQ(groom.pointAttributes.view<float>(attribute::kRadius)[1], 0.002f);
    EXPECT_EQ(groom.pointAttributes.view<Vec3f>(attribute::kPointColour)[1], Vec3f(0, 1, 0));
    EXPECT_EQ(groom.pointAttributes.view<float>("wet")[2], 3);
}

TEST(StrandsPly, ListsAndEdgesAreStrandsWithTheirPointsValues) {
    expectStrand("element strand 1\nproperty list uchar int vertex_indices\n", "3 0 1 2\n");
    expectStrand("element edge 2\nproperty int vertex1\nproperty int vertex2\n", "1 2\n0 1\n");
}

TEST(StrandsPly, AStrandWithoutPointsHasNoValues) {
    // Ids and root UVs of points are their strand's by the first of them, also where the last strand has
    // none.
    const auto imported = read(
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
        "property float groom_id\nproperty float groom_guide\nelement strand 2\n"
        "property list uchar int vertex_indices\nend_header\n0 0 0 7 1\n0 0.1 0 7 1\n2 0 1\n0\n");
    ASSERT_TRUE(imported) << imported.error().message();
    ASSERT_EQ(imported->groom.strandCount(), 1u);
    ASSERT_EQ(imported->dropped.size(), 1u);
    EXPECT_EQ(imported->groom.strandAttributes.view<std::uint32_t>(attribute::kStrandId)[0], 7u);
    EXPECT_EQ(imported->groom.strandAttributes.view<std::uint8_t>(attribute::kGuide)[0], 1);
}

TEST(StrandsPly, WhatContradictsItselfIsRefused) {
    const auto refusal = [](const std::string& element, const std::string& row) {
        const auto imported = read(kVertices + element + "end_header\n" + kRows + row);
        return imported ? std::string() : imported.error().message();
    };
    const std::string list = "element strand 1\nproperty list uchar int vertex_indices\n";
    EXPECT_THAT(refusal(list, "3 0 1 7\n"), HasSubstr("refers to a vertex that does not exist; there are 3"));
    EXPECT_THAT(refusal(list, "3 0 1 -1\n"), HasSubstr("refers to vertex -1"));
    EXPECT_THAT(refusal(list, "200 0 1 2\n"), HasSubstr("a list of 200 values"));
    EXPECT_THAT(refusal("element vertex 1\nproperty float x\n", "1\n"), HasSubstr("in two elements"));
    EXPECT_THAT(refusal("", ""), HasSubstr("without strands"));
}

std::string plyOf(std::span<const Vec3f> points, const std::string& more = {}, const std::string& rows = {}) {
    std::string text = fmt::format(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float "
        "z\n{}end_header\n",
        points.size(), more);
    for (const Vec3f& p : points) text += fmt::format("{:.9g} {:.9g} {:.9g}\n", p.x(), p.y(), p.z());
    return text + rows;
}

TEST(StrandsPlyPoints, AreCutByOptionByDistanceOrByCounts) {
    const std::vector<Vec3f> points = runsOf(12, 20);
    const auto guessed = read(plyOf(points));
    ASSERT_TRUE(guessed) << guessed.error().message();
    EXPECT_EQ(guessed->groom.strandCount(), 12u);
    EXPECT_THAT(guessed->warnings.front().what, HasSubstr("20 points each"));
    StrandImportOptions options;
    options.pointsPerStrand = 40;
    const auto asked = read(plyOf(points), options);
    ASSERT_TRUE(asked);
    EXPECT_EQ(asked->groom.strandCount(), 6u);
    options.pointsPerStrand = 7;
    const auto wrong = read(plyOf(points), options);
    ASSERT_FALSE(wrong);
    EXPECT_THAT(wrong.error().message(), HasSubstr("240 points, no multiple of 7"));
    const auto counted = read(plyOf(points, "element strand 3\nproperty int count\n", "100\n100\n40\n"));
    ASSERT_TRUE(counted) << counted.error().message();
    EXPECT_EQ(counted->groom.strand(2).size(), 40u);
    const auto contradicts = read(plyOf(points, "element strand 2\nproperty int count\n", "100\n100\n"));
    ASSERT_FALSE(contradicts);
    EXPECT_THAT(contradicts.error().message(), HasSubstr("200 points together; there are 240"));
}

TEST(StrandsPlyPoints, CountsAreTheNumbersThatAddUpToTheVertices) {
    const std::vector<Vec3f> points = runsOf(12, 20);
    const auto counted = read(
        plyOf(points, "element curve 3\nproperty int first\nproperty int cv_total\nproperty float label\n",
              "0 100 0.5\n100 100 0.25\n200 40 0.125\n"));
    ASSERT_TRUE(counted) << counted.error().message();
    ASSERT_EQ(counted->groom.strandCount(), 3u);
    EXPECT_EQ(counted->groom.strand(2).size(), 40u);
    EXPECT_THAT(counted->groom.strandAttributes.view<float>("label"),
                testing::ElementsAre(0.5f, 0.25f, 0.125f));
    EXPECT_FALSE(counted->groom.strandAttributes.has("cv_total"));
    // Strands that say nothing of their points: these are cut as if they stood alone.
    const auto uncounted = read(
        plyOf(points, "element strand 12\nproperty float label\n", "0\n1\n2\n3\n4\n5\n6\n7\n8\n9\n10\n11\n"));
    ASSERT_TRUE(uncounted) << uncounted.error().message();
    ASSERT_EQ(uncounted->groom.strandCount(), 12u);
    EXPECT_EQ(uncounted->groom.strandAttributes.view<float>("label")[7], 7);
    const auto twice = read(plyOf(
        points, "element strand 1\nproperty int count\nelement hair 1\nproperty int n\n", "240\n240\n"));
    ASSERT_FALSE(twice);
    EXPECT_THAT(twice.error().message(), HasSubstr("in two elements"));
}

TEST(StrandsPlyPoints, PointsOfAStrandAreGatheredByItsNumber) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float "
        "z\nproperty "
        "float width\nproperty int StrandID\nend_header\n";
    // One point of each strand after the other.
    for (int i = 0; i < 4; ++i) text += fmt::format("0 0.{} 0 0.001 7\n1 0.{} 0 0.002 3\n", i, i);
    const auto imported = read(text);
    ASSERT_TRUE(imported) << imported.error().message();
    ASSERT_EQ(imported->groom.strandCount(), 2u);
    EXPECT_EQ(imported->groom.strand(0)[3], Vec3f(0, 0.3f, 0));
    EXPECT_EQ(imported->groom.strand(1)[0], Vec3f(1, 0, 0));
    EXPECT_FLOAT_EQ(imported->groom.pointAttributes.view<float>(attribute::kRadius)[3], 0.0005f);
    EXPECT_THAT(imported->warnings.front().what, HasSubstr("gathered"));
}

TEST(StrandsPlyPoints, ACloudAndAMeshAreNoStrands) {
    const auto cloud = read(plyOf(std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 3, 0}, {9, 1, 0}, {2, 2, 2}}));
    ASSERT_FALSE(cloud);
    EXPECT_THAT(cloud.error().message(), HasSubstr("--points-per-strand"));
    const auto mesh =
        read(plyOf(runsOf(12, 20), "element face 1\nproperty list uchar int vertex_indices\n", "3 0 1 2\n"));
    ASSERT_FALSE(mesh);
    EXPECT_THAT(mesh.error().message(), HasSubstr("it has faces"));
}

}  // namespace
}  // namespace hairloom
