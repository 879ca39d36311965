// SPDX-License-Identifier: GPL-3.0-or-later
#include "importers/namespaces_linux.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/descriptor_posix.h"

namespace hairloom {
namespace {

constexpr const char* kOutside = "/.hairloom-outside";  ///< in the new root, while it is made

std::string reason(const char* what) {
    return fmt::format("{}: {}", what, std::generic_category().message(errno));
}

bool put(const char* file, const std::string& text) {
    const Descriptor target(open(file, O_WRONLY | O_CLOEXEC));
    return target && write(target.number(), text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

/// In the namespace of users the process stays who it is, and may do there what it may not outside.
bool unshareAll() {
    const uid_t user = geteuid();
    const gid_t group = getegid();
    constexpr int kOthers = CLONE_NEWPID | CLONE_NEWNS | CLONE_NEWIPC;
    // Without a namespace of users only the superuser gets the others.
    if (unshare(CLONE_NEWUSER | kOthers) != 0) return unshare(kOthers) == 0;
    put("/proc/self/setgroups", "deny");
    return put("/proc/self/uid_map", fmt::format("{0} {0} 1", user)) &&
           put("/proc/self/gid_map", fmt::format("{0} {0} 1", group));
}

constexpr int kBySignal = 128;  ///< with the signal's number an exit status, as shells have it

int waitFor(pid_t child) {
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFSIGNALED(status) ? kBySignal + WTERMSIG(status) : WEXITSTATUS(status);
}

[[noreturn]] void endLike(pid_t child) {
    const int status = waitFor(child);
    if (status > kBySignal) {
        signal(status - kBySignal, SIG_DFL);
        raise(status - kBySignal);
    }
    _exit(status);
}

/// A process in the new namespace. It is not the first one there, whom the kernel spares signals like that of
/// abort(); the first one waits for it, and goes with its parent.
ConfinementLayer enterNewest() {
    ConfinementLayer layer{"processes", LayerState::Missing, {}};
    std::array<int, 2> ends{-1, -1};
    const bool hasPipe = pipe2(ends.data(), O_CLOEXEC) == 0;
    const Descriptor readEnd(ends[0]);
    Descriptor parentsEnd(ends[1]);
    const pid_t first = hasPipe ? fork() : -1;
    if (first > 0) endLike(first);
    if (first < 0) {
        layer.why = reason("no process in the new namespace");
        return layer;
    }
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    // The parent may have ended before the kernel heard that, and has no number here to ask for.
    parentsEnd = Descriptor();
    pollfd parent{readEnd.number(), POLLIN, 0};
    if (poll(&parent, 1, 0) > 0) _exit(1);
    const pid_t reader = fork();
    if (reader > 0) _exit(waitFor(reader));
    layer.state = LayerState::Set;
    return layer;
}

bool makeFolders(const std::string& path) {
    for (std::size_t at = path.find('/', 1);; at = path.find('/', at + 1)) {
        const std::string folder = path.substr(0, at);
        if (mkdir(folder.c_str(), 0755) != 0 && errno != EEXIST) return false;
        if (at == std::string::npos) return true;
    }
}

/// Keeps the flags that the kernel does not let go of.
void makeReadOnly(const std::string& folder) {
    unsigned long flags = MS_REMOUNT | MS_BIND | MS_RDONLY | MS_NOSUID | MS_NODEV | MS_NOEXEC;
    struct statvfs info {};
    if (statvfs(folder.c_str(), &info) == 0) {
        if ((info.f_flag & ST_NOATIME) != 0) flags |= MS_NOATIME;
        if ((info.f_flag & ST_NODIRATIME) != 0) flags |= MS_NODIRATIME;
        if ((info.f_flag & ST_RELATIME) != 0) flags |= MS_RELATIME;
    }
    // Writing is refused by other layers, too.
    static_cast<void>(mount(nullptr, folder.c_str(), nullptr, flags, nullptr));
}

/// The folder under its own name in a root that holds nothing else.
ConfinementLayer leaveOnly(const std::string& folder) {
    ConfinementLayer layer{"paths", LayerState::Missing, {}};
    if (folder == "/") {
        layer.why = "the file lies in the root folder";
        return layer;
    }
    // Until something is in the way nothing is lost by stopping.
    if (mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        mount("none", "/tmp", "tmpfs", MS_NOSUID | MS_NODEV, "size=1m,mode=700") != 0) {
        layer.why = reason("no mounts");
        return layer;
    }
    layer.state = LayerState::Failed;
    if (mkdir("/tmp/.hairloom-outside", 0700) != 0 ||
        syscall(SYS_pivot_root, "/tmp", "/tmp/.hairloom-outside") != 0 || chdir("/") != 0) {
        layer.why = reason("no root of its own");
        return layer;
    }
    const std::string outside = kOutside + folder;
    if (!makeFolders(folder) ||
        mount(outside.c_str(), folder.c_str(), nullptr, MS_BIND | MS_REC, nullptr) != 0) {
        layer.why = reason("the folder cannot be mounted");
        return layer;
    }
    if (umount2(kOutside, MNT_DETACH) != 0) {
        layer.why = reason("what is outside cannot be let go of");
        return layer;
    }
    rmdir(kOutside);
    makeReadOnly(folder);
    layer.state = LayerState::Set;
    return layer;
}

}  // namespace

std::vector<ConfinementLayer> enterNamespaces(const std::filesystem::path& folder) {
    if (!unshareAll()) {
        const std::string why = reason("no namespaces");
        return {{"processes", LayerState::Missing, why}, {"paths", LayerState::Missing, why}};
    }
    ConfinementLayer processes = enterNewest();
    return {std::move(processes), leaveOnly(folder.string())};
}

}  // namespace hairloom
