// SPDX-License-Identifier: GPL-3.0-or-later
// USD packages: the directory of a zip (APPNOTE.TXT of PKWARE, 4.3) whose files are stored as they are.

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "core/base/file.h"
#include "importers/usd_files.h"

namespace hairloom {
namespace {

constexpr std::uint32_t kEnd = 0x06054b50, kEntry = 0x02014b50, kFile = 0x04034b50;
constexpr std::size_t kEndSize = 22, kEntrySize = 46, kFileSize = 30;

template <class T>
T at(std::span<const std::byte> bytes, std::size_t place) {
    T value;
    std::memcpy(&value, bytes.data() + place, sizeof value);
    return value;
}

/// Where the end of the directory stands, behind which there may be a comment.
std::optional<std::size_t> findEnd(std::span<const std::byte> bytes) {
    constexpr std::size_t kLongestComment = 65535;
    if (bytes.size() < kEndSize) return std::nullopt;
    const std::size_t last = bytes.size() - kEndSize;
    for (std::size_t back = 0; back <= std::min(last, kLongestComment); ++back) {
        if (at<std::uint32_t>(bytes, last - back) == kEnd) return last - back;
    }
    return std::nullopt;
}

}  // namespace

Result<std::vector<UsdPackageFile>> usdPackageFiles(const std::string& file,
                                                    std::span<const std::byte> bytes) {
    const auto end = findEnd(bytes);
    if (!end)
        return failIn(file, Byte{bytes.size()}, "is a zip without a directory", "expected a whole package");
    const std::size_t count = at<std::uint16_t>(bytes, *end + 10);
    std::size_t place = at<std::uint32_t>(bytes, *end + 16);
    std::vector<UsdPackageFile> files;
    for (std::size_t i = 0; i < count; ++i) {
        if (place > bytes.size() || bytes.size() - place < kEntrySize ||
            at<std::uint32_t>(bytes, place) != kEntry)
            return failIn(file, Byte{place}, fmt::format("has no entry {} of {}", i, count),
                          "expected a directory of a zip");
        const auto flags = at<std::uint16_t>(bytes, place + 8), method = at<std::uint16_t>(bytes, place + 10);
        const std::size_t size = at<std::uint32_t>(bytes, place + 24),
                          nameSize = at<std::uint16_t>(bytes, place + 28),
                          more = std::size_t{at<std::uint16_t>(bytes, place + 30)} +
                                 at<std::uint16_t>(bytes, place + 32),
                          head = at<std::uint32_t>(bytes, place + 42);
        if (nameSize > bytes.size() - place - kEntrySize)
            return failIn(file, Byte{place}, "a name goes beyond the end of the file");
        const std::string name(reinterpret_cast<const char*>(bytes.data()) + place + kEntrySize, nameSize);
        place += kEntrySize + nameSize + more;
        if (name.ends_with('/')) continue;
        if (method != 0 || (flags & 1u) != 0)
            return failIn(file, Byte{place}, name + " is compressed or encrypted",
                          "expected a USD package, whose files are stored as they are (usdzip)");
        if (head > bytes.size() || bytes.size() - head < kFileSize || at<std::uint32_t>(bytes, head) != kFile)
            return failIn(file, Byte{head}, name + " is not where the directory says", "expected a file");
        const std::size_t begin =
            head + kFileSize + at<std::uint16_t>(bytes, head + 26) + at<std::uint16_t>(bytes, head + 28);
        if (begin > bytes.size() || size > bytes.size() - begin)
            return failIn(file, Byte{head}, name + " goes beyond the end of the file",
                          fmt::format("expected {} bytes", size));
        files.push_back({name, begin, size});
    }
    if (files.empty()) return failIn(file, {}, "is an empty package", "expected a USD file first");
    std::ranges::stable_sort(files, {}, &UsdPackageFile::begin);
    return files;
}

}  // namespace hairloom
