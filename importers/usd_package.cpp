// SPDX-License-Identifier: GPL-3.0-or-later
// USD packages: zip archives whose files are stored as they are.

#include <algorithm>

#include "importers/usd_files.h"
#include "importers/zip_file.h"

namespace hairloom {

Result<std::vector<UsdPackageFile>> usdPackageFiles(const std::string& file,
                                                    std::span<const std::byte> bytes) {
    const auto zip = ZipFile::open(file, bytes);
    if (!zip) return tl::unexpected(zip.error());
    std::vector<UsdPackageFile> files;
    for (const ZipEntry& entry : zip->entries()) {
        if (entry.name.ends_with('/')) continue;
        if (entry.method != 0)
            return failIn(file, Byte{entry.header}, entry.name + " is compressed",
                          "expected a USD package, whose files are stored as they are (usdzip)");
        const auto stored = zip->packed(entry);
        if (!stored) return tl::unexpected(stored.error());
        files.push_back(
            {entry.name, static_cast<std::uint64_t>(stored->data() - bytes.data()), stored->size()});
    }
    if (files.empty()) return failIn(file, {}, "is an empty package", "expected a USD file first");
    std::ranges::stable_sort(files, {}, &UsdPackageFile::begin);
    return files;
}

}  // namespace hairloom
