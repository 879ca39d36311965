// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <vector>

#include "core/base/descriptor_posix.h"
#include "core/base/ended_slots_posix.h"
#include "core/base/output_file.h"
#include "core/base/temporary_file.h"

namespace hairloom {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kCopyBytes = std::size_t{1} << 20u;

tl::unexpected<Error> systemError(int code = errno) {
    return fail(std::generic_category().message(code));
}

std::string randomText() {
    constexpr std::string_view kLetters = "0123456789abcdefghijklmnopqrstuv";
    std::array<unsigned char, 13> bytes{};
    // The kernel's pool is filled long before a user's program starts; a short read cannot be of so few
    // bytes.
    while (getrandom(bytes.data(), bytes.size(), 0) < 0 && errno == EINTR) {
    }
    std::string text;
    for (const unsigned char byte : bytes) text += kLetters[byte % kLetters.size()];
    return text;
}

/// ".NAME." of temporary files, with a name cut where the whole would be too long.
std::string prefixFor(const fs::path& target) {
    return "." + target.filename().string().substr(0, 200) + ".";
}

/// Held while a temporary file is looked for and made, so that of two writers one comes first. Where the file
/// system knows no locks, both go on, and the last one's content stands.
class FolderLock {
  public:
    explicit FolderLock(int folder) : folder_(folder) {
        // A program that keeps a lock on a folder for itself must not stop us for good.
        constexpr int kTries = 2000;
        for (int i = 0; i < kTries && flock(folder_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK; ++i)
            usleep(1000);
    }
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;
    ~FolderLock() { flock(folder_, LOCK_UN); }

  private:
    int folder_;
};

bool isLocked(int folder, const char* name) {
    const Descriptor file(openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    return file && flock(file.number(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

/// Whether another process is writing a target with these temporary names.
bool somebodyWrites(const fs::path& folderPath, int folder, const std::string& prefix) {
    std::error_code code;
    for (fs::directory_iterator entry(folderPath, code), end; !code && entry != end; entry.increment(code)) {
        const std::string name = entry->path().filename().string();
        const bool temporary = name.ends_with(kPartSuffix) || name.ends_with(kWholeSuffix);
        if (!temporary || !name.starts_with(prefix)) continue;
        // The random part follows at once: ".a.b.RANDOM" is not of "a".
        if (name.find('.', prefix.size()) != name.rfind('.')) continue;
        if (!isInEndedSlot(name) && isLocked(folder, name.c_str())) return true;
    }
    return false;
}

Status writeAll(int file, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(file, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return systemError(written < 0 ? errno : ENOSPC);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return {};
}

std::size_t readPiece(int file, std::vector<std::byte>& piece, std::uint64_t offset) {
    piece.resize(kCopyBytes);
    std::size_t count = 0;
    while (count < piece.size()) {
        const ssize_t got =
            pread(file, piece.data() + count, piece.size() - count, static_cast<off_t>(offset + count));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        count += static_cast<std::size_t>(got);
    }
    piece.resize(count);
    return count;
}

/// All that `from` holds becomes all that `to` holds, on the disk.
Status copyContent(int from, int to) {
    std::vector<std::byte> piece;
    std::uint64_t at = 0;
    for (; readPiece(from, piece, at) > 0; at += piece.size()) {
        if (auto status = writeAll(to, piece); !status) return status;
    }
    if (ftruncate(to, static_cast<off_t>(at)) != 0 || fsync(to) != 0) return systemError();
    return {};
}

/// Access lists and attributes of users; what the file system does not take stays behind.
void copyAttributes(int from, int to) {
    std::vector<char> names(std::size_t{1} << 16u);
    const ssize_t size = flistxattr(from, names.data(), names.size());
    for (const char* name = names.data(); size > 0 && name < names.data() + size;
         name += std::strlen(name) + 1) {
        const std::string_view view(name);
        if (!view.starts_with("user.") && view != "system.posix_acl_access") continue;
        std::vector<char> value(std::size_t{1} << 16u);
        const ssize_t length = fgetxattr(from, name, value.data(), value.size());
        if (length >= 0) fsetxattr(to, name, value.data(), static_cast<std::size_t>(length), 0);
    }
}

constexpr std::int64_t kNanoseconds = 1'000'000'000;

std::int64_t nanoseconds(const timespec& time) {
    return std::int64_t{time.tv_sec} * kNanoseconds + time.tv_nsec;
}

std::string_view deviceName(mode_t mode) {
    if (S_ISFIFO(mode)) return kFifo;
    if (S_ISSOCK(mode)) return "a socket";
    if (S_ISREG(mode) || S_ISDIR(mode)) return {};
    return "a device";
}

/// The superuser may write what nobody may: without a bit for writing, the file is meant to stay.
bool isReadOnly(const fs::path& path, mode_t mode) {
    return (mode & (S_IWUSR | S_IWGRP | S_IWOTH)) == 0 ||
           (access(path.c_str(), W_OK) != 0 && errno != ENOENT);
}

/// A link in a folder where everybody may write, laid by neither us nor the folder's owner.
bool isForeignLink(const fs::path& link) {
    struct stat own {
    }, folder{};
    const fs::path parent = link.has_parent_path() ? link.parent_path() : fs::path(".");
    if (lstat(link.c_str(), &own) != 0 || stat(parent.c_str(), &folder) != 0) return false;
    return (folder.st_mode & S_ISVTX) != 0 && (folder.st_mode & S_IWOTH) != 0 && own.st_uid != geteuid() &&
           own.st_uid != folder.st_uid;
}

}  // namespace

FileState fileState(const fs::path& path) {
    FileState state;
    struct stat info {};
    if (stat(path.c_str(), &info) != 0) return state;
    state.exists = true;
    state.folder = S_ISDIR(info.st_mode);
    state.device = deviceName(info.st_mode);
    state.readOnly = !state.folder && isReadOnly(path, info.st_mode);
    state.identity = {info.st_dev, info.st_ino};
    state.bytes = static_cast<std::uint64_t>(info.st_size);
    state.changed = nanoseconds(info.st_mtim);
    state.accessed = nanoseconds(info.st_atim);
    return state;
}

Result<fs::path> followLinks(const fs::path& path) {
    constexpr int kMaxLinks = 40;
    fs::path at = path;
    for (int i = 0; i < kMaxLinks; ++i) {
        std::error_code code;
        const fs::path next = fs::read_symlink(at, code);
        if (code) return at;
        if (isForeignLink(at)) {
            return failIn(path.string(), {}, "is a link of another user in a folder for all users",
                          "give another name");
        }
        at = next.is_absolute() ? next : at.parent_path() / next;
    }
    return failIn(path.string(), {}, "is a circular link", "expected the name of a file");
}

struct TemporaryFile::Impl {
    fs::path target;
    std::string targetName;
    std::string name;
    Descriptor folder, file;
    EndedSlot* slot = nullptr;
    /// What was there before, where it is kept: the file itself by another name, or a copy of its content.
    struct Old {
        std::string name;  ///< empty where nothing is kept
        bool isCopy = false;
        struct stat info {};
        Descriptor file;  ///< locked, as what is being written
    } old;
    bool isTouched = false;  ///< the target is no longer as it was
    bool isLeft = false;  ///< it stays: the target is torn and this has all of its content, or by setKept()

    Impl() = default;
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        if (!name.empty() && !isLeft) unlinkat(folder.number(), name.c_str(), 0);
        if (!old.name.empty()) unlinkat(folder.number(), old.name.c_str(), 0);
        clearSlot();
    }
    void clearSlot() {
        if (slot != nullptr) slot->state = 0;
        slot = nullptr;
    }

    Status make();
    Descriptor openTarget(int flags) const {
        return Descriptor(openat(folder.number(), targetName.c_str(), flags | O_NOFOLLOW | O_CLOEXEC));
    }
    Result<bool> adopt(int from, const struct stat& info, std::int64_t accessed) const;
    Status keepOld(const struct stat& info, bool isCopy);
    Status putBack();
    Status moveIntoPlace();
    Status copyIntoPlace();
    Status flushFolder() const {
        // Some network file systems flush no folders, and say so.
        if (fsync(folder.number()) != 0 && errno != EINVAL && errno != EROFS) return systemError();
        return {};
    }
};

TemporaryFile::TemporaryFile(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TemporaryFile::TemporaryFile(TemporaryFile&&) noexcept = default;
TemporaryFile& TemporaryFile::operator=(TemporaryFile&&) noexcept = default;
TemporaryFile::~TemporaryFile() = default;

Status TemporaryFile::Impl::make() {
    const std::string prefix = prefixFor(target);
    const fs::path folderPath = target.has_parent_path() ? target.parent_path() : fs::path(".");
    folder = Descriptor(open(folderPath.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!folder) return systemError();
    const FolderLock lock(folder.number());
    if (somebodyWrites(folderPath, folder.number(), prefix))
        return fail("another program is writing it", "wait until it is done");
    const std::string wanted = prefix + randomText() + std::string(kPartSuffix);
    slot = takeEndedSlot(folder.number(), wanted);
    // Nobody else reads what may become a private file; adopt() opens it as far as the target is open.
    const bool exists = faccessat(folder.number(), targetName.c_str(), F_OK, AT_SYMLINK_NOFOLLOW) == 0;
    file = Descriptor(openat(folder.number(), wanted.c_str(),
                             O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, exists ? 0600 : 0666));
    if (!file) return systemError();
    name = wanted;
    flock(file.number(), LOCK_EX | LOCK_NB);
    return {};
}

Result<TemporaryFile> TemporaryFile::create(const fs::path& target) {
    auto impl = std::make_unique<Impl>();
    impl->target = target;
    impl->targetName = target.filename().string();
    if (auto status = impl->make(); !status) return tl::unexpected(status.error());
    return TemporaryFile(std::move(impl));
}

Status TemporaryFile::write(std::span<const std::byte> bytes) {
    return writeAll(impl_->file.number(), bytes);
}

Status TemporaryFile::writeAt(std::uint64_t offset, std::span<const std::byte> bytes) {
    if (pwrite(impl_->file.number(), bytes.data(), bytes.size(), static_cast<off_t>(offset)) !=
        static_cast<ssize_t>(bytes.size()))
        return systemError();
    return {};
}

Status TemporaryFile::flush() {
    if (fsync(impl_->file.number()) != 0) return systemError();
    return {};
}

fs::path TemporaryFile::path() const {
    return impl_->target.parent_path() / impl_->name;
}

void TemporaryFile::setKept(bool isKept) {
    impl_->isLeft = isKept;
    if (isKept) impl_->clearSlot();
}

bool TemporaryFile::equalsTarget() const {
    const Descriptor old(impl_->openTarget(O_RDONLY));
    struct stat own {
    }, theirs{};
    if (!old || fstat(old.number(), &theirs) != 0 || fstat(impl_->file.number(), &own) != 0 ||
        own.st_size != theirs.st_size)
        return false;
    std::vector<std::byte> a, b;
    for (std::uint64_t at = 0; readPiece(old.number(), a, at) > 0; at += a.size()) {
        readPiece(impl_->file.number(), b, at);
        if (a != b) return false;
    }
    return true;
}

/// Gives the new file what belongs to the old; false where it cannot have the old one's owner.
Result<bool> TemporaryFile::Impl::adopt(int from, const struct stat& info, std::int64_t accessed) const {
    struct stat own {};
    if (fstat(file.number(), &own) != 0) return systemError();
    if ((own.st_uid != info.st_uid || own.st_gid != info.st_gid) &&
        fchown(file.number(), info.st_uid, info.st_gid) != 0)
        return false;
    if (fchmod(file.number(), info.st_mode & 07777) != 0) return systemError();
    copyAttributes(from, file.number());
    const std::array<timespec, 2> times{timespec{accessed / kNanoseconds, accessed % kNanoseconds},
                                        timespec{0, UTIME_OMIT}};
    futimens(file.number(), times.data());
    return true;
}

Status TemporaryFile::Impl::moveIntoPlace() {
    if (fsync(file.number()) != 0) return systemError();
    if (renameat(folder.number(), name.c_str(), folder.number(), targetName.c_str()) != 0)
        return systemError();
    isTouched = true;
    name.clear();
    clearSlot();
    return flushFolder();
}

/// The file itself stays, with all its links. Killed on the way, the run leaves the whole content beside it.
Status TemporaryFile::Impl::copyIntoPlace() {
    if (fsync(file.number()) != 0) return systemError();
    const Descriptor there(openTarget(O_WRONLY));
    if (!there) return systemError();
    std::string whole = name.substr(0, name.size() - kPartSuffix.size()) + std::string(kWholeSuffix);
    if (renameat(folder.number(), name.c_str(), folder.number(), whole.c_str()) != 0) return systemError();
    name = std::move(whole);
    clearSlot();
    if (auto status = flushFolder(); !status) return status;
    isLeft = true;
    isTouched = true;
    if (auto status = copyContent(file.number(), there.number()); !status) return status;
    isLeft = false;
    return {};
}

/// A second name where the file itself is going to make room, else a copy, as where file systems know no
/// second names.
Status TemporaryFile::Impl::keepOld(const struct stat& info, bool isCopy) {
    std::string kept = prefixFor(target) + randomText() + std::string(kPartSuffix);
    isCopy |= linkat(folder.number(), targetName.c_str(), folder.number(), kept.c_str(), 0) != 0;
    if (isCopy) unlinkat(folder.number(), kept.c_str(), 0);
    Descriptor keeps(
        openat(folder.number(), kept.c_str(),
               isCopy ? O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC : O_RDONLY | O_NOFOLLOW | O_CLOEXEC, 0600));
    if (!keeps) return systemError();
    old = {std::move(kept), isCopy, info, std::move(keeps)};
    flock(old.file.number(), LOCK_EX | LOCK_NB);
    if (!isCopy) return {};
    const Descriptor there(openTarget(O_RDONLY));
    const auto status = there ? copyContent(there.number(), old.file.number()) : systemError();
    if (status) return status;
    unlinkat(folder.number(), std::exchange(old.name, {}).c_str(), 0);
    return status;
}

Status TemporaryFile::Impl::putBack() {
    if (!isTouched) return {};
    if (old.name.empty()) {
        if (unlinkat(folder.number(), targetName.c_str(), 0) != 0) return systemError();
    } else if (!old.isCopy) {
        if (renameat(folder.number(), old.name.c_str(), folder.number(), targetName.c_str()) != 0)
            return systemError();
        old.name.clear();
    } else {
        const Descriptor there(openTarget(O_WRONLY));
        if (!there) return systemError();
        if (auto status = copyContent(old.file.number(), there.number()); !status) return status;
        const std::array<timespec, 2> times{old.info.st_atim, old.info.st_mtim};
        futimens(there.number(), times.data());
        isLeft = false;
    }
    return flushFolder();
}

Status TemporaryFile::putBack() {
    auto status = impl_->putBack();
    if (status || impl_->old.name.empty()) return status;
    const std::string kept = (impl_->target.parent_path() / std::exchange(impl_->old.name, {})).string();
    return fail(fmt::format("{}; what was there is in '{}'", status.error().problem, kept));
}

Status TemporaryFile::replaceTarget(std::int64_t accessed, bool isOldKept) {
    const Descriptor there(impl_->openTarget(O_RDONLY | O_NONBLOCK));
    struct stat info {};
    // What may be written and not read tells its owner and mode all the same.
    if (fstatat(impl_->folder.number(), impl_->targetName.c_str(), &info, AT_SYMLINK_NOFOLLOW) != 0)
        return impl_->moveIntoPlace();
    bool isMoved = there && info.st_nlink == 1;
    if (isMoved) {
        const auto adopted = impl_->adopt(there.number(), info, accessed);
        if (!adopted) return tl::unexpected(adopted.error());
        isMoved = *adopted;
    }
    if (isOldKept) {
        if (auto status = impl_->keepOld(info, !isMoved); !status) return status;
    }
    return isMoved ? impl_->moveIntoPlace() : impl_->copyIntoPlace();
}

Status writeThrough(const fs::path& path, std::span<const std::byte> bytes) {
    if (path == "-") return writeAll(STDOUT_FILENO, bytes);
    const Descriptor device(open(path.c_str(), O_WRONLY | O_NOCTTY | O_APPEND | O_CLOEXEC));
    if (!device) return systemError();
    return writeAll(device.number(), bytes);
}

void allowManyFiles() {
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= limit.rlim_max) return;
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_NOFILE, &limit);
}

bool isBeingWritten(const fs::path& temporary) {
    return isLocked(AT_FDCWD, temporary.c_str());
}

}  // namespace hairloom
