// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/usd_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <system_error>

#include "core/base/file.h"

namespace hairloom {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxFiles = 4096;
constexpr std::uint64_t kMaxBytes = std::uint64_t{4} << 30u;

bool startsWith(std::span<const std::byte> bytes, std::string_view start) {
    return bytes.size() >= start.size() && std::memcmp(bytes.data(), start.data(), start.size()) == 0;
}

Result<UsdLayer> parsed(const std::string& name, std::span<const std::byte> bytes) {
    if (startsWith(bytes, "PXR-USDC")) return readUsdc(name, bytes);
    if (startsWith(bytes, "#usda"))
        return readUsda(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    return failIn(name, {}, "is no USD", "expected text or binary USD");
}

/// "a/b.usdz[c/d.usda]": the file and what lies in it.
std::pair<std::string, std::string> splitKey(const std::string& key) {
    const std::size_t open = key.find('[');
    if (open == std::string::npos || !key.ends_with(']')) return {key, {}};
    return {key.substr(0, open), key.substr(open + 1, key.size() - open - 2)};
}

/// Without what formats may be told behind a colon.
std::string plainAsset(const std::string& asset) {
    return asset.substr(0, std::min(asset.find(":SDF_FORMAT_ARGS:"), asset.size()));
}

}  // namespace

Result<UsdLayer> UsdFiles::layerIn(const std::string& path, std::vector<std::byte>&& bytes,
                                   std::string& key) {
    if (!startsWith(bytes, "PK\x03\x04")) return parsed(path, bytes);
    auto files = usdPackageFiles(path, bytes);
    if (!files) return tl::unexpected(files.error());
    Package& package = packages_[path];
    package = {std::move(bytes), std::move(*files)};
    const auto [file, entry] = splitKey(key);
    const auto found = entry.empty() ? package.files.begin()
                                     : std::ranges::find(package.files, entry, &UsdPackageFile::name);
    if (found == package.files.end())
        return failIn(path, {}, "has no " + entry, "expected a file of the package");
    key = fmt::format("{}[{}]", file, found->name);
    return parsed(fmt::format("{}[{}]", path, found->name),
                  std::span(package.bytes).subspan(found->begin, found->size));
}

Result<UsdLayer> UsdFiles::first(std::vector<std::byte>&& bytes, std::string& key) {
    key = file_;
    if (!folder_.empty()) {
        std::error_code code;
        folder_ = fs::canonical(folder_, code);
        if (code) folder_.clear();
        // Others know it by the name that links lead to.
        const fs::path own = fs::canonical(file_, code);
        if (!code) key = own.string();
    }
    bytes_ = bytes.size();
    auto layer = layerIn(std::string(key), std::move(bytes), key);
    if (layer) return layer;
    Error error = layer.error();
    if (error.file == key) error.file = file_;
    return tl::unexpected(error);
}

Result<std::string> UsdFiles::keyInPackage(const std::string& path, const std::string& entry,
                                           const std::string& asset) {
    const std::vector<UsdPackageFile>& files = packages_.at(path).files;
    const fs::path beside = (fs::path(entry).parent_path() / asset).lexically_normal();
    for (const std::string& name :
         {beside.generic_string(), fs::path(asset).lexically_normal().generic_string()}) {
        if (std::ranges::find(files, name, &UsdPackageFile::name) != files.end())
            return fmt::format("{}[{}]", path, name);
    }
    return fail("the package has no such file");
}

Result<std::string> UsdFiles::keyInFolder(const fs::path& from, const std::string& asset) {
    if (folder_.empty()) return fail("other files are not read here");
    const auto [name, entry] = splitKey(asset);
    std::error_code code;
    const fs::path found = fs::weakly_canonical(from.parent_path() / fs::path(name), code);
    if (code) return fail("is no place of a file");
    const auto [end, rest] = std::ranges::mismatch(folder_, found);
    if (end != folder_.end()) return fail("lies outside the folder of the file");
    if (!fs::exists(found, code)) {
        // Where the folder is all that there is, a link out of it leads nowhere.
        return fail(fs::is_symlink(found, code)
                        ? "is a link that leads nowhere, or lies outside the folder of the file"
                        : "there is no such file");
    }
    if (!fs::is_regular_file(found, code)) return fail("is no file");
    return entry.empty() ? found.string() : fmt::format("{}[{}]", found.string(), entry);
}

Result<std::string> UsdFiles::keyOf(const std::string& from, const std::string& asset) {
    const auto [path, entry] = splitKey(from);
    const std::string plain = plainAsset(asset);
    if (plain.empty()) return fail("has no name");
    if (!entry.empty() && packages_.contains(path)) return keyInPackage(path, entry, plain);
    return keyInFolder(path, plain);
}

Result<UsdLayer> UsdFiles::open(std::string& key) {
    if (++opened_ > kMaxFiles) return fail(fmt::format("more than {} files are not read", kMaxFiles));
    const auto [path, entry] = splitKey(key);
    if (const auto known = packages_.find(path); known != packages_.end()) {
        const std::vector<UsdPackageFile>& files = known->second.files;
        const auto found =
            entry.empty() ? files.begin() : std::ranges::find(files, entry, &UsdPackageFile::name);
        if (found == files.end()) return fail("the package has no such file");
        key = fmt::format("{}[{}]", path, found->name);
        return parsed(key, std::span(known->second.bytes).subspan(found->begin, found->size));
    }
    auto bytes = readFile(path, kMaxBytes - std::min(bytes_, kMaxBytes));
    if (!bytes) return tl::unexpected(bytes.error());
    bytes_ += bytes->size();
    return layerIn(path, std::move(*bytes), key);
}

}  // namespace hairloom
