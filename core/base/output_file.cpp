// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/output_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <system_error>

#include "core/base/content_kind.h"
#include "core/base/file.h"
#include "core/base/log.h"
#include "core/base/output_batch.h"
#include "core/base/temporary_file.h"
#include "core/base/write_rules.h"
#include "core/base/written_files.h"

namespace hairloom {
namespace {

namespace fs = std::filesystem;

/// "cannot be written" with the reason, told of the name that was asked for.
tl::unexpected<Error> notWritten(const fs::path& path, const Error& why) {
    return failIn(path.string(), {}, "cannot be written: " + why.problem,
                  why.expected.empty() ? "expected a writable folder with free space" : why.expected);
}

constexpr const char* kStandardOutput = "-";

/// Whether rules allow content of `kind` (empty where unknown yet) in place of what has the name; `target` is
/// behind links.
Status mayReplace(const fs::path& path, const fs::path& target, std::string_view kind, Replacing replacing) {
    const FileState state = fileState(target);
    const auto refuse = [&](std::string what) {
        return failIn(path.string(), {}, std::move(what), writeRules().instead);
    };
    if (!state.exists) return {};
    if (state.folder) return failIn(path.string(), {}, "is a folder", "expected the name of a file");
    if (isKeptNew(target))
        return failIn(path.string(), {}, "was made by another job since this version was taken",
                      "run the job again, which takes the next version");
    if (writeRules().force || replacing == Replacing::Anything) return {};
    if (state.device == kFifo && isPipeAllowed(path)) return {};
    if (!state.device.empty()) return refuse(fmt::format("is {}", state.device));
    if (state.readOnly) return refuse("is read-only");
    const InputState input = inputState(target, state);
    if (input == InputState::ChangedSince) return refuse("was changed by another program since it was read");
    if (kind.empty()) return {};
    if (input == InputState::ChangedSinceWritten && kind == content::kProject)
        return refuse("was changed by another program since it was written");
    if (input == InputState::AsRead && kind != content::kProject)
        return refuse("is an input file and would be replaced");
    const std::string_view there = contentKind(readBeginning(path, kContentKindBytes));
    if (there == kind || state.bytes == 0) return {};
    return refuse(fmt::format("is {} and would be replaced by {}", there, kind));
}

bool isTemporaryName(std::string_view name) {
    return name.starts_with('.') && (name.ends_with(kPartSuffix) || name.ends_with(kWholeSuffix));
}

}  // namespace

namespace {

/// Content that is to take a place.
struct Coming {
    Coming() = default;
    Coming(const Coming&) = delete;
    Coming& operator=(const Coming&) = delete;
    virtual ~Coming() = default;

    fs::path path;    ///< as asked for
    fs::path target;  ///< behind links
    Replacing replacing = Replacing::SameKind;
    std::int64_t accessed = 0;  ///< the file that is replaced, before anybody looked at its kind
    std::vector<std::byte> beginning;
    std::optional<TemporaryFile> temporary;  ///< none for a device
    std::vector<std::byte> held;             ///< all of it for a device: half of a file is never sent

    Status mayReplace() const {
        return hairloom::mayReplace(path, target, contentKind(beginning), replacing);
    }
    Status putInPlace(bool isOldKept = false);
    /// After putInPlace() with the old kept, also where it failed.
    Status putBack() { return temporary ? temporary->putBack() : Status(); }
};

}  // namespace

struct OutputFile::Impl : Coming {};

OutputFile::OutputFile(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
OutputFile::OutputFile(OutputFile&&) noexcept = default;
OutputFile& OutputFile::operator=(OutputFile&&) noexcept = default;
OutputFile::~OutputFile() = default;

namespace {

/// What waits for its batch, in order. Of a thread: a project that is saved meanwhile waits for nobody.
struct Waiting {
    bool open = false;
    std::vector<std::unique_ptr<Coming>> files;
};

Waiting& waiting() {
    static thread_local Waiting instance;
    return instance;
}

/// The name behind links. Those of the system's own folders for open files lead to no name.
Result<fs::path> targetOf(const fs::path& path) {
    const std::string name = path.generic_string();
    const bool isSystems = name.starts_with("/dev/") || name.starts_with("/proc/");
    if (isSystems && !fileState(path).device.empty()) return path;
    return followLinks(path);
}

}  // namespace

Result<OutputFile> OutputFile::open(const fs::path& path, std::string_view kind, Replacing replacing) {
    auto impl = std::make_unique<Impl>();
    impl->path = path;
    impl->replacing = replacing;
    if (path == kStandardOutput && isPipeAllowed(path)) {
        impl->target = path;
        return OutputFile(std::move(impl));
    }
    auto target = targetOf(path);
    if (!target) return tl::unexpected(target.error());
    const FileState state = fileState(*target);
    if (auto status = mayReplace(path, *target, kind, replacing); !status)
        return tl::unexpected(status.error());
    impl->target = std::move(*target);
    impl->accessed = state.accessed;
    if (state.device.empty()) {
        auto temporary = TemporaryFile::create(impl->target);
        if (!temporary) return notWritten(path, temporary.error());
        impl->temporary = std::move(*temporary);
    }
    return OutputFile(std::move(impl));
}

Status OutputFile::check(const fs::path& path, std::string_view kind) {
    const auto target = targetOf(path);
    if (!target) return tl::unexpected(target.error());
    return mayReplace(path, *target, kind, Replacing::SameKind);
}

Status OutputFile::tryOut() {
    if (!impl_->temporary) return {};
    constexpr std::byte kAny{};
    if (auto status = impl_->temporary->write({&kAny, 1}); !status)
        return notWritten(impl_->path, status.error());
    if (auto status = impl_->temporary->flush(); !status) return notWritten(impl_->path, status.error());
    return {};
}

Status OutputFile::write(std::span<const std::byte> bytes) {
    if (impl_->beginning.size() < kContentKindBytes) {
        const auto more = bytes.first(std::min(bytes.size(), kContentKindBytes - impl_->beginning.size()));
        impl_->beginning.insert(impl_->beginning.end(), more.begin(), more.end());
    }
    if (!impl_->temporary) {
        impl_->held.insert(impl_->held.end(), bytes.begin(), bytes.end());
        return {};
    }
    if (const auto status = impl_->temporary->write(bytes); !status)
        return notWritten(impl_->path, status.error());
    return {};
}

Status OutputFile::writeAt(std::uint64_t offset, std::span<const std::byte> bytes) {
    if (!impl_->temporary) {
        if (impl_->held.size() < offset + bytes.size())
            impl_->held.resize(static_cast<std::size_t>(offset) + bytes.size());
        std::memcpy(impl_->held.data() + offset, bytes.data(), bytes.size());
        return {};
    }
    if (auto status = impl_->temporary->writeAt(offset, bytes); !status)
        return notWritten(impl_->path, status.error());
    return {};
}

void OutputFile::keepUnfinished() {
    if (impl_->temporary) impl_->temporary->setKept(true);
}

Status Coming::putInPlace(bool isOldKept) {
    if (!temporary) {
        if (auto status = writeThrough(target, held); !status) return notWritten(path, status.error());
        return {};
    }
    if (temporary->equalsTarget()) {
        temporary->setKept(false);
        temporary.reset();
    } else if (auto status = temporary->replaceTarget(accessed, isOldKept); !status) {
        return notWritten(path, status.error());
    }
    return {};
}

Status OutputFile::finish() {
    if (impl_->temporary) {
        if (auto status = impl_->mayReplace(); !status) return status;
    }
    if (!waiting().open) {
        const bool isFile = impl_->temporary.has_value();
        auto status = impl_->putInPlace();
        if (status && isFile) noteWritten(impl_->target);
        return status;
    }
    if (impl_->temporary) {
        if (auto status = impl_->temporary->flush(); !status) return notWritten(impl_->path, status.error());
    }
    waiting().files.push_back(std::move(impl_));
    return {};
}

OutputBatch::OutputBatch() : isOuter_(!waiting().open) {
    waiting().open = true;
    if (isOuter_) allowManyFiles();
}

OutputBatch::~OutputBatch() {
    if (!isOuter_) return;
    waiting().open = false;
    waiting().files.clear();
}

fs::path whereWritten(const fs::path& path) {
    if (!waiting().open) return path;
    const auto target = targetOf(path);
    if (!target) return path;
    const auto& files = waiting().files;
    const auto last = std::find_if(files.rbegin(), files.rend(), [&](const auto& file) {
        return file->temporary && file->target == *target;
    });
    return last == files.rend() ? path : (*last)->temporary->path();
}

std::vector<fs::path> waitingFiles() {
    std::vector<fs::path> paths;
    std::set<fs::path> isKnown;
    for (const auto& file : waiting().files)
        if (file->temporary && isKnown.insert(file->path).second) paths.push_back(file->path);
    return paths;
}

fs::path numbered(const fs::path& path, std::size_t number) {
    return path.parent_path() /
           (path.stem().string() + fmt::format("_{:04}", number) + path.extension().string());
}

Status OutputBatch::commit() {
    if (!isOuter_) return {};
    const EndsLater whole;
    auto files = std::exchange(waiting().files, {});
    // What has gone into a device does not come back: it comes last.
    const auto devices = std::stable_partition(files.begin(), files.end(),
                                               [](const auto& file) { return file->temporary.has_value(); });
    const auto places = std::span(files.begin(), devices);
    for (const auto& file : places) {
        if (auto status = file->mayReplace(); !status) return status;
    }
    std::vector<fs::path> written;
    for (const auto& file : places) written.push_back(file->target);
    for (std::size_t i = 0; i < files.size(); ++i) {
        const auto status = files[i]->putInPlace(true);
        if (status) continue;
        Error error = status.error();
        for (std::size_t k = i + 1; k-- > 0;) {
            if (auto back = files[k]->putBack(); !back) {
                error.problem +=
                    fmt::format("; {} cannot be put back: {}", files[k]->path.string(), back.error().problem);
            }
        }
        return tl::unexpected(std::move(error));
    }
    for (const fs::path& target : written) noteWritten(target);
    return {};
}

Status writeFileAtomically(const fs::path& path, std::span<const std::byte> bytes, Replacing replacing) {
    auto file = OutputFile::open(path, contentKind(bytes), replacing);
    if (!file) return tl::unexpected(file.error());
    if (auto status = file->write(bytes); !status) return status;
    return file->finish();
}

Status writeFileAtomically(const fs::path& path, std::string_view text) {
    return writeFileAtomically(path, std::as_bytes(std::span(text.data(), text.size())));
}

Result<std::vector<std::string>> writeFiles(const fs::path& folder,
                                            const std::vector<std::pair<std::string, std::string>>& files) {
    std::error_code code;
    fs::create_directories(folder, code);
    if (code)
        return failIn(folder.string(), {}, "the folder cannot be made: " + code.message(),
                      "expected a folder that can be written");
    OutputBatch batch;
    std::vector<std::string> names;
    for (const auto& [name, text] : files) {
        if (auto status = writeFileAtomically(folder / name, text); !status)
            return tl::unexpected(status.error());
        names.push_back(name);
    }
    if (auto status = batch.commit(); !status) return tl::unexpected(status.error());
    return names;
}

std::vector<LeftOver> findLeftOvers(const fs::path& folder) {
    std::vector<LeftOver> found;
    std::error_code code;
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
        const std::string name = entry->path().filename().string();
        if (!isTemporaryName(name) || !entry->is_regular_file(code) || isBeingWritten(entry->path()))
            continue;
        const bool whole = name.ends_with(kWholeSuffix);
        // ".NAME.RANDOM.hairloom-part": NAME is what is left without the last two pieces.
        const std::size_t cut = name.rfind('.', name.rfind('.') - 1);
        found.push_back({entry->path(), name.substr(1, cut - 1), entry->file_size(code), whole});
        code.clear();
    }
    std::ranges::sort(found, {}, &LeftOver::file);
    return found;
}

Status removeLeftOver(const LeftOver& leftOver) {
    const std::string name = leftOver.file.string();
    if (isBeingWritten(leftOver.file))
        return failIn(name, {}, "is being written", "wait until the other program is done");
    std::error_code code;
    if (!fs::remove(leftOver.file, code) || code)
        return failIn(name, {}, fmt::format("cannot be removed: {}", code.message()),
                      "expected a folder that can be written");
    return {};
}

}  // namespace hairloom
