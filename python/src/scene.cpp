// SPDX-License-Identifier: GPL-3.0-or-later
// What a groom has from the scene around it: a surface, a body to collide with, names of layers and groups.

#include <fmt/format.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>

#include "core/groom/spheres.h"
#include "core/groom/validate.h"
#include "core/simulation/bake_body.h"
#include "python/src/arrays.h"
#include "python/src/groom.h"

namespace hairloom::python {
namespace {

using namespace nb::literals;

/// Polygons as hosts have them: vertices, and corners face after face.
PolygonSoup polygonsOf(nb::handle positions, nb::handle corners, nb::handle offsets) {
    const Input<Vec3f> points("positions", positions);
    const Input<std::uint32_t> vertices("corners", corners);
    const Input<std::uint32_t> starts("offsets", offsets);
    const auto values = starts.values();
    if (values.empty() || values.front() != 0 || values.back() != vertices.held.size ||
        !std::ranges::is_sorted(values))
        raiseArgument(
            "offsets",
            values.empty() ? "is empty" : fmt::format("run from {} to {}", values.front(), values.back()),
            fmt::format("ascending numbers from 0 to the {} corners", vertices.held.size));
    PolygonSoup soup;
    soup.positions = points.copy();
    soup.corners = vertices.copy();
    soup.offsets = starts.copy();
    return soup;
}

nb::object setScalp(PyGroom& groom, nb::handle positions, nb::handle corners, nb::handle offsets,
                    nb::handle uvs) {
    PolygonSoup soup = polygonsOf(positions, corners, offsets);
    if (!uvs.is_none()) {
        const Input<Vec2f> given("uvs", uvs);
        if (given.held.size != soup.corners.size())
            raiseArgument("uvs", fmt::format("has {} rows", given.held.size),
                          fmt::format("{}, one for each corner", soup.corners.size()));
        soup.uvs = given.copy();
    }
    const Use use(groom.inUse, kTheGroom);
    return arrayOf(unwrap(withoutGil([&]() -> Result<std::vector<float>> {
        auto mesh = ScalpMesh::make(soup);
        if (!mesh) return tl::unexpected(mesh.error());
        Groom changed = groom.groom;
        for (std::size_t s = 0; s < changed.strandCount(); ++s) {
            if (changed.strand(s).empty())
                return fail(fmt::format("strand {} has no points", s), "expected at least 2");
        }
        // The file that another scalp came from has no say over this one.
        changed.characterFile.clear();
        changed.characterMetresPerUnit = 0;
        changed.scalpExpression.clear();
        auto distances = bindToScalp(changed, std::make_shared<const ScalpMesh>(std::move(*mesh)), {});
        groom.groom = std::move(changed);
        return distances;
    })));
}

const ScalpMesh* scalpOf(const PyGroom& groom) {
    return groom.groom.scalp.get();
}

nb::object scalpPositions(PyGroom& groom) {
    const Use use(groom.inUse, kTheGroom);
    if (!scalpOf(groom)) return nb::none();
    return viewOf(scalpOf(groom)->positions(), groom.groom.scalp);
}
nb::object scalpTriangles(PyGroom& groom) {
    const Use use(groom.inUse, kTheGroom);
    if (!scalpOf(groom)) return nb::none();
    std::vector<std::uint32_t> corners;
    for (const Triangle& triangle : scalpOf(groom)->triangles())
        corners.insert(corners.end(), triangle.begin(), triangle.end());
    const std::size_t rows = corners.size() / 3;
    return arrayOf(std::move(corners), {rows, 3});
}
nb::object scalpUvs(PyGroom& groom) {
    const Use use(groom.inUse, kTheGroom);
    if (!scalpOf(groom) || scalpOf(groom)->cornerUvs().empty()) return nb::none();
    return viewOf(scalpOf(groom)->cornerUvs(), groom.groom.scalp);
}

nb::dict setBody(PyGroom& groom, nb::handle positions, nb::handle corners, nb::handle offsets,
                 nb::handle bones, nb::handle weights, double cell, double megabytes) {
    const PolygonSoup soup = polygonsOf(positions, corners, offsets);
    if (!(cell >= 0.0005 && cell <= 0.05))
        raiseArgument("cell", fmt::format("is {} m", cell), "0.0005 m to 0.05 m");
    if (!(megabytes >= 0.1 && megabytes <= 64))
        raiseArgument("megabytes", fmt::format("is {}", megabytes), "0.1 to 64");
    if (bones.is_none() != weights.is_none())
        raiseArgument(bones.is_none() ? "bones" : "weights", "is None", "bones and weights, or neither");
    SkinWeights given;
    if (!bones.is_none()) {
        const Input<std::uint32_t> names("bones", bones);
        const Input<Vec4f> shares("weights", weights);
        const std::size_t vertices = soup.positions.size();
        if (names.held.size != 4 * vertices)
            raiseArgument("bones", fmt::format("has {} numbers", names.held.size),
                          fmt::format("{}, four for each vertex", 4 * vertices));
        if (shares.held.size != vertices)
            raiseArgument("weights", fmt::format("has {} rows", shares.held.size),
                          fmt::format("{}, one for each vertex", vertices));
        given.bones.resize(vertices);
        given.weights.resize(vertices);
        for (std::size_t v = 0; v < vertices; ++v) {
            for (std::size_t i = 0; i < 4; ++i) {
                given.bones[v][i] = names.values()[4 * v + i];
                given.weights[v][i] = shares.values()[v][static_cast<Eigen::Index>(i)];
            }
        }
        constexpr std::size_t kMostBones = 65536;
        unwrap(validate(given, kMostBones));
    }
    const Use use(groom.inUse, kTheGroom);
    const BakedBody baked = unwrap(withoutGil([&]() -> Result<BakedBody> {
        const auto mesh = ScalpMesh::make(soup);
        if (!mesh) return tl::unexpected(mesh.error());
        SkinWeights skin;
        std::vector<std::string> names;
        if (given.vertexCount() > 0) {
            std::uint32_t most = 0;
            for (const std::uint32_t source : mesh->sourceVertices()) {
                skin.bones.push_back(given.bones[source]);
                skin.weights.push_back(given.weights[source]);
                most = std::max(most, *std::ranges::max_element(given.bones[source]));
            }
            // A field keeps the bones that move it by name. LiveSimulation finds its matrices by these.
            for (std::uint32_t bone = 0; bone <= most; ++bone) names.push_back(std::to_string(bone));
        }
        BakeBodyOptions options;
        options.finest = static_cast<float>(cell);
        options.mostBytes = static_cast<std::size_t>(megabytes * 1e6);
        return bakeBody(*mesh, skin, names, options);
    }));
    groom.groom.body = baked.field;
    nb::dict report;
    report["cell"] = baked.cell;
    report["worst_gap"] = baked.fit.worstGap;
    report["worst_bulge"] = baked.fit.worstBulge;
    report["notes"] = baked.notes;
    return report;
}

std::vector<std::string> layers(PyGroom& groom) {
    const Use use(groom.inUse, kTheGroom);
    std::vector<std::string> names;
    for (const Layer& layer : groom.groom.layers) names.push_back(layer.name);
    return names;
}

void setLayers(PyGroom& groom, const std::vector<std::string>& names) {
    const Use use(groom.inUse, kTheGroom);
    if (names.empty()) raiseArgument("layers", "is empty", "at least one name");
    Groom changed = groom.groom;
    changed.layers.resize(names.size());
    for (std::size_t i = 0; i < names.size(); ++i) changed.layers[i].name = names[i];
    unwrap(checkStructure(changed));
    groom.groom = std::move(changed);
}

std::vector<std::string> groups(PyGroom& groom) {
    const Use use(groom.inUse, kTheGroom);
    return groom.groom.groupNames;
}

void setGroups(PyGroom& groom, const std::vector<std::string>& names) {
    const Use use(groom.inUse, kTheGroom);
    Groom changed = groom.groom;
    changed.groupNames = names;
    unwrap(checkStructure(changed));
    groom.groom = std::move(changed);
}

nb::object spheres(PyGroom& groom) {
    const Use use(groom.inUse, kTheGroom);
    std::vector<Vec4f> balls;
    for (const CollisionSphere& ball : groom.groom.spheres)
        balls.push_back({ball.centre.x(), ball.centre.y(), ball.centre.z(), ball.radius});
    return arrayOf(std::move(balls));
}

void setSpheres(PyGroom& groom, nb::handle values) {
    const Use use(groom.inUse, kTheGroom);
    groom.groom.spheres = spheresOf("spheres", values, groom.groom.spheres);
}

nb::object capsules(PyGroom& groom) {
    const Use use(groom.inUse, kTheGroom);
    std::vector<std::array<std::uint32_t, 2>> pairs;
    for (const auto& [first, second] : capsulesOf(groom.groom.spheres)) pairs.push_back({first, second});
    return arrayOf(std::move(pairs));
}

void setCapsules(PyGroom& groom, nb::handle values) {
    const Use use(groom.inUse, kTheGroom);
    const Input<std::array<std::uint32_t, 2>> given("capsules", values);
    if (given.values().size() > runtime::kMaxCapsules)
        raiseArgument("capsules", fmt::format("has {} rows", given.values().size()),
                      fmt::format("at most {}", runtime::kMaxCapsules));
    std::vector<CollisionSphere> joined = groom.groom.spheres;
    for (CollisionSphere& ball : joined) ball.joined = -1;
    for (const auto& [first, second] : given.values()) {
        if (std::max(first, second) >= joined.size() || first == second)
            raiseArgument("capsules", fmt::format("joins the spheres {} and {}", first, second),
                          fmt::format("two different ones of the {} spheres", joined.size()));
        // Each sphere is joined to one other; others may be joined to it.
        const bool isTaken = joined[first].joined >= 0;
        CollisionSphere& ball = joined[isTaken ? second : first];
        if (ball.joined >= 0)
            raiseArgument("capsules",
                          fmt::format("joins the spheres {} and {}, each to several", first, second),
                          "pairs in an order in which each has a sphere that is joined to no other yet");
        ball.joined = static_cast<std::int32_t>(isTaken ? first : second);
    }
    groom.groom.spheres = std::move(joined);
}

}  // namespace

std::vector<CollisionSphere> spheresOf(const char* name, nb::handle values,
                                       std::span<const CollisionSphere> before) {
    const Input<Vec4f> given(name, values);
    std::vector<CollisionSphere> balls;
    for (const Vec4f& ball : given.values()) {
        if (!(ball.w() > 0))
            raiseArgument(name, fmt::format("has the radius {}", ball.w()), "radii above 0 m");
        balls.push_back({fmt::format("sphere {}", balls.size() + 1), ball.head<3>(), ball.w(), {}, -1});
    }
    for (std::size_t i = 0; i < balls.size() && i < before.size(); ++i) {
        balls[i].name = before[i].name;
        balls[i].bone = before[i].bone;
        const std::int32_t joined = before[i].joined;
        if (joined >= 0 && static_cast<std::size_t>(joined) < balls.size()) balls[i].joined = joined;
    }
    return balls;
}

void bindScene(nb::class_<PyGroom>& groom) {
    groom
        .def("set_scalp", &setScalp, "positions"_a.none(), "corners"_a.none(), "offsets"_a.none(),
             "uvs"_a.none() = nb::none(),
             nb::sig("def set_scalp(self, positions: object, corners: object, offsets: object, uvs: object | "
                     "None = None) -> numpy.typing.NDArray[numpy.float32]"),
             "Binds every root to the nearest point of a mesh, which becomes the scalp. Points stay where "
             "they are. root_uv is set from the mesh. Returns how far each root is from it, float32 "
             "(strands,), metres.\n\npositions: float32 (vertices, 3), metres, at rest. corners: uint32 "
             "(corners,), the vertex of each corner of each face, counter-clockwise from outside. offsets: "
             "uint32 (faces + 1,), face f owns the corners offsets[f] to offsets[f + 1]. uvs: float32 "
             "(corners, 2).\n\nRaises ArgumentError for other types or shapes, and Error for a mesh without "
             "a usable face. The groom is then unchanged.")
        .def_prop_ro("scalp_positions", &scalpPositions,
                     nb::sig("def scalp_positions(self) -> numpy.typing.NDArray[numpy.float32] | None"),
                     "float32 (vertices, 3), metres, at rest. A read-only view. None without a scalp.")
        .def_prop_ro("scalp_triangles", &scalpTriangles,
                     nb::sig("def scalp_triangles(self) -> numpy.typing.NDArray[numpy.uint32] | None"),
                     "uint32 (triangles, 3), vertices, counter-clockwise from outside. None without a scalp.")
        .def_prop_ro("scalp_uvs", &scalpUvs,
                     nb::sig("def scalp_uvs(self) -> numpy.typing.NDArray[numpy.float32] | None"),
                     "float32 (triangles · 3, 2), of each corner of each triangle. None without.")
        .def("set_body", &setBody, "positions"_a.none(), "corners"_a.none(), "offsets"_a.none(),
             "bones"_a.none() = nb::none(), "weights"_a.none() = nb::none(), "cell"_a = 0.002,
             "megabytes"_a = 4.0,
             nb::sig("def set_body(self, positions: object, corners: object, offsets: object, bones: object "
                     "| None = None, weights: object | None = None, cell: float = 0.002, megabytes: float = "
                     "4.0) -> dict[str, typing.Any]"),
             "Bakes a mesh at rest into the distances that strands collide with. It may be open at the "
             "neck.\n\npositions, corners and offsets as in set_scalp(). bones: uint32 (4 · vertices,), four "
             "of each vertex, from 0. weights: float32 (vertices, 4), ≥ 0, of sum 1 or 0. Without them it "
             "moves as a whole. cell: the finest metres between distances, 0.0005 to 0.05. megabytes: the "
             "most memory, 0.1 to 64.\n\nReturns cell, worst_gap and worst_bulge (m), and notes. Raises "
             "Error for a mesh that encloses no space.")
        .def_prop_rw("layers", &layers, &setLayers,
                     "Names of the layers that the attribute 'layer' of strands counts from 0. A layer that "
                     "stays keeps its settings.")
        .def_prop_rw("groups", &groups, &setGroups,
                     "Names of the groups that the attribute 'group' of strands counts from 0.")
        .def_prop_rw(
            "spheres", &spheres, &setSpheres,
            nb::for_getter(nb::sig("def spheres(self) -> numpy.typing.NDArray[numpy.float32]")),
            nb::for_setter(nb::sig("def spheres(self, values: object) -> None")),
            nb::for_setter("values"_a.none()),
            "float32 (k, 4), centre and radius > 0 of what strands collide with, metres, at rest. A copy.")
        .def_prop_rw(
            "capsules", &capsules, &setCapsules,
            nb::for_getter(nb::sig("def capsules(self) -> numpy.typing.NDArray[numpy.uint32]")),
            nb::for_setter(nb::sig("def capsules(self, values: object) -> None")),
            nb::for_setter("values"_a.none()),
            "uint32 (k, 2), the numbers of two spheres each, whose hull is a tapered capsule. A copy. "
            "Spheres that are set anew keep theirs.");
}

}  // namespace hairloom::python
