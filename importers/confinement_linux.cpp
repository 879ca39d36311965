// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>

#include "importers/confinement.h"

namespace hairloom {
namespace {

#if defined(__x86_64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kArchitecture = 0;
#endif

/// All that memory, threads, time and files that are open need.
constexpr std::array kAllowed{
    SYS_read,           SYS_pread64,         SYS_readv,
    SYS_lseek,          SYS_close,           SYS_fstat,
    SYS_newfstatat,     SYS_statx,           SYS_getdents64,
    SYS_readlinkat,     SYS_faccessat,       SYS_faccessat2,
    SYS_getcwd,         SYS_fcntl,           SYS_fadvise64,
    SYS_mmap,           SYS_munmap,          SYS_mremap,
    SYS_mprotect,       SYS_madvise,         SYS_brk,
    SYS_futex,          SYS_sched_yield,     SYS_getrandom,
    SYS_clock_gettime,  SYS_clock_nanosleep, SYS_rt_sigaction,
    SYS_rt_sigprocmask, SYS_rt_sigreturn,    SYS_sigaltstack,
    SYS_exit,           SYS_exit_group,      SYS_getpid,
    SYS_gettid,         SYS_tgkill,          SYS_prlimit64,
    SYS_uname,          SYS_sysinfo,         SYS_sched_getaffinity,
#ifdef SYS_readlink
    SYS_readlink,
#endif
#ifdef SYS_access
    SYS_access,
#endif
#ifdef SYS_stat
    SYS_stat,           SYS_lstat,
#endif
};

constexpr std::uint32_t kLowHalf = 0;  // of a little-endian argument

/// Sanitizers make system calls of their own.
#if defined(HAIRLOOM_ADDRESS_SANITIZER) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

constexpr sock_filter load(std::size_t offset) {
    return BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset));
}
constexpr sock_filter skipUnlessEqual(std::uint32_t value, std::uint8_t instructions) {
    return BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, instructions);
}
constexpr sock_filter end(std::uint32_t verdict) {
    return BPF_STMT(BPF_RET | BPF_K, verdict);
}
constexpr std::size_t argument(std::size_t index) {
    return offsetof(seccomp_data, args) + index * sizeof(std::uint64_t) + kLowHalf;
}

/// The call is refused when any of `bits` is set in its argument.
void refuseBits(std::vector<sock_filter>& filter, long call, std::size_t index, std::uint32_t bits) {
    filter.push_back(skipUnlessEqual(static_cast<std::uint32_t>(call), 4));
    filter.push_back(load(argument(index)));
    filter.push_back(BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, bits, 0, 1));
    filter.push_back(end(SECCOMP_RET_ERRNO | EPERM));
    filter.push_back(end(SECCOMP_RET_ALLOW));
}

/// Writing to standard output and error alone.
void allowOutputs(std::vector<sock_filter>& filter, long call) {
    filter.push_back(skipUnlessEqual(static_cast<std::uint32_t>(call), 4));
    filter.push_back(load(argument(0)));
    filter.push_back(BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, STDERR_FILENO, 0, 1));
    filter.push_back(end(SECCOMP_RET_ERRNO | EPERM));
    filter.push_back(end(SECCOMP_RET_ALLOW));
}

bool limitSystemCalls() {
    if (kSanitized || kArchitecture == 0) return false;
    std::vector<sock_filter> filter{load(offsetof(seccomp_data, arch)), skipUnlessEqual(kArchitecture, 1),
                                    BPF_JUMP(BPF_JMP | BPF_JA, 1, 0, 0), end(SECCOMP_RET_KILL_PROCESS),
                                    load(offsetof(seccomp_data, nr))};
    constexpr std::uint32_t kWriting = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND;
    // Each leaves the call's number in place unless it decides.
    refuseBits(filter, SYS_openat, 2, kWriting);
#ifdef SYS_open
    refuseBits(filter, SYS_open, 1, kWriting);
#endif
    allowOutputs(filter, SYS_write);
    allowOutputs(filter, SYS_writev);
    for (const long call : kAllowed) {
        filter.push_back(skipUnlessEqual(static_cast<std::uint32_t>(call), 1));
        filter.push_back(end(SECCOMP_RET_ALLOW));
    }
    filter.push_back(end(SECCOMP_RET_ERRNO | EPERM));
    sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
    return prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

int landlockVersion() {
    const long version =
        syscall(SYS_landlock_create_ruleset, nullptr, std::size_t{0}, LANDLOCK_CREATE_RULESET_VERSION);
    return version > 0 ? static_cast<int>(version) : 0;
}

/// What version 1 knows of files, and renaming and truncating where the kernel knows them, too.
std::uint64_t rightsOf(int version) {
    std::uint64_t rights = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1u) - 1;
    if (version >= 2) rights |= std::uint64_t{1} << 13u;  // LANDLOCK_ACCESS_FS_REFER
    if (version >= 3) rights |= std::uint64_t{1} << 14u;  // LANDLOCK_ACCESS_FS_TRUNCATE
    return rights;
}

bool limitFiles(const std::filesystem::path& folder, int version) {
    if (version == 0) return false;
    landlock_ruleset_attr attributes{};
    attributes.handled_access_fs = rightsOf(version);
    const auto rules =
        static_cast<int>(syscall(SYS_landlock_create_ruleset, &attributes, sizeof attributes, 0));
    if (rules < 0) return false;
    landlock_path_beneath_attr beneath{};
    beneath.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
    beneath.parent_fd = open(folder.c_str(), O_PATH | O_CLOEXEC);
    const bool limited =
        beneath.parent_fd >= 0 &&
        syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &beneath, 0) == 0 &&
        syscall(SYS_landlock_restrict_self, rules, 0) == 0;
    if (beneath.parent_fd >= 0) close(beneath.parent_fd);
    close(rules);
    return limited;
}

}  // namespace

Confinement confineProcess(const std::filesystem::path& folder) {
    Confinement confinement;
    confinement.landlockVersion = landlockVersion();
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return confinement;
    confinement.files = limitFiles(folder, confinement.landlockVersion);
    confinement.systemCalls = limitSystemCalls();
    return confinement;
}

std::vector<ConfinementTrial> tryToEscape(const std::filesystem::path& folder,
                                          const std::filesystem::path& outside) {
    std::vector<ConfinementTrial> trials;
    const auto note = [&](const char* what, int descriptor) {
        trials.push_back({what, descriptor < 0});
        if (descriptor >= 0) close(descriptor);
    };
    note("network", socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    const auto written = folder / "hairloom-confinement-trial";
    note("write", open(written.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
    unlink(written.c_str());
    note("other_files", open(outside.c_str(), O_RDONLY | O_CLOEXEC));
    const pid_t child = fork();
    if (child == 0) _exit(0);
    if (child > 0) waitpid(child, nullptr, 0);
    trials.push_back({"programs", child < 0});
    return trials;
}

}  // namespace hairloom
