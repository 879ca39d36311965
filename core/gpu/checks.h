// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a description of a resource must fulfil, on any backend.

#include "core/base/result.h"
#include "core/gpu/types.h"

namespace hairloom::gpu {

/// `content`: bytes of first content, 0 for none. Errors name the resource, and the limit where there is one.
Status checkDesc(const DeviceInfo& info, const BufferDesc& desc, std::size_t content);
Status checkDesc(const DeviceInfo& info, const TextureDesc& desc, std::size_t content);

}  // namespace hairloom::gpu
