// SPDX-License-Identifier: GPL-3.0-or-later
// A document's script makes of the document as it was opened the same bytes as the hand did.

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/editing/layer_commands.h"
#include "core/editing/place.h"
#include "core/editing/replay.h"
#include "core/editing/selection_commands.h"
#include "core/editing/settings_commands.h"
#include "core/editing/sphere_commands.h"
#include "core/editing/stack_commands.h"
#include "core/geometry/selection.h"
#include "core/groom/file/project_file.h"
#include "core/groom/file/settings_json.h"
#include "core/operations/stack.h"
#include "tests/editing/editing_samples.h"
#include "tests/support/temporary_folder.h"

namespace hairloom::editing {
namespace {

template <class S>
void read(JsonReader reader, S& settings) {
    hairloom::readSettings(std::move(reader), settings);
}
void read(JsonReader reader, BrushSettings& settings) {
    reader.fields(settings);
}
template <class S>
nlohmann::json written(const S& settings) {
    return hairloom::toJson(settings);
}
nlohmann::json written(const BrushSettings& settings) {
    return fieldsToJson(settings);
}

void disturb(nlohmann::json& value, Random& random) {
    if (value.is_boolean()) {
        value = !value.get<bool>();
    } else if (value.is_number_integer()) {
        value = random.below(4 + 2 * static_cast<std::uint32_t>(value.get<std::uint64_t>() % 1000));
    } else if (value.is_number()) {
        value = readableDecimal(random.uniform(0, 2) * value.get<float>() + random.uniform(0, 0.01f));
    } else if (value.is_array() && !value.empty()) {
        disturb(value[random.below(static_cast<std::uint32_t>(value.size()))], random);
    }
}

/// The settings with one field, drawn at random, at another value that may be.
template <class S>
S withAnyField(const S& settings, Random& random) {
    nlohmann::json json = written(settings);
    const auto member = std::next(json.begin(), random.below(static_cast<std::uint32_t>(json.size())));
    disturb(*member, random);
    S changed = settings;
    const JsonReader reader(json, "settings");
    read(reader, changed);
    return reader.ok() && runtime::problemsIn(changed).empty() ? changed : settings;
}

runtime::SimulationSettings anyPhysics(const runtime::SimulationSettings& settings, Random& random) {
    runtime::SimulationSettings changed = withAnyField(settings, random);
    if (random.below(4) == 0) changed.integrator = static_cast<runtime::Integrator>(random.below(2));
    if (random.below(4) == 0) changed.windKind = static_cast<runtime::WindKind>(random.below(2));
    return changed;
}

std::vector<std::uint32_t> someOf(std::size_t count, Random& random, std::uint32_t oneIn) {
    std::vector<std::uint32_t> some;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (random.below(oneIn) == 0) some.push_back(i);
    }
    return some;
}

BrushCurve anyCurve(Random& random) {
    std::vector<float> values(random.below(5));
    for (float& value : values) value = random.uniform();
    return BrushCurve(std::move(values));
}

/// Any brush with any settings, somewhere on the head.
void anyStroke(Document& document, Random& random) {
    const auto names = brushNames();
    Stroke stroke;
    stroke.tool = names[random.below(static_cast<std::uint32_t>(names.size()))];
    for (int i = 0; i < 4; ++i) stroke.settings = withAnyField(stroke.settings, random);
    stroke.settings.radius = random.uniform(0.005f, 0.04f);
    stroke.settings.depth = random.uniform(0, 0.1f);
    stroke.settings.mirrorNormal.x() = 1;
    stroke.settings.falloff = anyCurve(random);
    stroke.settings.profile = anyCurve(random);
    for (const BrushParameter& parameter : brushInfo(stroke.tool).parameters) {
        const auto min = static_cast<float>(parameter.min), max = static_cast<float>(parameter.max);
        const float value = random.uniform(min, std::min(max, min + 10));
        stroke.settings.parameters[std::string(parameter.name)] =
            parameter.kind == runtime::FieldKind::Bool ? static_cast<float>(random.below(2)) : value;
    }
    Vec3f out(random.uniform(-1, 1), random.uniform(0, 1), random.uniform(-1, 1));
    const auto begun = document.beginStroke(stroke);
    ASSERT_TRUE(begun) << begun.error().message();
    const float height = random.uniform(0, 0.1f);
    for (std::uint32_t dabs = 1 + random.below(5); dabs > 0; --dabs) {
        out += 0.1f * Vec3f(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        const Vec3f unit = out.normalized();
        const Vec3f view = random.below(2) == 0 ? Vec3f(-unit) : Vec3f(Vec3f::Zero());
        const auto done = document.dab(
            dabAt(stroke.settings, kHeadCentre + unit * (kHeadRadius + height), view, random.uniform()));
        ASSERT_TRUE(done) << done.error().message();
    }
    random.below(8) == 0 ? document.cancelStroke() : static_cast<void>(document.endStroke());
}

PlacementSettings anyPlacement(PlacementSettings settings, Random& random) {
    settings = withAnyField(settings, random);
    // As many as a test can wait for.
    settings.count = 40 + random.below(100);
    settings.points = std::clamp(settings.points, 2u, 12u);
    settings.densityPerCm2 = std::min(settings.densityPerCm2, 1.0f);
    return settings;
}

/// A slider that is dragged, and perhaps put back to where it was.
void anyDrag(Document& document, Random& random, std::uint64_t key) {
    const runtime::SimulationSettings before = document.groom().simulation;
    for (int i = 0; i < 3; ++i) {
        document.performMerged(
            key, [&](const Model& model) { return setPhysics(model, anyPhysics(before, random), "Drag"); });
    }
    if (random.below(3) == 0)
        document.performMerged(key, [&](const Model& model) { return setPhysics(model, before, "Drag"); });
}

std::unique_ptr<Command> anyStrandCommand(const Model& model, Random& random) {
    const auto strands = someOf(model.groom.strandCount(), random, 4);
    switch (random.below(8)) {
        case 6: {
            auto moved = moveToLayer(model, strands,
                                     random.below(static_cast<std::uint32_t>(model.groom.layers.size())));
            return moved ? std::move(*moved) : nullptr;
        }
        case 7: {
            auto removed =
                removeLayer(model, random.below(static_cast<std::uint32_t>(model.groom.layers.size())));
            return removed ? std::move(*removed) : nullptr;
        }
        case 0:
            return selectStrands(model, strands, static_cast<Choice>(random.below(4)));
        case 1:
            return hideStrands(model, strands);
        case 2:
            return showStrands(model);
        case 3:
            return freezeStrands(model, strands, random.below(2) == 0);
        case 4:
            return deleteStrands(model, someOf(model.groom.strandCount(), random, 20));
        default:
            return triangulate(model);
    }
}

std::unique_ptr<Command> anyScalpCommand(const Model& model, Random& random) {
    const ScalpMesh& head = *model.groom.scalp;
    const FaceSet faces =
        growSelection(head, {random.below(static_cast<std::uint32_t>(head.triangleCount()))},
                      static_cast<int>(3 + random.below(6)));
    switch (random.below(3)) {
        case 0:
            return selectScalp(model, faces, static_cast<Choice>(1 + random.below(3)), "above:0.5");
        case 1: {
            std::vector<float> density(head.vertexCount());
            for (float& value : density) value = random.uniform();
            return setDensity(model, density);
        }
        default: {
            PlaceRequest request;
            std::set_intersection(faces.begin(), faces.end(), model.groom.scalpSelection.begin(),
                                  model.groom.scalpSelection.end(), std::back_inserter(request.region));
            request.reach = random.below(2) == 0 ? 0 : random.uniform(0, 0.05f);
            auto command = place(model.groom, request, {});
            return command ? std::move(*command) : nullptr;
        }
    }
}

std::unique_ptr<Command> anySphereCommand(const Model& model, Random& random) {
    const auto& spheres = model.groom.spheres;
    const SurfacePoint onHead{random.below(static_cast<std::uint32_t>(model.groom.scalp->triangleCount())),
                              Vec3f::Constant(1.0f / 3)};
    if (spheres.empty()) return placeSphere(model, onHead, random.uniform(0.01f, 0.05f));
    const std::size_t index = random.below(static_cast<std::uint32_t>(spheres.size()));
    switch (random.below(7)) {
        case 0:
            return placeSphere(model, onHead, random.uniform(0.01f, 0.05f), "Head");
        case 1:
            return moveSphere(model, index, Vec3f(random.uniform(), random.uniform(), random.uniform()));
        case 2:
            return resizeSphere(model, index, random.uniform(0, 0.1f));
        case 3:
            return attachSphere(model, index, "Neck_L");
        case 4:
            return renameSphere(model, index, "Sphere \"ä\"");
        case 5:
            return spheres.size() < 10 ? mirrorSphere(model, index) : nullptr;
        default:
            return removeSphere(model, index);
    }
}

std::unique_ptr<Command> anySettingsCommand(const Model& model, Random& random) {
    const Groom& groom = model.groom;
    switch (random.below(7)) {
        case 0:
            return setMaterial(model, withAnyField(groom.material, random));
        case 1:
            return setPhysics(model, anyPhysics(groom.simulation, random));
        case 2:
            return setInterpolation(model, withAnyField(groom.interpolation, random));
        case 3:
            return setPlacementSettings(model, anyPlacement(groom.placement, random));
        case 4: {
            Groom preset = groom;
            preset.material = withAnyField(preset.material, random);
            preset.simulation = anyPhysics(preset.simulation, random);
            return setSettings(model, preset, "Preset");
        }
        case 5: {
            auto made = setCardEdits(model, {anyCardEdit(random), anyCardEdit(random)}, "Cards");
            EXPECT_TRUE(made);
            return std::move(*made);
        }
        default: {
            std::vector<Layer> layers = groom.layers;
            layers[0].locked = random.below(8) == 0;
            layers.back().visible = random.below(4) != 0;
            if (layers.size() < 5) layers.push_back({"More", true, false, 1, {}});
            return setLayers(model, std::move(layers));
        }
    }
}

Operator anyOperator(Random& random) {
    const auto& known = stackOperators();
    Operator one = newOperator(known[random.below(static_cast<std::uint32_t>(known.size()))].name);
    one.enabled = random.below(4) != 0;
    one.weight = random.below(2) == 0 ? 1 : random.uniform();
    return one;
}

StackCommand anyStackCommand(const Model& model, Random& random) {
    const auto count = static_cast<std::uint32_t>(model.groom.operators.size());
    if (count == 0 || (count < 6 && random.below(3) == 0))
        return addOperator(model, random.below(count + 1), anyOperator(random));
    const std::size_t index = random.below(count);
    switch (random.below(12)) {
        case 0:
            return bakeOperators(model);
        case 1:
            return copyOperator(model, index);
        case 2:
        case 3:
            return moveOperator(model, index, random.below(count));
        case 4:
            return setOperators(model, {anyOperator(random), model.groom.operators[index]}, "Operators");
        case 5:
        case 6:
            return removeOperator(model, index);
        default:
            return setOperator(model, index, anyOperator(random), "Operator");
    }
}

void anyEdit(Document& document, Random& random, std::uint64_t number) {
    switch (random.below(10)) {
        case 0:
            document.undo();
            break;
        case 1:
            document.redo();
            break;
        case 2:
            document.perform(anyStrandCommand(document.model(), random));
            break;
        case 3:
            document.perform(anyScalpCommand(document.model(), random));
            break;
        case 4:
            document.perform(anySphereCommand(document.model(), random));
            break;
        case 5:
            document.perform(anySettingsCommand(document.model(), random));
            break;
        case 6:
            anyDrag(document, random, 1 + number);
            break;
        case 7: {
            auto command = anyStackCommand(document.model(), random);
            ASSERT_TRUE(command) << command.error().message();
            document.perform(std::move(*command));
            break;
        }
        default:
            anyStroke(document, random);
    }
}

class ScriptOfAnyEdits : public testing::TestWithParam<std::uint64_t> {
  protected:
    std::string savedBytes(const Groom& groom) {
        const auto path = folder_ / "groom.hairloom";
        EXPECT_TRUE(saveProject(groom, path));
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

  private:
    const TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Seeds, ScriptOfAnyEdits, testing::Values(1, 2, 3, 4, 5, 6));

TEST_P(ScriptOfAnyEdits, ReplayedGivesTheBytesOfTheSavedProject) {
    Random random(GetParam());
    const Groom start = hairOnHead(80, 6);
    Document document(start);
    document.setHistoryLimit(std::size_t{1} << 30u);
    for (std::uint64_t i = 0; i < 200; ++i) ASSERT_NO_FATAL_FAILURE(anyEdit(document, random, i));
    const auto script = document.script();
    ASSERT_TRUE(script) << script.error().message();
    const auto parsed = parseScript("s.json", *script, scriptExtensions());
    ASSERT_TRUE(parsed) << parsed.error().message();
    Groom replayed = start;
    const auto report = runScript(*parsed, replayed);
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_GT(report->strokes, 40u);
    EXPECT_TRUE(savedBytes(replayed) == savedBytes(document.groom()));
    EXPECT_FALSE(hasErrors(validate(document.groom())));
}

TEST(MergedSteps, AreOneThatLeadsFromTheFirstToTheLast) {
    Document document(hairOnHead(20));
    const float before = document.groom().simulation.windSpeed;
    const auto drag = [&](std::uint64_t key, float speed) {
        document.performMerged(key, [&](const Model& model) {
            runtime::SimulationSettings settings = model.groom.simulation;
            settings.windSpeed = speed;
            return setPhysics(model, settings, "Wind speed");
        });
    };
    for (const float speed : {1.0f, 2.0f, 3.0f}) drag(7, speed);
    EXPECT_EQ(document.history().size(), 1u);
    EXPECT_EQ(document.groom().simulation.windSpeed, 3);
    EXPECT_THAT(document.script().value(), testing::HasSubstr("\"windSpeed\":3"));
    drag(8, 4);
    EXPECT_EQ(document.history().size(), 2u) << "another drag is another step";
    document.undo();
    document.undo();
    EXPECT_EQ(document.groom().simulation.windSpeed, before);
    drag(8, 5);
    EXPECT_EQ(document.history().size(), 1u) << "what was undone is no step to join";
}

TEST(MergedSteps, AreNoneWhereTheSliderIsPutBack) {
    Document document(hairOnHead(20));
    const float before = document.groom().simulation.windSpeed;
    Part heard = Part::None;
    const Subscription subscription = document.observe([&](const Change& change) { heard = change.parts; });
    for (const float speed : {before + 1, before}) {
        document.performMerged(7, [&](const Model& model) {
            runtime::SimulationSettings settings = model.groom.simulation;
            settings.windSpeed = speed;
            return setPhysics(model, settings);
        });
    }
    EXPECT_EQ(document.history().size(), 0u);
    EXPECT_FALSE(document.isModified());
    EXPECT_EQ(heard, Part::Physics | Part::History) << "the value that went back is said";
}

TEST(MergedSteps, AfterASliderIsPutBackTheDragTouchesNoOtherStep) {
    Document document(hairOnHead(20));
    const float before = document.groom().simulation.windSpeed;
    const auto drag = [&](std::uint64_t key, float speed) {
        document.performMerged(key, [&](const Model& model) {
            runtime::SimulationSettings settings = model.groom.simulation;
            settings.windSpeed = speed;
            return setPhysics(model, settings);
        });
    };
    for (const float speed : {before + 1, before, before + 2}) drag(7, speed);
    EXPECT_EQ(document.history().size(), 1u);
    EXPECT_EQ(document.groom().simulation.windSpeed, before + 2);
    for (const float speed : {before + 3, before + 2, before + 4}) drag(8, speed);
    EXPECT_EQ(document.history().size(), 2u);
    document.undo();
    EXPECT_EQ(document.groom().simulation.windSpeed, before + 2);
    document.undo();
    EXPECT_EQ(document.groom().simulation.windSpeed, before);
}

TEST(ReplacedGroom, SaysWhichPartsDifferAndNamesItsStepWhereAScriptCannotHoldIt) {
    Document document(hairOnHead(20));
    Groom other = document.groom();
    other.material.specular = 1.25f;
    Part heard = Part::None;
    const Subscription subscription = document.observe([&](const Change& change) { heard = change.parts; });
    document.perform(replaceGroom(document.model(), other, "Import"));
    EXPECT_EQ(heard, Part::Material | Part::History);
    const auto script = document.script();
    ASSERT_FALSE(script);
    EXPECT_THAT(script.error().message(), testing::HasSubstr("step 1, 'Import'"));
}

}  // namespace
}  // namespace hairloom::editing
