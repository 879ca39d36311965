// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/mesh_reader/limited_files.h"

#include <filesystem>
#include <string>
#include <system_error>

namespace hairloom {
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 30u;

/// `path` is UTF-8, which not every library takes char for.
bool isSaneFile(const std::string& path) {
    const std::filesystem::path file(std::u8string(path.begin(), path.end()));
    std::error_code code;
    if (!std::filesystem::is_regular_file(file, code)) return false;
    return std::filesystem::file_size(file, code) <= kLargestFile && !code;
}

}  // namespace

LimitedFiles::LimitedFiles(std::string path, const std::string& extension)
    : path_(std::move(path)), alias_(path_ + ".content." + extension) {}

std::string LimitedFiles::real(const char* file) const {
    return file == alias_ ? path_ : std::string(file);
}

bool LimitedFiles::Exists(const char* file) const {
    return isSaneFile(real(file));
}

Assimp::IOStream* LimitedFiles::Open(const char* file, const char* mode) {
    const std::string path = real(file);
    if (mode[0] != 'r' || !isSaneFile(path)) return nullptr;
    return Assimp::DefaultIOSystem::Open(path.c_str(), mode);
}

}  // namespace hairloom
