// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/write_rules.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/temporary_file.h"
#include "core/base/written_files.h"

namespace hairloom {
namespace {

/// A file as it was when the process last had to do with it.
struct KnownFile {
    FileVersion version;
    bool written = false;  ///< by the process itself
};

struct Known {
    std::mutex mutex;
    WriteRules rules;
    /// By names without links. A name alone tells of a file that another has taken the place of.
    std::map<std::filesystem::path, KnownFile> files;
    std::set<std::filesystem::path> pipes;
    std::vector<std::string> newNames;  ///< what they begin with, without links
};

Known& known() {
    static Known instance;
    return instance;
}

std::filesystem::path keyOf(const std::filesystem::path& path) {
    std::error_code code;
    auto key = std::filesystem::weakly_canonical(path, code);
    return code ? std::filesystem::absolute(path, code) : key;
}

/// The file behind another of its names, where it still has the name that it is known by.
const KnownFile* byOtherName(const FileVersion& version) {
    for (const auto& [path, file] : known().files) {
        if (file.version.identity == version.identity && fileVersion(path).identity == version.identity)
            return &file;
    }
    return nullptr;
}

}  // namespace

FileVersion fileVersion(const std::filesystem::path& path) {
    return fileState(path);
}

void setWriteRules(WriteRules rules) {
    const std::lock_guard lock(known().mutex);
    known().rules = std::move(rules);
    known().files.clear();
    known().pipes.clear();
    known().newNames.clear();
}

const WriteRules& writeRules() {
    return known().rules;
}

void noteInput(const std::filesystem::path& path) {
    if (!writeRules().keepInputs) return;
    const FileVersion version = fileVersion(path);
    if (!version.exists) return;
    const std::lock_guard lock(known().mutex);
    known().files.try_emplace(keyOf(path), KnownFile{version, false});
}

void noteInput(const std::filesystem::path& path, const FileVersion& version) {
    if (!writeRules().keepInputs) return;
    const std::lock_guard lock(known().mutex);
    known().files.insert_or_assign(keyOf(path), KnownFile{version, false});
}

void forgetInput(const std::filesystem::path& path) {
    const std::lock_guard lock(known().mutex);
    known().files.erase(keyOf(path));
}

FileVersion knownVersion(const std::filesystem::path& path) {
    const std::lock_guard lock(known().mutex);
    const auto found = known().files.find(keyOf(path));
    return found == known().files.end() ? FileVersion{} : found->second.version;
}

bool isChangedByOthers(const std::filesystem::path& path) {
    const FileVersion before = knownVersion(path);
    const FileVersion now = fileVersion(path);
    return before.exists && now.exists && now != before;
}

std::vector<std::filesystem::path> notedInputs() {
    const std::lock_guard lock(known().mutex);
    std::vector<std::filesystem::path> inputs;
    for (const auto& [path, file] : known().files)
        if (!file.written) inputs.push_back(path);
    return inputs;
}

void keepNew(const std::filesystem::path& beginning) {
    const std::lock_guard lock(known().mutex);
    const std::filesystem::path folder = beginning.has_parent_path() ? beginning.parent_path() : ".";
    known().newNames.push_back((keyOf(folder) / beginning.filename()).string());
}

bool isKeptNew(const std::filesystem::path& path) {
    const std::lock_guard lock(known().mutex);
    if (known().newNames.empty()) return false;
    const auto key = keyOf(path);
    const std::string name = key.string();
    const auto begins = [&](const std::string& beginning) { return name.starts_with(beginning); };
    if (std::ranges::none_of(known().newNames, begins)) return false;
    const auto found = known().files.find(key);
    return found == known().files.end() || !found->second.written;
}

void allowPipe(const std::filesystem::path& path) {
    const std::lock_guard lock(known().mutex);
    known().pipes.insert(path);
}

bool isPipeAllowed(const std::filesystem::path& path) {
    const std::lock_guard lock(known().mutex);
    return known().pipes.contains(path);
}

InputState inputState(const std::filesystem::path& path, const FileVersion& version) {
    if (!writeRules().keepInputs) return InputState::NotRead;
    const std::lock_guard lock(known().mutex);
    const auto found = known().files.find(keyOf(path));
    const KnownFile* file = found == known().files.end() ? byOtherName(version) : &found->second;
    if (file == nullptr) return InputState::NotRead;
    if (file->version == version) return file->written ? InputState::NotRead : InputState::AsRead;
    return file->written ? InputState::ChangedSinceWritten : InputState::ChangedSince;
}

void noteWritten(const std::filesystem::path& path) {
    if (!writeRules().keepInputs) return;
    const FileVersion version = fileVersion(path);
    const std::lock_guard lock(known().mutex);
    known().files.insert_or_assign(keyOf(path), KnownFile{version, true});
}

}  // namespace hairloom
