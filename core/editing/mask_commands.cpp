// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/mask_commands.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/editing/selection_commands.h"
#include "core/editing/settings_commands.h"
#include "core/groom/mask_names.h"
#include "core/operations/mask.h"
#include "core/operations/stack.h"

namespace hairloom::editing {
namespace {

constexpr auto kFirst = static_cast<std::uint32_t>(MaskMap::mask1);

}  // namespace

std::vector<std::uint32_t> freeMasks(const Groom& groom) {
    std::vector<std::uint32_t> free;
    for (std::uint32_t number = 1; number <= kPaintedMasks; ++number) {
        const auto map = static_cast<MaskMap>(kFirst + number - 1);
        const auto painted = groom.strandAttributes.view<float>(maskAttribute(number));
        if (std::ranges::none_of(groom.operators, [&](const Operator& one) { return readsMap(one, map); }) &&
            std::ranges::none_of(painted, [](float share) { return share > 0; }))
            free.push_back(number);
    }
    return free;
}

Result<std::uint32_t> freeMask(const Groom& groom) {
    const auto free = freeMasks(groom);
    if (!free.empty()) return free.front();
    return fail(fmt::format("all {} masks are in use", kPaintedMasks), "name the one to overwrite");
}

Result<std::vector<std::uint32_t>> masksFor(const Groom& groom, std::size_t count, std::uint32_t first) {
    std::vector<std::uint32_t> numbers = freeMasks(groom);
    if (first > 0) {
        numbers.clear();
        for (std::uint32_t number = first; number <= kPaintedMasks; ++number) numbers.push_back(number);
    }
    if (count > numbers.size())
        return fail(
            fmt::format("{} regions need a mask each, and {} of {} {}", count, numbers.size(), kPaintedMasks,
                        first > 0 ? fmt::format("begin at {}", first) : std::string("are free")),
            first > 0 ? "an image of fewer colours, or a lower first mask"
                      : "an image of fewer colours, or name the first mask to overwrite");
    numbers.resize(count);
    return numbers;
}

std::unique_ptr<Command> fillMasks(const Model& model, std::string name,
                                   std::span<const std::uint32_t> numbers,
                                   std::span<const std::vector<float>> values,
                                   std::span<const std::string> called) {
    std::vector<std::unique_ptr<Command>> steps;
    for (std::size_t i = 0; i < numbers.size(); ++i) steps.push_back(setMask(model, numbers[i], values[i]));
    std::vector<std::string> names = model.groom.maskNames;
    const auto rename = [&](std::size_t i, const std::string& to) {
        if (called[i].empty()) return;
        if (auto renamed = maskNamesWith(names, numbers[i], to)) names = std::move(*renamed);
    };
    // First away with those that go, which others may take.
    for (std::size_t i = 0; i < called.size(); ++i) rename(i, {});
    for (std::size_t i = 0; i < called.size(); ++i) rename(i, called[i]);
    if (auto step = setMaskNames(model, std::move(names))) steps.push_back(std::move(*step));
    return together(std::move(name), std::move(steps));
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
