// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/take_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/editing/document.h"
#include "core/editing/records.h"
#include "core/editing/selection_commands.h"
#include "core/editing/settings_commands.h"
#include "core/editing/stack_commands.h"
#include "core/groom/carried_weight.h"
#include "core/operations/length_constraint.h"
#include "core/operations/strand_edit.h"

namespace hairloom::editing {
namespace {

std::string recordOfShape(std::span<const Vec3f> positions_ss, bool carriesWeight) {
    auto values = nlohmann::ordered_json::array();
    for (const Vec3f& position : positions_ss) {
        for (int c = 0; c < 3; ++c) values.push_back(readableDecimal(position[c]));
    }
    return recordOf("take_shape", {{"points", std::move(values)}, {"carriesWeight", carriesWeight}});
}

}  // namespace

Result<std::unique_ptr<Command>> takeShape(const Model& model, std::span<const Vec3f> positions_ss,
                                           bool carriesWeight) {
    const Groom& groom = model.groom;
    if (positions_ss.size() != groom.pointCount())
        return fail(fmt::format("the shape has {} points", positions_ss.size()),
                    fmt::format("the hair has {}", groom.pointCount()));
    if (!std::ranges::all_of(positions_ss, [](const Vec3f& at) { return at.allFinite(); }))
        return fail("the shape has positions that are not finite",
                    "expected a frame before the simulation broke down");
    std::vector<Vec3f> shape(positions_ss.begin(), positions_ss.end());
    const auto authored = groom.positions();
    std::vector<float> lengths;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
        const std::size_t first = groom.offsets[s], count = groom.offsets[s + 1] - first;
        if (count < 2) continue;
        shape[first] = authored[first];
        measureSegments(authored.subspan(first, count), lengths);
        restoreLengthsByDirection(std::span(shape).subspan(first, count), lengths);
    }
    Model next{groom, nullptr};
    next.groom.pointAttributes.set(attribute::kPosition, std::move(shape));
    if (!groom.operators.empty() && groom.strandCount() > 0) {
        if (groom.operators.size() >= kMaxOperators)
            return fail(fmt::format("{} operators", groom.operators.size()),
                        "expected fewer: bake some before you set the rest shape");
        if (auto sculpt = stackAfterStroke(next, allStrands(groom))) sculpt->exchange(next);
    }
    if (carriesWeight) carryWeight(next.groom.simulation);
    return replaceGroom(model, std::move(next.groom), "Set rest shape",
                        recordOfShape(positions_ss, carriesWeight));
}

// --- As operations of a script ---

namespace {

MakeCommand readTakeShape(JsonReader& reader) {
    const std::vector<double> numbers = reader.numbers("points", -kAnywhere, kAnywhere, 3 * kMaxNumbers, "m");
    const bool carriesWeight = reader.boolean("carriesWeight");
    std::vector<Vec3f> points(numbers.size() / 3);
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i] = Vec3d(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]).cast<float>();
    if (numbers.size() % 3 != 0)
        reader.complain("points", "has numbers that are not points", "expected three numbers for each point");
    return [points, carriesWeight](const Document& document) -> CommandResult {
        return takeShape(document.model(), points, carriesWeight);
    };
}

constexpr RecordedOperation kTakeShapeRecords[] = {
    {"take_shape", readTakeShape},
};

}  // namespace

RecordList takeShapeRecords() {
    return kTakeShapeRecords;
}

}  // namespace hairloom::editing
