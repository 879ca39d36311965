// SPDX-License-Identifier: GPL-3.0-or-later
// Heads and tables of OpenEXR, written here number by number.
#include "core/render/exr_head.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/render/exr.h"

namespace hairloom::render {
namespace {

using testing::HasSubstr;

/// A file of 3 × 4 pixels without packing, whose values say where they are.
struct Exr {
    std::uint32_t flags = 2;
    std::string compression = std::string(1, '\0'), lineOrder = std::string(1, '\0');
    std::vector<std::pair<std::string, std::uint32_t>> channels{{"B", 2}, {"G", 2}, {"R", 2}};
    std::int32_t sampling = 1, left = -1, top = 5;
    std::string channelsEnd = std::string(1, '\0');
    std::vector<std::string> more{};            ///< attributes, whole
    std::function<void(std::string&)> table{};  ///< changes what follows the head
    std::size_t head = 0;                       ///< bytes, once made

    template <class T>
    static std::string bytesOf(T value) {
        std::string bytes(sizeof value, '\0');
        std::memcpy(bytes.data(), &value, sizeof value);
        return bytes;
    }
    static std::string attribute(const std::string& name, const std::string& type,
                                 const std::string& content) {
        return name + '\0' + type + '\0' + bytesOf(static_cast<std::uint32_t>(content.size())) + content;
    }
    static float value(int x, int y, std::size_t channel) {
        return static_cast<float>(100 * y + 10 * x) + static_cast<float>(channel);
    }

    std::string make() {
        constexpr int kWidth = 3, kHeight = 4;
        std::string list;
        for (const auto& [name, type] : channels)
            list += name + '\0' + bytesOf(type) + bytesOf(0u) + bytesOf(sampling) + bytesOf(sampling);
        const std::string window =
            bytesOf(left) + bytesOf(top) + bytesOf(left + kWidth - 1) + bytesOf(top + kHeight - 1);
        std::string file =
            bytesOf(20000630u) + bytesOf(flags) + attribute("channels", "chlist", list + channelsEnd) +
            attribute("compression", "compression", compression) + attribute("dataWindow", "box2i", window) +
            attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", lineOrder) +
            attribute("pixelAspectRatio", "float", bytesOf(1.0f)) +
            attribute("screenWindowCenter", "v2f", bytesOf(0.0f) + bytesOf(0.0f)) +
            attribute("screenWindowWidth", "float", bytesOf(1.0f));
        for (const std::string& one : more) file += one;
        file += '\0';
        head = file.size();
        std::string places, lines;
        std::vector<std::string> blocks;
        for (int y = 0; y < kHeight; ++y) {
            std::string pixels;
            for (std::size_t c = 0; c < channels.size(); ++c) {
                for (int x = 0; x < kWidth; ++x) pixels += bytesOf(value(x, y, c));
            }
            blocks.push_back(bytesOf(top + y) + bytesOf(static_cast<std::uint32_t>(pixels.size())) + pixels);
        }
        const bool falls = lineOrder[0] == 1;
        const std::uint64_t begin = head + 8 * blocks.size(), each = blocks[0].size();
        for (std::size_t y = 0; y < blocks.size(); ++y)
            places += bytesOf(begin + each * (falls ? blocks.size() - 1 - y : y));
        for (std::size_t i = 0; i < blocks.size(); ++i) lines += blocks[falls ? blocks.size() - 1 - i : i];
        std::string rest = places + lines;
        if (table) table(rest);
        return file + rest;
    }
};

Result<LinearImage> decoded(Exr exr) {
    const std::string file = exr.make();
    return decodeExr("a.exr", std::as_bytes(std::span(file)));
}

std::string failure(Exr exr) {
    const auto image = decoded(std::move(exr));
    return image ? "it was read" : image.error().message();
}

TEST(ExrHead, LinesFromTheBottomUpAreTheSamePicture) {
    const auto rising = decoded({}), falling = decoded({.lineOrder = "\1"});
    ASSERT_TRUE(rising) << rising.error().message();
    ASSERT_TRUE(falling) << falling.error().message();
    EXPECT_EQ(rising->rgba, falling->rgba);
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 3; ++x) {
            const auto pixel = static_cast<std::size_t>(4 * (3 * y + x));
            for (std::size_t c = 0; c < 3; ++c)
                EXPECT_EQ(rising->rgba[pixel + c], Exr::value(x, y, 2 - c)) << x << ' ' << y;
            EXPECT_EQ(rising->rgba[pixel + 3], 1);
        }
    }
}

TEST(ExrHead, WholeNumbersBesideColoursAreNoHindrance) {
    EXPECT_TRUE(decoded({.channels = {{"B", 2}, {"G", 2}, {"R", 2}, {"id", 0}}}));
    EXPECT_THAT(failure({.channels = {{"B", 2}, {"G", 2}, {"R", 0}}}),
                HasSubstr("whole numbers for colours"));
    EXPECT_TRUE(decoded({.more = {Exr::attribute("owner", "string", "somebody"),
                                  Exr::attribute("type", "string", "scanlineimage")}}));
}

TEST(ExrHead, WhatIsNotAsItMustBeIsTold) {
    using Case = std::pair<Exr, const char*>;
    const std::string nothing;
    for (const auto& [exr, why] : {
             Case{{.flags = 1}, "is of version 1"},
             Case{{.flags = 2 | 0x200}, "is tiled"},
             Case{{.flags = 2 | 0x1000}, "several parts"},
             Case{{.flags = 2 | 0x10000}, "flags"},
             Case{{.compression = "\5"}, "is packed in a way that is not read"},
             Case{{.compression = nothing}, "another compression"},
             Case{{.lineOrder = "\2"}, "an order that is none"},
             Case{{.channels = {}}, "a list of channels that is none"},
             Case{{.channels = {{"R", 2}, {"R", 2}}}, "a channel twice"},
             Case{{.channels = {{"R", 7}}}, "a type that is none"},
             Case{{.channels = {{std::string(300, 'R'), 2}}}, "a channel without a name"},
             Case{{.sampling = 2}, "fewer values than pixels"},
             Case{{.channelsEnd = nothing}, "without an end"},
             Case{{.channelsEnd = std::string("\0more", 5)}, "a list of channels that is none"},
             Case{{.more = {Exr::attribute("compression", "compression", "\0")}}, "an attribute twice"},
             Case{{.more = {Exr::attribute("type", "string", "deepscanline")}}, "no image in lines"},
             Case{{.more = {Exr::attribute("type", "string", "nonsense")}}, "no image in lines"},
             Case{{.more = {std::string("a\0int\0\xff\xff\xff\x7f", 10)}}, "goes beyond its end"},
             Case{{.more = {std::string(1, 'a') + '\0' + '\0'}}, "without type or size"},
             Case{{.table = [](std::string& rest) { rest.resize(20); }}, "within the table"},
             Case{{.table = [](std::string& rest) { rest.resize(60); }}, "do not end where"},
             Case{{.table = [](std::string& rest) { rest[0] = 0; }}, "not where the table says"},
             Case{{.table = [](std::string& rest) { std::swap_ranges(&rest[0], &rest[8], &rest[8]); }},
                  "other lines"},
             Case{{.table = [](std::string& rest) { rest[32] = 0; }}, "other lines"},
             Case{{.table = [](std::string& rest) { rest[36] = 4; }}, "bytes hold"},
             Case{{.table = [](std::string& rest) { rest += "more"; }}, "continues after"},
         })
        EXPECT_THAT(failure(exr), testing::AllOf(HasSubstr("a.exr"), HasSubstr(why)));
    std::vector<std::string> many;
    for (int i = 0; i < 1001; ++i) many.push_back(Exr::attribute("a" + std::to_string(i), "int", "0000"));
    EXPECT_THAT(failure({.more = many}), HasSubstr("more than 1000 attributes"));
    many.resize(200);
    EXPECT_TRUE(decoded({.more = many}));
}

TEST(ExrHead, AnyByteOfTheHeadMayBeAnyOther) {
    Exr exr;
    const std::string whole = exr.make();
    for (std::size_t at = 0; at < exr.head + 40; ++at) {
        for (const char value : {'\0', '\1', '\x7f', '\xff', 'a'}) {
            std::string changed = whole;
            changed[at] = value;
            const auto image = decodeExr("a.exr", std::as_bytes(std::span(changed)));
            if (!image) {
                EXPECT_FALSE(image.error().problem.empty());
            }
        }
    }
}

}  // namespace
}  // namespace hairloom::render
