// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entry for pictures; FUZZED_PICTURE decodes one format.

#include <cstdlib>

#include "core/render/exr.h"
#include "core/render/png.h"
#include "importers/mesh_reader/jpeg.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hairloom;
    const auto picture = FUZZED_PICTURE("fuzzed", std::as_bytes(std::span(data, size)));
    if (picture ? picture->rgba.size() != std::size_t{4} * picture->width * picture->height
                : picture.error().problem.empty())
        std::abort();
    return 0;
}
