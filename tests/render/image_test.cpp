// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <png.h>

#include <filesystem>

#include "core/base/random.h"
#include "core/render/png.h"
#include "core/render/tone_map.h"

namespace hairloom::render {
namespace {

TEST(Png, ComesBackAsItWent) {
    Image image{33, 7, std::vector<std::uint8_t>(33 * 7 * 4)};
    Random random(2);
    for (auto& value : image.rgba) value = static_cast<std::uint8_t>(random.below(256));
    const auto path = std::filesystem::path(testing::TempDir()) / "hairloom-png-test.png";
    ASSERT_TRUE(writePng(path, image));
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_file(&png, path.c_str()), 0);
    ASSERT_EQ(png.width, 33u);
    ASSERT_EQ(png.height, 7u);
    png.format = PNG_FORMAT_RGBA;
    std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(png));
    ASSERT_NE(png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr), 0);
    EXPECT_EQ(pixels, image.rgba);
    std::filesystem::remove(path);
}

TEST(Png, WhatCannotBeWrittenIsAnError) {
    EXPECT_FALSE(writePng(std::filesystem::path(testing::TempDir()) / "empty.png", {}));
    EXPECT_FALSE(
        writePng(std::filesystem::path(testing::TempDir()) / "no" / "folder.png", {1, 1, {1, 2, 3, 4}}));
}

TEST(ToneMap, KeepsBlackAndOrder) {
    EXPECT_NEAR(encodeSrgb(0.5f), 0.735357f, 1e-5f);
    EXPECT_NEAR(encodeSrgb(0.001f), 0.01292f, 1e-6f);
    EXPECT_NEAR(filmic(0), 0, 1e-6f);
    EXPECT_NEAR(filmic(kFilmicWhite), 1, 1e-6f);
    float before = -1;
    for (float x = 0; x < 8; x += 0.05f) {
        EXPECT_GT(filmic(x), before);
        before = filmic(x);
    }
    const Image image = toneMap({2, 1, {0, 0, 0, 1, 100, 100, 100, 0}}, 1);
    EXPECT_EQ(image.rgba, (std::vector<std::uint8_t>{0, 0, 0, 255, 255, 255, 255, 0}));
}

}  // namespace
}  // namespace hairloom::render
