// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whole files in, and a reader that treats every count as hostile; output_file.h writes. All binary data is
// little-endian.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/output_file.h"
#include "core/base/result.h"

namespace hairloom {

static_assert(std::endian::native == std::endian::little,
              "file formats are read and written without swapping");

/// The whole file. Errors: missing, unreadable, a folder, longer than `maxBytes`.
Result<std::vector<std::byte>> readFile(const std::filesystem::path& path,
                                        std::uint64_t maxBytes = std::uint64_t{4} << 30u);
Result<std::string> readTextFile(const std::filesystem::path& path,
                                 std::uint64_t maxBytes = std::uint64_t{4} << 30u);

/// The first bytes of a file, at most `count` of them; none where it cannot be read.
std::vector<std::byte> readBeginning(const std::filesystem::path& path, std::size_t count);

/// Reads plain values from a block of memory; never past its end.
class ByteReader {
  public:
    /// `file` is named in errors. `bytes` must outlive the reader.
    ByteReader(std::string file, std::span<const std::byte> bytes) : file_(std::move(file)), bytes_(bytes) {}

    std::uint64_t position() const { return position_; }
    std::uint64_t size() const { return bytes_.size(); }
    std::uint64_t remaining() const { return bytes_.size() - position_; }

    /// An offset past the end is an error that names `what`.
    Status seek(std::uint64_t offset, std::string_view what);

    template <class T>
    Result<T> read(std::string_view what) {
        static_assert(std::is_trivially_copyable_v<T>);
        T value;
        if (auto status = readInto(std::as_writable_bytes(std::span(&value, 1)), what); !status) {
            return tl::unexpected(status.error());
        }
        return value;
    }

    /// `count` values; checks the count against what remains before it allocates.
    template <class T>
    Result<std::vector<T>> readArray(std::uint64_t count, std::string_view what) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (count > remaining() / sizeof(T)) return tl::unexpected(tooShort(what, count, sizeof(T)));
        std::vector<T> values(static_cast<std::size_t>(count));
        if (auto status = readInto(std::as_writable_bytes(std::span(values)), what); !status) {
            return tl::unexpected(status.error());
        }
        return values;
    }

    /// An error at the current position.
    Error error(std::string problem, std::string expected = {}) const {
        return {file_, Byte{position_}, std::move(problem), std::move(expected)};
    }

  private:
    Status readInto(std::span<std::byte> target, std::string_view what);
    Error tooShort(std::string_view what, std::uint64_t count, std::size_t elementSize) const;

    std::string file_;
    std::span<const std::byte> bytes_;
    std::uint64_t position_ = 0;
};

/// Appends plain values to a growing block of memory.
class ByteWriter {
  public:
    template <class T>
    void write(const T& value) {
        writeArray(std::span<const T>(&value, 1));
    }
    template <class T>
    void writeArray(std::span<const T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        const auto bytes = std::as_bytes(values);
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }
    /// Zeros up to the next multiple of `alignment`.
    void align(std::size_t alignment) {
        bytes_.resize((bytes_.size() + alignment - 1) / alignment * alignment);
    }
    void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
    /// Over what was written at `position`.
    template <class T>
    void overwrite(std::size_t position, const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        std::memcpy(bytes_.data() + position, &value, sizeof value);
    }
    std::size_t size() const { return bytes_.size(); }
    std::span<const std::byte> bytes() const { return bytes_; }
    std::vector<std::byte> take() && { return std::move(bytes_); }

  private:
    std::vector<std::byte> bytes_;
};

}  // namespace hairloom
