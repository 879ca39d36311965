// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/settings_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/editing/document.h"
#include "core/editing/records.h"
#include "core/groom/file/card_edits_json.h"
#include "core/groom/file/layers_json.h"
#include "core/groom/file/poses_json.h"
#include "core/groom/file/settings_json.h"
#include "core/groom/file/time_line_json.h"
#include "core/groom/groom_hash.h"
#include "core/groom/mask_names.h"
#include "hairloom/body_field.h"

namespace hairloom::editing {
namespace {

/// Exchanges one value; `Access` finds it in the model.
template <class T>
class ValueCommand final : public Command {
  public:
    using Access = T& (*)(Model&);
    ValueCommand(std::string name, Part part, Access access, T value, std::size_t heapBytes = 0)
        : name_(std::move(name)), part_(part), access_(access), value_(std::move(value)), heap_(heapBytes) {}
    std::string name() const override { return name_; }
    Change exchange(Model& model) override {
        std::swap(access_(model), value_);
        return {part_, {}};
    }
    std::size_t bytes() const override { return sizeof(*this) + name_.capacity() + heap_; }

  private:
    std::string name_;
    Part part_;
    Access access_;
    T value_;
    std::size_t heap_;  ///< bytes that the value holds elsewhere, about
};

template <class T>
std::unique_ptr<Command> valueCommand(std::string name, Part part, T& (*access)(Model&), T value,
                                      std::string record, std::size_t heapBytes = 0) {
    auto command =
        std::make_unique<ValueCommand<T>>(std::move(name), part, access, std::move(value), heapBytes);
    command->setRecord(std::move(record));
    return command;
}

template <class S>
std::string settingsRecord(std::string_view op, const S& settings) {
    return recordOf(op, {{"settings", hairloom::toJson(settings)}});
}

/// Settings and spheres differ where their text does; it holds every bit of them.
template <class S>
bool differs(const S& a, const S& b) {
    return hairloom::toJson(a) != hairloom::toJson(b);
}

bool sharesAll(const AttributeSet& a, const AttributeSet& b) {
    return std::ranges::equal(a.all(), b.all(), [](const auto& x, const auto& y) {
        return x.first == y.first && versionOf(x.second) == versionOf(y.second);
    });
}

bool sameTriangles(const Groom& a, const Groom& b) {
    return a.triangulation.triangles == b.triangulation.triangles;
}

/// Parts of which nothing is shared count as different.
Part differenceOf(const Groom& a, const Groom& b) {
    const std::pair<Part, bool> kinds[] = {
        {Part::Strands, !a.offsets.sharesWith(b.offsets) ||
                            !sharesAll(a.strandAttributes, b.strandAttributes) ||
                            !sharesAll(a.pointAttributes, b.pointAttributes)},
        {Part::Head, a.scalp != b.scalp || a.characterFile != b.characterFile},
        {Part::ScalpFaces, a.scalpSelection != b.scalpSelection || a.scalpExpression != b.scalpExpression},
        {Part::Density, a.scalpDensity != b.scalpDensity},
        {Part::Placement, differs(a.placement, b.placement)},
        {Part::Spheres, differs(a.spheres, b.spheres) || a.body != b.body},
        {Part::Physics, differs(a.simulation, b.simulation) || a.poses != b.poses},
        {Part::Material, differs(a.material, b.material)},
        {Part::Shadows, differs(a.shadows, b.shadows)},
        {Part::Interpolation, differs(a.interpolation, b.interpolation)},
        {Part::Cards, differs(a.cardEdits, b.cardEdits)},
        {Part::TimeLine, timeLineOf(a) != timeLineOf(b)},
        {Part::Operators, a.operators != b.operators || !a.operators.empty()},
        {Part::Layers, differs(a.layers, b.layers) || a.groupNames != b.groupNames},
        {Part::MaskNames, a.maskNames != b.maskNames},
        {Part::Triangulation, !sameTriangles(a, b)},
    };
    Part parts = Part::None;
    for (const auto& [part, isDifferent] : kinds) {
        if (isDifferent) parts = parts | part;
    }
    return parts;
}

std::size_t bytesNotShared(const AttributeSet& held, const AttributeSet& shown) {
    std::size_t bytes = 0;
    for (const auto& [name, data] : held.all()) {
        if (versionOf(data) == shown.version(name)) continue;
        bytes += std::visit([](const auto& array) { return array.view().size_bytes(); }, data);
    }
    return bytes;
}

/// Exchanges the whole groom. Arrays that are the same in both are shared.
class GroomCommand final : public Command {
  public:
    GroomCommand(std::string name, Part parts, Groom other)
        : name_(std::move(name)), parts_(parts), other_(std::move(other)) {}
    std::string name() const override { return name_; }
    Change exchange(Model& model) override {
        std::swap(model.groom, other_);
        bytes_ = bytesBeside(model.groom);
        return {parts_, {}};
    }
    std::size_t bytes() const override { return bytes_; }

  private:
    std::size_t bytesBeside(const Groom& shown) const {
        return sizeof(*this) + name_.capacity() +
               bytesNotShared(other_.pointAttributes, shown.pointAttributes) +
               bytesNotShared(other_.strandAttributes, shown.strandAttributes) +
               (other_.offsets.sharesWith(shown.offsets) ? 0 : other_.offsets.view().size_bytes()) +
               other_.scalpSelection.size() * sizeof(std::uint32_t) +
               other_.scalpDensity.size() * sizeof(float) +
               other_.triangulation.triangles.size() * sizeof(Triangle);
    }

    std::string name_;
    Part parts_;
    Groom other_;
    std::size_t bytes_ = sizeof(*this);
};

}  // namespace

std::unique_ptr<Command> setMaterial(const Model& model, const HairMaterial& material, std::string name) {
    if (hairloom::toJson(model.groom.material) == hairloom::toJson(material)) return nullptr;
    return valueCommand<HairMaterial>(
        std::move(name), Part::Material, [](Model& m) -> HairMaterial& { return m.groom.material; }, material,
        settingsRecord("material", material));
}

std::unique_ptr<Command> setPhysics(const Model& model, const runtime::SimulationSettings& settings,
                                    std::string name) {
    if (hairloom::toJson(model.groom.simulation) == hairloom::toJson(settings)) return nullptr;
    return valueCommand<runtime::SimulationSettings>(
        std::move(name), Part::Physics,
        [](Model& m) -> runtime::SimulationSettings& { return m.groom.simulation; }, settings,
        settingsRecord("simulation", settings));
}

std::unique_ptr<Command> setShadows(const Model& model, const ShadowSettings& settings, std::string name) {
    if (hairloom::toJson(model.groom.shadows) == hairloom::toJson(settings)) return nullptr;
    return valueCommand<ShadowSettings>(
        std::move(name), Part::Shadows, [](Model& m) -> ShadowSettings& { return m.groom.shadows; }, settings,
        settingsRecord("shadows", settings));
}

std::unique_ptr<Command> setInterpolation(const Model& model, const InterpolationSettings& settings,
                                          std::string name) {
    if (hairloom::toJson(model.groom.interpolation) == hairloom::toJson(settings)) return nullptr;
    return valueCommand<InterpolationSettings>(
        std::move(name), Part::Interpolation,
        [](Model& m) -> InterpolationSettings& { return m.groom.interpolation; }, settings,
        settingsRecord("interpolation", settings));
}

std::unique_ptr<Command> setPlacementSettings(const Model& model, const PlacementSettings& settings,
                                              std::string name) {
    if (hairloom::toJson(model.groom.placement) == hairloom::toJson(settings)) return nullptr;
    return valueCommand<PlacementSettings>(
        std::move(name), Part::Placement, [](Model& m) -> PlacementSettings& { return m.groom.placement; },
        settings, settingsRecord("placement", settings));
}

std::unique_ptr<Command> setSpheres(const Model& model, std::vector<CollisionSphere> spheres,
                                    std::string name) {
    if (hairloom::toJson(model.groom.spheres) == hairloom::toJson(spheres)) return nullptr;
    const std::size_t bytes = std::max(spheres.size(), model.groom.spheres.size()) * sizeof(CollisionSphere);
    std::string record = recordOf("spheres", {{"spheres", hairloom::toJson(spheres)}});
    return valueCommand<std::vector<CollisionSphere>>(
        std::move(name), Part::Spheres,
        [](Model& m) -> std::vector<CollisionSphere>& { return m.groom.spheres; }, std::move(spheres),
        std::move(record), bytes);
}

std::unique_ptr<Command> setBody(const Model& model, std::shared_ptr<const runtime::BodyField> body,
                                 std::string name) {
    using Body = std::shared_ptr<const runtime::BodyField>;
    if (model.groom.body == body) return nullptr;
    const std::size_t bytes =
        std::max(body ? body->bytes() : 0, model.groom.body ? model.groom.body->bytes() : 0);
    return valueCommand<Body>(
        std::move(name), Part::Spheres, [](Model& m) -> Body& { return m.groom.body; }, std::move(body), {},
        bytes);
}

std::unique_ptr<Command> setLayers(const Model& model, std::vector<Layer> layers) {
    const std::vector<Layer>& now = model.groom.layers;
    assert(layers.size() >= now.size());
    if (!differs(now, layers)) return nullptr;
    // Other looks of the same layers move nothing.
    bool looksAlone = layers.size() == now.size();
    for (std::size_t i = 0; i < now.size() && looksAlone; ++i) {
        Layer alike = layers[i];
        alike.material = now[i].material;
        looksAlone = !differs(std::vector{now[i]}, std::vector{alike});
    }
    const Part part = looksAlone ? Part::Material : Part::Layers;
    const std::size_t bytes = layers.size() * sizeof(Layer);
    std::string record = recordOf("layers", {{"layers", hairloom::toJson(layers)}});
    return valueCommand<std::vector<Layer>>(
        "Layers", part, [](Model& m) -> std::vector<Layer>& { return m.groom.layers; }, std::move(layers),
        std::move(record), bytes);
}

Result<std::unique_ptr<Command>> setMaskNames(const Model& model, std::vector<std::string> names) {
    if (auto status = checkMaskNames(names); !status) return tl::unexpected(status.error());
    if (model.groom.maskNames == names) return nullptr;
    const std::size_t bytes = names.size() * (sizeof(std::string) + kLongestMaskName);
    std::string record = recordOf("mask_names", {{"names", maskNamesToJson(names)}});
    return valueCommand<std::vector<std::string>>(
        "Rename mask", Part::MaskNames,
        [](Model& m) -> std::vector<std::string>& { return m.groom.maskNames; }, std::move(names),
        std::move(record), bytes);
}

Result<std::unique_ptr<Command>> setCardEdits(const Model& model, std::vector<CardEdit> edits,
                                              std::string name) {
    std::size_t roots = 0, bytes = 0;
    for (const CardEdit& edit : edits) {
        roots += edit.roots.size();
        bytes +=
            sizeof(CardEdit) + edit.roots.size() * sizeof(Vec3f) + edit.strip.size() * sizeof(CardStation);
    }
    if (edits.size() > kMaxCardEdits || roots > kMaxCardRoots)
        return fail(fmt::format("{} cards of {} hairs are shaped by hand", edits.size(), roots),
                    fmt::format("at most {} of {}", kMaxCardEdits, kMaxCardRoots));
    if (!differs(model.groom.cardEdits, edits)) return nullptr;
    std::string record = recordOf("card_edits", {{"card_edits", hairloom::toJson(edits)}});
    return valueCommand<std::vector<CardEdit>>(
        std::move(name), Part::Cards, [](Model& m) -> std::vector<CardEdit>& { return m.groom.cardEdits; },
        std::move(edits), std::move(record), bytes);
}

Result<std::unique_ptr<Command>> setPoses(const Model& model, std::vector<GroomPose> poses,
                                          std::string name) {
    const std::vector<GroomPose>& now = model.groom.poses;
    if (!std::ranges::equal(now, poses, {}, &GroomPose::name, &GroomPose::name))
        return fail("these are settings of other poses", "expected the names of those that there are");
    for (const GroomPose& pose : poses) {
        if (const auto problems = fieldsOutOfRange(pose); !problems.empty())
            return fail(fmt::format("pose '{}': {}", pose.name, problems[0]), "a value within its range");
    }
    if (now == poses) return nullptr;
    std::string record = recordOf("poses", {{"poses", hairloom::toJson(poses)}});
    const std::size_t bytes = poses.size() * sizeof(GroomPose);
    return valueCommand<std::vector<GroomPose>>(
        std::move(name), Part::Physics, [](Model& m) -> std::vector<GroomPose>& { return m.groom.poses; },
        std::move(poses), std::move(record), bytes);
}

Result<std::unique_ptr<Command>> setTimeLine(const Model& model, TimeLine line, std::string name) {
    using Held = std::shared_ptr<const TimeLine>;
    if (const auto problems = problemsOf(line); !problems.empty())
        return fail(problems[0].where + " " + problems[0].what, problems[0].expected);
    if (timeLineOf(model.groom) == line) return nullptr;
    std::string record = recordOf("time_line", {{"time_line", hairloom::toJson(line)}});
    std::size_t bytes = sizeof(TimeLine) + line.clips.size() * sizeof(ClipStrip) +
                        line.head.size() * sizeof(HeadKey) + line.wind.size() * sizeof(WindKey);
    for (const SettingTrack& track : line.settings) bytes += track.keys.size() * sizeof(SettingKey);
    return valueCommand<Held>(
        std::move(name), Part::TimeLine, [](Model& m) -> Held& { return m.groom.timeLine; },
        line == TimeLine() ? nullptr : std::make_shared<const TimeLine>(std::move(line)), std::move(record),
        bytes);
}

std::unique_ptr<Command> setSettings(const Model& model, const Groom& from, std::string name) {
    std::vector<std::unique_ptr<Command>> steps;
    steps.push_back(setMaterial(model, from.material, name));
    steps.push_back(setShadows(model, from.shadows, name));
    steps.push_back(setPhysics(model, from.simulation, name));
    steps.push_back(setInterpolation(model, from.interpolation, name));
    steps.push_back(setPlacementSettings(model, from.placement, name));
    steps.push_back(setSpheres(model, from.spheres, name));
    // Of another head it would be other skin.
    if (from.scalp == model.groom.scalp) steps.push_back(setBody(model, from.body, name));
    return together(std::move(name), std::move(steps));
}

std::unique_ptr<Command> replaceGroom(const Model& model, Groom groom, std::string name, std::string record) {
    if (sameContent(model.groom, groom)) return nullptr;
    const Part parts = differenceOf(model.groom, groom);
    auto command = std::make_unique<GroomCommand>(std::move(name), parts, std::move(groom));
    command->setRecord(std::move(record));
    return command;
}

std::unique_ptr<Command> triangulate(const Model& model) {
    const Groom& groom = model.groom;
    const auto roots = groom.rootBindings();
    if (!groom.scalp || roots.empty() || !groom.triangulation.triangles.empty()) return nullptr;
    auto made = triangulateRoots(*groom.scalp, groom.scalpSelection, roots);
    if (!made || made->triangles.empty()) return nullptr;
    const std::size_t bytes = made->triangles.size() * sizeof(Triangle);
    return valueCommand<RootTriangulation>(
        "Triangulate roots", Part::Triangulation,
        [](Model& m) -> RootTriangulation& { return m.groom.triangulation; }, std::move(*made),
        recordOf("triangulate", nlohmann::ordered_json::object()), bytes);
}

// --- As operations of a script ---

namespace {

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
    return [spheres = readSphereList(reader)](const Document& document) -> CommandResult {
        return setSpheres(document.model(), spheres, "Spheres");
    };
}

MakeCommand readMaskNamesStep(JsonReader& reader) {
    std::vector<std::string> names;
    readMaskNames(reader.object("names"), names);
    return [names](const Document& document) { return setMaskNames(document.model(), names); };
}

MakeCommand readCards(JsonReader& reader) {
    return [edits = readCardEdits(reader)](const Document& document) {
        return setCardEdits(document.model(), edits, "Cards");
    };
}

MakeCommand readPoseList(JsonReader& reader) {
    return
        [poses = readPoses(reader)](const Document& document) { return setPoses(document.model(), poses); };
}

MakeCommand readTimeLineStep(JsonReader& reader) {
    return [line = readTimeLine(reader)](const Document& document) {
        return setTimeLine(document.model(), line, "Time line");
    };
}

MakeCommand readLayerList(JsonReader& reader) {
    return [layers = readLayers(reader)](const Document& document) -> CommandResult {
        if (layers.size() < document.groom().layers.size())
            return fail(fmt::format("{} layers", layers.size()), "as many as there are, or more");
        return setLayers(document.model(), layers);
    };
}

MakeCommand readTriangulate(JsonReader&) {
    return [](const Document& document) -> CommandResult { return triangulate(document.model()); };
}

constexpr RecordedOperation kSettingsCommandsRecords[] = {
    {"material", readSettingsStep<HairMaterial, setMaterial>},
    {"simulation", readSettingsStep<runtime::SimulationSettings, setPhysics>},
    {"shadows", readSettingsStep<ShadowSettings, setShadows>},
    {"interpolation", readSettingsStep<InterpolationSettings, setInterpolation>},
    {"placement", readSettingsStep<PlacementSettings, setPlacementSettings>},
    {"spheres", readSpheres},
    {"layers", readLayerList},
    {"mask_names", readMaskNamesStep},
    {"card_edits", readCards},
    {"poses", readPoseList},
    {"time_line", readTimeLineStep},
    {"triangulate", readTriangulate},
};

}  // namespace

RecordList settingsCommandsRecords() {
    return kSettingsCommandsRecords;
}

}  // namespace hairloom::editing
