// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entry for view files. Pictures that they name lie outside their folder, and are not opened.

#include <cstdlib>

#include "core/live/view_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hairloom;
    const auto view = parseViewFile("/nonexistent/fuzzed.json", {reinterpret_cast<const char*>(data), size});
    if (!view && view.error().problem.empty()) std::abort();
    return 0;
}
