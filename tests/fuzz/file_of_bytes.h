// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// For readers that take a path.

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace hairloom {

/// A file in memory, gone with its object.
class FileOfBytes {
  public:
    FileOfBytes(const std::uint8_t* data, std::size_t size)
        : descriptor_(memfd_create("fuzzed", MFD_CLOEXEC)) {
        if (descriptor_ < 0 || write(descriptor_, data, size) != static_cast<ssize_t>(size)) std::abort();
        lseek(descriptor_, 0, SEEK_SET);
    }
    FileOfBytes(const FileOfBytes&) = delete;
    FileOfBytes& operator=(const FileOfBytes&) = delete;
    ~FileOfBytes() { close(descriptor_); }
    std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

  private:
    int descriptor_;
};

}  // namespace hairloom
