// SPDX-License-Identifier: GPL-3.0-or-later
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

}  // namespace
}  // namespace hairloom
