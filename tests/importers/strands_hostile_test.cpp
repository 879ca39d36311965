// SPDX-License-Identifier: GPL-3.0-or-later
// Damaged and malicious files: an error or a groom that holds together, never a crash or a large allocation.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <ctime>

#include "core/base/random.h"
#include "tests/importers/strands_files.h"

namespace hairloom {
namespace {

using namespace strand_files;

/// What every importer promises whatever it is given.
void expectSoundOrRefused(const Bytes& bytes, const StrandImportOptions& options = {}) {
    const auto imported = read(bytes, options);
    if (!imported) {
        EXPECT_FALSE(imported.error().problem.empty());
        return;
    }
    const Groom& groom = imported->groom;
    ASSERT_GT(groom.strandCount(), 0u);
    ASSERT_EQ(groom.positions().size(), groom.pointCount());
    // Nothing can come out that was not in the file: a point takes at least two bytes.
    ASSERT_LE(groom.pointCount() * 2, bytes.size());
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        ASSERT_LT(groom.offsets[s] + 1, groom.offsets[s + 1]);
        for (const Vec3f& point : groom.strand(s)) ASSERT_TRUE(point.allFinite());
    }
}

std::vector<Bytes> samples() {
    return {
        fullHair(4, 5),
        fullTfx4(4, 4),
        plainTfx3(4, 4),
        bytesOf(ribbonObj(3, 4, RibbonOrder::Interleaved)),
        bytesOf(ribbonObj(3, 4, RibbonOrder::EdgeAfterEdge, RibbonFaces::Triangles)),
        bytesOf("v 0 0 0\nv 0 .1 0\nv 0 .2 0\nl 1 2 3\nl 3 2 1\nl -1 -2\n"),
        bytesOf("#usda 1.0\n(\n    metersPerUnit = +1\n    upAxis = \"Y\"\n)\ndef BasisCurves \"hair\"\n{\n"
                "    int[] curveVertexCounts = [3]\n"
                "    point3f[] points = [(0, 0, 0), (0, 0.1, 0), (0, 0.2, 0)]\n}\n")};
}

TEST(StrandsHostile, EveryTruncation) {
    for (const Bytes& whole : samples()) {
        for (std::size_t length = 0; length < whole.size(); ++length) {
            expectSoundOrRefused(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)));
        }
    }
}

TEST(StrandsHostile, TruncatedBinariesAreRefused) {
    for (const Bytes& whole : {fullHair(4, 5), fullTfx4(4, 4), plainTfx3(4, 4)}) {
        for (std::size_t length = 0; length < whole.size(); ++length) {
            EXPECT_FALSE(read(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length))))
                << length;
        }
    }
}

TEST(StrandsHostile, EveryBitOfTheHeadersFlipped) {
    for (const Bytes& whole : samples()) {
        const std::size_t end = std::min<std::size_t>(whole.size(), 340);
        for (std::size_t bit = 0; bit < end * 8; ++bit) {
            Bytes damaged = whole;
            damaged[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
            expectSoundOrRefused(damaged);
        }
    }
}

TEST(StrandsHostile, ExtremeHeaderFields) {
    for (const Bytes& whole : {fullHair(4, 5), fullTfx4(4, 4), plainTfx3(4, 4)}) {
        for (std::size_t field = 0; field + 4 <= std::min<std::size_t>(whole.size(), 296); field += 4) {
            for (const std::uint32_t value :
                 {0u, 1u, 0x7FFFFFFFu, 0x80000000u, 0xFFFFFFFFu, 0xFFFFFFF0u, 0x7FC00000u}) {
                Bytes damaged = whole;
                std::memcpy(damaged.data() + field, &value, sizeof value);
                expectSoundOrRefused(damaged);
            }
        }
    }
}

TEST(StrandsHostile, RandomBytesBehindEveryMagic) {
    Random random(7);
    for (const Bytes& whole : samples()) {
        for (int round = 0; round < 300; ++round) {
            Bytes damaged = whole;
            const std::uint32_t hits = 1 + random.below(20);
            for (std::uint32_t hit = 0; hit < hits; ++hit) {
                damaged[4 + random.below(static_cast<std::uint32_t>(damaged.size() - 4))] =
                    static_cast<std::byte>(random.below(256));
            }
            expectSoundOrRefused(damaged);
        }
    }
}

TEST(StrandsHostile, TextGarbage) {
    Random random(8);
    const std::string_view alphabet = "vlf \n\\-+0123456789./eE#ncurvdeg\r\t";
    for (int round = 0; round < 3000; ++round) {
        std::string text = "v 0 0 0\nv 0 1 0\nv 1 1 0\n";
        const std::uint32_t length = random.below(200);
        for (std::uint32_t i = 0; i < length; ++i) {
            text += alphabet[random.below(static_cast<std::uint32_t>(alphabet.size()))];
        }
        expectSoundOrRefused(bytesOf(text));
    }
}

TEST(StrandsHostile, VeryLongLines) {
    std::string text = "v 0 0 0\nv 0 .1 0\nl";
    for (int i = 0; i < 1000000; ++i) text += i % 2 ? " 2" : " 1";
    expectSoundOrRefused(bytesOf(text));
    expectSoundOrRefused(bytesOf("v " + std::string(5000000, '9')));
    expectSoundOrRefused(bytesOf("v 0 0 0\nl " + std::string(1000000, '1')));
    expectSoundOrRefused(bytesOf(std::string(1000000, '\\')));
    expectSoundOrRefused(
        bytesOf("v 1e999 -1e999 1e-999\nv 0 0 0\nv nan inf 0\nv 1e38 1e38 1e38\nl 1 2\nl 2 3\nl 2 4\n"));
}

TEST(StrandsHostile, ManySegmentsAtOneVertexTakeLinearTime) {
    const auto secondsFor = [](int segments) {
        std::string text = "v 0 0 0\n";
        for (int i = 0; i < segments; ++i) text += fmt::format("v {} 1 0\n", i);
        for (int i = 0; i < segments; ++i) text += fmt::format("l 1 {}\n", i + 2);
        const Bytes file = bytesOf(text);
        const std::clock_t begin = std::clock();  // processor time: other programs do not count
        expectSoundOrRefused(file);
        return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    };
    const double few = secondsFor(20'000), many = secondsFor(160'000);
    EXPECT_LT(many, 24 * few) << "eight times as many segments; 64 times as long were the square";
}

TEST(StrandsHostile, SegmentOptionOutOfProportion) {
    StrandImportOptions options;
    options.ribbonSegments = 0xFFFFFFFFu;
    expectSoundOrRefused(bytesOf(ribbonObj(2, 3, RibbonOrder::Interleaved)), options);
    options.ribbonSegments = 3;
    options.metresPerUnit = 0;
    EXPECT_FALSE(read(ribbonObj(2, 3, RibbonOrder::Interleaved), options));
}

TEST(StrandsHostile, MissingFileIsAnError) {
    const auto imported = importStrands("no/such/file.hair");
    ASSERT_FALSE(imported);
    EXPECT_NE(imported.error().message().find("no such file"), std::string::npos);
}

}  // namespace
}  // namespace hairloom
