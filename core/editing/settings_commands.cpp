// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/editing/settings_commands.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/editing/records.h"
#include "core/groom/file/settings_json.h"
#include "core/groom/groom_hash.h"

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
    return recordOf(op, {{"settings", toJson(settings)}});
}

nlohmann::ordered_json layersToJson(const std::vector<Layer>& layers) {
    auto list = nlohmann::ordered_json::array();
    for (const Layer& layer : layers)
        list.push_back({{"name", layer.name}, {"visible", layer.visible}, {"locked", layer.locked}});
    return list;
}

std::size_t arrayBytes(const Groom& groom) {
    std::size_t sum = groom.offsets.size() * sizeof(std::uint32_t);
    for (const AttributeSet* attributes : {&groom.strandAttributes, &groom.pointAttributes}) {
        for (const auto& [name, data] : attributes->all()) {
            std::visit([&]<class T>(const CowArray<T>& array) { sum += array.size() * sizeof(T); }, data);
        }
    }
    return sum + groom.triangulation.triangles.size() * sizeof(Triangle) +
           groom.scalpSelection.size() * sizeof(std::uint32_t) + groom.scalpDensity.size() * sizeof(float);
}

}  // namespace

std::unique_ptr<Command> setMaterial(const Model& model, const HairMaterial& material) {
    if (toJson(model.groom.material) == toJson(material)) return nullptr;
    return valueCommand<HairMaterial>(
        "Look", Part::Material, [](Model& m) -> HairMaterial& { return m.groom.material; }, material,
        settingsRecord("material", material));
}

std::unique_ptr<Command> setPhysics(const Model& model, const runtime::SimulationSettings& settings) {
    if (toJson(model.groom.simulation) == toJson(settings)) return nullptr;
    return valueCommand<runtime::SimulationSettings>(
        "Physics", Part::Physics, [](Model& m) -> runtime::SimulationSettings& { return m.groom.simulation; },
        settings, settingsRecord("simulation", settings));
}

std::unique_ptr<Command> setInterpolation(const Model& model, const InterpolationSettings& settings) {
    if (toJson(model.groom.interpolation) == toJson(settings)) return nullptr;
    return valueCommand<InterpolationSettings>(
        "Follow hairs", Part::Interpolation,
        [](Model& m) -> InterpolationSettings& { return m.groom.interpolation; }, settings,
        settingsRecord("interpolation", settings));
}

std::unique_ptr<Command> setPlacementSettings(const Model& model, const PlacementSettings& settings) {
    if (toJson(model.groom.placement) == toJson(settings)) return nullptr;
    return valueCommand<PlacementSettings>(
        "Placement settings", Part::Placement,
        [](Model& m) -> PlacementSettings& { return m.groom.placement; }, settings,
        settingsRecord("placement", settings));
}

std::unique_ptr<Command> setSpheres(const Model& model, std::vector<CollisionSphere> spheres,
                                    std::string name) {
    if (toJson(model.groom.spheres) == toJson(spheres)) return nullptr;
    const std::size_t bytes = std::max(spheres.size(), model.groom.spheres.size()) * sizeof(CollisionSphere);
    std::string record = recordOf("spheres", {{"spheres", toJson(spheres)}});
    return valueCommand<std::vector<CollisionSphere>>(
        std::move(name), Part::Spheres,
        [](Model& m) -> std::vector<CollisionSphere>& { return m.groom.spheres; }, std::move(spheres),
        std::move(record), bytes);
}

std::unique_ptr<Command> setLayers(const Model& model, std::vector<Layer> layers) {
    const std::vector<Layer>& now = model.groom.layers;
    assert(layers.size() >= now.size());
    const bool isSame =
        std::equal(now.begin(), now.end(), layers.begin(), layers.end(), [](const Layer& a, const Layer& b) {
            return a.name == b.name && a.visible == b.visible && a.locked == b.locked;
        });
    if (isSame) return nullptr;
    const std::size_t bytes = layers.size() * sizeof(Layer);
    std::string record = recordOf("layers", {{"layers", layersToJson(layers)}});
    return valueCommand<std::vector<Layer>>(
        "Layers", Part::Layers, [](Model& m) -> std::vector<Layer>& { return m.groom.layers; },
        std::move(layers), std::move(record), bytes);
}

std::unique_ptr<Command> replaceGroom(const Model& model, Groom groom, std::string name) {
    if (sameContent(model.groom, groom)) return nullptr;
    const std::size_t bytes = std::max(arrayBytes(groom), arrayBytes(model.groom));
    return valueCommand<Groom>(
        std::move(name), Part::Everything, [](Model& m) -> Groom& { return m.groom; }, std::move(groom),
        std::string(), bytes);
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

}  // namespace hairloom::editing
