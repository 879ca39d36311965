// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/documents/recovery.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>
#include <system_error>
#include <utility>

#include "core/base/file.h"
#include "core/base/output_file.h"

#ifdef _WIN32
#include <process.h>
#else
#include <unistd.h>
#endif

namespace hairloom {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::uint64_t kLargestNote = std::uint64_t{1} << 16u;
constexpr const char *kHeld = ".window", *kNote = ".json", *kCopy = ".hairloom";

fs::path fromEnvironment(const char* name) {
    const char* const value = std::getenv(name);
    const fs::path path = value != nullptr ? value : "";
    return path.is_absolute() ? path : fs::path();
}

std::int64_t ownProcess() {
#ifdef _WIN32
    return _getpid();
#else
    return getpid();
#endif
}

Json toJson(const OpenDocument& document) {
    return {{"project", document.project.string()},
            {"name", document.name},
            {"process", document.process},
            {"base",
             {{"exists", document.base.exists},
              {"volume", document.base.identity.first},
              {"number", document.base.identity.second},
              {"bytes", document.base.bytes},
              {"changed", document.base.changed}}}};
}

/// What can be read of it: a copy is worth having without.
OpenDocument readNote(const fs::path& path) {
    OpenDocument document;
    const auto text = readTextFile(path, kLargestNote);
    if (!text) return document;
    const Json note = Json::parse(*text, nullptr, false);
    try {
        document.name = note.at("name").get<std::string>();
        document.process = note.at("process").get<std::int64_t>();
        // Another process has another folder to take a relative path from.
        const fs::path project = note.at("project").get<std::string>();
        if (project.is_absolute()) document.project = project;
        const Json& base = note.at("base");
        document.base.exists = base.at("exists").get<bool>();
        document.base.identity = {base.at("volume").get<std::uint64_t>(),
                                  base.at("number").get<std::uint64_t>()};
        document.base.bytes = base.at("bytes").get<std::uint64_t>();
        document.base.changed = base.at("changed").get<std::int64_t>();
    } catch (const Json::exception&) {
        return document;
    }
    return document;
}

fs::path withSuffix(fs::path path, const char* suffix) {
    return path.replace_extension(suffix);
}

std::vector<fs::path> filesIn(const fs::path& folder, const char* suffix) {
    std::vector<fs::path> found;
    std::error_code code;
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
        if (entry->path().extension() != suffix || entry->path().filename().string().starts_with('.'))
            continue;
        std::error_code unknown;
        if (entry->is_regular_file(unknown)) found.push_back(entry->path());
    }
    return found;
}

/// What runs holds its file; the files of what does not run are taken away when `held` goes.
bool isRunning(const fs::path& windowFile) {
    return !HeldFile::hold(windowFile);
}

/// Notes and names without a window and without a copy.
void sweep(const fs::path& folder) {
    std::error_code code;
    for (const fs::path& held : filesIn(folder, kHeld)) static_cast<void>(isRunning(held));
    for (const fs::path& note : filesIn(folder, kNote)) {
        if (fs::exists(withSuffix(note, kCopy), code) || fs::exists(withSuffix(note, kHeld), code)) continue;
        fs::remove(note, code);
    }
}

}  // namespace

bool isSameProject(const fs::path& a, const fs::path& b) {
    std::error_code code;
    if (fs::equivalent(a, b, code) && !code) return true;
    return fs::weakly_canonical(a, code) == fs::weakly_canonical(b, code);
}

fs::path recoveryFolder() {
#ifdef _WIN32
    const fs::path data = fromEnvironment("APPDATA");
#else
    fs::path data = fromEnvironment("XDG_DATA_HOME");
    if (data.empty() && !fromEnvironment("HOME").empty()) data = fromEnvironment("HOME") / ".local/share";
#endif
    return data.empty() ? data : data / "Hairloom" / "Hairloom" / "recovery";
}

RecoveryPlace::RecoveryPlace(fs::path stem, HeldFile held) : stem_(std::move(stem)), held_(std::move(held)) {}

RecoveryPlace::~RecoveryPlace() {
    // What was moved from has no names: those without a stem would be files of whoever's folder this is.
    if (!held_ || stem_.empty()) return;
    if (!keepsCopy_) removeCopy();
    std::error_code code;
    if (!fs::exists(copy(), code)) fs::remove(fileOf(kNote), code);
}

fs::path RecoveryPlace::fileOf(const char* suffix) const {
    return withSuffix(stem_, suffix);
}

Result<RecoveryPlace> RecoveryPlace::take() {
    const fs::path folder = recoveryFolder();
    if (folder.empty()) return fail("the system names no folder for data of programs", "set HOME");
    std::error_code code;
    fs::create_directories(folder, code);
    if (code)
        return failIn(folder.string(), {}, "cannot be made: " + code.message(),
                      "expected a folder that can be written");
    // Others have no business in it, whatever the umask says.
    fs::permissions(folder, fs::perms::owner_all, code);
    std::random_device random;
    const fs::path stem = folder / fmt::format("{:08x}{:08x}", random(), random());
    auto held = HeldFile::hold(withSuffix(stem, kHeld));
    if (!held) return tl::unexpected(held.error());
    return RecoveryPlace(stem, std::move(*held));
}

bool RecoveryPlace::isThere() const {
    std::error_code code;
    return fs::exists(held_->path(), code);
}

Status RecoveryPlace::describe(const OpenDocument& document) const {
    OpenDocument noted = document;
    noted.process = ownProcess();
    const std::string text = toJson(noted).dump(2, ' ', false, Json::error_handler_t::replace);
    return writeFileAtomically(fileOf(kNote), std::as_bytes(std::span(text)), Replacing::Anything);
}

void RecoveryPlace::removeCopy() {
    std::error_code code;
    fs::remove(copy(), code);
}

std::vector<OpenDocument> RecoveryPlace::othersWith(const fs::path& project) const {
    std::vector<OpenDocument> found;
    for (const fs::path& held : filesIn(stem_.parent_path(), kHeld)) {
        if (held == held_->path() || !isRunning(held)) continue;
        OpenDocument document = readNote(withSuffix(held, kNote));
        if (!document.project.empty() && isSameProject(document.project, project))
            found.push_back(std::move(document));
    }
    return found;
}

std::vector<RecoveryCopy> recoveryCopies() {
    std::vector<RecoveryCopy> found;
    const fs::path folder = recoveryFolder();
    if (folder.empty()) return found;
    sweep(folder);
    for (const fs::path& file : filesIn(folder, kCopy)) {
        std::error_code code;
        if (fs::exists(withSuffix(file, kHeld), code)) continue;  // its window runs
        RecoveryCopy copy;
        copy.file = file;
        copy.of = readNote(withSuffix(file, kNote));
        if (copy.of.name.empty()) copy.of.name = file.stem().string();
        copy.when = fs::last_write_time(file, code);
        copy.bytes = fs::file_size(file, code);
        const FileVersion project = fileVersion(copy.of.project);
        if (!copy.of.project.empty() && project.exists) {
            copy.isProjectChanged = project != copy.of.base;
            // Where the project is what the copy began with, clocks do not matter.
            copy.isOlder =
                copy.isProjectChanged && fs::last_write_time(copy.of.project, code) >= copy.when && !code;
        }
        found.push_back(std::move(copy));
    }
    std::ranges::sort(found, std::ranges::greater(), &RecoveryCopy::when);
    return found;
}

Status removeRecoveryCopy(const RecoveryCopy& copy) {
    std::error_code code;
    fs::remove(copy.file, code);
    if (code)
        return failIn(copy.file.string(), {}, "cannot be removed: " + code.message(),
                      "expected a folder that can be written");
    fs::remove(withSuffix(copy.file, kNote), code);
    return {};
}

}  // namespace hairloom
