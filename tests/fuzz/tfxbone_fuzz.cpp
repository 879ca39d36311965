// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entry for .tfxbone, beside three strands.

#include <cstdlib>

#include "importers/tfx_bones.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hairloom;
    RawStrands strands;
    strands.offsets = {0, 2, 4, 6};
    const Status taken = readTfxBones("fuzzed", std::as_bytes(std::span(data, size)), strands);
    if (!taken && (taken.error().problem.empty() || !strands.attributes.empty())) std::abort();
    for (const RawAttribute& weights : strands.attributes) {
        if (weights.numbers.size() != 3) std::abort();
    }
    return 0;
}
