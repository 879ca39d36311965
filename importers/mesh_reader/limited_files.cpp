// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/mesh_reader/limited_files.h"

#include <filesystem>
#include <system_error>

namespace hairloom {
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 30u;

bool isSaneFile(const std::string& path) {
    std::error_code code;
    if (!std::filesystem::is_regular_file(path, code)) return false;
    return std::filesystem::file_size(path, code) <= kLargestFile && !code;
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
