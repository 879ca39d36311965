// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/groom/file/character_path.h"

#include <algorithm>
#include <system_error>
#include <vector>

namespace hairloom {
namespace {

namespace fs = std::filesystem;

bool isFile(const fs::path& path) {
    std::error_code code;
    return fs::is_regular_file(path, code);
}

fs::path absoluteOf(const fs::path& path) {
    std::error_code code;
    const fs::path absolute = fs::absolute(path, code);
    return code ? path : absolute.lexically_normal();
}

/// A file of that name in the folder or one directly in it, the first by name.
fs::path inOrBelow(const fs::path& folder, const fs::path& name) {
    constexpr std::size_t kMostFolders = 256;
    if (isFile(folder / name)) return folder / name;
    std::error_code code;
    std::vector<fs::path> folders;
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
        if (folders.size() == kMostFolders) break;
        if (entry->is_directory(code)) folders.push_back(entry->path());
    }
    std::ranges::sort(folders);
    const auto found = std::ranges::find_if(folders, [&](const fs::path& one) { return isFile(one / name); });
    return found == folders.end() ? fs::path() : *found / name;
}

}  // namespace

std::string characterNameFor(const std::string& file, const fs::path& project) {
    if (file.empty()) return file;
    const fs::path path(file);
    if (path.is_relative() && !isFile(path)) return file;
    const fs::path absolute = absoluteOf(path), folder = absoluteOf(project).parent_path();
    const fs::path way = absolute.lexically_relative(folder);
    const auto above = std::count(way.begin(), way.end(), fs::path(".."));
    // Above everything there is, no two move together.
    const bool isNear =
        !way.empty() && (above == 0 || (above == 1 && folder.parent_path() != folder.root_path()));
    return (isNear ? way : absolute).generic_string();
}

std::string findCharacter(const std::string& name, const fs::path& project) {
    if (name.empty()) return name;
    const fs::path path(name), folder = absoluteOf(project).parent_path();
    if (path.is_absolute() && isFile(path)) return name;
    if (path.is_relative() && isFile(folder / path)) return (folder / path).lexically_normal().string();
    if (path.is_relative() && isFile(path)) return absoluteOf(path).string();
    const fs::path found = inOrBelow(folder, path.filename());
    return found.empty() ? name : found.lexically_normal().string();
}

}  // namespace hairloom
