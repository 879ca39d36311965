// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What makers of several buffers share.

#include <span>
#include <vector>

#include "core/gpu/device.h"

namespace hairloom::render {

/// A buffer of elements that shaders read.
inline Result<gpu::BufferPtr> structured(gpu::Device& device, const char* name, std::uint32_t elementBytes,
                                         std::span<const std::byte> content) {
    gpu::BufferDesc desc;
    desc.name = name;
    desc.size = content.size();
    desc.elementBytes = elementBytes;
    return device.createBuffer(desc, content);
}

/// Moves results into their places and remembers the first error.
class Gather {
  public:
    template <class T>
    Gather& operator()(T& target, Result<T> result) {
        if (result) {
            target = std::move(*result);
        } else if (status_) {
            status_ = tl::unexpected(result.error());
        }
        return *this;
    }
    const Status& status() const { return status_; }

  private:
    Status status_;
};

template <class T>
std::span<const std::byte> bytes(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

}  // namespace hairloom::render
