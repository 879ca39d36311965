// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/ended_slots_posix.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <vector>

#include "core/base/output_file.h"
#include "core/base/temporary_file.h"

namespace hairloom {
namespace {

std::array<EndedSlot, 256> slots;  // NOLINT(readability-identifier-naming): the handler's

std::atomic<int> endsLater{0};  // NOLINT(readability-identifier-naming): the handler's
std::atomic<int> endedBy{0};    // NOLINT(readability-identifier-naming)

/// Folders that were made for files that are still to come, the innermost first.
struct FolderSlot {
    std::atomic<bool> isUsed{false};
    std::array<char, 4096> path{};
};
std::array<FolderSlot, 16> folderSlots;  // NOLINT(readability-identifier-naming)

extern "C" void removeAndEnd(int signal) {
    if (endsLater > 0) {
        endedBy = signal;
        return;
    }
    for (EndedSlot& slot : slots) {
        if (slot.state == 2) unlinkat(slot.folder, slot.name.data(), 0);
    }
    for (FolderSlot& folder : folderSlots) {
        if (folder.isUsed) rmdir(folder.path.data());
    }
    struct sigaction action {};
    action.sa_handler = SIG_DFL;
    sigaction(signal, &action, nullptr);
    raise(signal);
}

}  // namespace

EndedSlot* takeEndedSlot(int folder, const std::string& name) {
    for (EndedSlot& slot : slots) {
        int isFree = 0;
        if (name.size() >= slot.name.size() || !slot.state.compare_exchange_strong(isFree, 1)) continue;
        slot.folder = folder;
        std::memcpy(slot.name.data(), name.c_str(), name.size() + 1);
        slot.state = 2;
        return &slot;
    }
    return nullptr;
}

bool isInEndedSlot(const std::string& name) {
    return std::ranges::any_of(
        slots, [&](const EndedSlot& slot) { return slot.state == 2 && name == slot.name.data(); });
}

EndsLater::EndsLater() {
    ++endsLater;
}

EndsLater::~EndsLater() {
    if (--endsLater > 0) return;
    if (const int signal = endedBy.exchange(0); signal != 0) raise(signal);
}

void removeFoldersWhenEnded(const std::vector<std::filesystem::path>& innermostFirst) {
    for (FolderSlot& slot : folderSlots) slot.isUsed = false;
    for (std::size_t i = 0; i < std::min(innermostFirst.size(), folderSlots.size()); ++i) {
        const std::string& path = innermostFirst[i].native();
        if (path.size() >= folderSlots[i].path.size()) return;
        std::memcpy(folderSlots[i].path.data(), path.c_str(), path.size() + 1);
        folderSlots[i].isUsed = true;
    }
}

void removeTemporariesWhenEnded() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action {};
        // What the parent had ignored (nohup) stays ignored.
        if (sigaction(signal, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) continue;
        action = {};
        action.sa_handler = removeAndEnd;
        sigfillset(&action.sa_mask);
        sigaction(signal, &action, nullptr);
    }
    // A limit on the size of files is an error like a full disk.
    struct sigaction ignore {};
    ignore.sa_handler = SIG_IGN;
    sigaction(SIGXFSZ, &ignore, nullptr);
}

}  // namespace hairloom
