// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/records.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/editing/document.h"
#include "core/editing/layer_commands.h"
#include "core/editing/place.h"
#include "core/editing/selection_commands.h"
#include "core/editing/settings_commands.h"
#include "core/editing/stack_commands.h"
#include "core/editing/take_shape.h"
#include "core/groom/file/card_edits_json.h"
#include "core/groom/file/layers_json.h"
#include "core/groom/file/settings_json.h"
#include "core/operations/mask.h"
#include "core/operations/stack.h"
#include "core/operations/strand_edit.h"

namespace hairloom::editing {
namespace {

using Json = nlohmann::ordered_json;
using Indices = std::vector<std::uint32_t>;
using CommandResult = Result<std::unique_ptr<Command>>;

constexpr std::size_t kMaxNumbers = 4'000'000;

/// Settings under "settings"; those that are not named have their defaults.
template <class S, std::unique_ptr<Command> (*Make)(const Model&, const S&, std::string)>
MakeCommand readSettingsStep(JsonReader& reader) {
    S checked;
    readSettings(reader.object("settings"), checked);
    return [checked](const Document& document) -> CommandResult {
        return Make(document.model(), checked, "Settings");
    };
}

MakeCommand readSpheres(JsonReader& reader) {
    std::vector<CollisionSphere> spheres;
    for (JsonReader& entry : reader.objects("spheres")) spheres.push_back(readSphere(entry));
    return [spheres](const Document& document) -> CommandResult {
        return setSpheres(document.model(), spheres, "Spheres");
    };
}

MakeCommand readCards(JsonReader& reader) {
    return [edits = readCardEdits(reader)](const Document& document) {
        return setCardEdits(document.model(), edits, "Cards");
    };
}

MakeCommand readLayerList(JsonReader& reader) {
    return [layers = readLayers(reader)](const Document& document) -> CommandResult {
        if (layers.size() < document.groom().layers.size())
            return fail(fmt::format("{} layers", layers.size()), "as many as there are, or more");
        return setLayers(document.model(), layers);
    };
}

Status checkBelow(const Indices& indices, std::size_t count, std::string_view what) {
    if (indices.empty() || indices.back() < count) return {};
    return fail(fmt::format("{} {} does not exist", what, indices.back()),
                fmt::format("there are {}", count));
}

MakeCommand readStrands(JsonReader& reader) {
    constexpr std::string_view kActions[] = {"select", "hide", "show", "freeze", "thaw", "delete"};
    const std::string_view action = kActions[reader.choice("do", kActions)];
    const Indices strands = action == "show" ? Indices() : readRuns(reader, "strands");
    return [action, strands](const Document& document) -> CommandResult {
        const Model& model = document.model();
        if (auto status = checkBelow(strands, model.groom.strandCount(), "strand"); !status)
            return tl::unexpected(status.error());
        if (action == "select") return selectStrands(model, strands, Choice::Replace);
        if (action == "hide") return hideStrands(model, strands);
        if (action == "show") return showStrands(model);
        if (action == "delete") return deleteStrands(model, strands);
        return freezeStrands(model, strands, action == "freeze");
    };
}

MakeCommand readScalp(JsonReader& reader) {
    const Indices faces = readRuns(reader, "faces");
    const std::string expression = reader.string("expression");
    return [faces, expression](const Document& document) -> CommandResult {
        const std::size_t count = document.groom().scalp ? document.groom().scalp->triangleCount() : 0;
        if (auto status = checkBelow(faces, count, "face"); !status) return tl::unexpected(status.error());
        return selectScalp(document.model(), faces, Choice::Replace, expression);
    };
}

MakeCommand readDensity(JsonReader& reader) {
    std::vector<float> values;
    for (const double value : reader.numbers("values", 0, 1, kMaxNumbers))
        values.push_back(static_cast<float>(value));
    return [values](const Document& document) -> CommandResult {
        const std::size_t vertices = document.groom().scalp ? document.groom().scalp->vertexCount() : 0;
        if (values.size() != vertices)
            return fail(fmt::format("{} densities", values.size()),
                        fmt::format("one for each of {} vertices", vertices));
        return setDensity(document.model(), values);
    };
}

MakeCommand readMaskValues(JsonReader& reader) {
    const auto number = static_cast<std::uint32_t>(reader.count("mask", 1, kPaintedMasks));
    std::vector<float> values;
    for (const double value : reader.numbers("values", 0, 1, kMaxNumbers))
        values.push_back(static_cast<float>(value));
    return [number, values](const Document& document) -> CommandResult {
        const std::size_t strands = document.groom().strandCount();
        if (values.size() != strands)
            return fail(fmt::format("{} values of a mask", values.size()),
                        fmt::format("one for each of {} strands", strands));
        return setMask(document.model(), number, values);
    };
}

MakeCommand readTakeShape(JsonReader& reader) {
    const std::vector<double> numbers = reader.numbers("points", -kAnywhere, kAnywhere, 3 * kMaxNumbers, "m");
    const bool carriesWeight = reader.boolean("carriesWeight");
    std::vector<Vec3f> points(numbers.size() / 3);
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i] = Vec3d(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]).cast<float>();
    if (numbers.size() % 3 != 0) reader.complain("points", "has numbers that are not points");
    return [points, carriesWeight](const Document& document) -> CommandResult {
        return takeShape(document.model(), points, carriesWeight);
    };
}

MakeCommand readPlace(JsonReader& reader) {
    PlaceRequest request;
    request.region = readRuns(reader, "region");
    request.reach = static_cast<float>(reader.number("reach", 0, 10, "m"));
    const bool collide = reader.boolean("collide");
    const auto clearance = static_cast<float>(reader.number("clearance", 0, 0.01, "m"));
    return [request, collide, clearance](const Document& document) -> CommandResult {
        return place(document.groom(), request, KeepOut{collide ? document.skinField() : nullptr, clearance});
    };
}

std::uint32_t readLayerIndex(JsonReader& reader) {
    return static_cast<std::uint32_t>(reader.count("layer", 0, std::numeric_limits<std::uint32_t>::max()));
}

MakeCommand readMoveToLayer(JsonReader& reader) {
    return [strands = readRuns(reader, "strands"),
            layer = readLayerIndex(reader)](const Document& document) -> CommandResult {
        const Model& model = document.model();
        if (auto status = checkBelow(strands, model.groom.strandCount(), "strand"); !status)
            return tl::unexpected(status.error());
        return moveToLayer(model, strands, layer);
    };
}

MakeCommand readRemoveLayer(JsonReader& reader) {
    return [layer = readLayerIndex(reader)](const Document& document) {
        return removeLayer(document.model(), layer);
    };
}

MakeCommand readTriangulate(JsonReader&) {
    return [](const Document& document) -> CommandResult { return triangulate(document.model()); };
}

MakeCommand readWholeStack(JsonReader& reader) {
    return [operators = readOperators(reader)](const Document& document) {
        return setOperators(document.model(), operators, "Operators");
    };
}

Operator readOneOperator(JsonReader& reader) {
    JsonReader part = reader.object("operator");
    return readOperator(part);
}

std::size_t readIndex(JsonReader& reader, std::string_view name) {
    return static_cast<std::size_t>(reader.count(name, 0, kMaxOperators));
}

MakeCommand readAddOperator(JsonReader& reader) {
    return [at = readIndex(reader, "at"), one = readOneOperator(reader)](const Document& document) {
        return addOperator(document.model(), at, one);
    };
}

MakeCommand readSetOperator(JsonReader& reader) {
    return [at = readIndex(reader, "at"), one = readOneOperator(reader)](const Document& document) {
        return setOperator(document.model(), at, one, "Operator");
    };
}

MakeCommand readMoveOperator(JsonReader& reader) {
    return [at = readIndex(reader, "at"), to = readIndex(reader, "to")](const Document& document) {
        return moveOperator(document.model(), at, to);
    };
}

template <StackCommand (*Make)(const Model&, std::size_t)>
MakeCommand readAtOperator(JsonReader& reader) {
    return [at = readIndex(reader, "at")](const Document& document) { return Make(document.model(), at); };
}

MakeCommand readBake(JsonReader&) {
    return [](const Document& document) { return bakeOperators(document.model()); };
}

constexpr RecordedOperation kOperations[] = {
    {"material", readSettingsStep<HairMaterial, setMaterial>},
    {"simulation", readSettingsStep<runtime::SimulationSettings, setPhysics>},
    {"interpolation", readSettingsStep<InterpolationSettings, setInterpolation>},
    {"placement", readSettingsStep<PlacementSettings, setPlacementSettings>},
    {"spheres", readSpheres},
    {"layers", readLayerList},
    {"card_edits", readCards},
    {"move_to_layer", readMoveToLayer},
    {"remove_layer", readRemoveLayer},
    {"strands", readStrands},
    {"scalp", readScalp},
    {"density", readDensity},
    {"mask", readMaskValues},
    {"place", readPlace},
    {"triangulate", readTriangulate},
    {"operators", readWholeStack},
    {"add_operator", readAddOperator},
    {"set_operator", readSetOperator},
    {"move_operator", readMoveOperator},
    {"copy_operator", readAtOperator<copyOperator>},
    {"remove_operator", readAtOperator<removeOperator>},
    {"bake_operators", readBake},
    {"take_shape", readTakeShape},
};

}  // namespace

Json runsOf(std::span<const std::uint32_t> ascending) {
    Json runs = Json::array();
    for (std::size_t i = 0; i < ascending.size();) {
        std::size_t end = i + 1;
        while (end < ascending.size() && ascending[end] == ascending[end - 1] + 1) ++end;
        runs.push_back(ascending[i]);
        runs.push_back(end - i);
        i = end;
    }
    return runs;
}

Indices readRuns(JsonReader& reader, std::string_view name) {
    constexpr double kLargest = 4294967295.0;
    const std::vector<double> runs = reader.numbers(name, 0, kLargest, kMaxNumbers);
    Indices numbers;
    std::uint64_t next = 0;
    for (std::size_t i = 0; i + 1 < runs.size(); i += 2) {
        const auto first = static_cast<std::uint64_t>(runs[i]);
        const auto count = static_cast<std::uint64_t>(runs[i + 1]);
        if (first < next || count > kMaxNumbers - numbers.size()) {
            reader.complain(name, fmt::format("does not ascend at value {}", i),
                            fmt::format("expected ascending runs of up to {} numbers", kMaxNumbers));
            return {};
        }
        for (std::uint64_t k = 0; k < count; ++k) numbers.push_back(static_cast<std::uint32_t>(first + k));
        next = first + count;
    }
    if (runs.size() % 2 != 0) reader.complain(name, "has an odd number of values", "first, count, …");
    return numbers;
}

std::string recordOf(std::string_view op, Json members) {
    Json record{{"op", op}};
    for (auto& [name, value] : members.items()) record[name] = std::move(value);
    return record.dump();
}

std::span<const RecordedOperation> recordedOperations() {
    return kOperations;
}

}  // namespace hairloom::editing
