// SPDX-License-Identifier: GPL-3.0-or-later
// A child process that behaves as the environment variable HAIRLOOM_TEST_CHILD or else its first argument
// says.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#include <windows.h>
#endif

namespace {

void prepare() {
#ifdef _WIN32
    SetErrorMode(SEM_FAILCRITICALERRORS | SEM_NOGPFAULTERRORBOX);
    _setmode(_fileno(stdout), _O_BINARY);
#endif
}

void crash() {
#ifdef _WIN32
    RaiseException(EXCEPTION_ACCESS_VIOLATION, EXCEPTION_NONCONTINUABLE, 0, nullptr);
#else
    // Sanitizers would make an exit status of it.
    std::signal(SIGSEGV, SIG_DFL);
    std::raise(SIGSEGV);
#endif
}

void sleepLong() {
    std::this_thread::sleep_for(std::chrono::seconds(60));
}

void writeOut(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stdout);
    std::fflush(stdout);
}

int behave(std::string_view how, const std::vector<std::string>& words) {
    if (how == "crash") crash();
    if (how == "hang") sleepLong();
    if (how == "nonsense") writeOut("nonsense\n");
    if (how == "words") {
        for (const std::string& word : words) writeOut(word + "\n");
    }
    if (how == "output") {
        writeOut("abc");
        std::fputs("junk", stderr);
        writeOut(std::string(300'000, '\0'));
    }
    if (how == "half") {
        writeOut("half");
        return 3;
    }
    if (how == "close and hang") {
        std::fclose(stdout);
        sleepLong();
    }
    if (how == "flood") {
        const std::string piece(1u << 16u, 'x');
        for (;;) writeOut(piece);
    }
    if (how == "memory") {
        const std::vector<char> much(200'000'000, 'x');
        writeOut({much.data(), 1});
        sleepLong();
    }
    return 0;
}

}  // namespace

int main(int count, char** arguments) {
    prepare();
    const std::vector<std::string> words(arguments + 1, arguments + count);
    const char* how = std::getenv("HAIRLOOM_TEST_CHILD");
    if (how != nullptr && *how != '\0') return behave(how, words);
    return words.empty() ? 2 : behave(words.front(), {words.begin() + 1, words.end()});
}
