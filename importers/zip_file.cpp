// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/zip_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "core/base/file.h"

namespace hairloom {
namespace {

constexpr std::uint32_t kLocal = 0x04034b50, kCentral = 0x02014b50, kEnd = 0x06054b50;
constexpr std::uint32_t kEnd64 = 0x06064b50, kLocator64 = 0x07064b50;
constexpr std::size_t kEndBytes = 22, kCentralBytes = 46, kLocalBytes = 30, kLocatorBytes = 20;
constexpr std::size_t kLongestComment = 65535;
constexpr std::uint16_t kStored = 0, kDeflated = 8;
constexpr std::uint64_t kBestRatio = 1032;  ///< of deflate

template <class T>
T valueAt(std::span<const std::byte> bytes, std::uint64_t at) {
    T value{};
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/// Sizes and places of more than 32 bits, which stand in an extra field in this order where the directory has
/// 0xffffffff.
void takeExtra64(std::span<const std::byte> extra, ZipEntry& entry) {
    while (extra.size() >= 4) {
        const auto id = valueAt<std::uint16_t>(extra, 0);
        const std::size_t size = valueAt<std::uint16_t>(extra, 2);
        if (size > extra.size() - 4) return;
        auto field = extra.subspan(4, size);
        extra = extra.subspan(4 + size);
        if (id != 1) continue;
        for (std::uint64_t* value : {&entry.size, &entry.packed, &entry.header}) {
            if (*value != 0xffffffff || field.size() < 8) continue;
            *value = valueAt<std::uint64_t>(field, 0);
            field = field.subspan(8);
        }
    }
}

}  // namespace

bool looksLikeZip(std::span<const std::byte> bytes) {
    return bytes.size() >= 4 &&
           (valueAt<std::uint32_t>(bytes, 0) == kLocal || valueAt<std::uint32_t>(bytes, 0) == kEnd);
}

Result<ZipFile> ZipFile::open(std::string file, std::span<const std::byte> bytes) {
    ZipFile zip(std::move(file), bytes);
    if (bytes.size() < kEndBytes) return failIn(zip.file_, Byte{0}, "is no zip archive");
    std::uint64_t at = bytes.size() - kEndBytes;
    const std::uint64_t lowest = at > kLongestComment ? at - kLongestComment : 0;
    while (valueAt<std::uint32_t>(bytes, at) != kEnd) {
        if (at == lowest)
            return failIn(zip.file_, Byte{bytes.size()}, "is a zip archive without its directory",
                          "expected a whole file: it was cut, or not finished");
        --at;
    }
    std::uint64_t count = valueAt<std::uint16_t>(bytes, at + 10);
    std::uint64_t directory = valueAt<std::uint32_t>(bytes, at + 16);
    if (at >= kLocatorBytes && valueAt<std::uint32_t>(bytes, at - kLocatorBytes) == kLocator64) {
        const auto end64 = valueAt<std::uint64_t>(bytes, at - kLocatorBytes + 8);
        if (end64 > bytes.size() || bytes.size() - end64 < 56 ||
            valueAt<std::uint32_t>(bytes, end64) != kEnd64)
            return failIn(zip.file_, Byte{at - kLocatorBytes}, "names a directory that is not there");
        count = valueAt<std::uint64_t>(bytes, end64 + 32);
        directory = valueAt<std::uint64_t>(bytes, end64 + 48);
    }
    if (auto status = zip.readDirectory(directory, at, count); !status) return tl::unexpected(status.error());
    return zip;
}

Status ZipFile::readDirectory(std::uint64_t at, std::uint64_t end, std::uint64_t count) {
    if (at > end || count > (end - at) / kCentralBytes)
        return failIn(file_, Byte{end}, fmt::format("announces {} files in its directory", count),
                      "expected a directory that fits before its end");
    entries_.reserve(static_cast<std::size_t>(count));
    for (std::uint64_t i = 0; i < count; ++i) {
        if (end - at < kCentralBytes || valueAt<std::uint32_t>(bytes_, at) != kCentral)
            return failIn(file_, Byte{at}, fmt::format("file {} of its directory is damaged", i));
        ZipEntry entry;
        entry.flags = valueAt<std::uint16_t>(bytes_, at + 8);
        entry.method = valueAt<std::uint16_t>(bytes_, at + 10);
        entry.checksum = valueAt<std::uint32_t>(bytes_, at + 16);
        entry.packed = valueAt<std::uint32_t>(bytes_, at + 20);
        entry.size = valueAt<std::uint32_t>(bytes_, at + 24);
        entry.header = valueAt<std::uint32_t>(bytes_, at + 42);
        const std::size_t name = valueAt<std::uint16_t>(bytes_, at + 28);
        const std::size_t extra = valueAt<std::uint16_t>(bytes_, at + 30);
        const std::size_t comment = valueAt<std::uint16_t>(bytes_, at + 32);
        if (name + extra + comment > end - at - kCentralBytes)
            return failIn(file_, Byte{at}, fmt::format("file {} of its directory is damaged", i));
        const auto text = bytes_.subspan(static_cast<std::size_t>(at + kCentralBytes), name);
        entry.name.assign(reinterpret_cast<const char*>(text.data()), text.size());
        takeExtra64(bytes_.subspan(static_cast<std::size_t>(at + kCentralBytes + name), extra), entry);
        at += kCentralBytes + name + extra + comment;
        entries_.push_back(std::move(entry));
    }
    return {};
}

Result<std::span<const std::byte>> ZipFile::packed(const ZipEntry& entry) const {
    const auto wrong = [&](std::string problem) {
        return failIn(file_, Byte{entry.header}, fmt::format("{}: {}", entry.name, problem),
                      fmt::format("the archive has {} bytes", bytes_.size()));
    };
    if ((entry.flags & 1u) != 0) return wrong("is encrypted");
    if (entry.header > bytes_.size() || bytes_.size() - entry.header < kLocalBytes ||
        valueAt<std::uint32_t>(bytes_, entry.header) != kLocal)
        return wrong("is not where the directory says");
    const std::uint64_t begin = entry.header + kLocalBytes +
                                valueAt<std::uint16_t>(bytes_, entry.header + 26) +
                                valueAt<std::uint16_t>(bytes_, entry.header + 28);
    if (begin > bytes_.size() || entry.packed > bytes_.size() - begin)
        return wrong(fmt::format("needs {} bytes from byte {} on", entry.packed, begin));
    return bytes_.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(entry.packed));
}

Result<std::vector<std::byte>> ZipFile::read(const ZipEntry& entry, std::uint64_t most) const {
    const auto from = packed(entry);
    if (!from) return tl::unexpected(from.error());
    const auto wrong = [&](std::string problem, std::string expected = {}) {
        return failIn(file_, Byte{entry.header}, fmt::format("{}: {}", entry.name, problem),
                      std::move(expected));
    };
    if (entry.method != kStored && entry.method != kDeflated)
        return wrong(fmt::format("is packed by method {}", entry.method),
                     "expected stored (0) or deflated (8)");
    const std::uint64_t bound = entry.method == kStored ? entry.packed : kBestRatio * (entry.packed + 1);
    if (entry.size > bound || entry.size > most)
        return wrong(
            fmt::format("claims {} bytes unpacked", entry.size),
            fmt::format("expected at most {} from {} packed ones", std::min(bound, most), entry.packed));
    std::vector<std::byte> bytes(static_cast<std::size_t>(entry.size));
    if (entry.method == kStored) {
        std::copy_n(from->begin(), bytes.size(), bytes.begin());
    } else {
        z_stream stream{};
        // Negative: deflate alone, without zlib's own head.
        if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return wrong("cannot be unpacked");
        std::size_t in = 0, out = 0;
        int state = Z_OK;
        while (state == Z_OK) {
            constexpr std::size_t kPiece = std::size_t{1} << 30u;
            const std::size_t give = std::min(kPiece, from->size() - in);
            const std::size_t room = std::min(kPiece, bytes.size() - out);
            stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(from->data() + in));
            stream.avail_in = static_cast<uInt>(give);
            std::byte none{};
            stream.next_out = reinterpret_cast<Bytef*>(room > 0 ? bytes.data() + out : &none);
            stream.avail_out = static_cast<uInt>(room);
            state = inflate(&stream, Z_NO_FLUSH);
            const std::size_t taken = give - stream.avail_in, made = room - stream.avail_out;
            in += taken;
            out += made;
            if (state == Z_OK && taken == 0 && made == 0) state = Z_BUF_ERROR;
        }
        inflateEnd(&stream);
        if (state != Z_STREAM_END || out != bytes.size())
            return wrong(fmt::format("unpacks to {} bytes", out),
                         fmt::format("the directory says {}", entry.size));
    }
    uLong checksum = crc32(0, nullptr, 0);
    checksum = crc32_z(checksum, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
    if (checksum != entry.checksum) return wrong("is damaged: its checksum differs");
    return bytes;
}

}  // namespace hairloom
