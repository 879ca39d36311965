// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/strands.h"

#include <algorithm>
#include <cassert>
#include <set>

namespace hairloom {

const StrandWriter& strandWriter(std::string_view name, StrandWriters writers) {
    const auto found = std::ranges::find(writers, name, &StrandWriter::name);
    assert(found != writers.end());
    return *found;
}

std::vector<std::string> exportPrograms(StrandWriters writers) {
    std::set<std::string> programs;
    for (const StrandWriter& writer : writers) {
        for (const ExportTarget& target : writer.targets) programs.insert(target.program);
    }
    return {programs.begin(), programs.end()};
}

const ExportTarget* findTarget(const StrandWriter& writer, std::string_view program) {
    const auto found = std::ranges::find(writer.targets, program, &ExportTarget::program);
    return found == writer.targets.end() ? nullptr : &*found;
}

const StrandWriter& preferredWriter(std::string_view program, StrandWriters writers) {
    // Binary USD carries most; where a program has a format for its own groom, that one goes before it.
    for (const std::string_view format : {"abc-unreal", "usdc", "tfx", "abc", "hair"}) {
        const StrandWriter& writer = strandWriter(format, writers);
        if (findTarget(writer, program) != nullptr) return writer;
    }
    const auto reads = [&](const StrandWriter& writer) { return findTarget(writer, program) != nullptr; };
    const auto found = std::ranges::find_if(writers, reads);
    assert(found != writers.end());
    return *found;
}

}  // namespace hairloom
