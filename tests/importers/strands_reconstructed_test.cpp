// SPDX-License-Identifier: GPL-3.0-or-later
// Hair as those who reconstruct it keep it: points with counts, arrays of NumPy, text without a format's
// name.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "importers/points_per_strand.h"
#include "tests/importers/strands_files.h"

namespace hairloom {
namespace {

using namespace strand_files;
using testing::HasSubstr;

constexpr std::size_t kStrands = 7;

/// Strand s has 4 + s points.
std::size_t pointsOf(std::size_t s) {
    return 4 + s;
}

void writePoint(ByteWriter& writer, std::size_t s, std::size_t i, std::uint32_t numbers) {
    const Vec3f p = curlPoint(s, i, pointsOf(s));
    std::vector<float> all{p.x(), p.y(), p.z(), 0.5f, 0.25f, 0.125f, static_cast<float>(s)};
    if (numbers == 4) all[3] = static_cast<float>(i);
    writer.writeArray(std::span<const float>(all).first(numbers));
}

enum class Counts { Each, Together, WithTotal };

Bytes countedFile(Counts counts, std::uint32_t numbers) {
    ByteWriter writer;
    writer.write(static_cast<std::uint32_t>(kStrands));
    std::uint32_t total = 0;
    for (std::size_t s = 0; s < kStrands; ++s) total += static_cast<std::uint32_t>(pointsOf(s));
    if (counts == Counts::WithTotal) writer.write(total);
    for (std::size_t s = 0; counts != Counts::Each && s < kStrands; ++s)
        writer.write(static_cast<std::uint32_t>(pointsOf(s)));
    for (std::size_t s = 0; s < kStrands; ++s) {
        if (counts == Counts::Each) writer.write(static_cast<std::uint32_t>(pointsOf(s)));
        for (std::size_t i = 0; i < pointsOf(s); ++i) writePoint(writer, s, i, numbers);
    }
    return bytesOf(writer);
}

void expectCurls(const Groom& groom) {
    ASSERT_EQ(groom.strandCount(), kStrands);
    for (std::size_t s = 0; s < kStrands; ++s) {
        ASSERT_EQ(groom.strand(s).size(), pointsOf(s)) << s;
        for (std::size_t i = 0; i < pointsOf(s); ++i)
            EXPECT_LT((groom.strand(s)[i] - curlPoint(s, i, pointsOf(s))).norm(), 1e-6f) << s << ", " << i;
    }
}

bool says(const std::vector<Finding>& findings, std::string_view words) {
    return std::ranges::any_of(findings,
                               [&](const Finding& one) { return one.what.find(words) != one.what.npos; });
}

TEST(StrandsCounted, EveryLayoutIsFoundByTheSizeOfTheFile) {
    for (const Counts counts : {Counts::Each, Counts::Together, Counts::WithTotal}) {
        for (const std::uint32_t numbers : {3u, 4u, 6u, 7u}) {
            const auto imported = read(countedFile(counts, numbers));
            ASSERT_TRUE(imported) << numbers << ": " << imported.error().message();
            EXPECT_EQ(imported->format, "Counted strands");
            EXPECT_TRUE(says(imported->warnings,
                             counts == Counts::Each ? "counts before each strand" : "all counts first"));
            expectCurls(imported->groom);
            const AttributeSet& points = imported->groom.pointAttributes;
            EXPECT_EQ(points.has("direction"), numbers >= 6);
            if (numbers == 7) {
                EXPECT_EQ(points.view<float>("label").back(), 6);
            }
            if (numbers == 4) {
                EXPECT_EQ(points.view<float>("value").back(), 9);
            }
        }
    }
}

TEST(StrandsCounted, OneCountMayStandForAll) {
    ByteWriter writer;
    writer.write(3u);
    writer.write(5u);
    for (std::size_t s = 0; s < 3; ++s) {
        for (std::size_t i = 0; i < 5; ++i) {
            const Vec3f p = curlPoint(s, i, 5);
            writer.writeArray(std::span<const float>(p.data(), 3));
        }
    }
    const auto imported = read(bytesOf(writer));
    ASSERT_TRUE(imported) << imported.error().message();
    ASSERT_EQ(imported->groom.strandCount(), 3u);
    EXPECT_EQ(imported->groom.strand(2)[4], curlPoint(2, 4, 5));
}

TEST(StrandsCounted, WhatWasCutOrAddedToIsRefusedAtTheStrand) {
    const Bytes whole = countedFile(Counts::Each, 7);
    Bytes cut(whole.begin(), whole.end() - 10), longer = whole;
    longer.resize(longer.size() + 3);
    for (const Bytes& bytes : {cut, longer}) {
        const auto imported = read(bytes);
        ASSERT_FALSE(imported);
        EXPECT_THAT(imported.error().message(),
                    HasSubstr("announces 7 strands with position, direction and label"));
    }
    // A count that no file could bear out.
    ByteWriter huge;
    huge.write(2u);
    huge.write(0xfffffff0u);
    huge.write(1.0f);
    huge.write(1.0f);
    EXPECT_FALSE(read(bytesOf(huge)));
}

TEST(StrandsCounted, AFewPointsThatAreNoNumbersDoNotHideTheFormat) {
    Bytes bytes = countedFile(Counts::Each, 3);
    const float none = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(bytes.data() + 8, &none, sizeof none);
    const auto imported = read(bytes);
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_EQ(imported->groom.strandCount(), kStrands - 1);
    ASSERT_EQ(imported->dropped.size(), 1u);
    EXPECT_EQ(imported->dropped[0].reason, DropReason::NotFinite);
}

TEST(PointsPerStrand, AreFoundWhereDistancesTellThem) {
    for (const std::size_t size : {6u, 25u, 64u, 100u})
        EXPECT_EQ(guessPointsPerStrand(runsOf(24, size)), size);
    EXPECT_EQ(guessPointsPerStrand(runsOf(1, 100)), 0u) << "one strand is a strand of any length";
    std::vector<Vec3f> cloud;
    for (int i = 0; i < 600; ++i)
        cloud.emplace_back(std::sin(static_cast<float>(i * i)), std::cos(7.0f * static_cast<float>(i)), 0);
    EXPECT_EQ(guessPointsPerStrand(cloud), 0u);
    EXPECT_EQ(guessPointsPerStrand({}), 0u);
}

/// As reconstructions leave them: each 24th strand jumps by more than it is away from others.
TEST(PointsPerStrand, AreFoundAmongStrandsThatJump) {
    for (const std::size_t size : {24u, 100u}) {
        std::vector<Vec3f> points = runsOf(240, size);
        for (std::size_t s = 0; s < 240; s += 24) {
            for (std::size_t i = size / 2; i < size; ++i) points[s * size + i].z() += 0.3f;
        }
        EXPECT_EQ(guessPointsPerStrand(points), size);
    }
}

Bytes npy(const std::string& type, const std::string& shape, const ByteWriter& data, bool isFortran = false) {
    std::string head = fmt::format("{{'descr': '{}', 'fortran_order': {}, 'shape': {}, }}", type,
                                   isFortran ? "True" : "False", shape);
    head.resize((head.size() + 11 + 63) / 64 * 64 - 11, ' ');
    head += '\n';
    ByteWriter writer;
    writer.writeArray(std::span<const char>("\x93NUMPY\x01", 7));
    writer.write(std::uint8_t{0});
    writer.write(static_cast<std::uint16_t>(head.size()));
    writer.writeArray(std::span<const char>(head));
    writer.writeArray(data.bytes());
    return bytesOf(writer);
}

struct Member {
    std::string name;
    Bytes bytes;
    bool isDeflated = false;
};

Bytes zipOf(const std::vector<Member>& members) {
    ByteWriter zip, directory;
    for (const Member& member : members) {
        Bytes packed = member.bytes;
        if (member.isDeflated) {
            z_stream stream{};
            deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
            packed.resize(deflateBound(&stream, static_cast<uLong>(member.bytes.size())));
            stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(member.bytes.data()));
            stream.avail_in = static_cast<uInt>(member.bytes.size());
            stream.next_out = reinterpret_cast<Bytef*>(packed.data());
            stream.avail_out = static_cast<uInt>(packed.size());
            deflate(&stream, Z_FINISH);
            packed.resize(stream.total_out);
            deflateEnd(&stream);
        }
        const auto checksum = static_cast<std::uint32_t>(crc32(
            0, reinterpret_cast<const Bytef*>(member.bytes.data()), static_cast<uInt>(member.bytes.size())));
        const auto at = static_cast<std::uint32_t>(zip.size());
        const auto common = [&](ByteWriter& to) {
            to.write(std::uint16_t{20});
            to.write(std::uint16_t{0});
            to.write(static_cast<std::uint16_t>(member.isDeflated ? 8 : 0));
            to.write(0u);
            to.write(checksum);
            to.write(static_cast<std::uint32_t>(packed.size()));
            to.write(static_cast<std::uint32_t>(member.bytes.size()));
            to.write(static_cast<std::uint16_t>(member.name.size()));
            to.write(std::uint16_t{0});
        };
        zip.write(0x04034b50u);
        common(zip);
        zip.writeArray(std::span<const char>(member.name));
        zip.writeArray(std::span<const std::byte>(packed));
        directory.write(0x02014b50u);
        directory.write(std::uint16_t{20});
        common(directory);
        for (int i = 0; i < 5; ++i) directory.write(std::uint16_t{0});
        directory.write(at);
        directory.writeArray(std::span<const char>(member.name));
    }
    const auto begin = static_cast<std::uint32_t>(zip.size());
    zip.writeArray(directory.bytes());
    zip.write(0x06054b50u);
    zip.write(0u);
    zip.write(static_cast<std::uint16_t>(members.size()));
    zip.write(static_cast<std::uint16_t>(members.size()));
    zip.write(static_cast<std::uint32_t>(directory.size()));
    zip.write(begin);
    zip.write(std::uint16_t{0});
    return bytesOf(zip);
}

/// Seven strands of five points as doubles, also with the first axis fastest.
ByteWriter cube(bool isFortran) {
    ByteWriter data;
    const auto value = [](std::size_t s, std::size_t i, int c) { return double{curlPoint(s, i, 5)[c]}; };
    if (!isFortran) {
        for (std::size_t s = 0; s < 7; ++s)
            for (std::size_t i = 0; i < 5; ++i)
                for (int c = 0; c < 3; ++c) data.write(value(s, i, c));
    } else {
        for (int c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < 5; ++i)
                for (std::size_t s = 0; s < 7; ++s) data.write(value(s, i, c));
    }
    return data;
}

TEST(StrandsNumpy, StrandsByPointsByCoordinates) {
    for (const bool isFortran : {false, true}) {
        const Bytes array = npy("<f8", "(7, 5, 3)", cube(isFortran), isFortran);
        ByteWriter labels;
        for (std::int64_t s = 0; s < 7; ++s) labels.write(10 * s);
        const Bytes more = npy("<i8", "(7,)", labels);
        for (const Bytes& file :
             {array, zipOf({{"strands.npy", array, true}, {"cluster.npy", more, false}})}) {
            const auto imported = read(file);
            ASSERT_TRUE(imported) << imported.error().message();
            EXPECT_EQ(imported->format, "NumPy strands");
            ASSERT_EQ(imported->groom.strandCount(), 7u);
            for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(imported->groom.strand(3)[i], curlPoint(3, i, 5));
        }
    }
}

TEST(StrandsNumpy, APointBeyondAKilometreIsRefusedWithItsStrandOfCountedStrandsToo) {
    Bytes array = npy("<f8", "(7, 5, 3)", cube(false)), counted = countedFile(Counts::Together, 3);
    const double far = 1e6;
    const auto farther = static_cast<float>(1e30);
    std::memcpy(array.data() + array.size() - sizeof far, &far, sizeof far);
    std::memcpy(counted.data() + counted.size() - sizeof farther, &farther, sizeof farther);
    for (const Bytes& file : {array, zipOf({{"strands.npy", array, true}}), counted}) {
        const auto imported = read(file);
        ASSERT_FALSE(imported);
        EXPECT_THAT(imported.error().message(), HasSubstr("1000 m"));
        EXPECT_THAT(imported.error().message(), HasSubstr("strand 6"));
    }
}

TEST(StrandsNumpy, PointsWithCountsOffsetsOrNumbersOfStrands) {
    ByteWriter points, counts, offsets, numbers;
    std::int64_t begin = 0;
    offsets.write(begin);
    for (std::size_t s = 0; s < kStrands; ++s) {
        counts.write(static_cast<std::int32_t>(pointsOf(s)));
        begin += static_cast<std::int64_t>(pointsOf(s));
        offsets.write(begin);
        for (std::size_t i = 0; i < pointsOf(s); ++i) {
            const Vec3f p = curlPoint(s, i, pointsOf(s));
            points.writeArray(std::span<const float>(p.data(), 3));
            numbers.write(static_cast<std::uint16_t>(s));
        }
    }
    const Bytes places = npy("<f4", fmt::format("({}, 3)", begin), points);
    for (const Bytes& how : {npy("<i4", "(7,)", counts), npy("<i8", "(8,)", offsets),
                             npy("<u2", fmt::format("({},)", begin), numbers)}) {
        const auto imported = read(zipOf({{"xyz.npy", places}, {"how.npy", how, true}}));
        ASSERT_TRUE(imported) << imported.error().message();
        expectCurls(imported->groom);
    }
}

TEST(StrandsNumpy, PaddingBehindAStrandIsNoPoint) {
    ByteWriter data;
    for (std::size_t s = 0; s < kStrands; ++s) {
        for (std::size_t i = 0; i < 12; ++i) {
            const Vec3f p = i < pointsOf(s) ? curlPoint(s, i, pointsOf(s))
                                            : Vec3f(Vec3f::Constant(std::numeric_limits<float>::quiet_NaN()));
            data.writeArray(std::span<const float>(p.data(), 3));
        }
    }
    const auto imported = read(npy("<f4", "(1, 7, 12, 3)", data));
    ASSERT_TRUE(imported) << imported.error().message();
    expectCurls(imported->groom);
}

TEST(StrandsNumpy, WhatIsNoHairIsNamed) {
    const auto refusal = [](const Bytes& bytes) {
        const auto imported = read(bytes);
        return imported ? std::string() : imported.error().message();
    };
    EXPECT_THAT(refusal(npy("|O", "(7,)", {})), HasSubstr("pickle"));
    EXPECT_THAT(refusal(zipOf({{"strands.npy", npy("|O", "(7,)", {})}})), HasSubstr("pickle"));
    EXPECT_THAT(refusal(npy("<f4", "(1000000000, 1000000000, 3)", cube(false))), HasSubstr("announces"));
    EXPECT_THAT(refusal(zipOf({{"a.npy", npy("<f8", "(7, 5, 3)", cube(false))},
                               {"b.npy", npy("<f8", "(7, 5, 3)", cube(false))}})),
                HasSubstr("a (7, 5, 3), b (7, 5, 3)"));
    Bytes damaged = zipOf({{"strands.npy", npy("<f8", "(7, 5, 3)", cube(false))}});
    damaged[400] ^= std::byte{1};
    EXPECT_THAT(refusal(damaged), HasSubstr("checksum"));
    const Bytes whole = zipOf({{"strands.npy", npy("<f8", "(7, 5, 3)", cube(false)), true}});
    for (std::size_t length = 0; length < whole.size(); length += 7)
        EXPECT_FALSE(read(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length))))
            << length;
    for (std::size_t at = 0; at < whole.size(); ++at) {
        Bytes changed = whole;
        changed[at] ^= std::byte{0xff};
        read(changed);  // whatever comes of it, it comes to an end
    }
}

TEST(StrandsText, TressFx2) {
    const std::string head = "version 2.0\nscale 1.0\nrotation 0 0 0\ntranslation 0 0 0\nnumStrands 2\n";
    const std::string one = "strand 0 numVerts 3 texcoord 0.25 0.5\n0, 0, 0\n0, 0.1, 0\n0.0,0.2,0.5\n";
    const std::string two = "strand 1 numVerts 2 texcoord 0.75 0.5\n1 0 0\n1 0.1 0\n";
    const auto imported = read(head + one + two);
    ASSERT_TRUE(imported) << imported.error().message();
    ASSERT_EQ(imported->groom.strandCount(), 2u);
    EXPECT_EQ(imported->groom.strand(0)[2], Vec3f(0, 0.2f, 0.5f));
    EXPECT_EQ(imported->groom.strandAttributes.view<Vec2f>(attribute::kRootUv)[1], Vec2f(0.75f, 0.5f));
    const auto refusal = [](const std::string& text) {
        const auto read = strand_files::read(text);
        return read ? std::string() : read.error().message();
    };
    EXPECT_THAT(refusal(head + one), HasSubstr("numStrands says 2"));
    EXPECT_THAT(refusal(head + one + "strand 1 numVerts 3 texcoord 0 0\n1.000 0.000 0.000\n"),
                HasSubstr("after 1 vertices"));
    EXPECT_THAT(refusal(head + "strand 0 numVerts 2 texcoord 0 0\n1 0 zero\n1 1 1\n"),
                HasSubstr("test:7: 'zero' is no coordinate"));
    EXPECT_THAT(refusal(head + "strand 0 numVerts 4000000000 texcoord 0 0\n"), HasSubstr("bytes are left"));
    const auto moved = read("version 2.0\nscale 2\nrotation 0 0 90\ntranslation 1 0 0\n" + one);
    ASSERT_TRUE(moved);
    EXPECT_LT((moved->groom.strand(0)[1] - Vec3f(0.8f, 0, 0)).norm(), 1e-6f);
}

TEST(StrandsText, TressFxMayBeginWithAnyOfItsHead) {
    const std::string strand = "strand 0 numVerts 2\n0 0 0\n0 0.1 0\n";
    for (const std::string head : {"", "numStrands 1\r\n", "# made by a script\nscale 1\nnumStrands 1\n"}) {
        const auto imported = read(head + strand);
        ASSERT_TRUE(imported) << head << ": " << imported.error().message();
        EXPECT_EQ(imported->format, "TressFX 2 text");
        EXPECT_EQ(imported->groom.strandCount(), 1u);
    }
}

TEST(StrandsText, MitsubaPointsWithEmptyLinesBetweenStrands) {
    const auto imported = read("0 0 0\n0 0.1 0\n0 0.2 0\n\n\n1 0 0\r\n1 0.1 0\r\n");
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_EQ(imported->format, "Mitsuba hair");
    ASSERT_EQ(imported->groom.strandCount(), 2u);
    EXPECT_EQ(imported->groom.strand(0).size(), 3u);
    const auto radii = read("# curves\n0 0 0 0.001\n0 0.1 0 0.0005\n\n1 0 0 1e-3\n1 0.1 0 0\n");
    ASSERT_TRUE(radii) << radii.error().message();
    EXPECT_FLOAT_EQ(radii->groom.pointAttributes.view<float>(attribute::kRadius)[1], 0.0005f);
    EXPECT_FALSE(says(radii->warnings, "no end"));
    EXPECT_FALSE(read("0 0 0 1\n0 0.1 0\n"));
    const auto cut = read("0 0 0\n0 0.1 0\n\n1 0 0\n1 0.1 0.0");
    ASSERT_TRUE(cut) << cut.error().message();
    EXPECT_TRUE(says(cut->warnings, "the last line has no end"));
    EXPECT_FALSE(read("0 0\n0 0.1\n"));
}

TEST(StrandsText, MitsubaBinary) {
    ByteWriter writer;
    writer.writeArray(std::span<const char>("BINARY_HAIR", 11));
    writer.write(5u);
    const float mark = std::numeric_limits<float>::infinity();
    for (const float value :
         {mark, 0.f, 0.f, 0.f, 0.f, .1f, 0.f, 0.f, .2f, 0.f, mark, 1.f, 0.f, 0.f, 1.f, .1f, 0.f})
        writer.write(value);
    const auto imported = read(bytesOf(writer));
    ASSERT_TRUE(imported) << imported.error().message();
    ASSERT_EQ(imported->groom.strandCount(), 2u);
    EXPECT_EQ(imported->groom.strand(1)[1], Vec3f(1, 0.1f, 0));
    Bytes huge = bytesOf(writer);
    std::memset(huge.data() + 11, 0xff, 4);
    EXPECT_THAT(read(huge).error().message(), HasSubstr("announces 4294967295 points"));
}

TEST(StrandsText, PbrtPiecesBecomeOneStrandBelowTheirTransforms) {
    // A strand of two cubic pieces, one of its own, and a B-spline, all moved by one.
    const std::string scene =
        "LookAt 0 0 5  0 0 0  0 1 0\nWorldBegin\nAttributeBegin\n  Translate 1 0 0 # comment\n"
        "Shape \"curve\" \"string type\" [ \"cylinder\" ] \"point3 P\" [ 0 0 0  0 .1 0  0 .2 0  0 .3 0 ]\n"
        "  \"float width0\" 0.002 \"float width1\" [ 0.001 ]\n"
        "Shape \"curve\" \"point P\" [ 0 .3 0  0 .4 0  0 .5 0  0 .6 0 ] \"float width\" [0.001]\n"
        "Shape \"curve\" \"point P\" [ 5 0 0  5 .1 0  5 .2 0  5 .3 0 ]\n"
        "AttributeEnd\nShape \"sphere\" \"float radius\" 1\n"
        "Shape \"curve\" \"string basis\" \"bspline\" \"point3 P\" [ 0 0 0 0 1 0 0 2 0 0 3 0 0 4 0 ]\n";
    const auto imported = read(scene);
    ASSERT_TRUE(imported) << imported.error().message();
    EXPECT_EQ(imported->format, "pbrt curves");
    ASSERT_EQ(imported->groom.strandCount(), 3u);
    const auto first = imported->groom.strand(0);
    EXPECT_EQ(first.size(), 7u);
    EXPECT_LT((first.front() - Vec3f(1, 0, 0)).norm(), 1e-6f);
    EXPECT_LT((first.back() - Vec3f(1, 0.6f, 0)).norm(), 1e-6f);
    EXPECT_FLOAT_EQ(imported->groom.pointAttributes.view<float>(attribute::kRadius)[0], 0.001f);
    EXPECT_LT((imported->groom.strand(1).front() - Vec3f(6, 0, 0)).norm(), 1e-6f);
    EXPECT_LT((imported->groom.strand(2).front() - Vec3f(0, 1, 0)).norm(), 1e-6f);
    const auto refusal = [](const std::string& text) {
        const auto read = strand_files::read(text);
        return read ? std::string() : read.error().message();
    };
    EXPECT_THAT(refusal("Shape \"curve\" \"point P\" [ 0 0 0  0 .1 0 ]"), HasSubstr("a curve of 6 numbers"));
    EXPECT_THAT(refusal("\nShape \"curve\" \"point P\" [ 0 0 x ]"),
                HasSubstr("test:2: 'x' in P is no number"));
    EXPECT_THAT(refusal("Shape \"curve\" \"point P\" [ 0 0 0"), HasSubstr("has no end"));
    EXPECT_THAT(refusal("AttributeEnd Shape \"curve\""), HasSubstr("ends what did not begin"));
}

}  // namespace
}  // namespace hairloom
