// SPDX-License-Identifier: GPL-3.0-or-later
#include <windows.h>

#include <system_error>

#include "core/base/held_file.h"

namespace hairloom {

struct HeldFile::Impl {
    std::filesystem::path path;
    HANDLE file = INVALID_HANDLE_VALUE;

    Impl() = default;
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        if (file != INVALID_HANDLE_VALUE) CloseHandle(file);
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
    auto impl = std::make_unique<Impl>();
    impl->path = path;
    // Nobody else may open it, and the system takes it away when the process ends.
    impl->file = CreateFileW(path.c_str(), GENERIC_READ | GENERIC_WRITE, 0, nullptr, OPEN_ALWAYS,
                             FILE_ATTRIBUTE_NORMAL | FILE_FLAG_DELETE_ON_CLOSE, nullptr);
    if (impl->file == INVALID_HANDLE_VALUE) {
        const DWORD code = GetLastError();
        if (code == ERROR_SHARING_VIOLATION) return failIn(path.string(), {}, "is held");
        return failIn(path.string(), {},
                      "cannot be made: " + std::system_category().message(static_cast<int>(code)),
                      "expected a folder that can be written");
    }
    return HeldFile(std::move(impl));
}

}  // namespace hairloom
