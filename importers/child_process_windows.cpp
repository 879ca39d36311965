// SPDX-License-Identifier: GPL-3.0-or-later
#include <windows.h>
// psapi.h needs what windows.h defines.
#include <fmt/format.h>
#include <psapi.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/base/stop_scope.h"
#include "importers/child_watch.h"

namespace hairloom {
namespace {

constexpr DWORD kPipeBytes = 1u << 20u;
constexpr DWORD kKilled = 1;
// Statuses from here on are those that the system ends a process with (NTSTATUS of severity "error").
constexpr DWORD kFirstException = 0xc0000000u;

std::string systemMessage(DWORD code) {
    return std::system_category().message(static_cast<int>(code));
}

class Handle {
  public:
    Handle() = default;
    explicit Handle(HANDLE handle) : handle_(handle == INVALID_HANDLE_VALUE ? nullptr : handle) {}
    Handle(Handle&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~Handle() {
        if (handle_ != nullptr) CloseHandle(handle_);
    }
    HANDLE get() const { return handle_; }

  private:
    HANDLE handle_ = nullptr;
};

/// As CommandLineToArgvW and the C runtime take it apart again.
std::wstring quoted(const std::wstring& argument) {
    std::wstring result = L"\"";
    std::size_t backslashes = 0;
    for (const wchar_t c : argument) {
        if (c == L'\\') {
            ++backslashes;
            continue;
        }
        // Backslashes are themselves but before a quotation mark.
        result.append(c == L'"' ? 2 * backslashes + 1 : backslashes, L'\\');
        backslashes = 0;
        result += c;
    }
    result.append(2 * backslashes, L'\\');
    return result + L"\"";
}

Handle openNull(DWORD access) {
    SECURITY_ATTRIBUTES inherited{sizeof(SECURITY_ATTRIBUTES), nullptr, TRUE};
    return Handle(CreateFileW(L"NUL", access, FILE_SHARE_READ | FILE_SHARE_WRITE, &inherited, OPEN_EXISTING,
                              0, nullptr));
}

/// A file that goes when it is closed and holds the bytes, read from their start.
Result<Handle> fileOf(const std::string& name, std::span<const std::byte> bytes) {
    std::wstring folder(MAX_PATH + 1, L'\0'), path(MAX_PATH + 1, L'\0');
    SECURITY_ATTRIBUTES inherited{sizeof(SECURITY_ATTRIBUTES), nullptr, TRUE};
    if (GetTempPathW(MAX_PATH, folder.data()) != 0 &&
        GetTempFileNameW(folder.c_str(), L"hlm", 0, path.data()) != 0) {
        Handle file(CreateFileW(path.c_str(), GENERIC_READ | GENERIC_WRITE, 0, &inherited, CREATE_ALWAYS,
                                FILE_ATTRIBUTE_TEMPORARY | FILE_FLAG_DELETE_ON_CLOSE, nullptr));
        bool isWritten = file.get() != nullptr;
        while (isWritten && !bytes.empty()) {
            const auto piece = static_cast<DWORD>(std::min<std::size_t>(bytes.size(), kPipeBytes));
            DWORD done = 0;
            isWritten = WriteFile(file.get(), bytes.data(), piece, &done, nullptr) != 0 && done > 0;
            bytes = bytes.subspan(done);
        }
        if (isWritten && SetFilePointer(file.get(), 0, nullptr, FILE_BEGIN) == 0) return file;
    }
    return fail(fmt::format("no input for {}: {}", name, systemMessage(GetLastError())));
}

/// A job that ends its process when it is closed, denies it memory over the limit, other programs, and what
/// the windows of others show and hold.
Handle createJob(const ChildLimits& limits) {
    Handle job(CreateJobObjectW(nullptr, nullptr));
    JOBOBJECT_EXTENDED_LIMIT_INFORMATION info{};
    info.BasicLimitInformation.LimitFlags = JOB_OBJECT_LIMIT_KILL_ON_JOB_CLOSE |
                                            JOB_OBJECT_LIMIT_PROCESS_MEMORY |
                                            JOB_OBJECT_LIMIT_DIE_ON_UNHANDLED_EXCEPTION;
    // Programs that it starts have jobs of their own.
    info.BasicLimitInformation.LimitFlags |=
        limits.startsPrograms ? JOB_OBJECT_LIMIT_SILENT_BREAKAWAY_OK : JOB_OBJECT_LIMIT_ACTIVE_PROCESS;
    info.BasicLimitInformation.ActiveProcessLimit = 1;
    info.ProcessMemoryLimit = static_cast<SIZE_T>(limits.residentBytes);
    JOBOBJECT_BASIC_UI_RESTRICTIONS windows{};
    windows.UIRestrictionsClass = JOB_OBJECT_UILIMIT_DESKTOP | JOB_OBJECT_UILIMIT_DISPLAYSETTINGS |
                                  JOB_OBJECT_UILIMIT_EXITWINDOWS | JOB_OBJECT_UILIMIT_GLOBALATOMS |
                                  JOB_OBJECT_UILIMIT_HANDLES | JOB_OBJECT_UILIMIT_READCLIPBOARD |
                                  JOB_OBJECT_UILIMIT_SYSTEMPARAMETERS | JOB_OBJECT_UILIMIT_WRITECLIPBOARD;
    if (job.get() != nullptr) {
        SetInformationJobObject(job.get(), JobObjectExtendedLimitInformation, &info, sizeof(info));
        SetInformationJobObject(job.get(), JobObjectBasicUIRestrictions, &windows, sizeof(windows));
    }
    return job;
}

/// Kills the child when it goes out of scope.
struct Child {
    Handle job, process, output;

    Child() = default;
    Child(Child&&) = default;
    Child& operator=(Child&&) = delete;
    ~Child() {
        if (process.get() == nullptr) return;
        // Also where the system refused the job.
        TerminateProcess(process.get(), kKilled);
        WaitForSingleObject(process.get(), INFINITE);
    }
};

/// The list of handles that a child inherits: these and no others.
class InheritedHandles {
  public:
    explicit InheritedHandles(std::vector<HANDLE> handles) : handles_(std::move(handles)) {
        SIZE_T size = 0;
        InitializeProcThreadAttributeList(nullptr, 1, 0, &size);
        memory_.resize(size);
        usable_ = InitializeProcThreadAttributeList(list(), 1, 0, &size) != 0;
        if (usable_) {
            UpdateProcThreadAttribute(list(), 0, PROC_THREAD_ATTRIBUTE_HANDLE_LIST, handles_.data(),
                                      handles_.size() * sizeof(HANDLE), nullptr, nullptr);
        }
    }
    InheritedHandles(const InheritedHandles&) = delete;
    InheritedHandles& operator=(const InheritedHandles&) = delete;
    ~InheritedHandles() {
        if (usable_) DeleteProcThreadAttributeList(list());
    }
    LPPROC_THREAD_ATTRIBUTE_LIST list() {
        return reinterpret_cast<LPPROC_THREAD_ATTRIBUTE_LIST>(memory_.data());
    }

  private:
    std::vector<HANDLE> handles_;
    std::vector<std::byte> memory_;
    bool usable_ = false;
};

Result<Child> spawn(const std::string& name, const std::filesystem::path& program,
                    const std::vector<std::string>& arguments, const ChildLimits& limits,
                    std::span<const std::byte> bytes) {
    SECURITY_ATTRIBUTES inherited{sizeof(SECURITY_ATTRIBUTES), nullptr, TRUE};
    HANDLE readEnd = nullptr, writeEnd = nullptr;
    if (CreatePipe(&readEnd, &writeEnd, &inherited, kPipeBytes) == 0)
        return fail(fmt::format("no pipe to {}: {}", name, systemMessage(GetLastError())));
    Child child;
    child.output = Handle(readEnd);
    const Handle output(writeEnd);
    SetHandleInformation(readEnd, HANDLE_FLAG_INHERIT, 0);
    auto input = bytes.empty() ? Result<Handle>(openNull(GENERIC_READ)) : fileOf(name, bytes);
    if (!input) return tl::unexpected(input.error());
    const Handle errors = openNull(GENERIC_WRITE);

    InheritedHandles handles({input->get(), output.get(), errors.get()});
    STARTUPINFOEXW startup{};
    startup.StartupInfo.cb = sizeof(startup);
    startup.StartupInfo.dwFlags = STARTF_USESTDHANDLES;
    startup.StartupInfo.hStdInput = input->get();
    startup.StartupInfo.hStdOutput = output.get();
    startup.StartupInfo.hStdError = errors.get();
    startup.lpAttributeList = handles.list();
    // Programs are named as on other systems.
    std::filesystem::path file = program;
    if (!file.has_extension()) file += L".exe";
    std::wstring words = quoted(file.wstring());
    for (const std::string& argument : arguments) {
        const auto* utf8 = reinterpret_cast<const char8_t*>(argument.c_str());
        words += L" " + quoted(std::filesystem::path(utf8).wstring());
    }
    PROCESS_INFORMATION started{};
    // Suspended until it is in its job, so that nothing it starts escapes.
    constexpr DWORD kFlags = CREATE_SUSPENDED | CREATE_NO_WINDOW | EXTENDED_STARTUPINFO_PRESENT;
    if (CreateProcessW(file.wstring().c_str(), words.data(), nullptr, nullptr, TRUE, kFlags, nullptr, nullptr,
                       &startup.StartupInfo, &started) == 0) {
        return notStarted(name, program, systemMessage(GetLastError()));
    }
    child.process = Handle(started.hProcess);
    const Handle thread(started.hThread);
    child.job = createJob(limits);
    if (child.job.get() != nullptr) AssignProcessToJobObject(child.job.get(), child.process.get());
    ResumeThread(thread.get());
    return child;
}

std::uint64_t residentBytes(HANDLE process) {
    PROCESS_MEMORY_COUNTERS counters{};
    counters.cb = sizeof(counters);
    return GetProcessMemoryInfo(process, &counters, sizeof(counters)) == 0 ? 0 : counters.WorkingSetSize;
}

/// Appends what can be read without waiting; false at the end of the pipe.
bool readSome(HANDLE pipe, std::vector<std::byte>& output) {
    DWORD available = 0;
    if (PeekNamedPipe(pipe, nullptr, 0, nullptr, &available, nullptr) == 0) return false;
    if (available == 0) return true;
    const std::size_t before = output.size();
    output.resize(before + available);
    DWORD got = 0;
    const bool open = ReadFile(pipe, output.data() + before, available, &got, nullptr) != 0;
    output.resize(before + got);
    return open;
}

}  // namespace

Result<std::vector<std::byte>> runChild(const std::string& name, const std::filesystem::path& program,
                                        const std::vector<std::string>& arguments, const ChildLimits& limits,
                                        std::span<const std::byte> input) {
    if (auto status = checkStop(); !status) return tl::unexpected(status.error());
    auto child = spawn(name, program, arguments, limits, input);
    if (!child) return tl::unexpected(child.error());
    const HANDLE process = child->process.get();
    ChildWatch watch(name, limits, [process] { return residentBytes(process); });
    std::vector<std::byte> output;
    for (bool ended = false;;) {
        const std::size_t before = output.size();
        const bool open = readSome(child->output.get(), output);
        makeRoom(limits, output);
        if (auto status = watch.check(output.size()); !status) return tl::unexpected(status.error());
        if (!open) break;
        if (output.size() > before) continue;
        if (ended) break;
        // A pipe cannot be waited for; the end of the process can, and then there may be a last piece.
        ended = WaitForSingleObject(process, 1) == WAIT_OBJECT_0;
    }
    // A child may close its output and linger.
    while (WaitForSingleObject(process, static_cast<DWORD>(kWatchInterval.count())) != WAIT_OBJECT_0) {
        if (auto status = watch.check(output.size()); !status) return tl::unexpected(status.error());
    }
    DWORD end = 0;
    GetExitCodeProcess(process, &end);
    if (end >= kFirstException) {
        return tl::unexpected(crashed(name, fmt::format("exception 0x{:08x}", end)).error());
    }
    if (end != 0) return tl::unexpected(gaveUp(name, static_cast<int>(end)).error());
    return output;
}

std::filesystem::path programFolder() {
    std::wstring path(32768, L'\0');
    const DWORD length = GetModuleFileNameW(nullptr, path.data(), static_cast<DWORD>(path.size()));
    if (length == 0 || length == path.size()) return {};
    path.resize(length);
    return std::filesystem::path(path).parent_path();
}

}  // namespace hairloom
