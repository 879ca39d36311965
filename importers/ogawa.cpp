// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/ogawa.h"

#include <fmt/format.h>

#include <cstring>

namespace hairloom {
namespace {

constexpr std::uint64_t kHeaderBytes = 16;
constexpr std::uint64_t kCountBytes = 8;
/// Children of groups that may be looked at again, as those of instances are: a second's work at most.
constexpr std::uint64_t kReadAgain = 20'000'000;

std::uint64_t readCount(std::span<const std::byte> bytes, std::uint64_t offset) {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

}  // namespace

tl::unexpected<Error> OgawaFile::error(OgawaNode node, std::string problem, std::string expected) const {
    return failIn(file_, Byte{node.offset()}, std::move(problem), std::move(expected));
}

Result<OgawaFile> OgawaFile::open(std::string file, std::span<const std::byte> bytes) {
    OgawaFile opened(std::move(file), bytes);
    if (bytes.size() < kHeaderBytes || std::memcmp(bytes.data(), "Ogawa", 5) != 0)
        return failIn(opened.file_, Byte{0}, "is not an Ogawa file",
                      "expected an Alembic file in Ogawa's container");
    if (std::to_integer<int>(bytes[5]) != 0xff)
        return failIn(opened.file_, Byte{5}, "was not completed by the program that wrote it",
                      "export it again");
    if (std::to_integer<int>(bytes[6]) != 0 || std::to_integer<int>(bytes[7]) != 1)
        return failIn(opened.file_, Byte{6}, "is another version of Ogawa", "expected version 1");
    opened.root_.reference = readCount(bytes, 8);
    return opened;
}

Result<std::uint64_t> OgawaFile::countAt(std::uint64_t offset, std::uint64_t elementBytes) const {
    const OgawaNode node{offset};
    if (offset < kHeaderBytes || offset > bytes_.size() || bytes_.size() - offset < kCountBytes)
        return error(node, "is outside the file", fmt::format("the file has {} bytes", bytes_.size()));
    const std::uint64_t count = readCount(bytes_, offset);
    if (count > (bytes_.size() - offset - kCountBytes) / elementBytes) {
        return error(node, fmt::format("{} × {} bytes were announced", count, elementBytes),
                     fmt::format("only {} are left in the file", bytes_.size() - offset - kCountBytes));
    }
    return count;
}

Result<std::uint64_t> OgawaFile::childCount(OgawaNode node) const {
    if (node.isData()) return error(node, "is data", "expected a group");
    if (node.offset() == 0) return std::uint64_t{0};
    return countAt(node.offset(), kCountBytes);
}

OgawaNode OgawaFile::child(OgawaNode node, std::uint64_t index) const {
    return {readCount(bytes_, node.offset() + kCountBytes * (index + 1))};
}

Result<std::vector<OgawaNode>> OgawaFile::group(OgawaNode node) const {
    std::vector<OgawaNode> children;
    const auto count = childCount(node);
    if (!count) return tl::unexpected(count.error());
    visited_ += 1 + *count;
    if (visited_ > bytes_.size() / kCountBytes + kReadAgain)
        return error(node, "groups form a cycle", "expected a tree");
    children.resize(static_cast<std::size_t>(*count));
    for (std::size_t i = 0; i < children.size(); ++i) children[i] = child(node, i);
    return children;
}

Result<std::span<const std::byte>> OgawaFile::data(OgawaNode node) const {
    if (!node.isData()) return error(node, "is a group", "expected data");
    if (node.offset() == 0) return std::span<const std::byte>();
    const auto count = countAt(node.offset(), 1);
    if (!count) return tl::unexpected(count.error());
    return bytes_.subspan(static_cast<std::size_t>(node.offset() + kCountBytes),
                          static_cast<std::size_t>(*count));
}

}  // namespace hairloom
