// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/flip.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace hairloom::render {
namespace {

template <class Grey>
Image picture(std::uint32_t size, const Grey& grey) {
    Image image{size, size, {}};
    for (std::uint32_t y = 0; y < size; ++y) {
        for (std::uint32_t x = 0; x < size; ++x) {
            for (int c = 0; c < 3; ++c) image.rgba.push_back(static_cast<std::uint8_t>(grey(x, y)));
            image.rgba.push_back(255);
        }
    }
    return image;
}

double flip(const Image& a, const Image& b) {
    const auto difference = flipDifference(a, b);
    EXPECT_TRUE(difference) << difference.error().message();
    return difference ? difference->mean : -1;
}

TEST(Flip, IsZeroForEqualAndLargeForOppositePictures) {
    Random random(1);
    const Image noise = picture(40, [&](auto, auto) { return random.below(256); });
    EXPECT_EQ(flip(noise, noise), 0);
    const Image black = picture(40, [](auto, auto) { return 0; });
    const Image white = picture(40, [](auto, auto) { return 255; });
    // Black and white are 100 apart in Hunt's Lab and have no features: Eq. 7 and 8 in closed form. Green and
    // blue, the farthest two, have Lab (87.7, -86.2, 83.2) and (32.3, 79.2, -107.9).
    const double chroma = std::hypot(0.877 * -86.2 - 0.323 * 79.2, 0.877 * 83.2 + 0.323 * 107.9);
    const double maximum = std::pow(87.7 - 32.3 + chroma, 0.7);
    const double expected = 0.95 + (std::pow(100, 0.7) - 0.4 * maximum) / (0.6 * maximum) * 0.05;
    EXPECT_NEAR(flip(black, white), expected, 0.001);
    EXPECT_NEAR(flip(white, black), flip(black, white), 1e-12);
}

TEST(Flip, GrowsWithTheDifference) {
    const Image grey = picture(40, [](auto, auto) { return 100; });
    double before = 0;
    for (const int step : {1, 3, 8, 20, 60}) {
        const double now = flip(grey, picture(40, [&](auto, auto) { return 100 + step; }));
        EXPECT_GT(now, before) << step;
        before = now;
    }
    // One step of 255 is 0.4 of lightness: (0.4 / 100)^0.7 of the range from black to white, as Eq. 7
    // stretches it.
    EXPECT_NEAR(flip(grey, picture(40, [](auto, auto) { return 101; })), 0.031, 0.003);
}

TEST(Flip, BlursWhatEyesBlur) {
    const Image grey = picture(60, [](auto, auto) { return 128; });
    // The same change of mean square, as a checkerboard of pixels and as halves of the picture.
    const Image fine = picture(60, [](auto x, auto y) { return (x + y) % 2 == 0 ? 118 : 138; });
    const Image coarse = picture(60, [](auto x, auto) { return x < 30 ? 118 : 138; });
    EXPECT_LT(flip(grey, fine), 0.6 * flip(grey, coarse));
}

TEST(Flip, PicturesOfOtherSizesAreErrors) {
    const Image a = picture(10, [](auto, auto) { return 0; });
    EXPECT_FALSE(flipDifference(a, picture(11, [](auto, auto) { return 0; })));
    EXPECT_FALSE(flipDifference({}, {}));
}

}  // namespace
}  // namespace hairloom::render
