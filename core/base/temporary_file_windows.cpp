// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <windows.h>

#include <bcrypt.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <system_error>
#include <vector>

#include "core/base/hash.h"
#include "core/base/output_file.h"
#include "core/base/temporary_file.h"

namespace hairloom {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kCopyBytes = std::size_t{1} << 20u;

tl::unexpected<Error> systemError(DWORD code = GetLastError()) {
    return fail(std::system_category().message(static_cast<int>(code)));
}

class Handle {
  public:
    explicit Handle(HANDLE handle = INVALID_HANDLE_VALUE) : handle_(handle) {}
    Handle(Handle&& other) noexcept : handle_(std::exchange(other.handle_, INVALID_HANDLE_VALUE)) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~Handle() { close(); }
    void close() {
        if (*this) CloseHandle(std::exchange(handle_, INVALID_HANDLE_VALUE));
    }
    HANDLE get() const { return handle_; }
    explicit operator bool() const { return handle_ != INVALID_HANDLE_VALUE && handle_ != nullptr; }

  private:
    HANDLE handle_;
};

constexpr DWORD kShareAll = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

Handle openExisting(const fs::path& path, DWORD access, DWORD share = kShareAll) {
    return Handle(CreateFileW(path.c_str(), access, share, nullptr, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS,
                              nullptr));
}

/// Names that the console's handler takes away; see the other system's file.
struct Slot {
    std::atomic<int> state{0};  ///< 0 free, 1 being written, 2 in use
    std::array<wchar_t, 1024> path{};
    std::atomic<HANDLE> file{INVALID_HANDLE_VALUE};
};
std::array<Slot, 256> slots;  // NOLINT(readability-identifier-naming): the handler's

Slot* takeSlot(const fs::path& path) {
    const std::wstring& text = path.native();
    for (Slot& slot : slots) {
        int isFree = 0;
        if (text.size() >= slot.path.size() || !slot.state.compare_exchange_strong(isFree, 1)) continue;
        std::ranges::copy(text, slot.path.begin());
        slot.path[text.size()] = 0;
        slot.state = 2;
        return &slot;
    }
    return nullptr;
}

bool isOwn(const fs::path& path) {
    return std::ranges::any_of(slots,
                               [&](const Slot& slot) { return slot.state == 2 && path == slot.path.data(); });
}

std::atomic<int> endsLater{0};          // NOLINT(readability-identifier-naming): the handler's
std::mutex foldersMutex;                // NOLINT(readability-identifier-naming)
std::vector<fs::path> foldersToRemove;  // NOLINT(readability-identifier-naming): the innermost first

BOOL WINAPI removeAndEnd(DWORD) {
    // A thread of its own.
    while (endsLater > 0) Sleep(10);
    for (Slot& slot : slots) {
        if (slot.state != 2) continue;
        CloseHandle(slot.file);
        DeleteFileW(slot.path.data());
    }
    const std::lock_guard lock(foldersMutex);
    for (const fs::path& folder : foldersToRemove) RemoveDirectoryW(folder.c_str());
    return FALSE;  // the next handler ends the process
}

std::string randomText() {
    constexpr std::string_view kLetters = "0123456789abcdefghijklmnopqrstuv";
    std::array<unsigned char, 13> bytes{};
    BCryptGenRandom(nullptr, bytes.data(), static_cast<ULONG>(bytes.size()), BCRYPT_USE_SYSTEM_PREFERRED_RNG);
    std::string text;
    for (const unsigned char byte : bytes) text += kLetters[byte % kLetters.size()];
    return text;
}

/// Held while a temporary file is looked for and made, so that of two writers one comes first.
class FolderLock {
  public:
    explicit FolderLock(const fs::path& folder) {
        std::error_code code;
        const std::wstring name = fs::absolute(folder, code).native();
        const auto hash = hashBytes(std::as_bytes(std::span(name)));
        const std::string text = fmt::format("Local\\hairloom-{:016x}", hash);
        mutex_ = Handle(CreateMutexW(nullptr, FALSE, std::wstring(text.begin(), text.end()).c_str()));
        if (mutex_) WaitForSingleObject(mutex_.get(), 2000);
    }
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;
    ~FolderLock() {
        if (mutex_) ReleaseMutex(mutex_.get());
    }

  private:
    Handle mutex_;
};

bool somebodyWrites(const fs::path& folder, const std::string& prefix) {
    std::error_code code;
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
        const std::string name = entry->path().filename().string();
        const bool temporary = name.ends_with(kPartSuffix) || name.ends_with(kWholeSuffix);
        if (!temporary || !name.starts_with(prefix)) continue;
        if (name.find('.', prefix.size()) != name.rfind('.')) continue;
        if (!isOwn(entry->path()) && isBeingWritten(entry->path())) return true;
    }
    return false;
}

Status writeAll(HANDLE file, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const auto piece = bytes.first(std::min(bytes.size(), kCopyBytes));
        DWORD written = 0;
        if (WriteFile(file, piece.data(), static_cast<DWORD>(piece.size()), &written, nullptr) == 0)
            return systemError();
        bytes = bytes.subspan(written);
    }
    return {};
}

std::size_t readPiece(HANDLE file, std::vector<std::byte>& piece, std::uint64_t offset) {
    piece.resize(kCopyBytes);
    OVERLAPPED at{};
    at.Offset = static_cast<DWORD>(offset);
    at.OffsetHigh = static_cast<DWORD>(offset >> 32u);
    DWORD got = 0;
    if (ReadFile(file, piece.data(), static_cast<DWORD>(piece.size()), &got, &at) == 0) got = 0;
    piece.resize(got);
    return got;
}

/// All that `from` holds becomes all that `to` holds, on the disk.
Status copyContent(HANDLE from, HANDLE to) {
    std::vector<std::byte> piece;
    for (std::uint64_t at = 0; readPiece(from, piece, at) > 0; at += piece.size()) {
        if (auto status = writeAll(to, piece); !status) return status;
    }
    return SetEndOfFile(to) != 0 && FlushFileBuffers(to) != 0 ? Status() : systemError();
}

std::string prefixFor(const fs::path& target) {
    return "." + target.filename().string() + ".";
}

fs::path beside(const fs::path& target) {
    return target.parent_path() / fs::path(prefixFor(target) + randomText() + std::string(kPartSuffix));
}

}  // namespace

FileState fileState(const fs::path& path) {
    FileState state;
    const DWORD attributes = GetFileAttributesW(path.c_str());
    const Handle file = openExisting(path, 0);
    if (attributes == INVALID_FILE_ATTRIBUTES && !file) return state;
    state.exists = true;
    if (file && GetFileType(file.get()) != FILE_TYPE_DISK) {
        state.device = GetFileType(file.get()) == FILE_TYPE_PIPE ? kFifo : "a device";
        return state;
    }
    state.folder = (attributes & FILE_ATTRIBUTE_DIRECTORY) != 0;
    state.readOnly = !state.folder && (attributes & FILE_ATTRIBUTE_READONLY) != 0;
    BY_HANDLE_FILE_INFORMATION info{};
    if (!file || GetFileInformationByHandle(file.get(), &info) == 0) return state;
    state.identity = {info.dwVolumeSerialNumber,
                      std::uint64_t{info.nFileIndexHigh} << 32u | info.nFileIndexLow};
    state.bytes = std::uint64_t{info.nFileSizeHigh} << 32u | info.nFileSizeLow;
    state.changed = static_cast<std::int64_t>(std::uint64_t{info.ftLastWriteTime.dwHighDateTime} << 32u |
                                              info.ftLastWriteTime.dwLowDateTime);
    return state;
}

Result<fs::path> followLinks(const fs::path& path) {
    constexpr int kMaxLinks = 40;
    fs::path at = path;
    for (int i = 0; i < kMaxLinks; ++i) {
        std::error_code code;
        if (!fs::is_symlink(fs::symlink_status(at, code)) || code) return at;
        const fs::path next = fs::read_symlink(at, code);
        if (code) return at;
        at = next.is_absolute() ? next : at.parent_path() / next;
    }
    return failIn(path.string(), {}, "is a circular link", "expected the name of a file");
}

struct TemporaryFile::Impl {
    fs::path target;
    fs::path path;
    Handle file;
    Slot* slot = nullptr;
    fs::path old;            ///< what was there before; empty where nothing is kept
    bool isOldCopy = false;  ///< of its content; else the file itself by another name
    DWORD oldAttributes = FILE_ATTRIBUTE_NORMAL;
    bool isTouched = false;  ///< the target is no longer as it was
    bool isLeft = false;  ///< it stays: the target is torn and this has all of its content, or by setKept()

    Impl() = default;
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        file.close();
        if (!path.empty() && !isLeft) DeleteFileW(path.c_str());
        if (!old.empty()) DeleteFileW(old.c_str());
        clearSlot();
    }
    void clearSlot() {
        if (slot != nullptr) slot->state = 0;
        slot = nullptr;
    }
    Status make();
    Status keepOld(bool isCopy);
    Status putBack();
    Status moveIntoPlace();
    Status copyIntoPlace();
};

TemporaryFile::TemporaryFile(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TemporaryFile::TemporaryFile(TemporaryFile&&) noexcept = default;
TemporaryFile& TemporaryFile::operator=(TemporaryFile&&) noexcept = default;
TemporaryFile::~TemporaryFile() = default;

Status TemporaryFile::Impl::make() {
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    // As u8string: names outside the code page are text all the same.
    const std::string prefix = prefixFor(target);
    const FolderLock lock(folder);
    if (somebodyWrites(folder, prefix)) return fail("another program is writing it", "wait until it is done");
    const fs::path wanted = beside(target);
    slot = takeSlot(wanted);
    // Nobody else may open it for writing: that is how isBeingWritten() knows.
    file = Handle(CreateFileW(wanted.c_str(), GENERIC_READ | GENERIC_WRITE, FILE_SHARE_READ, nullptr,
                              CREATE_NEW, FILE_ATTRIBUTE_NORMAL, nullptr));
    if (!file) return systemError();
    if (slot != nullptr) slot->file = file.get();
    path = wanted;
    return {};
}

Result<TemporaryFile> TemporaryFile::create(const fs::path& target) {
    auto impl = std::make_unique<Impl>();
    impl->target = target;
    if (auto status = impl->make(); !status) return tl::unexpected(status.error());
    return TemporaryFile(std::move(impl));
}

Status TemporaryFile::write(std::span<const std::byte> bytes) {
    return writeAll(impl_->file.get(), bytes);
}

Status TemporaryFile::writeAt(std::uint64_t offset, std::span<const std::byte> bytes) {
    LARGE_INTEGER at{}, end{};
    at.QuadPart = static_cast<LONGLONG>(offset);
    if (SetFilePointerEx(impl_->file.get(), at, nullptr, FILE_BEGIN) == 0) return systemError();
    if (auto status = writeAll(impl_->file.get(), bytes); !status) return status;
    return SetFilePointerEx(impl_->file.get(), end, nullptr, FILE_END) != 0 ? Status() : systemError();
}

Status TemporaryFile::flush() {
    if (FlushFileBuffers(impl_->file.get()) == 0) return systemError();
    return {};
}

fs::path TemporaryFile::path() const {
    return impl_->path;
}

void TemporaryFile::setKept(bool isKept) {
    impl_->isLeft = isKept;
    if (isKept) impl_->clearSlot();
}

bool TemporaryFile::equalsTarget() const {
    const Handle old = openExisting(impl_->target, GENERIC_READ);
    LARGE_INTEGER own{}, theirs{};
    if (!old || GetFileSizeEx(old.get(), &theirs) == 0 || GetFileSizeEx(impl_->file.get(), &own) == 0 ||
        own.QuadPart != theirs.QuadPart)
        return false;
    std::vector<std::byte> a, b;
    for (std::uint64_t at = 0; readPiece(old.get(), a, at) > 0; at += a.size()) {
        readPiece(impl_->file.get(), b, at);
        if (a != b) return false;
    }
    return true;
}

/// ReplaceFile() keeps the old file's attributes, access list and time of creation.
Status TemporaryFile::Impl::moveIntoPlace() {
    if (FlushFileBuffers(file.get()) == 0) return systemError();
    const DWORD attributes = GetFileAttributesW(target.c_str());
    const bool exists = attributes != INVALID_FILE_ATTRIBUTES;
    // Forced: a read-only file stays one.
    const bool readOnly = exists && (attributes & FILE_ATTRIBUTE_READONLY) != 0;
    if (readOnly) SetFileAttributesW(target.c_str(), attributes & ~DWORD{FILE_ATTRIBUTE_READONLY});
    if (slot != nullptr) slot->file = INVALID_HANDLE_VALUE;
    file.close();
    bool moved = exists && ReplaceFileW(target.c_str(), path.c_str(), nullptr,
                                        REPLACEFILE_IGNORE_MERGE_ERRORS, nullptr, nullptr) != 0;
    if (!moved) {
        moved = MoveFileExW(path.c_str(), target.c_str(),
                            MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) != 0;
    }
    const DWORD code = GetLastError();
    if (readOnly) SetFileAttributesW(target.c_str(), attributes);
    if (!moved) return systemError(code);
    isTouched = true;
    path.clear();
    clearSlot();
    return {};
}

/// The file itself stays, with all its links. Killed on the way, the run leaves the whole content beside it.
Status TemporaryFile::Impl::copyIntoPlace() {
    if (FlushFileBuffers(file.get()) == 0) return systemError();
    const Handle there = openExisting(target, GENERIC_WRITE, FILE_SHARE_READ);
    if (!there) return systemError();
    fs::path whole = path;
    whole.replace_extension(std::string(kWholeSuffix));
    if (slot != nullptr) slot->file = INVALID_HANDLE_VALUE;
    file.close();
    clearSlot();
    if (MoveFileExW(path.c_str(), whole.c_str(), MOVEFILE_WRITE_THROUGH) == 0) return systemError();
    path = whole;
    file = openExisting(whole, GENERIC_READ, 0);
    if (!file) return systemError();
    isLeft = isTouched = true;
    if (auto status = copyContent(file.get(), there.get()); !status) return status;
    isLeft = false;
    return {};
}

/// A second name where the file itself is going to make room, else a copy, as where file systems know no
/// second names.
Status TemporaryFile::Impl::keepOld(bool isCopy) {
    const fs::path kept = beside(target);
    oldAttributes = GetFileAttributesW(target.c_str());
    isOldCopy = isCopy || CreateHardLinkW(kept.c_str(), target.c_str(), nullptr) == 0;
    if (isOldCopy && CopyFileW(target.c_str(), kept.c_str(), TRUE) == 0) return systemError();
    if (isOldCopy) SetFileAttributesW(kept.c_str(), FILE_ATTRIBUTE_NORMAL);
    old = kept;
    return {};
}

Status TemporaryFile::Impl::putBack() {
    if (!isTouched) return {};
    if (old.empty()) return DeleteFileW(target.c_str()) != 0 ? Status() : systemError();
    if (!isOldCopy) {
        if (MoveFileExW(old.c_str(), target.c_str(), MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) == 0)
            return systemError();
        SetFileAttributesW(target.c_str(), oldAttributes);
        old.clear();
        return {};
    }
    const Handle kept = openExisting(old, GENERIC_READ);
    const Handle there = openExisting(target, GENERIC_WRITE, FILE_SHARE_READ);
    FILETIME written{};
    if (!kept || !there || GetFileTime(kept.get(), nullptr, nullptr, &written) == 0) return systemError();
    if (auto status = copyContent(kept.get(), there.get()); !status) return status;
    SetFileTime(there.get(), nullptr, nullptr, &written);
    isLeft = false;
    return {};
}

Status TemporaryFile::putBack() {
    auto status = impl_->putBack();
    if (status || impl_->old.empty()) return status;
    const fs::path kept = std::exchange(impl_->old, {});
    return fail(fmt::format("{}; what was there is in '{}'", status.error().problem, kept.string()));
}

/// ReplaceFile() takes care of times.
Status TemporaryFile::replaceTarget(std::int64_t, bool isOldKept) {
    BY_HANDLE_FILE_INFORMATION info{};
    const bool isThere = [&] {
        const Handle there = openExisting(impl_->target, 0);
        if (there && GetFileInformationByHandle(there.get(), &info) == 0) info.nNumberOfLinks = 1;
        return static_cast<bool>(there);
    }();
    const bool isLinked = info.nNumberOfLinks > 1;
    // One that a program holds stays. ReplaceFile() may leave pieces of its own before it says so.
    if (isThere && !isLinked && !openExisting(impl_->target, DELETE) &&
        GetLastError() == ERROR_SHARING_VIOLATION)
        return systemError();
    if (isThere && isOldKept) {
        if (auto status = impl_->keepOld(isLinked); !status) return status;
    }
    return isLinked ? impl_->copyIntoPlace() : impl_->moveIntoPlace();
}

Status writeThrough(const fs::path& path, std::span<const std::byte> bytes) {
    if (path == "-") return writeAll(GetStdHandle(STD_OUTPUT_HANDLE), bytes);
    const Handle device = openExisting(path, GENERIC_WRITE);
    if (!device) return systemError();
    return writeAll(device.get(), bytes);
}

void allowManyFiles() {}  // there is no such limit

EndsLater::EndsLater() {
    ++endsLater;
}

EndsLater::~EndsLater() {
    --endsLater;
}

void removeFoldersWhenEnded(const std::vector<fs::path>& innermostFirst) {
    const std::lock_guard lock(foldersMutex);
    foldersToRemove = innermostFirst;
}

bool isBeingWritten(const fs::path& temporary) {
    const Handle file = openExisting(temporary, GENERIC_READ | GENERIC_WRITE, 0);
    return !file && GetLastError() == ERROR_SHARING_VIOLATION;
}

void removeTemporariesWhenEnded() {
    SetConsoleCtrlHandler(removeAndEnd, TRUE);
}

}  // namespace hairloom
