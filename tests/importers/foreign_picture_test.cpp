// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures by way of the process that reads them.

#include <gmock/gmock.h>
#include <zlib.h>

#include <fstream>

#include "core/base/file.h"
#include "core/render/exr.h"
#include "core/render/png.h"
#include "importers/foreign_reader.h"
#include "tests/support/temporary_folder.h"

namespace hairloom {
namespace {

using testing::HasSubstr;

class ForeignPicture : public testing::Test {
  protected:
    std::string failure(const std::string& file, std::initializer_list<PictureKind> kinds) {
        const auto picture = readPicture(folder / file, kinds);
        return picture ? std::string() : picture.error().message();
    }
    const TemporaryFolder folder;
};

TEST_F(ForeignPicture, IsWhatTheLibraryReads) {
    render::Image image{3, 2, {}};
    for (int i = 0; i < 24; ++i) image.rgba.push_back(static_cast<std::uint8_t>(10 * i));
    const auto png = folder / "a.png", exr = folder / "a.exr";
    ASSERT_TRUE(render::writePng(png, image));
    const auto read = readPicture(png, {PictureKind::Png});
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->rgba, render::readPng(png)->rgba);
    const render::LinearImage linear{2, 1, {0, 0.25f, 0.5f, 1, 200, 3, 4, 0}};
    ASSERT_TRUE(render::writeExr(exr, linear));
    const auto back = readPicture(exr, {PictureKind::Png, PictureKind::Exr});
    ASSERT_TRUE(back) << back.error().message();
    EXPECT_EQ(back->rgba, linear.rgba);
    EXPECT_THAT(failure("a.exr", {PictureKind::Png}),
                HasSubstr("OpenEXR; expected an image in the format PNG"));
    EXPECT_THAT(failure("none.png", {PictureKind::Png}), HasSubstr("no such file"));
}

TEST_F(ForeignPicture, SizesThatTheFileOnlySaysAreRefusedBeforeMemoryIsTaken) {
    const auto path = folder / "bomb.png";
    ASSERT_TRUE(render::writePng(path, {1, 1, {1, 2, 3, 4}}));
    auto bytes = *readFile(path);
    // Width and height in the head: big-endian, then five bytes more and the checksum.
    constexpr std::size_t kHead = 12, kWidth = 16, kHeight = 20, kChecksum = 29;
    const auto say = [&](std::size_t at, std::uint32_t value) {
        for (std::size_t i = 0; i < 4; ++i)
            bytes[at + i] = static_cast<std::byte>(value >> (24 - 8 * i) & 0xffu);
    };
    for (const auto& [width, height] :
         {std::pair{20000u, 20000u}, {40000u, 1u}, {1u, 32769u}, {0x7fffffffu, 2u}}) {
        say(kWidth, width);
        say(kHeight, height);
        say(kChecksum, static_cast<std::uint32_t>(
                           crc32(0, reinterpret_cast<const Bytef*>(&bytes[kHead]), kChecksum - kHead)));
        ASSERT_TRUE(writeFileAtomically(path, bytes));
        EXPECT_THAT(failure("bomb.png", {PictureKind::Png}),
                    testing::AllOf(HasSubstr("bomb.png"),
                                   HasSubstr(width < 0x7fffffffu ? "expected at most" : "PNG")))
            << width;
    }
}

TEST_F(ForeignPicture, DamageIsAnErrorThatNamesTheFile) {
    render::Image image{64, 64, std::vector<std::uint8_t>(std::size_t{64} * 64 * 4)};
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        image.rgba[i] = static_cast<std::uint8_t>(i * i >> 3u);
    ASSERT_TRUE(render::writePng(folder / "a.png", image));
    const auto whole = *readFile(folder / "a.png");
    for (const std::size_t length : {std::size_t{0}, std::size_t{4}, std::size_t{40}, whole.size() / 2}) {
        std::ofstream(folder / "cut.png", std::ios::binary)
            .write(reinterpret_cast<const char*>(whole.data()), static_cast<std::streamsize>(length));
        EXPECT_THAT(failure("cut.png", {PictureKind::Png}), HasSubstr("cut.png")) << length;
    }
}

/// Eight by six pixels, grey.
constexpr unsigned char kGreyJpeg[] = {
    0xff, 0xd8, 0xff, 0xe0, 0x00, 0x10, 0x4a, 0x46, 0x49, 0x46, 0x00, 0x01, 0x01, 0x00, 0x00, 0x01,
    0x00, 0x01, 0x00, 0x00, 0xff, 0xdb, 0x00, 0x43, 0x00, 0x03, 0x02, 0x02, 0x02, 0x02, 0x02, 0x03,
    0x02, 0x02, 0x02, 0x03, 0x03, 0x03, 0x03, 0x04, 0x06, 0x04, 0x04, 0x04, 0x04, 0x04, 0x08, 0x06,
    0x06, 0x05, 0x06, 0x09, 0x08, 0x0a, 0x0a, 0x09, 0x08, 0x09, 0x09, 0x0a, 0x0c, 0x0f, 0x0c, 0x0a,
    0x0b, 0x0e, 0x0b, 0x09, 0x09, 0x0d, 0x11, 0x0d, 0x0e, 0x0f, 0x10, 0x10, 0x11, 0x10, 0x0a, 0x0c,
    0x12, 0x13, 0x12, 0x10, 0x13, 0x0f, 0x10, 0x10, 0x10, 0xff, 0xc0, 0x00, 0x0b, 0x08, 0x00, 0x06,
    0x00, 0x08, 0x01, 0x01, 0x11, 0x00, 0xff, 0xc4, 0x00, 0x14, 0x00, 0x01, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x07, 0xff, 0xc4, 0x00, 0x1b,
    0x10, 0x00, 0x00, 0x07, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x01, 0x05, 0x07, 0x19, 0x53, 0x93, 0xd2, 0xff, 0xda, 0x00, 0x08, 0x01, 0x01, 0x00,
    0x00, 0x3f, 0x00, 0x29, 0x96, 0xc7, 0x42, 0xb5, 0x1d, 0x4b, 0xa1, 0xff, 0xd9,
};

TEST_F(ForeignPicture, JpegsAreReadAndWhatIsRefusedSaysWhatWouldDo) {
    const std::vector<unsigned char> whole(std::begin(kGreyJpeg), std::end(kGreyJpeg));
    // The head of the frame: its kind, then two bytes of length, the bits, height and width, components.
    constexpr std::size_t kKind = 0x5a, kBits = kKind + 3, kHeight = kBits + 1, kComponents = kBits + 5;
    ASSERT_EQ(whole[kKind], 0xc0);
    const auto failureOf = [&](const std::vector<unsigned char>& bytes) {
        std::ofstream(folder / "a.jpg", std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        return failure("a.jpg", {PictureKind::Jpeg});
    };
    const std::string first = failureOf(whole);
    if (first.find("does not read") != std::string::npos) GTEST_SKIP() << "this build has no libjpeg";
    EXPECT_EQ(first, "");
    const auto read = readPicture(folder / "a.jpg", {PictureKind::Jpeg});
    ASSERT_TRUE(read);
    EXPECT_EQ(read->width, 8u);
    EXPECT_EQ(read->height, 6u);
    const auto changed = [&](std::initializer_list<std::pair<std::size_t, unsigned char>> changes) {
        auto bytes = whole;
        for (const auto& [at, value] : changes) bytes[at] = value;
        return failureOf(bytes);
    };
    EXPECT_THAT(changed({{kBits, 12}}), HasSubstr("expected 8 bits a channel"));
    EXPECT_THAT(changed({{kKind, 0xc3}}), HasSubstr("expected a baseline or progressive JPEG"));
    EXPECT_THAT(changed({{kHeight, 0xff}, {kHeight + 1, 0xff}}), HasSubstr("expected at most 32768"));
    EXPECT_THAT(changed({{kHeight, 0x9f}}), HasSubstr("32768 along a side"));
    // The library makes pixels up for what is missing, which is no picture of what was painted.
    for (const std::size_t length : {std::size_t{3}, kKind, kComponents, whole.size() - 9, whole.size() - 2})
        EXPECT_THAT(failureOf({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)}),
                    HasSubstr("expected"))
            << length;
    // Four components of print: their ids and samplings follow the count.
    auto print = whole;
    print[kComponents] = 4;
    const std::vector<unsigned char> components{0x02, 0x11, 0, 0x03, 0x11, 0, 0x04, 0x11, 0};
    print.insert(print.begin() + kComponents + 4, components.begin(), components.end());
    print[kKind + 2] = static_cast<unsigned char>(print[kKind + 2] + components.size());
    EXPECT_THAT(failureOf(print), HasSubstr("convert CMYK"));
}

}  // namespace
}  // namespace hairloom
