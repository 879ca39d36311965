// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <set>

#include "core/render/font.h"

namespace hairloom::render {
namespace {

Image grey(std::uint32_t width, std::uint32_t height) {
    Image image{width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height, 200)};
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
    return image;
}
/// Rows of the image as text: '#' is white, '.' the dark ground, ' ' the image.
std::vector<std::string> seen(const Image& image) {
    std::vector<std::string> rows(image.height);
    for (std::size_t i = 0; i < std::size_t{image.width} * image.height; ++i) {
        const std::uint8_t red = image.rgba[4 * i];
        rows[i / image.width] += red == 255 ? '#' : red == 200 ? ' ' : '.';
    }
    return rows;
}
std::size_t inkIn(const Image& image) {
    std::size_t count = 0;
    for (const std::string& row : seen(image))
        count += static_cast<std::size_t>(std::ranges::count(row, '#'));
    return count;
}

TEST(Text, EveryCharacterHasAShapeOfItsOwn) {
    std::set<std::string> shapes;
    for (std::size_t glyph = 0; glyph < 96; ++glyph) {
        std::string shape;
        for (std::size_t y = 0; y < kGlyphHeight; ++y)
            for (std::size_t x = 0; x < kGlyphWidth; ++x) shape += isInk(glyph, x, y) ? '#' : '.';
        EXPECT_TRUE(shapes.insert(shape).second) << static_cast<char>(glyph + ' ');
    }
    for (const std::string_view row : kFont)
        for (std::size_t x = kGlyphWidth; x < row.size(); x += kGlyphWidth + 1) EXPECT_EQ(row[x], '.') << row;
}

TEST(Text, LettersWithMarksAreReadWithoutThem) {
    Image marked = grey(200, 40), bare = grey(200, 40), unknown = grey(200, 40), asked = grey(200, 40);
    burnIn(marked, {"L\u00e4nge \u00c5s\u00ed \u017b\u00f3\u0142w \u0131\u017e 5\u00b0"});
    burnIn(bare, {"Lange Asi Zolw iz 5\u00b0"});
    EXPECT_EQ(seen(marked), seen(bare));
    burnIn(unknown, {"\u6bdb\U0001f600\u0180\u00bf\xc3"});
    burnIn(asked, {"?????"});
    EXPECT_EQ(seen(unknown), seen(asked));
}

TEST(Text, StandsInTheLowerLeftCorner) {
    Image image = grey(20, 18);
    burnIn(image, {"Ag"});
    EXPECT_EQ(seen(image), (std::vector<std::string>{
                               "                    ",
                               "                    ",
                               "                    ",
                               "................    ",
                               "................    ",
                               "................    ",
                               "...###..........    ",
                               "..#...#.........    ",
                               "..#...#..####...    ",
                               "..#####.#...#...    ",
                               "..#...#.#...#...    ",
                               "..#...#.#...#...    ",
                               "..#...#..####...    ",
                               "............#...    ",
                               ".........###....    ",
                               "................    ",
                               "................    ",
                               "................    ",
                           }));
}

TEST(Text, GrowsWithTheImageAndTheLowestLinesStay) {
    Image small = grey(400, 360), large = grey(800, 720);
    burnIn(small, {"frame 12", "hair"});
    burnIn(large, {"frame 12", "hair"});
    EXPECT_GT(inkIn(small), 0u);
    EXPECT_EQ(inkIn(large), 4 * inkIn(small));
    Image low = grey(400, 20), one = grey(400, 20);
    burnIn(low, {"frame 12", "hair"});
    burnIn(one, {"hair"});
    EXPECT_EQ(low.rgba, one.rgba);
}

TEST(Text, EndsLongLinesWithDotsAndLeavesTinyImagesAlone) {
    Image narrow = grey(40, 20), dots = grey(40, 20);
    burnIn(narrow, {"abcdefgh"});
    burnIn(dots, {"abc..."});
    EXPECT_EQ(narrow.rgba, dots.rgba);
    for (const auto& [width, height] : {std::pair(3u, 100u), std::pair(100u, 3u), std::pair(0u, 0u)}) {
        Image tiny = grey(width, height);
        burnIn(tiny, {"abc"});
        EXPECT_EQ(tiny.rgba, grey(width, height).rgba);
    }
    Image none = grey(40, 20);
    burnIn(none, {});
    burnIn(none, {""});
    EXPECT_EQ(none.rgba, grey(40, 20).rgba);
}

TEST(Text, OtherCharactersAreQuestionMarks) {
    Image other = grey(60, 20), marks = grey(60, 20);
    burnIn(other, {"\xce\xb2\xe4\xb8\xad\t"});
    burnIn(marks, {"???"});
    EXPECT_EQ(other.rgba, marks.rgba);
    Image degrees = grey(60, 20);
    burnIn(degrees, {"30\xc2\xb0"});
    burnIn(other = grey(60, 20), {"30?"});
    EXPECT_NE(degrees.rgba, other.rgba);
}

TEST(Text, IsReadOverWhatIsTransparent) {
    Image clear{20, 18, std::vector<std::uint8_t>(std::size_t{4} * 20 * 18, 0)};
    burnIn(clear, {"A"});
    const std::size_t ground = std::size_t{4} * (17 * 20);
    EXPECT_EQ(clear.rgba[ground], 0);
    EXPECT_EQ(clear.rgba[ground + 3], 153);
    Image solid = grey(20, 18);
    burnIn(solid, {"A"});
    EXPECT_EQ(solid.rgba[ground], 80);
    EXPECT_EQ(solid.rgba[ground + 3], 255);
}

}  // namespace
}  // namespace hairloom::render
