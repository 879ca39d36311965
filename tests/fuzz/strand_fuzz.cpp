// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entry for one strand format: files that the format's reader takes for its own go through the
// whole import. FUZZED_SUFFIX names the format.

#include <algorithm>
#include <cstdlib>

#include "importers/raw_strands.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hairloom;
    static const StrandReader& reader =
        *std::ranges::find_if(strandReaders(), [](const StrandReader& candidate) {
            return std::ranges::find(candidate.format.suffixes, FUZZED_SUFFIX) !=
                   candidate.format.suffixes.end();
        });
    const auto bytes = std::as_bytes(std::span(data, size));
    if (size == 0 || !reader.recognise(bytes)) return -1;  // none of the corpus
    StrandImportOptions options;
    options.frames = true;
    const auto imported = importStrandsFromMemory("fuzzed", bytes, options);
    if (imported && imported->groom.strandCount() == 0) std::abort();
    if (!imported && imported.error().problem.empty()) std::abort();
    return 0;
}
