// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <initializer_list>
#include <system_error>

#include "importers/confinement.h"
#include "importers/namespaces_linux.h"
#include "importers/sanitized.h"

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
    SYS_read,          SYS_pread64,         SYS_readv,        SYS_lseek,
    SYS_close,         SYS_fstat,           SYS_newfstatat,   SYS_statx,
    SYS_getdents64,    SYS_readlinkat,      SYS_faccessat,    SYS_faccessat2,
    SYS_getcwd,        SYS_fadvise64,       SYS_gettid,       SYS_munmap,
    SYS_mremap,        SYS_uname,           SYS_madvise,      SYS_brk,
    SYS_sysinfo,       SYS_futex,           SYS_sched_yield,  SYS_getrandom,
    SYS_clock_gettime, SYS_clock_nanosleep, SYS_rt_sigaction, SYS_rt_sigprocmask,
    SYS_rt_sigreturn,  SYS_sigaltstack,     SYS_exit,         SYS_exit_group,
    SYS_getpid,
#ifdef SYS_readlink
    SYS_readlink,
#endif
#ifdef SYS_access
    SYS_access,
#endif
#ifdef SYS_stat
    SYS_stat,          SYS_lstat,
#endif
};

constexpr sock_filter load(std::size_t offset) {
    return BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset));
}
constexpr sock_filter skipUnlessEqual(std::uint32_t value, std::uint8_t instructions) {
    return BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, instructions);
}
constexpr sock_filter end(std::uint32_t verdict) {
    return BPF_STMT(BPF_RET | BPF_K, verdict);
}
constexpr sock_filter kAllow = end(SECCOMP_RET_ALLOW), kRefuse = end(SECCOMP_RET_ERRNO | EPERM);

/// Half of an argument, of a little-endian machine.
constexpr std::size_t lowHalf(std::size_t index) {
    return offsetof(seccomp_data, args) + index * sizeof(std::uint64_t);
}
constexpr std::size_t highHalf(std::size_t index) {
    return lowHalf(index) + sizeof(std::uint32_t);
}

/// Rules in the order in which they were added. The number of the call is loaded where each begins.
class Rules {
  public:
    Rules() {
        filter_ = {load(offsetof(seccomp_data, arch)), skipUnlessEqual(kArchitecture, 1),
                   BPF_JUMP(BPF_JMP | BPF_JA, 1, 0, 0), end(SECCOMP_RET_KILL_PROCESS),
                   load(offsetof(seccomp_data, nr))};
    }
    void allow(long call) { rule(call, {kAllow}); }
    /// Unless any of `bits` is set in the argument.
    void allowWithoutBits(long call, std::size_t index, std::uint32_t bits) {
        rule(call, {load(lowHalf(index)), BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, bits, 0, 1), kRefuse, kAllow});
    }
    /// Where the argument is at most `most`.
    void allowUpTo(long call, std::size_t index, std::uint32_t most) {
        rule(call, {load(lowHalf(index)), BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, most, 0, 1), kRefuse, kAllow});
    }
    /// Where the argument is one of the two.
    void allowEither(long call, std::size_t index, std::uint32_t a, std::uint32_t b) {
        rule(call, {load(lowHalf(index)), BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, a, 2, 0),
                    BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, b, 1, 0), kRefuse, kAllow});
    }
    /// Where the first argument is one of the two, and the third is null.
    void allowAsking(long call, std::uint32_t a, std::uint32_t b) {
        rule(call, {load(lowHalf(2)), skipUnlessEqual(0, 5), load(highHalf(2)), skipUnlessEqual(0, 3),
                    load(lowHalf(0)), BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, a, 2, 0),
                    BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, b, 1, 0), kRefuse, kAllow});
    }
    bool set() {
        filter_.push_back(kRefuse);
        sock_fprog program{static_cast<unsigned short>(filter_.size()), filter_.data()};
        return prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
    }

  private:
    /// Every rule decides once it has begun.
    void rule(long call, std::initializer_list<sock_filter> instructions) {
        filter_.push_back(skipUnlessEqual(static_cast<std::uint32_t>(call),
                                          static_cast<std::uint8_t>(instructions.size())));
        filter_.insert(filter_.end(), instructions);
    }

    std::vector<sock_filter> filter_;
};

std::string reason() {
    return std::generic_category().message(errno);
}

ConfinementLayer limitSystemCalls() {
    ConfinementLayer layer{"system_calls", LayerState::Missing, {}};
    if (kSanitized || kArchitecture == 0) {
        layer.why = kSanitized ? "built with a sanitizer" : "no rules for this processor";
        return layer;
    }
    if (prctl(PR_GET_SECCOMP) < 0) {
        layer.why = "the kernel has no seccomp";
        return layer;
    }
    constexpr std::uint32_t kWriting = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND;
    const auto own = static_cast<std::uint32_t>(getpid());
    Rules rules;
    rules.allowWithoutBits(SYS_openat, 2, kWriting);
#ifdef SYS_open
    rules.allowWithoutBits(SYS_open, 1, kWriting);
#endif
    rules.allowUpTo(SYS_write, 0, STDERR_FILENO);
    rules.allowUpTo(SYS_writev, 0, STDERR_FILENO);
    // No memory that is executed.
    rules.allowWithoutBits(SYS_mmap, 2, PROT_EXEC);
    rules.allowWithoutBits(SYS_mprotect, 2, PROT_EXEC);
    // Duplicates and flags alone: other commands have signals sent.
    rules.allowUpTo(SYS_fcntl, 1, F_GETFL);
    // abort() signals the process itself; limits can be asked for and not set.
    rules.allowEither(SYS_tgkill, 0, own, own);
    rules.allowEither(SYS_sched_getaffinity, 0, 0, own);
    rules.allowAsking(SYS_prlimit64, 0, own);
    for (const long call : kAllowed) rules.allow(call);
    layer.state = rules.set() ? LayerState::Set : LayerState::Failed;
    if (layer.state == LayerState::Failed) layer.why = reason();
    return layer;
}

int landlockVersion() {
    const long version =
        syscall(SYS_landlock_create_ruleset, nullptr, std::size_t{0}, LANDLOCK_CREATE_RULESET_VERSION);
    return version > 0 ? static_cast<int>(version) : 0;
}

/// As in linux/landlock.h of kernels that know all of it; older ones take the beginning.
struct LandlockRules {
    std::uint64_t files = 0;
    std::uint64_t network = 0;
    std::uint64_t scoped = 0;
};

/// Everything that the kernel knows to refuse.
LandlockRules rulesOf(int version) {
    LandlockRules rules;
    rules.files = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1u) - 1;
    if (version >= 2) rules.files |= std::uint64_t{1} << 13u;  // moving between folders
    if (version >= 3) rules.files |= std::uint64_t{1} << 14u;  // truncating
    if (version >= 5) rules.files |= std::uint64_t{1} << 15u;  // commands of devices
    if (version >= 4) rules.network = 3;                       // TCP: taking a port, connecting
    if (version >= 6) rules.scoped = 3;                        // sockets without a file, signals
    return rules;
}

std::size_t bytesOf(int version) {
    return (version >= 6 ? 3 : version >= 4 ? 2 : 1) * sizeof(std::uint64_t);
}

ConfinementLayer limitFiles(const std::filesystem::path& folder, int version) {
    ConfinementLayer layer{"files", LayerState::Missing, "the kernel has no Landlock, or it is turned off"};
    if (version == 0) return layer;
    layer.state = LayerState::Failed;
    const LandlockRules refused = rulesOf(version);
    const auto rules = static_cast<int>(syscall(SYS_landlock_create_ruleset, &refused, bytesOf(version), 0));
    if (rules < 0) {
        layer.why = reason();
        return layer;
    }
    landlock_path_beneath_attr beneath{};
    beneath.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
    beneath.parent_fd = open(folder.c_str(), O_PATH | O_CLOEXEC);
    const bool limited =
        beneath.parent_fd >= 0 &&
        syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &beneath, 0) == 0 &&
        syscall(SYS_landlock_restrict_self, rules, 0) == 0;
    layer.why = limited ? std::string() : reason();
    layer.state = limited ? LayerState::Set : LayerState::Failed;
    if (beneath.parent_fd >= 0) close(beneath.parent_fd);
    close(rules);
    return layer;
}

/// Sanitizers reserve terabytes of address space; there the parent's watch is the only limit.
ConfinementLayer limitMemory(std::uint64_t bytes) {
    if (kSanitized) return {"memory", LayerState::Missing, "built with a sanitizer"};
    // What limits the user already may be less, and cannot be raised.
    rlimit before{};
    const bool known = getrlimit(RLIMIT_AS, &before) == 0;
    const rlim_t most = known ? std::min<rlim_t>(bytes, before.rlim_max) : bytes;
    const rlimit limit{most, most}, noCoreFile{0, 0};
    setrlimit(RLIMIT_CORE, &noCoreFile);
    if (setrlimit(RLIMIT_AS, &limit) != 0) return {"memory", LayerState::Failed, reason()};
    return {"memory", LayerState::Set, {}};
}

}  // namespace

void endWithParent() {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    // The parent may have ended before the kernel heard that; its end of the pipe is closed then.
    pollfd output{STDOUT_FILENO, 0, 0};
    if (poll(&output, 1, 0) > 0 && (output.revents & POLLERR) != 0) _exit(1);
}

Confinement confineProcess(const std::filesystem::path& folder, std::uint64_t memoryBytes) {
    Confinement confinement;
    confinement.landlockVersion = landlockVersion();
    confinement.layers.push_back(limitMemory(memoryBytes));
    for (ConfinementLayer& layer : enterNamespaces(folder)) confinement.layers.push_back(std::move(layer));
    const bool isFinal = prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0;
    confinement.layers.push_back(limitFiles(folder, isFinal ? confinement.landlockVersion : 0));
    confinement.layers.push_back(limitSystemCalls());
    return confinement;
}

}  // namespace hairloom
