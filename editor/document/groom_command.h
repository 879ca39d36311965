// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A change of several parts of the groom at once, as panels and imports make them. Holds the other groom;
// arrays that the change did not touch are shared with the document, so it costs what it touched.

#include "core/editing/command.h"

namespace hairloom::editor {

class GroomCommand : public editing::Command {
  public:
    GroomCommand(std::string name, editing::Part parts, Groom other)
        : name_(std::move(name)), parts_(parts), other_(std::move(other)) {}

    std::string name() const override { return name_; }
    editing::Change exchange(editing::Model& model) override;
    std::size_t bytes() const override { return bytes_; }

  private:
    std::string name_;
    editing::Part parts_;
    Groom other_;
    std::size_t bytes_ = sizeof(*this);
};

}  // namespace hairloom::editor
