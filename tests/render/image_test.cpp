// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <png.h>
#include <tinyexr.h>
#include <zlib.h>

#include <filesystem>

#include "core/base/file.h"
#include "core/base/random.h"
#include "core/render/aov.h"
#include "core/render/png.h"
#include "core/render/tone_map.h"
#include "tests/support/temporary_folder.h"

namespace hairloom::render {
namespace {

TEST(Png, RoundTripsUnchanged) {
    Image image{33, 7, std::vector<std::uint8_t>(33 * 7 * 4)};
    Random random(2);
    for (auto& value : image.rgba) value = static_cast<std::uint8_t>(random.below(256));
    const TemporaryFolder folder;
    const auto path = folder / "png-test.png";
    ASSERT_TRUE(writePng(path, image));
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_file(&png, path.string().c_str()), 0);
    ASSERT_EQ(png.width, 33u);
    ASSERT_EQ(png.height, 7u);
    png.format = PNG_FORMAT_RGBA;
    std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(png));
    ASSERT_NE(png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr), 0);
    EXPECT_EQ(pixels, image.rgba);
}

TEST(Png, InvalidImagesAreErrors) {
    const TemporaryFolder folder;
    EXPECT_FALSE(writePng(folder / "empty.png", {}));
    EXPECT_FALSE(writePng(folder / "no" / "folder.png", {1, 1, {1, 2, 3, 4}}));
}

TEST(Png, AnimationsHoldTheirFrames) {
    Random random(6);
    std::vector<Image> frames(3, Image{20, 11, std::vector<std::uint8_t>(20 * 11 * 4)});
    for (Image& frame : frames) {
        for (auto& value : frame.rgba) value = static_cast<std::uint8_t>(random.below(256));
    }
    const TemporaryFolder folder;
    const auto path = folder / "apng-test.png";
    ASSERT_TRUE(writeAnimatedPng(path, frames, 40));
    // What knows nothing of animations sees the first frame.
    const auto first = readPng(path);
    ASSERT_TRUE(first) << first.error().message();
    ASSERT_EQ(first->width, 20u);
    for (std::size_t i = 0; i < first->rgba.size(); ++i) {
        const float value = static_cast<float>(frames[0].rgba[i]) / 255;
        ASSERT_NEAR(first->rgba[i], i % 4 == 3 ? value : decodeSrgb(value), 1e-6f);
    }
    // Chunks follow each other to the end, with their numbers in sequence and right checksums.
    const auto file = readFile(path).value();
    std::string types;
    std::uint32_t sequence = 0;
    const auto number = [&](std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i)
            value = value << 8u | std::to_integer<std::uint32_t>(file[at + i]);
        return value;
    };
    std::size_t at = 8;
    while (at + 12 <= file.size()) {
        const std::uint32_t size = number(at);
        const std::string type(reinterpret_cast<const char*>(&file[at + 4]), 4);
        types += type + " ";
        if (type == "fcTL" || type == "fdAT") {
            EXPECT_EQ(number(at + 8), sequence++);
        }
        EXPECT_EQ(number(at + 8 + size), crc32(0, reinterpret_cast<const Bytef*>(&file[at + 4]), size + 4));
        at += 12 + size;
    }
    EXPECT_EQ(at, file.size());
    EXPECT_EQ(types, "IHDR acTL fcTL IDAT fcTL fdAT fcTL fdAT IEND ");
    frames[1].width = 10;
    EXPECT_FALSE(writeAnimatedPng(path, frames, 40));
    EXPECT_FALSE(writeAnimatedPng(path, {}, 40));
}

TEST(Png, DamagedOnesAreErrors) {
    const TemporaryFolder folder;
    const auto path = folder / "bad.png";
    ASSERT_TRUE(writeFileAtomically(path, std::as_bytes(std::span(std::string_view("no picture"))),
                                    Replacing::Anything));
    EXPECT_FALSE(readPng(path));
    EXPECT_FALSE(readPng(path.string() + ".not-there"));
}

// Read back by the encoder's own library, which the program does not use for reading.
TEST(Exr, RoundTripsUnchanged) {
    LinearImage image{19, 33, std::vector<float>(19 * 33 * 4)};
    Random random(3);
    for (float& value : image.rgba) value = random.uniform(-2, 300);
    const TemporaryFolder folder;
    const auto path = folder / "exr-test.exr";
    ASSERT_TRUE(writeExr(path, image));
    float* pixels = nullptr;
    int width = 0, height = 0;
    const char* error = nullptr;
    ASSERT_EQ(LoadEXR(&pixels, &width, &height, path.string().c_str(), &error), 0) << error;
    ASSERT_EQ(width, 19);
    ASSERT_EQ(height, 33);
    const std::vector<float> read(pixels, pixels + image.rgba.size());
    std::free(pixels);
    EXPECT_EQ(read, image.rgba);
    EXPECT_FALSE(writeExr(path, {}));
}

// The same library takes the layers apart by their channels' names.
TEST(Exr, LayersStandBesideThePicture) {
    LinearImage image{5, 3, std::vector<float>(5 * 3 * 4, 0.25f)};
    std::vector<SurfacePixel> surface(15);
    for (std::uint32_t i = 0; i < 15; ++i) {
        const auto value = static_cast<float>(i);
        surface[i] = {
            0.5f + value, i == 4 ? SurfacePixel::kNoStrand : 16'000'000 + i, value, -value, {value, 2, 3, 1}};
    }
    const std::vector<std::string> names{"velocity", "depth", "albedo", "id"};
    auto layers = aovLayers(names, surface).value();
    const TemporaryFolder folder;
    const auto path = folder / "exr-layers.exr";
    ASSERT_TRUE(writeExr(path, image, layers));
    const auto layer = [&](const char* name) {
        float* pixels = nullptr;
        int width = 0, height = 0;
        const char* error = nullptr;
        EXPECT_EQ(LoadEXRWithLayer(&pixels, &width, &height, path.string().c_str(), name, &error), 0) << name;
        std::vector<float> read(pixels, pixels + 4 * 15);
        std::free(pixels);
        return read;
    };
    EXPECT_EQ(layer("albedo")[4 * 7], 7.0f);
    EXPECT_EQ(layer("albedo")[4 * 7 + 2], 3.0f);
    // Layers of one channel fill all four.
    EXPECT_EQ(layer("depth")[4 * 14], 14.5f);
    EXPECT_EQ(layer("id")[4 * 14], 16'000'014.0f);
    EXPECT_EQ(layer("id")[4 * 4], -1.0f);
    EXPECT_EQ(readExr(path).value().rgba, image.rgba);
    layers[0].values.pop_back();
    EXPECT_FALSE(writeExr(path, image, layers));
    surface[2].strand = 20'000'000;
    EXPECT_FALSE(aovLayers(names, surface));
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
