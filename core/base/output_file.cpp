// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/output_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "core/base/content_kind.h"
#include "core/base/file.h"
#include "core/base/log.h"
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

/// Whether rules allow content of `kind` (empty where unknown yet) in place of what has the name.
Status mayReplace(const fs::path& path, const FileState& state, std::string_view kind, Replacing replacing) {
    const auto refuse = [&](std::string what) {
        return failIn(path.string(), {}, std::move(what), writeRules().instead);
    };
    if (!state.exists) return {};
    if (state.folder) return failIn(path.string(), {}, "is a folder", "expected the name of a file");
    if (writeRules().force || replacing == Replacing::Anything) return {};
    if (!state.device.empty()) return refuse(fmt::format("is {}", state.device));
    if (state.readOnly) return refuse("is read-only");
    const InputState input = inputState(state);
    if (input == InputState::ChangedSince) return refuse("was changed by another program since it was read");
    if (kind.empty()) return {};
    if (input == InputState::AsRead && kind != content::kProject)
        return refuse("is an input of this job and would be replaced");
    const std::string_view there = contentKind(readBeginning(path, kContentKindBytes));
    if (there == kind || state.bytes == 0) return {};
    return refuse(fmt::format("is {} and would be replaced by {}", there, kind));
}

bool isTemporaryName(std::string_view name) {
    return name.starts_with('.') && (name.ends_with(kPartSuffix) || name.ends_with(kWholeSuffix));
}

}  // namespace

struct OutputFile::Impl {
    fs::path path;    ///< as asked for
    fs::path target;  ///< behind links
    Replacing replacing = Replacing::SameKind;
    std::int64_t accessed = 0;  ///< the file that is replaced, before anybody looked at its kind
    std::vector<std::byte> beginning;
    std::optional<TemporaryFile> temporary;  ///< none for a device
};

OutputFile::OutputFile(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
OutputFile::OutputFile(OutputFile&&) noexcept = default;
OutputFile& OutputFile::operator=(OutputFile&&) noexcept = default;
OutputFile::~OutputFile() = default;

Result<OutputFile> OutputFile::open(const fs::path& path, std::string_view kind, Replacing replacing) {
    auto target = followLinks(path);
    if (!target) return tl::unexpected(target.error());
    const FileState state = fileState(*target);
    if (auto status = mayReplace(path, state, kind, replacing); !status)
        return tl::unexpected(status.error());
    auto impl = std::make_unique<Impl>();
    impl->path = path;
    impl->target = std::move(*target);
    impl->replacing = replacing;
    impl->accessed = state.accessed;
    if (state.device.empty()) {
        auto temporary = TemporaryFile::create(impl->target);
        if (!temporary) return notWritten(path, temporary.error());
        impl->temporary = std::move(*temporary);
    }
    return OutputFile(std::move(impl));
}

bool OutputFile::isRegular() const {
    return impl_->temporary.has_value();
}

Status OutputFile::write(std::span<const std::byte> bytes) {
    if (impl_->beginning.size() < kContentKindBytes) {
        const auto more = bytes.first(std::min(bytes.size(), kContentKindBytes - impl_->beginning.size()));
        impl_->beginning.insert(impl_->beginning.end(), more.begin(), more.end());
    }
    const auto status =
        impl_->temporary ? impl_->temporary->write(bytes) : writeThrough(impl_->target, bytes);
    if (!status) return notWritten(impl_->path, status.error());
    return {};
}

Status OutputFile::writeAt(std::uint64_t offset, std::span<const std::byte> bytes) {
    if (!impl_->temporary)
        return failIn(impl_->path.string(), {}, "cannot be written out of order", "expected a file");
    if (auto status = impl_->temporary->writeAt(offset, bytes); !status)
        return notWritten(impl_->path, status.error());
    return {};
}

Status OutputFile::finish() {
    if (!impl_->temporary) return {};
    const std::string_view kind = contentKind(impl_->beginning);
    if (auto status = mayReplace(impl_->path, fileState(impl_->target), kind, impl_->replacing); !status)
        return status;
    if (impl_->temporary->equalsTarget()) {
        impl_->temporary.reset();
    } else if (auto status = impl_->temporary->replaceTarget(impl_->accessed); !status) {
        return notWritten(impl_->path, status.error());
    }
    noteWritten(impl_->target);
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
    if (code) return failIn(folder.string(), {}, "the folder cannot be made: " + code.message());
    std::vector<std::string> names;
    for (const auto& [name, text] : files) {
        if (auto status = writeFileAtomically(folder / name, text); !status)
            return tl::unexpected(status.error());
        names.push_back(name);
    }
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
        return failIn(name, {}, fmt::format("cannot be removed: {}", code.message()));
    return {};
}

}  // namespace hairloom
