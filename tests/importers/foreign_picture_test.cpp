// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures by way of the process that reads them.

#include <gmock/gmock.h>
#include <zlib.h>

#include <fstream>

#include "core/base/file.h"
#include "core/render/exr.h"
#include "core/render/png.h"
#include "importers/foreign_reader.h"

namespace hairloom {
namespace {

using testing::HasSubstr;

class ForeignPicture : public testing::Test {
  protected:
    std::string failure(const std::string& file, std::initializer_list<PictureKind> kinds) {
        const auto picture = readPicture(folder / file, kinds);
        return picture ? std::string() : picture.error().message();
    }
    void SetUp() override {
        folder = std::filesystem::path(testing::TempDir()) /
                 (std::string("hairloom-") + testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::create_directories(folder);
    }
    void TearDown() override { std::filesystem::remove_all(folder); }
    std::filesystem::path folder;
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
                HasSubstr("OpenEXR; expected a picture in the format PNG"));
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

}  // namespace
}  // namespace hairloom
