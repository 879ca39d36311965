// SPDX-License-Identifier: GPL-3.0-or-later
// A short run of what ./dev fuzz does at length: seeds of every format, changed by the same random steps each
// time.

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

#include "core/base/random.h"
#include "tests/importers/strands_files.h"
#include "tests/support/source_dir.h"

namespace hairloom {
namespace {

using namespace strand_files;

constexpr std::size_t kLargestSeed = 32 * 1024;
constexpr int kRuns = 400;  ///< of each seed

struct Seed {
    std::string name;
    Bytes bytes;
};

/// Ours, and the small files beside this checkout where there are any.
std::vector<Seed> seeds() {
    std::vector<Seed> seeds{
        {"hair", fullHair(3, 5)},
        {"tfx 4", fullTfx4(3, 4)},
        {"tfx 3", plainTfx3(3, 4)},
        {"ribbons", bytesOf(ribbonObj(2, 3, RibbonOrder::Interleaved))},
        {"curves", bytesOf("v 0 0 0\nv 0 1 0\nv 1 1 0 2\nl 1 2 3\ncstype rat bspline\ndeg 2\n"
                           "curv 0 1 1 2 3\nparm u 0 0 0 1 1 1\nend\n")},
        {"usda", bytesOf("#usda 1.0\n(metersPerUnit = 0.01)\ndef BasisCurves \"h\"\n{\n"
                         "int[] curveVertexCounts = [4]\nuniform token type = \"cubic\"\n"
                         "uniform token wrap = \"pinned\"\npoint3f[] points = [(0, 0, 0), "
                         "(0, 1, 0), (0, 2, 0), (0, 3, 0)]\nfloat[] widths = [1, 2] "
                         "(interpolation = \"varying\")\n}\n")}};
    const auto folder = outsideData() / "strands";
    if (!std::filesystem::exists(folder)) return seeds;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file() || entry.file_size() > kLargestSeed) continue;
        if (auto bytes = readFile(entry.path()))
            seeds.push_back({entry.path().filename().string(), std::move(*bytes)});
    }
    std::ranges::sort(seeds, {}, &Seed::name);
    return seeds;
}

void change(Bytes& bytes, Random& random) {
    const auto below = [&](std::size_t limit) {
        return std::size_t{random.below(static_cast<std::uint32_t>(limit))};
    };
    const std::size_t at = below(bytes.size());
    constexpr std::array<std::uint32_t, 8> kExtremes{0,          1,          0x7fffffff, 0x80000000,
                                                     0xffffffff, 0xfffffffe, 0x7f800000, 0x7fc00000};
    switch (below(5)) {
        case 0:
            bytes[at] ^= static_cast<std::byte>(1u << below(8));
            break;
        case 1:
            bytes[at] = static_cast<std::byte>(below(256));
            break;
        case 2: {
            const std::uint32_t value = kExtremes[below(kExtremes.size())];
            std::memcpy(&bytes[at], &value, std::min(sizeof value, bytes.size() - at));
            break;
        }
        case 3:
            bytes.erase(
                bytes.begin() + static_cast<std::ptrdiff_t>(at),
                bytes.begin() + static_cast<std::ptrdiff_t>(std::min(bytes.size(), at + 1 + below(64))));
            break;
        default: {
            const Bytes copied(
                bytes.begin() + static_cast<std::ptrdiff_t>(at),
                bytes.begin() + static_cast<std::ptrdiff_t>(std::min(bytes.size(), at + 1 + below(64))));
            bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(below(bytes.size())), copied.begin(),
                         copied.end());
        }
    }
}

TEST(StrandsFuzz, ChangedSeedsOfEveryFormatAreReadOrRefused) {
    std::uint64_t stream = 0;
    for (const Seed& seed : seeds()) {
        SCOPED_TRACE(seed.name);
        Random random(1, stream++);
        for (int run = 0; run < kRuns; ++run) {
            Bytes bytes = seed.bytes;
            const std::uint32_t changes = 1 + random.below(6);
            for (std::uint32_t k = 0; k < changes && !bytes.empty(); ++k) change(bytes, random);
            StrandImportOptions options;
            options.frames = run % 2 == 0;
            const auto imported = read(bytes, options);
            if (!imported) {
                EXPECT_FALSE(imported.error().problem.empty());
                continue;
            }
            EXPECT_GT(imported->groom.strandCount(), 0u);
            for (const Vec3f& position : imported->groom.positions()) ASSERT_TRUE(position.allFinite());
        }
    }
}

}  // namespace
}  // namespace hairloom
