// SPDX-License-Identifier: GPL-3.0-or-later
// Windows: the job object that the parent has put this process into, and low integrity, at which nothing that
// the user owns can be written and no other process of the user be touched. Windows has no more for a process
// without rights of its own to give away.
#include <windows.h>

#include <array>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "importers/confinement.h"

namespace hairloom {
namespace {

std::string reason() {
    return std::system_category().message(static_cast<int>(GetLastError()));
}

/// Closed when it goes.
class Token {
  public:
    explicit Token(DWORD access) {
        if (OpenProcessToken(GetCurrentProcess(), access, &handle_) == 0) handle_ = nullptr;
    }
    Token(const Token&) = delete;
    Token& operator=(const Token&) = delete;
    ~Token() {
        if (handle_ != nullptr) CloseHandle(handle_);
    }
    HANDLE get() const { return handle_; }

  private:
    HANDLE handle_ = nullptr;
};

/// What the job that the parent makes is to hold this process to.
ConfinementLayer jobLayer(const char* name, DWORD flag,
                          bool (*isMeant)(const JOBOBJECT_EXTENDED_LIMIT_INFORMATION&, std::uint64_t),
                          std::uint64_t memoryBytes) {
    BOOL isInJob = FALSE;
    if (IsProcessInJob(GetCurrentProcess(), nullptr, &isInJob) == 0 || isInJob == FALSE)
        return {name, LayerState::Failed, "the process is in no job"};
    JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits{};
    if (QueryInformationJobObject(nullptr, JobObjectExtendedLimitInformation, &limits, sizeof limits,
                                  nullptr) == 0)
        return {name, LayerState::Failed, reason()};
    // The parent always sets some.
    if (limits.BasicLimitInformation.LimitFlags == 0)
        return {name, LayerState::Missing, "this system does not tell the limits of a job"};
    if ((limits.BasicLimitInformation.LimitFlags & flag) == 0 || !isMeant(limits, memoryBytes))
        return {name, LayerState::Failed, "the job of the process has another limit"};
    return {name, LayerState::Set, {}};
}

/// The last number of the integrity's name; 0 where it is not told.
DWORD integrityOf(HANDLE token) {
    std::array<std::byte, 256> memory{};
    DWORD size = 0;
    if (GetTokenInformation(token, TokenIntegrityLevel, memory.data(), static_cast<DWORD>(memory.size()),
                            &size) == 0)
        return 0;
    const auto* const label = reinterpret_cast<const TOKEN_MANDATORY_LABEL*>(memory.data());
    PSID name = label->Label.Sid;
    return *GetSidSubAuthority(name, *GetSidSubAuthorityCount(name) - 1u);
}

ConfinementLayer lowerIntegrity() {
    ConfinementLayer layer{"integrity", LayerState::Failed, {}};
    const Token token(TOKEN_ADJUST_DEFAULT | TOKEN_QUERY);
    SID_IDENTIFIER_AUTHORITY authority = SECURITY_MANDATORY_LABEL_AUTHORITY;
    PSID low = nullptr;
    if (token.get() == nullptr ||
        AllocateAndInitializeSid(&authority, 1, SECURITY_MANDATORY_LOW_RID, 0, 0, 0, 0, 0, 0, 0, &low) == 0) {
        layer.why = reason();
        return layer;
    }
    TOKEN_MANDATORY_LABEL label{};
    label.Label.Attributes = SE_GROUP_INTEGRITY;
    label.Label.Sid = low;
    const bool isTaken = SetTokenInformation(token.get(), TokenIntegrityLevel, &label,
                                             static_cast<DWORD>(sizeof label) + GetLengthSid(low)) != 0;
    if (!isTaken) layer.why = reason();
    FreeSid(low);
    if (!isTaken) return layer;
    if (integrityOf(token.get()) != SECURITY_MANDATORY_LOW_RID)
        return {"integrity", LayerState::Missing, "this system has no levels of integrity"};
    return {"integrity", LayerState::Set, {}};
}

bool couldStart(const std::filesystem::path& program) {
    STARTUPINFOW startup{};
    startup.cb = sizeof startup;
    PROCESS_INFORMATION started{};
    if (CreateProcessW(program.c_str(), nullptr, nullptr, nullptr, FALSE, CREATE_SUSPENDED | CREATE_NO_WINDOW,
                       nullptr, nullptr, &startup, &started) == 0)
        return false;
    TerminateProcess(started.hProcess, 0);
    CloseHandle(started.hThread);
    CloseHandle(started.hProcess);
    return true;
}

bool couldTouch(DWORD process, DWORD access) {
    HANDLE handle = OpenProcess(access, FALSE, process);
    if (handle == nullptr) return false;
    CloseHandle(handle);
    return true;
}

bool couldTake(std::uint64_t bytes, DWORD protection) {
    void* const memory =
        VirtualAlloc(nullptr, static_cast<SIZE_T>(bytes), MEM_COMMIT | MEM_RESERVE, protection);
    if (memory == nullptr) return false;
    VirtualFree(memory, 0, MEM_RELEASE);
    return true;
}

}  // namespace

void endWithParent() {}

Confinement confineProcess(const std::filesystem::path&, std::uint64_t memoryBytes) {
    using Limits = JOBOBJECT_EXTENDED_LIMIT_INFORMATION;
    Confinement confinement;
    confinement.layers.push_back(jobLayer(
        "memory", JOB_OBJECT_LIMIT_PROCESS_MEMORY,
        [](const Limits& limits, std::uint64_t bytes) { return limits.ProcessMemoryLimit <= bytes; },
        memoryBytes));
    confinement.layers.push_back(jobLayer(
        "programs", JOB_OBJECT_LIMIT_ACTIVE_PROCESS,
        [](const Limits& limits, std::uint64_t) {
            return limits.BasicLimitInformation.ActiveProcessLimit == 1;
        },
        memoryBytes));
    confinement.layers.push_back(lowerIntegrity());
    return confinement;
}

std::vector<ConfinementTrial> tryToEscape(const ConfinementBait& bait) {
    std::vector<ConfinementTrial> trials;
    const auto note = [&](const char* what, bool could) { trials.push_back({what, !could}); };
    const auto written = bait.folder / "hairloom-confinement-trial";
    note("write", std::ofstream(written).is_open());
    DeleteFileW(written.c_str());
    note("other_files", std::ifstream(bait.outside).is_open());
    const auto process = static_cast<DWORD>(bait.process);
    note("signals", couldTouch(process, PROCESS_TERMINATE));
    note("limits", couldTouch(process, PROCESS_SET_QUOTA));
    note("memory", couldTake(bait.memoryBytes + bait.memoryBytes / 8, PAGE_READWRITE));
    note("code", couldTake(4096, PAGE_EXECUTE_READ));
    std::wstring own(32768, L'\0');
    own.resize(GetModuleFileNameW(nullptr, own.data(), static_cast<DWORD>(own.size())));
    note("programs", couldStart(own));
    return trials;
}

}  // namespace hairloom
