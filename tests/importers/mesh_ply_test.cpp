// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/ply_mesh.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>

namespace hairloom {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Result<RawScene> read(const std::string& content) {
    return readPlyMesh("x.ply", std::as_bytes(std::span(content)));
}

std::string refusal(const std::string& content) {
    const auto scene = read(content);
    EXPECT_FALSE(scene);
    return scene ? std::string() : scene.error().message();
}

const std::string kHeader =
    "element vertex 4\nproperty float x\nproperty float y\nproperty double z\nproperty uchar red\nproperty "
    "float u\n"
    "property float v\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";

template <class T>
void append(std::string& out, T value, bool big) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    if (big) std::reverse(bytes.begin(), bytes.end());
    out.append(bytes.data(), bytes.size());
}

std::string binary(bool big) {
    std::string out =
        std::string("ply\nformat binary_") + (big ? "big" : "little") + "_endian 1.0\n" + kHeader;
    for (int vertex = 0; vertex < 4; ++vertex) {
        append(out, static_cast<float>(vertex), big);
        append(out, static_cast<float>(vertex * vertex), big);
        append(out, 0.5, big);
        append(out, std::uint8_t{7}, big);
        append(out, 0.25f * static_cast<float>(vertex), big);
        append(out, 1.0f, big);
    }
    append(out, std::uint8_t{4}, big);
    for (int corner = 0; corner < 4; ++corner) append(out, std::int32_t{corner}, big);
    append(out, std::uint8_t{3}, big);
    for (int corner = 0; corner < 3; ++corner) append(out, std::int32_t{corner + 1}, big);
    return out;
}

const std::string kText = "ply\nformat ascii 1.0\ncomment made by hand\n" + kHeader +
                          "0 0 .5 7 0 1\n1 1 .5 7 .25 1\n2 4 .5 7 .5 1\n3 9 .5 7 .75 1\n4 0 1 2 3\n3 1 2 3\n";

TEST(PlyMesh, TextAndBothByteOrdersReadTheSame) {
    for (const std::string& content : {kText, binary(false), binary(true)}) {
        const auto scene = read(content);
        ASSERT_TRUE(scene) << scene.error().message();
        ASSERT_EQ(scene->soup.positions.size(), 4u);
        EXPECT_EQ(scene->soup.positions[3], Vec3f(3, 9, 0.5f));
        EXPECT_THAT(scene->soup.offsets, ElementsAre(0, 4, 7));
        EXPECT_THAT(scene->soup.corners, ElementsAre(0, 1, 2, 3, 1, 2, 3));
        ASSERT_EQ(scene->soup.uvs.size(), 7u);
        EXPECT_EQ(scene->soup.uvs[6], Vec2f(0.75f, 1));
        EXPECT_TRUE(scene->soup.normals.empty());
    }
}

TEST(PlyMesh, EveryTruncationIsRefused) {
    for (const std::string& content : {kText, binary(false)}) {
        const std::size_t last = content.find_last_not_of('\n');
        for (std::size_t length = 0; length < last; ++length) {
            EXPECT_FALSE(read(content.substr(0, length))) << length;
        }
    }
}

TEST(PlyMesh, HostileCountsAreRefusedBeforeAllocation) {
    const std::string vertex = "property float x\nproperty float y\nproperty float z\n";
    EXPECT_THAT(
        refusal("ply\nformat ascii 1.0\nelement vertex 4000000000\n" + vertex + "end_header\n1 2 3\n"),
        HasSubstr("4000000000 rows of 'vertex' were announced"));
    EXPECT_THAT(refusal("ply\nformat ascii 1.0\nelement vertex -1\n" + vertex + "end_header\n"),
                HasSubstr("x.ply:3"));
    EXPECT_THAT(
        refusal("ply\nformat ascii 1.0\nelement vertex 1\n" + vertex +
                "element face 1\nproperty list uint int vertex_index\nend_header\n1 2 3\n4294967295 0 1 2\n"),
        HasSubstr("a list of 4294967295 values"));
    EXPECT_THAT(refusal("ply\nformat ascii 1.0\nelement vertex 1\n" + vertex +
                        "element face 1\nproperty list int int vertex_index\nend_header\n1 2 3\n3 0 -1 0\n"),
                HasSubstr("x.ply:11: a face refers to vertex -1"));
}

TEST(PlyMesh, DamagedHeadersAreReportedWithTheirLine) {
    EXPECT_THAT(refusal("plx\n"), HasSubstr("x.ply:1"));
    EXPECT_THAT(refusal("ply\nformat ascii 2.0\nend_header\n"),
                HasSubstr("x.ply:2: the format is 'ascii 2.0'"));
    EXPECT_THAT(refusal("ply\nformat ascii 1.0\nproperty float x\nend_header\n"),
                HasSubstr("before any element"));
    EXPECT_THAT(refusal("ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\nend_header\n"),
                HasSubstr("x.ply:4: 'real' is not a type"));
    EXPECT_THAT(refusal("ply\nformat ascii 1.0\nelement vertex 1\nproperty list float int x\nend_header\n"),
                HasSubstr("not an integer type"));
    EXPECT_THAT(refusal("ply\nend_header\n"), HasSubstr("has no format"));
    EXPECT_THAT(refusal("ply\nformat ascii 1.0\n"), HasSubstr("no end"));
    EXPECT_THAT(refusal("ply\nformat ascii 1.0\nwhatever\nend_header\n"),
                HasSubstr("x.ply:3: found 'whatever'"));
    EXPECT_THAT(refusal("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n"),
                HasSubstr("without x, y and z"));
}

}  // namespace
}  // namespace hairloom
