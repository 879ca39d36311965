// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/write_rules.h"

#include <map>
#include <mutex>
#include <utility>

#include "core/base/temporary_file.h"
#include "core/base/written_files.h"

namespace hairloom {
namespace {

/// Files by identity: what was read, and what was written by the process itself.
struct Known {
    std::mutex mutex;
    WriteRules rules;
    std::map<std::pair<std::uint64_t, std::uint64_t>, FileState> read;
    std::map<std::pair<std::uint64_t, std::uint64_t>, FileState> written;
};

Known& known() {
    static Known instance;
    return instance;
}

}  // namespace

void setWriteRules(WriteRules rules) {
    const std::lock_guard lock(known().mutex);
    known().rules = std::move(rules);
    known().read.clear();
    known().written.clear();
}

const WriteRules& writeRules() {
    return known().rules;
}

void noteInput(const std::filesystem::path& path) {
    if (!writeRules().keepInputs) return;
    const FileState state = fileState(path);
    const std::lock_guard lock(known().mutex);
    if (!known().written.contains(state.identity)) known().read.try_emplace(state.identity, state);
}

InputState inputState(const FileState& state) {
    if (!writeRules().keepInputs) return InputState::NotRead;
    const std::lock_guard lock(known().mutex);
    const auto found = known().read.find(state.identity);
    if (found == known().read.end()) return InputState::NotRead;
    return found->second.sameContent(state) ? InputState::AsRead : InputState::ChangedSince;
}

void noteWritten(const std::filesystem::path& path) {
    if (!writeRules().keepInputs) return;
    const FileState state = fileState(path);
    const std::lock_guard lock(known().mutex);
    known().read.erase(state.identity);
    known().written.insert_or_assign(state.identity, state);
}

}  // namespace hairloom
