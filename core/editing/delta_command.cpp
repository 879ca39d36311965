// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/delta_command.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace hairloom::editing {
namespace {

std::vector<std::uint32_t> unionOf(std::initializer_list<std::span<const std::uint32_t>> lists) {
    std::vector<std::uint32_t> all;
    for (const auto list : lists) {
        std::vector<std::uint32_t> both;
        std::set_union(all.begin(), all.end(), list.begin(), list.end(), std::back_inserter(both));
        all = std::move(both);
    }
    return all;
}

class DeltaCommand final : public Command {
  public:
    DeltaCommand(std::string name, Deltas deltas) : name_(std::move(name)), deltas_(std::move(deltas)) {
        touched_ = unionOf({deltas_.points.strands(), deltas_.frozen.strands(), deltas_.hidden.strands(),
                            deltas_.selected.strands(), deltas_.dye.strands(), deltas_.mask.strands(),
                            deltas_.widths.strands(), deltas_.roots.strands()});
    }
    std::string name() const override { return name_; }

    Change exchange(Model& model) override {
        if (isDone_) deltas_.strands.exchange(model.groom);
        deltas_.points.exchange(model.groom);
        for (FlagDelta* flags : {&deltas_.frozen, &deltas_.hidden, &deltas_.selected})
            flags->exchange(model.groom);
        deltas_.faces.exchange(model.groom);
        deltas_.density.exchange(model.groom);
        deltas_.dye.exchange(model.groom);
        deltas_.mask.exchange(model.groom);
        deltas_.widths.exchange(model.groom);
        deltas_.roots.exchange(model.groom);
        if (!isDone_) deltas_.strands.exchange(model.groom);
        isDone_ = !isDone_;
        return {parts(), deltas_.strands.empty() ? std::span<const std::uint32_t>(touched_)
                                                 : std::span<const std::uint32_t>()};
    }

    std::size_t bytes() const override {
        return sizeof(*this) + name_.capacity() + touched_.capacity() * sizeof(std::uint32_t) +
               deltas_.points.bytes() + deltas_.frozen.bytes() + deltas_.hidden.bytes() +
               deltas_.selected.bytes() + deltas_.faces.bytes() + deltas_.density.bytes() +
               deltas_.dye.bytes() + deltas_.mask.bytes() + deltas_.widths.bytes() + deltas_.roots.bytes() +
               deltas_.strands.bytes();
    }

  private:
    Part parts() const {
        Part parts = Part::None;
        if (!deltas_.points.empty()) parts = parts | Part::Points;
        if (!deltas_.frozen.empty() || !deltas_.hidden.empty() || !deltas_.selected.empty())
            parts = parts | Part::StrandFlags;
        if (!deltas_.faces.empty()) parts = parts | Part::ScalpFaces;
        if (!deltas_.density.empty()) parts = parts | Part::Density;
        if (!deltas_.dye.empty()) parts = parts | Part::Dye;
        if (!deltas_.mask.empty()) parts = parts | Part::Masks;
        if (!deltas_.widths.empty()) parts = parts | Part::Widths;
        if (!deltas_.roots.empty()) parts = parts | Part::Triangulation;
        if (deltas_.dye.changesStrength()) parts = parts | Part::Material;
        if (!deltas_.strands.empty()) parts = parts | Part::Strands | Part::Triangulation;
        return parts;
    }

    std::string name_;
    Deltas deltas_;
    std::vector<std::uint32_t> touched_;
    bool isDone_ = true;
};

}  // namespace

std::unique_ptr<Command> commandOf(std::string name, Deltas deltas) {
    if (deltas.empty()) return nullptr;
    return std::make_unique<DeltaCommand>(std::move(name), std::move(deltas));
}

}  // namespace hairloom::editing
