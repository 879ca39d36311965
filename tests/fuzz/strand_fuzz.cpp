// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entry for one strand format: files that the format's reader takes for its own go through the
// whole import. FUZZED_READER names the reader. With FUZZED_FILE inputs are changes of that asset.

#include <cstdlib>

#include "importers/raw_strands.h"
#ifdef FUZZED_FILE
#include "tests/fuzz/changed_asset.h"
#endif

namespace hairloom {

StrandReader FUZZED_READER();

}  // namespace hairloom

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hairloom;
    static const StrandReader reader = FUZZED_READER();
#ifdef FUZZED_FILE
    AssetBytes changed = changedAsset(data, size);
    const std::span<const std::byte> bytes = changed.bytes();
#else
    const auto bytes = std::as_bytes(std::span(data, size));
#endif
    if (bytes.empty() || !reader.recognise(bytes)) return -1;  // none of the corpus
    StrandImportOptions options;
    options.frames = true;
    const auto imported = importStrandsFromMemory("fuzzed", bytes, options);
    if (imported && imported->groom.strandCount() == 0) std::abort();
    if (!imported && imported.error().problem.empty()) std::abort();
    return 0;
}
