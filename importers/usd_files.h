// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The files that a USD stage is made of: those in the folder of its first one, and those in a package.

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "importers/usd_stage.h"

namespace hairloom {

/// A file of a package (.usdz: a zip of files that are not compressed).
struct UsdPackageFile {
    std::string name;
    std::uint64_t begin = 0, size = 0;
};

/// In the order of the package, whose first file is its stage. Errors with the byte: no zip, compressed or
/// encrypted files, places beyond the end.
Result<std::vector<UsdPackageFile>> usdPackageFiles(const std::string& file,
                                                    std::span<const std::byte> bytes);

/// Reads layers by the names that other layers call them by.
class UsdFiles {
  public:
    /// `folder` may be empty: nothing but the first file is read.
    UsdFiles(std::string file, std::filesystem::path folder)
        : file_(std::move(file)), folder_(std::move(folder)) {}

    /// The first file, from its bytes. `key` names it in open().
    Result<UsdLayer> first(std::vector<std::byte>&& bytes, std::string& key);

    /// The key of the file that the layer `from` calls `asset`. Errors: a place outside the folder, whatever
    /// links lead there; no such file; no folder.
    Result<std::string> keyOf(const std::string& from, const std::string& asset);
    /// `key` becomes that of the layer itself where a package was named. Errors: unreadable, no USD, more
    /// files than are read.
    Result<UsdLayer> open(std::string& key);

  private:
    /// A file that is a package, kept while its files are read.
    struct Package {
        std::vector<std::byte> bytes;
        std::vector<UsdPackageFile> files;
    };
    Result<UsdLayer> layerIn(const std::string& path, std::vector<std::byte>&& bytes, std::string& key);
    Result<std::string> keyInPackage(const std::string& path, const std::string& entry,
                                     const std::string& asset);
    Result<std::string> keyInFolder(const std::filesystem::path& from, const std::string& asset);

    std::string file_;
    std::filesystem::path folder_;
    std::map<std::string, Package> packages_;
    std::size_t opened_ = 0;
    std::uint64_t bytes_ = 0;
};

}  // namespace hairloom
