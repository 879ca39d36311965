// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/mask_commands.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/editing/selection_commands.h"
#include "core/operations/mask.h"
#include "core/operations/stack.h"

namespace hairloom::editing {
namespace {

constexpr auto kFirst = static_cast<std::uint32_t>(MaskMap::mask1);

}  // namespace

Result<std::uint32_t> freeMask(const Groom& groom) {
    for (std::uint32_t number = 1; number <= kPaintedMasks; ++number) {
        const auto map = static_cast<MaskMap>(kFirst + number - 1);
        const auto painted = groom.strandAttributes.view<float>(maskAttribute(number));
        if (std::ranges::none_of(groom.operators,
                                 [&](const Operator& one) { return readsMap(one, map); }) &&
            std::ranges::none_of(painted, [](float share) { return share > 0; }))
            return number;
    }
    return fail(fmt::format("all {} masks are in use", kPaintedMasks), "name the one to overwrite");
}

StackCommand fillMaskOf(const Model& model, std::size_t index, std::span<const float> values) {
    const std::vector<Operator>& operators = model.groom.operators;
    if (index >= operators.size())
        return fail(fmt::format("operator {} does not exist", index),
                    fmt::format("there are {} operators", operators.size()));
    Operator changed = operators[index];
    Mask mask = maskOf(changed);
    if (mask.map < MaskMap::mask1) {
        const auto number = freeMask(model.groom);
        if (!number) return tl::unexpected(number.error());
        mask.map = static_cast<MaskMap>(kFirst + *number - 1);
        setMaskOf(changed, mask);
    }
    std::vector<std::unique_ptr<Command>> steps;
    steps.push_back(setMask(model, static_cast<std::uint32_t>(mask.map) - kFirst + 1, values));
    // The operator acts by what the mask has then.
    Model filled{model.groom, {}};
    if (steps[0]) steps[0]->exchange(filled);
    auto step = setOperator(filled, index, std::move(changed), {});
    if (steps[0]) steps[0]->exchange(filled);
    if (!step) return step;
    steps.push_back(std::move(*step));
    return together("Mask from image", std::move(steps));
}

}  // namespace hairloom::editing
