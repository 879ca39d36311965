// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/file.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hairloom {
namespace {

namespace fs = std::filesystem;

class FileTest : public testing::Test {
  protected:
    std::size_t filesInFolder() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
    }
    const TemporaryFolder own_;
    const fs::path& folder = own_.path();
};

// Names are UTF-8 in `char` on every system; the last of these needs two units of UTF-16.
TEST_F(FileTest, NamesOutsideAsciiNameTheSameFileAsTheirCharacters) {
    for (const std::u8string& name :
         {std::u8string(u8"Zöpfe.txt"), std::u8string(u8"髪.txt"), std::u8string(u8"💇.txt")}) {
        const std::string inChar(name.begin(), name.end());
        ASSERT_TRUE(writeFileAtomically(folder / inChar, std::string_view("hair")));
        EXPECT_EQ(readTextFile(folder / fs::path(name)).value(), "hair") << inChar;
        EXPECT_EQ((folder / inChar).filename().string(), inChar);
    }
    EXPECT_EQ(filesInFolder(), 3u);
    EXPECT_FALSE(readFile(folder / "\xC3(\xF0\x9F\x92"));  // not UTF-8
}

TEST_F(FileTest, ReadingNamesWhatIsWrong) {
    EXPECT_NE(readFile(folder / "none").error().message().find("no such file"), std::string::npos);
    EXPECT_NE(readFile(folder).error().message().find("is a folder"), std::string::npos);
    ASSERT_TRUE(writeFileAtomically(folder / "long", std::string_view("12345")));
    EXPECT_NE(readFile(folder / "long", 4).error().message().find("5 bytes"), std::string::npos);
}

TEST(ByteReader, RefusesCountsBeyondTheEndBeforeAllocating) {
    ByteWriter writer;
    writer.write(std::uint32_t{7});
    writer.write(1.5f);
    ByteReader reader("x.bin", writer.bytes());
    EXPECT_EQ(reader.read<std::uint32_t>("count").value(), 7u);
    const auto tooMany = reader.readArray<float>(std::uint64_t{1} << 62u, "positions");
    ASSERT_FALSE(tooMany);
    EXPECT_NE(tooMany.error().message().find("x.bin@4: positions"), std::string::npos);
    EXPECT_EQ(reader.readArray<float>(1, "positions").value().front(), 1.5f);
    EXPECT_FALSE(reader.read<std::uint8_t>("tail"));
    EXPECT_FALSE(reader.seek(9, "table"));
}

}  // namespace
}  // namespace hairloom
