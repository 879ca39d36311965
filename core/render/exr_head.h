// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The head of an OpenEXR file and where its lines of pixels lie, checked before the library sees the file:
// its version in Debian 12 ends the process over some heads, and believes offsets and sizes.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/base/result.h"

namespace hairloom::render {

struct ExrHead {
    std::uint64_t width = 0, height = 0;  ///< pixels; 0 where the window is empty
    std::uint32_t channels = 0;
    std::uint64_t end = 0;           ///< where the table of blocks begins
    std::uint64_t bytesPerLine = 0;  ///< of pixels, unpacked
    std::int64_t top = 0;            ///< number of the first line
    std::uint8_t compression = 0;    ///< as the file numbers it, up to that of PIZ
};

/// Of a file of one part in lines of pixels. Errors, with the byte: another kind of file; an attribute that
/// does not fit the file, stands there twice, or is one of the eight that each file has and is not as they
/// are; channels with fewer values than pixels; a window beyond a side of 2³¹.
Result<ExrHead> readExrHead(const std::string& file, std::span<const std::byte> content);

/// That the blocks of lines are where the table says, one for each, follow each other to the end of the file,
/// and can hold their pixels. `head`: of that content. Errors, with the byte: what is lost of them, or put
/// between.
Status checkExrBlocks(const std::string& file, std::span<const std::byte> content, const ExrHead& head);

}  // namespace hairloom::render
