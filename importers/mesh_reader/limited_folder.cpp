// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/mesh_reader/limited_folder.h"

#include <algorithm>
#include <system_error>

#include "core/base/file.h"

namespace hairloom {
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 30u;

/// Of UTF-8, which not every library takes char for.
std::filesystem::path pathOf(const std::string& text) {
    return std::filesystem::path(std::u8string(text.begin(), text.end()));
}

std::string textOf(const std::filesystem::path& path) {
    const std::u8string text = path.generic_u8string();
    return {text.begin(), text.end()};
}

bool liesIn(const std::filesystem::path& folder, const std::filesystem::path& file) {
    return std::ranges::mismatch(folder, file).in1 == folder.end();
}

}  // namespace

LimitedFolder::LimitedFolder(const std::string& file) {
    std::error_code code;
    const auto path = std::filesystem::weakly_canonical(pathOf(file), code);
    folder_ = (code ? std::filesystem::absolute(pathOf(file)) : path).parent_path();
}

std::string LimitedFolder::path() const {
    return textOf(folder_);
}

bool LimitedFolder::allows(const std::string& file) const {
    std::error_code code;
    const auto asked = pathOf(file);
    const auto path = std::filesystem::weakly_canonical(asked, code);
    if (code) return false;
    if (!liesIn(folder_, path)) {
        // Libraries look in the working folder, too; that is not the file's doing.
        if (refused_.empty() && liesIn(folder_, asked)) refused_ = textOf(asked.lexically_relative(folder_));
        return false;
    }
    if (!std::filesystem::is_regular_file(path, code)) {
        // Where the folder is all that there is, a link out of it leads nowhere.
        if (refused_.empty() && liesIn(folder_, asked) && std::filesystem::is_symlink(path, code))
            refused_ = textOf(asked.lexically_relative(folder_));
        return false;
    }
    return std::filesystem::file_size(path, code) <= kLargestFile && !code;
}

Result<std::vector<std::byte>> LimitedFolder::read(const std::string& file) const {
    if (!allows(file)) return fail("is outside the file's folder or is not a regular file");
    return readFile(pathOf(file), kLargestFile);
}

}  // namespace hairloom
