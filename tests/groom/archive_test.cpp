// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/file/archive.h"

#include <gmock/gmock.h>

#include <cstring>

#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/random.h"
#include "core/groom/file/json_reader.h"

namespace hairloom {
namespace {

using testing::HasSubstr;

/// A file around any head, sealed with the right checksum.
std::vector<std::byte> withHead(const std::string& head, std::size_t dataBytes = 0) {
    std::string file = "HAIRLOOM";
    const auto put = [&](auto value) { file.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
    put(std::uint32_t{1});
    put(std::uint32_t{0});
    put(std::uint64_t{head.size()});
    put(hashBytes(std::as_bytes(std::span(head))));
    file += head;
    file.resize((file.size() + kArchiveAlignment - 1) / kArchiveAlignment * kArchiveAlignment + dataBytes);
    const auto bytes = std::as_bytes(std::span(file));
    return {bytes.begin(), bytes.end()};
}

std::string openError(std::vector<std::byte> bytes) {
    const auto archive = ArchiveReader::open("f", std::move(bytes), "test", 1);
    return archive ? "it was opened" : archive.error().message();
}

std::string headWith(const std::string& arrays) {
    return R"({"kind":"test","version":1,"arrays":{)" + arrays + "}}";
}

std::string entry(const std::string& count, const std::string& offset, const std::string& type = "float") {
    return R"({"type":")" + type + R"(","count":)" + count + R"(,"offset":)" + offset +
           R"(,"checksum":"2d06800538d394c2"})";
}

TEST(Archive, AcceptsTheSmallestFile) {
    EXPECT_EQ(openError(withHead(headWith(""))), "it was opened");
}

TEST(Archive, RefusesHostileHeads) {
    const std::string deep = R"({"kind":)" + std::string(1000000, '[');
    const std::vector<std::pair<std::string, std::string>> cases = {
        {deep, "f@71: JSON is nested too deeply"},
        {R"({"kind":"test","kind":"test","version":1,"arrays":{}})", "has \"kind\" twice"},
        {R"({"kind":"test","version":1,"arrays":{},})", "JSON is damaged"},
        {R"({"kind":"test","version":1e999,"arrays":{}})", "JSON cannot be read"},
        {R"({"kind":"test","version":-1,"arrays":{}})", "/version is -1"},
        {R"({"kind":"test","version":1.0,"arrays":{}})", "/version is 1.0"},
        {"[]", "/ is an array; expected an object"},
        {"", "JSON is damaged"},
        {"{\"kind\":\"\xff\"}", "JSON is damaged"},
        {headWith(R"("a":)" + entry("18446744073709551615", "0")), "/arrays/a/count is 18446744073709551615"},
        {headWith(R"("a":)" + entry("0", "18446744073709551615")),
         "/arrays/a/offset is 18446744073709551615"},
        {headWith(R"("a":)" + entry("0", "0", "float16")), "'float16' is not an attribute type"},
        {headWith(R"("a":{"type":"float","count":0,"offset":0})"), "/arrays/a/checksum is missing"},
        {headWith(R"("a":{"type":"float","count":0,"offset":0,"checksum":"0x"})"),
         "/arrays/a/checksum is malformed"},
        {headWith(R"("a":3)"), "/arrays/a is 3; expected an object"},
        {headWith(R"("a":)" + entry("0", "64")), "array 'a' starts at byte"},
        {headWith(R"("a":)" + entry("40", "0")), "file ends within array 'a'"},
    };
    for (const auto& [head, expected] : cases) EXPECT_THAT(openError(withHead(head)), HasSubstr(expected));
}

TEST(Archive, RefusesArraysThatShareBytes) {
    const std::string head = headWith(R"("a":)" + entry("16", "0") + R"(,"b":)" + entry("16", "0"));
    EXPECT_THAT(openError(withHead(head, 128)), HasSubstr("starts at byte"));
}

TEST(Archive, KeepsArraysOfEveryTypeAndAlignsThem) {
    const std::vector<std::uint8_t> bytes{1, 2, 3};
    const std::vector<Vec4f> vectors{Vec4f(1, 2, 3, 4), Vec4f(5, 6, 7, 8)};
    ArchiveWriter writer("test", 1);
    writer.add("a/bytes", std::span(bytes));
    writer.add("a/none", std::span<const float>());
    writer.add("b/vectors", std::span(vectors));
    const auto file = writer.finish({{"note", "kept"}});
    ASSERT_TRUE(file);
    EXPECT_EQ(file->size() % kArchiveAlignment, 0u);
    const auto archive = ArchiveReader::open("f", *file, "test", 1);
    ASSERT_TRUE(archive) << archive.error().message();
    EXPECT_EQ(archive->head()["note"], "kept");
    EXPECT_EQ(archive->read<std::uint8_t>("a/bytes").value(), bytes);
    EXPECT_EQ(archive->read<Vec4f>("b/vectors").value(), vectors);
    EXPECT_TRUE(archive->read<float>("a/none").value().empty());
    EXPECT_FALSE(archive->read<float>("a/bytes"));
    EXPECT_FALSE(archive->read<float>("missing"));
    for (const auto& item : archive->head()["arrays"]) EXPECT_EQ(item["offset"].get<int>() % 64, 0);
}

TEST(Archive, NamesThatAreNotUtf8AreRefused) {
    ArchiveWriter writer("test", 1);
    writer.add("strand/\xff", std::span<const float>());
    EXPECT_FALSE(writer.finish(nlohmann::ordered_json::object()));
}

TEST(ReadableDecimal, GivesTheSameFloatAgain) {
    Random random(3);
    for (int i = 0; i < 100000; ++i) {
        const std::uint32_t bits = random.next();
        const auto value = std::bit_cast<float>(bits);
        if (std::isfinite(value)) {
            ASSERT_EQ(static_cast<float>(readableDecimal(value)), value);
        }
    }
    EXPECT_EQ(readableDecimal(0.1f), 0.1);
}

}  // namespace
}  // namespace hairloom
