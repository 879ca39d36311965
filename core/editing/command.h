// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One step that can be undone. A command holds only what differs between before and after, and exchanges it
// with the model: doing, undoing and doing again are the same exchange.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/editing/model.h"

namespace hairloom::editing {

class Command {
  public:
    Command() = default;
    Command(const Command&) = delete;
    Command& operator=(const Command&) = delete;
    virtual ~Command() = default;

    /// What a person did, for the history: "Comb", "Move sphere".
    virtual std::string name() const = 0;
    /// Swaps the parts of the model that this command concerns with those it holds. The change's strands stay
    /// valid until the next exchange.
    virtual Change exchange(Model& model) = 0;
    /// Memory held, bytes.
    virtual std::size_t bytes() const = 0;

    /// The operation of a script that does the same (JSON; an array of them where it takes several), or empty
    /// where there is none.
    const std::string& record() const { return record_; }
    void setRecord(std::string record) { record_ = std::move(record); }

  private:
    std::string record_;
};

/// Commands that are done in order and undone in reverse, as one.
class CommandGroup final : public Command {
  public:
    /// `done` says whether the commands have been carried out already.
    CommandGroup(std::string name, std::vector<std::unique_ptr<Command>> commands, bool done);
    std::string name() const override { return name_; }
    Change exchange(Model& model) override;
    std::size_t bytes() const override;

  private:
    std::string name_;
    std::vector<std::unique_ptr<Command>> commands_;
    bool done_;
};

/// The commands (nulls are left out) as one step that is not done yet; its record is theirs, where all have
/// one. Each must have been made for the model as the ones before it leave it. Null where there is none.
std::unique_ptr<Command> together(std::string name, std::vector<std::unique_ptr<Command>> commands);

}  // namespace hairloom::editing
