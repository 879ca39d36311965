// SPDX-License-Identifier: GPL-3.0-or-later
// What a confined process cannot do, found by doing it.

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "importers/confinement.h"

namespace hairloom {
namespace {

/// Whether the kernel gives so much memory with these rights.
bool getsMemory(std::uint64_t bytes, int rights) {
    void* const got = mmap(nullptr, static_cast<std::size_t>(bytes), rights,
                           MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (got == MAP_FAILED) return false;
    munmap(got, static_cast<std::size_t>(bytes));
    return true;
}

}  // namespace

std::vector<ConfinementTrial> tryToEscape(const ConfinementBait& bait) {
    std::vector<ConfinementTrial> trials;
    const auto note = [&](const char* what, bool could) { trials.push_back({what, !could}); };
    const auto noteOpened = [&](const char* what, int descriptor) {
        note(what, descriptor >= 0);
        if (descriptor >= 0) close(descriptor);
    };
    noteOpened("network", socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    const auto written = bait.folder / "hairloom-confinement-trial";
    noteOpened("write", open(written.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
    unlink(written.c_str());
    noteOpened("other_files", open(bait.outside.c_str(), O_RDONLY | O_CLOEXEC));
    struct stat info {};
    note("stat", stat(bait.outside.c_str(), &info) == 0);
    const auto process = static_cast<pid_t>(bait.process);
    note("signals", kill(process, 0) == 0);  // signal 0 asks whether one may be sent
    rlimit limit{};
    note("limits", prlimit(process, RLIMIT_NOFILE, nullptr, &limit) == 0);
    note("memory", getsMemory(bait.memoryBytes + bait.memoryBytes / 8, PROT_READ | PROT_WRITE));
    note("code", getsMemory(4096, PROT_READ | PROT_EXEC));
    const pid_t child = fork();
    if (child == 0) _exit(0);
    if (child > 0) waitpid(child, nullptr, 0);
    note("programs", child >= 0);
    return trials;
}

}  // namespace hairloom
