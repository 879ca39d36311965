// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmarks/peak_memory.h"

#ifdef __linux__
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <thread>

namespace hairloom::benchmarks {
namespace {

/// The most that a process has had so far; 0 where it has ended. The system's own account at its end counts
/// what its parent had as well.
std::uint64_t peakSoFar(pid_t process) {
    constexpr std::string_view kPeak = "VmHWM:";
    std::ifstream status("/proc/" + std::to_string(process) + "/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with(kPeak)) return std::stoull(line.substr(kPeak.size())) * 1024;
    }
    return 0;
}

}  // namespace

std::optional<std::uint64_t> peakMemory(std::vector<std::string> command) {
    std::vector<char*> words;
    for (std::string& word : command) words.push_back(word.data());
    words.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    for (const int output : {STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&actions, output, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    const int failed = posix_spawn(&child, words[0], &actions, nullptr, words.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) return std::nullopt;
    std::uint64_t most = 0;
    int status = 0;
    pid_t ended = 0;
    while ((ended = waitpid(child, &status, WNOHANG)) == 0) {
        most = std::max(most, peakSoFar(child));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (ended != child || status != 0 || most == 0) return std::nullopt;
    return most;
}

}  // namespace hairloom::benchmarks

#else

namespace hairloom::benchmarks {

std::optional<std::uint64_t> peakMemory(std::vector<std::string>) {
    return std::nullopt;
}

}  // namespace hairloom::benchmarks

#endif
