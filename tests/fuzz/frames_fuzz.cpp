// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entry for records of frames and takes, of a groom of two strands of three points.

#include <cstdlib>

#include "core/simulation/frame_record.h"
#include "tests/fuzz/file_of_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hairloom;
    static const Groom groom =
        makeGroom({0, 3, 6}, {{0, 0, 0}, {0, 1, 0}, {0, 2, 0}, {1, 0, 0}, {1, 1, 0}, {1, 2, 0}});
    const FileOfBytes file(data, size);
    for (const std::uint64_t index : {std::uint64_t{0}, std::uint64_t{1}, ~std::uint64_t{0}}) {
        const auto frame = readFrame(file.path(), groom, index);
        if (frame && frame->positions_ws.size() != groom.pointCount()) std::abort();
        if (!frame && frame.error().problem.empty()) std::abort();
    }
    return 0;
}
