// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Files within a zip archive, stored or deflated.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace hairloom {

struct ZipEntry {
    std::string name;
    std::uint16_t method = 0;  ///< 0 stored, 8 deflated
    std::uint16_t flags = 0;
    std::uint32_t checksum = 0;
    std::uint64_t packed = 0, size = 0;  ///< bytes in the archive, and unpacked
    std::uint64_t header = 0;            ///< byte of the archive
};

class ZipFile {
  public:
    /// `bytes` must outlive the archive. Errors: no zip, a directory that the bytes do not bear out.
    static Result<ZipFile> open(std::string file, std::span<const std::byte> bytes);

    const std::vector<ZipEntry>& entries() const { return entries_; }
    /// The bytes in the archive, which are the file's own where it is stored. Errors: bytes beyond the end.
    Result<std::span<const std::byte>> packed(const ZipEntry& entry) const;
    /// The file's bytes. Errors: encryption, another method, damage (the checksum is looked at), more bytes
    /// than packed ones can make or than `most`.
    Result<std::vector<std::byte>> read(const ZipEntry& entry, std::uint64_t most) const;

  private:
    ZipFile(std::string file, std::span<const std::byte> bytes) : file_(std::move(file)), bytes_(bytes) {}
    Status readDirectory(std::uint64_t at, std::uint64_t end, std::uint64_t count);

    std::string file_;
    std::span<const std::byte> bytes_;
    std::vector<ZipEntry> entries_;
};

/// Whether the bytes begin as a zip archive does.
bool looksLikeZip(std::span<const std::byte> bytes);

}  // namespace hairloom
