// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/processor_watch.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#ifdef __linux__
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>
#endif

namespace hairloom {
namespace {

#ifdef __linux__

/// Other programs, one for each processor, that compute as long as this lives.
class Burners {
  public:
    Burners() {
        for (unsigned i = 0; i < std::thread::hardware_concurrency(); ++i) {
            const pid_t child = fork();
            if (child == 0) {
                while (true) getppid();
            }
            children_.push_back(child);
        }
    }
    Burners(const Burners&) = delete;
    Burners& operator=(const Burners&) = delete;
    ~Burners() {
        for (const pid_t child : children_) {
            kill(child, SIGKILL);
            waitpid(child, nullptr, 0);
        }
    }

  private:
    std::vector<pid_t> children_;
};

TEST(ProcessorWatch, SeesOtherPrograms) {
    const Burners others;
    const ProcessorWatch watch;
    std::this_thread::sleep_for(std::chrono::seconds(1));
    const auto share = watch.othersShare();
    if (!share) GTEST_SKIP() << "the system does not tell";
    EXPECT_GT(*share, kBusyShare);
    EXPECT_LE(*share, 1.0);
}

TEST(ProcessorWatch, OwnWorkIsNotThatOfOthers) {
    // What else runs here counts before and after alike; the own work may add nothing.
    const auto shareOver = [](bool work) {
        const ProcessorWatch watch;
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(1);
        while (std::chrono::steady_clock::now() < end) {
            if (!work) std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        return watch.othersShare();
    };
    const auto idle = shareOver(false), working = shareOver(true);
    if (!idle || !working) GTEST_SKIP() << "the system does not tell";
    EXPECT_LT(*working, *idle + 0.5 / std::thread::hardware_concurrency() + 0.15);
}

TEST(ProcessorWatch, TooShortATimeTellsNothing) {
    EXPECT_FALSE(ProcessorWatch().othersShare());
}

#endif

}  // namespace
}  // namespace hairloom
