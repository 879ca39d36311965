// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include "core/base/descriptor_posix.h"
#include "core/base/stop_scope.h"
#include "importers/child_watch.h"

extern char** environ;

namespace hairloom {
namespace {

std::string systemMessage(int code) {
    return std::generic_category().message(code);
}

/// Kills and collects the child when it goes out of scope.
class Child {
  public:
    explicit Child(pid_t id) : id_(id) {}
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() {
        if (id_ <= 0) return;
        kill(id_, SIGKILL);
        wait();
    }
    pid_t id() const { return id_; }

    int wait() {
        int status = 0;
        while (waitpid(id_, &status, 0) < 0 && errno == EINTR) {
        }
        id_ = -1;
        return status;
    }

    std::optional<int> poll() {
        int status = 0;
        if (waitpid(id_, &status, WNOHANG) != id_) return std::nullopt;
        id_ = -1;
        return status;
    }

  private:
    pid_t id_;
};

/// Memory of a process and its children that is in use, bytes; 0 where the system does not tell.
std::uint64_t residentBytes(pid_t process) {
    std::ifstream file(fmt::format("/proc/{}/statm", process));
    std::uint64_t total = 0, resident = 0;
    file >> total >> resident;
    std::uint64_t bytes = file ? resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) : 0;
    // What reads may be a child of what was started, in a namespace of its own.
    std::ifstream children(fmt::format("/proc/{0}/task/{0}/children", process));
    for (pid_t child = 0; children >> child;) bytes += residentBytes(child);
    return bytes;
}

/// A file without a name that holds the bytes, read from their start.
Result<Descriptor> fileOf(const std::string& name, std::span<const std::byte> bytes) {
    Descriptor file(memfd_create("input", MFD_CLOEXEC));
    for (std::size_t done = 0; file.number() >= 0 && done < bytes.size();) {
        const ssize_t written = write(file.number(), bytes.data() + done, bytes.size() - done);
        if (written < 0 && errno != EINTR) break;
        done += static_cast<std::size_t>(std::max<ssize_t>(written, 0));
        if (done == bytes.size() && lseek(file.number(), 0, SEEK_SET) == 0) return file;
    }
    return fail(fmt::format("no input for {}: {}", name, systemMessage(errno)));
}

struct Spawned {
    pid_t process;
    Descriptor output;
};

Result<Spawned> spawn(const std::string& name, const std::filesystem::path& program,
                      const std::vector<std::string>& arguments, std::span<const std::byte> input) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0)
        return fail(fmt::format("no pipe to {}: {}", name, systemMessage(errno)));
    Descriptor readEnd(ends[0]);
    const Descriptor writeEnd(ends[1]);

    Result<Descriptor> given = Descriptor();
    if (!input.empty() && !(given = fileOf(name, input))) return tl::unexpected(given.error());

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    if (input.empty())
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    else
        posix_spawn_file_actions_adddup2(&actions, given->number(), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, writeEnd.number(), STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    std::vector<std::string> words{program.string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    pid_t process = 0;
    const int code =
        posix_spawn(&process, words.front().c_str(), &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (code != 0) return notStarted(name, program, systemMessage(code));
    return Spawned{process, std::move(readEnd)};
}

Status explainEnd(const std::string& name, int status) {
    if (WIFSIGNALED(status)) {
        const int number = WTERMSIG(status);
        return crashed(name, fmt::format("signal {}, {}", number, strsignal(number)));
    }
    if (WEXITSTATUS(status) != 0) return gaveUp(name, WEXITSTATUS(status));
    return {};
}

constexpr std::size_t kPiece = std::size_t{1} << 18u;

/// Appends what can be read; false at the end of the pipe.
bool readSome(int descriptor, std::span<std::byte> piece, std::vector<std::byte>& output) {
    const ssize_t got = read(descriptor, piece.data(), piece.size());
    if (got > 0) output.insert(output.end(), piece.begin(), piece.begin() + got);
    return got > 0 || (got < 0 && errno == EINTR);
}

}  // namespace

Result<std::vector<std::byte>> runChild(const std::string& name, const std::filesystem::path& program,
                                        const std::vector<std::string>& arguments, const ChildLimits& limits,
                                        std::span<const std::byte> input) {
    if (auto status = checkStop(); !status) return tl::unexpected(status.error());
    auto spawned = spawn(name, program, arguments, input);
    if (!spawned) return tl::unexpected(spawned.error());
    Child child(spawned->process);
    ChildWatch watch(name, limits, [id = spawned->process] { return residentBytes(id); });
    std::vector<std::byte> output, piece(kPiece);
#ifdef F_SETPIPE_SZ
    // Fewer turns between the two; smaller pipes do as well.
    fcntl(spawned->output.number(), F_SETPIPE_SZ, static_cast<int>(kPiece));
#endif
    pollfd waiting{spawned->output.number(), POLLIN, 0};
    for (bool open = true; open;) {
        const int ready = poll(&waiting, 1, static_cast<int>(kWatchInterval.count()));
        if (ready > 0) {
            open = readSome(waiting.fd, piece, output);
            makeRoom(limits, output);
        }
        if (auto status = watch.check(output.size()); !status) return tl::unexpected(status.error());
    }
    // A child may close its output and linger.
    std::optional<int> end;
    while (!(end = child.poll())) {
        if (auto status = watch.check(output.size()); !status) return tl::unexpected(status.error());
        usleep(200);
    }
    if (auto status = explainEnd(name, *end); !status) return tl::unexpected(status.error());
    return output;
}

std::filesystem::path programFolder() {
    std::error_code code;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", code);
    return code ? std::filesystem::path() : program.parent_path();
}

}  // namespace hairloom
