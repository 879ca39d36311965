// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/strands.h"

#include <algorithm>
#include <cassert>
#include <set>

namespace hairloom {

const StrandWriter& strandWriter(std::string_view name) {
    const auto found = std::ranges::find(strandWriters(), name, &StrandWriter::name);
    assert(found != strandWriters().end());
    return *found;
}

std::vector<std::string> exportPrograms() {
    std::set<std::string> programs;
    for (const StrandWriter& writer : strandWriters()) {
        for (const ExportTarget& target : writer.targets) programs.insert(target.program);
    }
    return {programs.begin(), programs.end()};
}

const ExportTarget* findTarget(const StrandWriter& writer, std::string_view program) {
    const auto found = std::ranges::find(writer.targets, program, &ExportTarget::program);
    return found == writer.targets.end() ? nullptr : &*found;
}

const StrandWriter& preferredWriter(std::string_view program) {
    // Binary USD carries most; where a program has a format for its own groom, that one goes before it.
    for (const std::string_view format : {"abc-unreal", "usdc", "tfx", "abc", "hair"}) {
        const StrandWriter& writer = strandWriter(format);
        if (findTarget(writer, program) != nullptr) return writer;
    }
    const auto reads = [&](const StrandWriter& writer) { return findTarget(writer, program) != nullptr; };
    const auto found = std::ranges::find_if(strandWriters(), reads);
    assert(found != strandWriters().end());
    return *found;
}

}  // namespace hairloom
