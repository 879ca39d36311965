// SPDX-License-Identifier: GPL-3.0-or-later
// Every command does, undoes and does again; and any mixture of them leaves a document that is in order.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <functional>

#include "core/editing/place.h"
#include "core/editing/records.h"
#include "core/editing/replay.h"
#include "core/editing/selection_commands.h"
#include "core/editing/settings_commands.h"
#include "core/editing/sphere_commands.h"
#include "core/geometry/selection.h"
#include "core/groom/mask_names.h"
#include "core/groom/time_line.h"
#include "tests/editing/editing_samples.h"

namespace hairloom::editing {
namespace {

using Strands = std::vector<std::uint32_t>;

struct Action {
    const char* name;
    std::function<std::unique_ptr<Command>(const Model&, Random&)> make;
};

void PrintTo(const Action& printed, std::ostream* out) {
    *out << printed.name;
}

/// Strands, about every fourth.
Strands someStrands(const Model& model, Random& random) {
    Strands strands;
    for (std::uint32_t s = 0; s < model.groom.strandCount(); ++s) {
        if (random.below(4) == 0) strands.push_back(s);
    }
    return strands;
}

FaceSet someFaces(const Model& model, Random& random) {
    const ScalpMesh& head = *model.groom.scalp;
    return growSelection(head, {random.below(static_cast<std::uint32_t>(head.triangleCount()))},
                         static_cast<int>(3 + random.below(6)));
}

std::size_t someSphere(const Model& model, Random& random) {
    return random.below(static_cast<std::uint32_t>(model.groom.spheres.size()));
}

std::vector<Action> actions() {
    const auto withSphere = [](auto make) {
        return [make](const Model& model, Random& random) -> std::unique_ptr<Command> {
            if (model.groom.spheres.empty()) return nullptr;
            return make(model, someSphere(model, random), random);
        };
    };
    return {{"SelectStrands",
             [](const Model& m, Random& r) {
                 return selectStrands(m, someStrands(m, r), static_cast<Choice>(r.below(4)));
             }},
            {"HideStrands", [](const Model& m, Random& r) { return hideStrands(m, someStrands(m, r)); }},
            {"ShowStrands", [](const Model& m, Random&) { return showStrands(m); }},
            {"FreezeStrands",
             [](const Model& m, Random& r) { return freezeStrands(m, someStrands(m, r), r.below(2) == 0); }},
            {"DeleteStrands",
             [](const Model& m, Random& r) {
                 Strands strands = someStrands(m, r);
                 if (strands.size() > 10) strands.resize(10);
                 return deleteStrands(m, strands);
             }},
            {"SelectScalp",
             [](const Model& m, Random& r) {
                 return selectScalp(m, someFaces(m, r), r.below(3) == 0 ? Choice::Toggle : Choice::Add);
             }},
            {"SetDensity",
             [](const Model& m, Random& r) {
                 std::vector<float> density(m.groom.scalp->vertexCount());
                 for (float& value : density) value = r.uniform();
                 return setDensity(m, density);
             }},
            {"SetMaterial",
             [](const Model& m, Random& r) {
                 HairMaterial material = m.groom.material;
                 material.eumelanin = r.uniform(0, 8);
                 return setMaterial(m, material);
             }},
            {"SetPhysics",
             [](const Model& m, Random& r) {
                 runtime::SimulationSettings settings = m.groom.simulation;
                 settings.substeps = 1 + r.below(16);
                 const runtime::Ramp::Key keys[] = {
                     {0, r.uniform(0, 1)}, {r.uniform(0.1f, 0.9f), r.uniform(0, 1)}, {1, r.uniform(0, 1)}};
                 settings.angularCurve = runtime::Ramp::of(keys);
                 return setPhysics(m, settings);
             }},
            {"SetInterpolation",
             [](const Model& m, Random& r) {
                 InterpolationSettings settings = m.groom.interpolation;
                 settings.followPerGuide = r.below(50);
                 return setInterpolation(m, settings);
             }},
            {"SetPlacement",
             [](const Model& m, Random& r) {
                 PlacementSettings settings = m.groom.placement;
                 settings.count = 40 + r.below(100);
                 settings.points = 2 + r.below(12);
                 settings.placement =
                     r.below(2) == 0 ? PlacementMethod::poissonDisk : PlacementMethod::random;
                 settings.seed = r.next();
                 return setPlacementSettings(m, settings);
             }},
            {"Triangulate", [](const Model& m, Random&) { return triangulate(m); }},
            {"SetLayers",
             [](const Model& m, Random& r) {
                 std::vector<Layer> layers = m.groom.layers;
                 layers[0].locked = r.below(8) == 0;
                 if (layers.size() < 5) layers.push_back({"More", true, false, 1, {}});
                 return setLayers(m, std::move(layers));
             }},
            {"SetCardEdits",
             [](const Model& m, Random& r) {
                 std::vector<CardEdit> edits = m.groom.cardEdits;
                 edits.push_back(anyCardEdit(r));
                 if (edits.size() > 3) edits.erase(edits.begin());
                 auto made = setCardEdits(m, std::move(edits), "Cards");
                 EXPECT_TRUE(made);
                 return std::move(*made);
             }},
            {"SetMaskNames",
             [](const Model& m, Random& r) {
                 const auto number = static_cast<std::uint32_t>(1 + r.below(4));
                 const auto names =
                     maskNamesWith(m.groom.maskNames, number, fmt::format("m{}", r.below(1u << 30u)));
                 EXPECT_TRUE(names);
                 auto made = setMaskNames(m, *names);
                 EXPECT_TRUE(made);
                 return std::move(*made);
             }},
            {"SetTimeLine",
             [](const Model& m, Random& r) {
                 TimeLine line = timeLineOf(m.groom);
                 line.preRoll = 1 + r.below(100);
                 line.head.resize(1);
                 line.head[0].degrees = r.uniform(-90, 90);
                 line.settings = {{"simulation.windSpeed", {{r.uniform(), Vec3d(r.uniform(), 0, 0)}}}};
                 auto made = setTimeLine(m, std::move(line), "Time line");
                 EXPECT_TRUE(made);
                 return std::move(*made);
             }},
            {"PlaceSphere",
             [](const Model& m, Random& r) {
                 const SurfacePoint place{r.below(static_cast<std::uint32_t>(m.groom.scalp->triangleCount())),
                                          Vec3f::Constant(1.0f / 3)};
                 return placeSphere(m, place, r.uniform(0.01f, 0.05f));
             }},
            {"MoveSphere", withSphere([](const Model& m, std::size_t i, Random& r) {
                 return moveSphere(m, i, Vec3f(r.uniform(), r.uniform(), r.uniform()));
             })},
            {"ResizeSphere", withSphere([](const Model& m, std::size_t i, Random& r) {
                 return resizeSphere(m, i, r.uniform(0, 0.1f));
             })},
            {"AttachSphere", withSphere([](const Model& m, std::size_t i, Random& r) {
                 return attachSphere(m, i, r.below(2) == 0 ? "Head" : "Neck_L");
             })},
            {"MirrorSphere", withSphere([](const Model& m, std::size_t i, Random&) {
                 return m.groom.spheres.size() < 20 ? mirrorSphere(m, i) : removeSphere(m, i);
             })},
            {"RemoveSphere",
             withSphere([](const Model& m, std::size_t i, Random&) { return removeSphere(m, i); })},
            {"ReplaceGroom",
             [](const Model& m, Random& r) {
                 Groom groom = m.groom;
                 groom.material.specular = r.uniform();
                 return replaceGroom(m, std::move(groom), "Import");
             }},
            {"SetMelanin",
             [](const Model& m, Random& r) {
                 std::vector<float> values(m.groom.strandCount(), r.uniform());
                 if (m.groom.strandAttributes.has(attribute::kMelanin) && r.below(2) == 0) values.clear();
                 return setMelanin(m, values);
             }},
            {"SetStiffness",
             [](const Model& m, Random& r) {
                 std::vector<float> values(m.groom.strandCount(), 4 * r.uniform());
                 if (m.groom.strandAttributes.has(attribute::kStiffness) && r.below(2) == 0) values.clear();
                 return setStiffness(m, values);
             }},
            {"Place", [](const Model& m, Random& r) -> std::unique_ptr<Command> {
                 PlaceRequest request;
                 if (r.below(2) == 0) {
                     const FaceSet faces = someFaces(m, r);
                     std::set_intersection(faces.begin(), faces.end(), m.groom.scalpSelection.begin(),
                                           m.groom.scalpSelection.end(), std::back_inserter(request.region));
                 }
                 request.reach = r.below(2) == 0 ? 0 : 0.03f;
                 auto command = place(m.groom, request, {});
                 return command ? std::move(*command) : nullptr;
             }}};
}

class EveryCommand : public testing::TestWithParam<Action> {};
INSTANTIATE_TEST_SUITE_P(Commands, EveryCommand, testing::ValuesIn(actions()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(EveryCommand, UndoAndRedoRestoreTheState) {
    Groom groom = hairOnHead(100, 6);
    groom.spheres = {{"Arm_L", Vec3f(0.1f, 1.5f, 0), 0.05f, "arm_L"}};
    groom.strandAttributes.set(attribute::kHidden, std::vector<std::uint8_t>(100, 0));
    groom.strandAttributes.edit<std::uint8_t>(attribute::kHidden)[3] = 1;
    Document document(groom);
    Random random(11);
    const std::uint64_t before = contentHash(document.groom());
    auto command = GetParam().make(document.model(), random);
    ASSERT_NE(command, nullptr);
    EXPECT_EQ(contentHash(document.groom()), before) << "making a command does nothing";
    EXPECT_FALSE(command->name().empty());
    EXPECT_GT(command->bytes(), 0u);
    Part heard = Part::None;
    const Subscription subscription = document.observe([&](const Change& change) { heard = change.parts; });
    document.perform(std::move(command));
    EXPECT_NE(heard, Part::History) << "it says what changed";
    const std::uint64_t after = contentHash(document.groom());
    EXPECT_NE(after, before);
    for (int i = 0; i < 2; ++i) {
        ASSERT_TRUE(document.undo());
        EXPECT_EQ(contentHash(document.groom()), before);
        ASSERT_TRUE(document.redo());
        EXPECT_EQ(contentHash(document.groom()), after);
    }
    EXPECT_FALSE(hasErrors(validate(document.groom())));
    if (std::string_view(GetParam().name) == "ReplaceGroom") return;  // nothing that a script could hold
    const auto script = document.script();
    ASSERT_TRUE(script) << script.error().message();
    const auto parsed = parseScript("s.json", *script, scriptExtensions());
    ASSERT_TRUE(parsed) << parsed.error().message();
    Groom replayed = groom;
    const auto report = runScript(*parsed, replayed);
    ASSERT_TRUE(report) << report.error().message();
    EXPECT_EQ(contentHash(replayed), after);
}

/// A stroke of any tool somewhere on the head.
void randomStroke(Document& document, Random& random) {
    Stroke stroke;
    stroke.tool = brushNames()[random.below(static_cast<std::uint32_t>(brushNames().size()))];
    stroke.settings.radius = random.uniform(0.005f, 0.04f);
    stroke.settings.strength = random.uniform();
    stroke.settings.invert = random.below(3) == 0;
    stroke.settings.symmetric = random.below(3) == 0;
    stroke.settings.collide = random.below(8) != 0;
    stroke.settings.seed = random.next();
    Vec3f out(random.uniform(-1, 1), random.uniform(0, 1), random.uniform(-1, 1));
    ASSERT_TRUE(document.beginStroke(stroke));
    const float height = random.uniform(0, 0.1f);
    const std::uint32_t dabs = 1 + random.below(5);
    for (std::uint32_t i = 0; i < dabs; ++i) {
        out += 0.1f * Vec3f(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        const Vec3f unit = out.normalized();
        const bool isView = random.below(2) == 0;
        ASSERT_TRUE(document.dab(dabAt(stroke.settings, kHeadCentre + unit * (kHeadRadius + height),
                                       isView ? Vec3f(-unit) : Vec3f(Vec3f::Zero()), random.uniform())));
    }
    if (random.below(6) == 0) {
        document.cancelStroke();
    } else {
        document.endStroke();
    }
}

TEST(AnySequence, Of500ActionsLeavesTheDocumentInOrder) {
    std::vector<Action> all = actions();
    std::erase_if(all, [](const Action& action) { return std::string_view(action.name) == "ReplaceGroom"; });
    int scripts = 0;
    for (const std::uint64_t seed : {1u, 2u}) {
        Random random(seed);
        const Groom start = hairOnHead(80, 6);
        Document document(start);
        const std::uint64_t first = contentHash(document.groom());
        document.setHistoryLimit(std::size_t{1} << 30u);
        for (int i = 0; i < 500; ++i) {
            switch (random.below(5)) {
                case 0:
                    document.undo();
                    break;
                case 1:
                    document.redo();
                    break;
                case 2:
                    document.perform(all[random.below(static_cast<std::uint32_t>(all.size()))].make(
                        document.model(), random));
                    break;
                default:
                    ASSERT_NO_FATAL_FAILURE(randomStroke(document, random));
            }
            if (i % 25 == 0) {
                const auto findings = validate(document.groom());
                ASSERT_FALSE(hasErrors(findings))
                    << i << ": " << findings.front().what << ' ' << findings.front().where;
            }
        }
        const std::uint64_t last = contentHash(document.groom());
        if (const auto script = document.script()) {
            Groom replayed = start;
            const auto report = runScript(*parseScript("s.json", *script, scriptExtensions()), replayed);
            ASSERT_TRUE(report) << report.error().message();
            EXPECT_EQ(contentHash(replayed), last);
            ++scripts;
        }
        const std::size_t steps = document.history().doneCount();
        while (document.undo()) {
        }
        EXPECT_EQ(contentHash(document.groom()), first);
        for (std::size_t i = 0; i < steps; ++i) document.redo();
        EXPECT_EQ(contentHash(document.groom()), last);
        // Bounds followed all of it.
        StrandBounds fresh;
        fresh.rebuild(document.groom());
        ASSERT_EQ(document.bounds().size(), fresh.size());
        for (std::size_t s = 0; s < fresh.size(); ++s) EXPECT_EQ(document.bounds()[s].low, fresh[s].low);
    }
    EXPECT_EQ(scripts, 2);
}

TEST(Records, NameWhatIsWrong) {
    const auto problem = [](std::string_view step) -> std::string {
        const auto script =
            parseScript("s.json", R"({"hairloom_script": 1, "operations": [)" + std::string(step) + "]}",
                        scriptExtensions());
        if (!script) return script.error().message();
        Groom groom = hairOnHead(20);
        const auto report = runScript(*script, groom);
        return report ? "it ran" : report.error().message();
    };
    using testing::HasSubstr;
    EXPECT_EQ(problem(R"({"op": "strands", "do": "delete", "strands": [3, 2, 9, 1]})"), "it ran");
    EXPECT_THAT(problem(R"({"op": "strands", "do": "delete", "strands": [3, 2, 4, 1]})"),
                HasSubstr("/operations/0/strands does not ascend at value 2"));
    EXPECT_THAT(problem(R"({"op": "strands", "do": "delete", "strands": [3]})"), HasSubstr("odd number"));
    EXPECT_THAT(problem(R"({"op": "strands", "do": "delete", "strands": [20, 1]})"),
                HasSubstr("strand 20 does not exist; there are 20"));
    EXPECT_THAT(problem(R"({"op": "strands", "do": "delete", "strands": [0, 4294967295]})"),
                HasSubstr("expected ascending runs"));
    EXPECT_THAT(problem(R"({"op": "scalp", "faces": [99999, 1], "expression": ""})"),
                HasSubstr("face 99999 does not exist"));
    EXPECT_THAT(problem(R"({"op": "density", "values": [1]})"), HasSubstr("1 densities"));
    EXPECT_THAT(problem(R"({"op": "melanin", "values": [1]})"), HasSubstr("1 values of melanin"));
    EXPECT_THAT(problem(R"({"op": "melanin", "values": [9]})"), HasSubstr("from 0 to 8"));
    EXPECT_EQ(problem(R"({"op": "melanin", "values": []})"), "it ran");
    EXPECT_THAT(problem(R"({"op": "stiffness", "values": [1]})"), HasSubstr("1 values of stiffness"));
    EXPECT_THAT(problem(R"({"op": "stiffness", "values": [1001]})"), HasSubstr("from 0 to 1000"));
    EXPECT_EQ(problem(R"({"op": "stiffness", "values": []})"), "it ran");
    EXPECT_THAT(problem(R"({"op": "layers", "layers": []})"), HasSubstr("0 layers"));
    EXPECT_THAT(problem(R"({"op": "material", "settings": {"specular": 9}})"),
                HasSubstr("/operations/0/settings/specular is 9"));
}

TEST(Records, OfGroupsWithinGroupsAreOneListOfOperations) {
    Document document(hairOnHead());
    const Strands some{1, 2, 5};
    std::vector<std::unique_ptr<Command>> inner, outer;
    inner.push_back(hideStrands(document.model(), some));
    inner.push_back(freezeStrands(document.model(), some, true));
    outer.push_back(together("Inner", std::move(inner)));
    outer.push_back(selectStrands(document.model(), some, Choice::Replace));
    document.perform(together("Outer", std::move(outer)));
    EXPECT_EQ(strandsWithFlag(document.groom(), attribute::kFrozen), some);
    EXPECT_EQ(strandsWithFlag(document.groom(), attribute::kSelected), some);
    expectScriptMakesTheSame(document);
}

TEST(Commands, NoChangeMakesNoCommand) {
    Document document(hairOnHead(20));
    const Model& model = document.model();
    EXPECT_EQ(setMaterial(model, model.groom.material), nullptr);
    EXPECT_EQ(setPhysics(model, model.groom.simulation), nullptr);
    EXPECT_EQ(setInterpolation(model, model.groom.interpolation), nullptr);
    EXPECT_EQ(setPlacementSettings(model, model.groom.placement), nullptr);
    EXPECT_EQ(showStrands(model), nullptr);
    EXPECT_EQ(selectStrands(model, {}, Choice::Add), nullptr);
    EXPECT_EQ(selectScalp(model, model.groom.scalpSelection, Choice::Add), nullptr);
    EXPECT_EQ(deleteStrands(model, {}), nullptr);
    document.perform(nullptr);
    EXPECT_FALSE(document.canUndo());
}

TEST(Commands, SelectHideFreezeAndDelete) {
    Document document(hairOnHead(10));
    const auto selected = [&] { return strandsWithFlag(document.groom(), attribute::kSelected); };
    document.perform(selectStrands(document.model(), Strands{1, 2, 3}, Choice::Replace));
    EXPECT_EQ(selected(), (Strands{1, 2, 3}));
    document.perform(selectStrands(document.model(), Strands{3, 4}, Choice::Add));
    EXPECT_EQ(selected(), (Strands{1, 2, 3, 4}));
    document.perform(selectStrands(document.model(), Strands{1, 9}, Choice::Remove));
    EXPECT_EQ(selected(), (Strands{2, 3, 4}));
    document.perform(selectStrands(document.model(), Strands{4, 5}, Choice::Toggle));
    EXPECT_EQ(selected(), (Strands{2, 3, 5}));
    document.perform(selectStrands(document.model(), {}, Choice::Replace));
    EXPECT_TRUE(selected().empty());
    while (document.undo()) {
    }
    EXPECT_FALSE(document.groom().strandAttributes.has(attribute::kSelected));
}

}  // namespace
}  // namespace hairloom::editing
