// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/webp.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

#include "core/base/file.h"
#include "tests/support/temporary_folder.h"

namespace hairloom::render {
namespace {

std::uint32_t numberAt(const std::vector<std::byte>& file, std::size_t at, std::size_t bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = bytes; i-- > 0;) value = value << 8u | std::to_integer<std::uint32_t>(file[at + i]);
    return value;
}

// The container's chunks: WebP Container Specification (RIFF; VP8X, ANIM, ANMF).
TEST(Webp, AnimationsHoldTheirFrames) {
    std::vector<Image> frames;
    for (int k = 0; k < 3; ++k) {
        Image frame{24, 10, std::vector<std::uint8_t>(24 * 10 * 4, 255)};
        for (std::size_t i = 0; i < frame.rgba.size(); i += 4)
            frame.rgba[i] = static_cast<std::uint8_t>((i * 7 + static_cast<std::size_t>(k) * 90) % 256);
        frames.push_back(frame);
    }
    const TemporaryFolder folder;
    const auto path = folder / "a.webp";
    const auto written = writeAnimatedWebp(path, frames, 40);
    if (!written && written.error().message().find("without libwebp") != std::string::npos)
        GTEST_SKIP() << written.error().message();
    ASSERT_TRUE(written) << written.error().message();
    const auto file = readFile(path).value();
    const auto isAt = [&](std::size_t at, const char* name) { return std::memcmp(&file[at], name, 4) == 0; };
    ASSERT_TRUE(isAt(0, "RIFF") && isAt(8, "WEBP") && isAt(12, "VP8X"));
    EXPECT_EQ(numberAt(file, 4, 4) + 8, file.size());
    EXPECT_EQ(numberAt(file, 24, 3) + 1, 24u);
    EXPECT_EQ(numberAt(file, 27, 3) + 1, 10u);
    std::uint32_t count = 0, time = 0;
    for (std::size_t at = 12; at + 8 <= file.size();) {
        const std::uint32_t size = numberAt(file, at + 4, 4);
        if (isAt(at, "ANIM")) {
            EXPECT_EQ(numberAt(file, at + 12, 2), 0u) << "plays for ever";
        }
        if (isAt(at, "ANMF")) {
            ++count;
            time += numberAt(file, at + 8 + 12, 3);
        }
        at += 8 + size + size % 2;
    }
    EXPECT_EQ(count, 3u);
    EXPECT_EQ(time, 120u);
    frames[1].height = 5;
    EXPECT_FALSE(writeAnimatedWebp(path, frames, 40));
    EXPECT_FALSE(writeAnimatedWebp(path, {}, 40));
    EXPECT_FALSE(writeAnimatedWebp(path, std::span(frames).first(1), 0));
}

}  // namespace
}  // namespace hairloom::render
