// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/base/descriptor_posix.h"
#include "core/base/held_file.h"

namespace hairloom {

struct HeldFile::Impl {
    std::filesystem::path path;
    Descriptor file;

    Impl() = default;
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    /// Taken away while it is held, so that nobody holds a name that is about to go.
    ~Impl() {
        if (file) unlink(path.c_str());
    }
};

HeldFile::HeldFile(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
HeldFile::HeldFile(HeldFile&&) noexcept = default;
HeldFile& HeldFile::operator=(HeldFile&&) noexcept = default;
HeldFile::~HeldFile() = default;

const std::filesystem::path& HeldFile::path() const {
    return impl_->path;
}

Result<HeldFile> HeldFile::hold(const std::filesystem::path& path) {
    constexpr int kTries = 5;
    for (int i = 0; i < kTries; ++i) {
        Descriptor file(open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600));
        if (!file)
            return failIn(path.string(), {}, "cannot be made: " + std::generic_category().message(errno),
                          "expected a folder that can be written");
        if (flock(file.number(), LOCK_EX | LOCK_NB) != 0) return failIn(path.string(), {}, "is held");
        struct stat held {
        }, named{};
        // Somebody may have taken the name away between opening and locking.
        const bool isNamed = fstat(file.number(), &held) == 0 && lstat(path.c_str(), &named) == 0 &&
                             held.st_dev == named.st_dev && held.st_ino == named.st_ino;
        if (!isNamed) continue;
        auto impl = std::make_unique<Impl>();
        impl->path = path;
        impl->file = std::move(file);
        return HeldFile(std::move(impl));
    }
    return failIn(path.string(), {}, "is taken away time and again");
}

}  // namespace hairloom
