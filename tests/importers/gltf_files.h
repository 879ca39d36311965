// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// glTF files made for one test: their buffer is written number by number and goes into the JSON.

#include <span>
#include <string>
#include <vector>

#include "core/base/file.h"

namespace hairloom::test {

std::string base64(std::span<const std::byte> bytes);

/// A buffer whose pieces become buffer views.
class GltfBuffer {
  public:
    /// The number of a view over these values, aligned to 4 bytes.
    template <class T>
    int view(const std::vector<T>& values, int stride = 0) {
        bytes_.align(4);
        return add(std::as_bytes(std::span(values)), stride);
    }
    /// "buffers" and "bufferViews" of the file's JSON.
    std::string json() const;

  private:
    int add(std::span<const std::byte> bytes, int stride);

    ByteWriter bytes_;
    std::string views_;
    int count_ = 0;
};

/// {"bufferView": view, …}
std::string accessor(int view, int componentType, std::size_t count, const std::string& type,
                     const std::string& more = {});

inline constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                     kUnsignedInt = 5125, kFloat = 5126;

}  // namespace hairloom::test
