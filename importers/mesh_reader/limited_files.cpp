// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/mesh_reader/limited_files.h"

#include <string>

namespace hairloom {

LimitedFiles::LimitedFiles(std::string path, const std::string& extension)
    : path_(std::move(path)), alias_(path_ + ".content." + extension), folder_(path_) {}

std::string LimitedFiles::real(const char* file) const {
    return file == alias_ ? path_ : std::string(file);
}

bool LimitedFiles::Exists(const char* file) const {
    return folder_.allows(real(file));
}

Assimp::IOStream* LimitedFiles::Open(const char* file, const char* mode) {
    const std::string path = real(file);
    if (mode[0] != 'r' || !folder_.allows(path)) return nullptr;
    return Assimp::DefaultIOSystem::Open(path.c_str(), mode);
}

}  // namespace hairloom
