// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/command.h"

#include <algorithm>
#include <utility>

namespace hairloom::editing {

CommandGroup::CommandGroup(std::string name, std::vector<std::unique_ptr<Command>> commands, bool done)
    : name_(std::move(name)), commands_(std::move(commands)), done_(done) {}

Change CommandGroup::exchange(Model& model) {
    Change all;
    std::size_t withStrands = 0;
    const auto run = [&](Command& command) {
        const Change change = command.exchange(model);
        all.parts = all.parts | change.parts;
        if (contains(change.parts, Part::Points | Part::StrandFlags) && withStrands++ == 0)
            all.strands = change.strands;
    };
    if (done_) {
        for (auto command = commands_.rbegin(); command != commands_.rend(); ++command) run(**command);
    } else {
        for (const auto& command : commands_) run(*command);
    }
    done_ = !done_;
    // Lists of several commands would have to be merged; observers then look at all strands.
    if (withStrands > 1) all.strands = {};
    return all;
}

std::size_t CommandGroup::bytes() const {
    std::size_t sum = sizeof(*this) + name_.size();
    for (const auto& command : commands_) sum += command->bytes();
    return sum;
}

std::unique_ptr<Command> together(std::string name, std::vector<std::unique_ptr<Command>> commands) {
    std::erase(commands, nullptr);
    if (commands.empty()) return nullptr;
    std::string record;
    for (const auto& command : commands) {
        std::string one = command->record();
        // Those of a group are operations of this one.
        if (one.starts_with('[')) one = one.substr(1, one.size() - 2);
        record += (record.empty() ? '[' : ',') + one;
    }
    const bool all = std::ranges::none_of(commands, [](const auto& c) { return c->record().empty(); });
    auto group = std::make_unique<CommandGroup>(std::move(name), std::move(commands), false);
    if (all) group->setRecord(record + ']');
    return group;
}

}  // namespace hairloom::editing
