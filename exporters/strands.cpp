// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/strands.h"

#include <algorithm>
#include <cassert>
#include <set>

namespace hairloom {

const std::vector<HairWriter>& registeredWriters();

const std::vector<HairWriter>& hairWriters() {
    static const auto kAll = [] {
        std::vector<HairWriter> writers = registeredWriters();
        std::ranges::sort(writers, {}, &HairWriter::name);
        return writers;
    }();
    return kAll;
}

const std::vector<HairWriter>& strandWriters() {
    static const auto kStrands = [] {
        std::vector<HairWriter> writers = hairWriters();
        std::erase_if(writers, [](const HairWriter& writer) { return writer.holdsCards(); });
        return writers;
    }();
    return kStrands;
}

const HairWriter& strandWriter(std::string_view name, HairWriters writers) {
    const auto found = std::ranges::find(writers, name, &HairWriter::name);
    assert(found != writers.end());
    return *found;
}

std::vector<std::string> exportPrograms(HairWriters writers) {
    std::set<std::string> programs;
    for (const HairWriter& writer : writers) {
        for (const ExportTarget& target : writer.targets) programs.insert(target.program);
    }
    return {programs.begin(), programs.end()};
}

const ExportTarget* findTarget(const HairWriter& writer, std::string_view program) {
    const auto found = std::ranges::find(writer.targets, program, &ExportTarget::program);
    return found == writer.targets.end() ? nullptr : &*found;
}

const HairWriter& preferredWriter(std::string_view program, HairWriters writers) {
    // Binary USD carries most; where a program has a format for its own groom, that one goes before it.
    for (const std::string_view format : {"abc-unreal", "usdc", "tfx", "abc", "hair"}) {
        const HairWriter& writer = strandWriter(format, writers);
        if (findTarget(writer, program) != nullptr) return writer;
    }
    const auto reads = [&](const HairWriter& writer) { return findTarget(writer, program) != nullptr; };
    const auto found = std::ranges::find_if(writers, reads);
    assert(found != writers.end());
    return *found;
}

}  // namespace hairloom
