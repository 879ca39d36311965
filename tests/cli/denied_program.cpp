// SPDX-License-Identifier: GPL-3.0-or-later
// denied CALL=ERROR… -- PROGRAM WORD…: runs the program as on a kernel where these system calls end with
// these numbers of errors: one without Landlock, or one that keeps namespaces to itself.

#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string_view>
#include <vector>

namespace {

const std::map<std::string_view, long> kCalls{{"landlock_create_ruleset", SYS_landlock_create_ruleset},
                                              {"landlock_restrict_self", SYS_landlock_restrict_self},
                                              {"unshare", SYS_unshare},
                                              {"prctl", SYS_prctl},
                                              {"pivot_root", SYS_pivot_root}};

}  // namespace

int main(int count, char** words) {
    std::vector<sock_filter> filter{
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offsetof(seccomp_data, nr)))};
    int at = 1;
    for (; at < count && std::string_view(words[at]) != "--"; ++at) {
        const std::string_view word = words[at];
        const auto call = kCalls.find(word.substr(0, word.find('=')));
        if (call == kCalls.end() || word.find('=') == word.npos) return 99;
        const auto error = static_cast<std::uint32_t>(std::atoi(word.data() + word.find('=') + 1));
        filter.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call->second), 0, 1));
        filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | error));
    }
    if (at + 1 >= count) return 99;
    filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
    sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
        prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0) {
        std::perror("denied");
        return 98;
    }
    execv(words[at + 1], words + at + 1);
    std::perror(words[at + 1]);
    return 97;
}
