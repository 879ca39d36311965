// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entry for projects: what is opened can be validated and saved.

#include <cstdlib>

#include "core/groom/file/project_file.h"
#include "core/groom/validate.h"
#include "tests/fuzz/file_of_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hairloom;
    const FileOfBytes file(data, size);
    const auto groom = readProjectFile(file.path());
    if (!groom) return groom.error().problem.empty() ? std::abort(), 0 : 0;
    if (!checkStructure(*groom)) std::abort();
    static_cast<void>(validate(*groom));
    return 0;
}
