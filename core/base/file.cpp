// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "core/base/output_batch.h"
#include "core/base/regular_file.h"
#include "core/base/write_rules.h"

namespace hairloom {
namespace {

struct FileCloser {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using FileHandle = std::unique_ptr<std::FILE, FileCloser>;

FileHandle openFile(const std::filesystem::path& path, const char* mode) {
#ifdef _WIN32
    const std::wstring wideMode(mode, mode + std::strlen(mode));
    return FileHandle(_wfopen(path.c_str(), wideMode.c_str()));
#else
    return FileHandle(std::fopen(path.c_str(), mode));
#endif
}

std::string systemMessage(int code) {
    return std::generic_category().message(code);
}

template <class Container>
Result<Container> readWhole(const std::filesystem::path& path, std::uint64_t maxBytes) {
    const std::string name = path.string();
    std::error_code code;
    // What this process writes and has not put in place yet is read where it lies.
    const std::filesystem::path place = whereWritten(path);
    if (auto status = checkIsFile(place); !status) return tl::unexpected(status.error());
    const FileHandle file = openFile(place, "rb");
    if (!file)
        return failIn(name, {}, fmt::format("cannot be read: {}", systemMessage(errno)),
                      "expected a readable file");
    const std::uint64_t size = std::filesystem::file_size(place, code);
    if (code)
        return failIn(name, {}, fmt::format("has no size: {}", code.message()), "expected a regular file");
    if (size > maxBytes) {
        return failIn(name, {}, fmt::format("is {} bytes long", size),
                      fmt::format("expected at most {}", maxBytes));
    }
    if (place == path) noteInput(path);
    Container content(static_cast<std::size_t>(size), typename Container::value_type{});
    const std::size_t got = std::fread(content.data(), 1, content.size(), file.get());
    if (got != content.size()) {
        return failIn(name, Byte{got}, "reading stopped early", fmt::format("expected {} bytes", size));
    }
    return content;
}

}  // namespace

Status checkIsFile(const std::filesystem::path& path) {
    const std::string name = path.string();
    std::error_code code;
    const auto status = std::filesystem::status(path, code);
    if (!std::filesystem::exists(status)) return failIn(name, {}, "no such file", "expected a readable file");
    if (std::filesystem::is_directory(status)) return failIn(name, {}, "is a folder", "expected a file");
    if (!std::filesystem::is_regular_file(status))
        return failIn(name, {}, "is a device or a FIFO", "expected a file");
    return {};
}

Result<std::vector<std::byte>> readFile(const std::filesystem::path& path, std::uint64_t maxBytes) {
    return readWhole<std::vector<std::byte>>(path, maxBytes);
}

Result<std::string> readTextFile(const std::filesystem::path& path, std::uint64_t maxBytes) {
    return readWhole<std::string>(path, maxBytes);
}

std::vector<std::byte> readBeginning(const std::filesystem::path& path, std::size_t count) {
    std::error_code code;
    if (!std::filesystem::is_regular_file(path, code)) return {};
    std::vector<std::byte> bytes(count);
    const FileHandle file = openFile(path, "rb");
    bytes.resize(file ? std::fread(bytes.data(), 1, count, file.get()) : 0);
    return bytes;
}

Status ByteReader::seek(std::uint64_t offset, std::string_view what) {
    if (offset > bytes_.size()) {
        return tl::unexpected(error(fmt::format("{} would start at byte {}", what, offset),
                                    fmt::format("the file has {} bytes", bytes_.size())));
    }
    position_ = offset;
    return {};
}

Status ByteReader::readInto(std::span<std::byte> target, std::string_view what) {
    if (target.size() > remaining()) return tl::unexpected(tooShort(what, target.size(), 1));
    if (!target.empty()) std::memcpy(target.data(), bytes_.data() + position_, target.size());
    position_ += target.size();
    return {};
}

Error ByteReader::tooShort(std::string_view what, std::uint64_t count, std::size_t elementSize) const {
    return error(fmt::format("{} needs {} × {} bytes", what, count, elementSize),
                 fmt::format("only {} bytes are left of {}", remaining(), size()));
}

}  // namespace hairloom
