// SPDX-License-Identifier: GPL-3.0-or-later
// A simulation whose motion comes from a host, frame by frame.

#include <fmt/format.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>

#include <array>
#include <charconv>
#include <optional>

#include "core/base/file.h"
#include "core/groom/file/json_reader.h"
#include "core/groom/file/settings_json.h"
#include "core/simulation/simulation.h"
#include "hairloom/body_field.h"
#include "python/src/arrays.h"
#include "python/src/groom.h"
#include "python/src/json_values.h"

namespace hairloom::python {
namespace {

using namespace nb::literals;

/// hairloom.LiveSimulation.
struct PyLive {
    Groom groom;
    std::optional<Simulation> simulation;
    std::optional<std::vector<CollisionSphere>> spheres_ws;  ///< that were given last
    std::vector<std::size_t> bones;  ///< of the body, which matrix moves each; empty: the first moves all
    double time = 0;
    std::atomic<bool> inUse = false;
};

constexpr const char* kTheLive = "the simulation";

/// What a host says of one time, as step() takes it.
struct LiveScene {
    nb::handle scalp, head, spheres, bones;
};

Eigen::Affine3f matrixOf(std::span<const Vec4f> rows) {
    Eigen::Affine3f matrix;
    for (Eigen::Index row = 0; row < 3; ++row)
        matrix.matrix().row(row) = rows[static_cast<std::size_t>(row)].transpose();
    matrix.makeAffine();
    return matrix;
}

HeadPose poseOf(PyLive& live, const LiveScene& scene) {
    HeadPose pose;
    if (!scene.head.is_none()) {
        const Input<Vec4f> rows("head", scene.head);
        if (rows.held.size != 4)
            raiseArgument("head", fmt::format("has {} rows", rows.held.size), "a matrix of shape (4, 4)");
        const Eigen::Affine3f matrix = matrixOf(rows.values());
        const Mat3f linear = matrix.linear();
        if (!(linear.transpose() * linear).isIdentity(1e-3f) || linear.determinant() < 0)
            raiseArgument("head", "is no rigid motion", "a rotation and a translation");
        pose.head_ws.matrix() = matrix.matrix();
    }
    if (!scene.scalp.is_none()) {
        if (!live.groom.scalp)
            raiseArgument("scalp", "is given", "None, since the groom has no scalp (set_scalp)");
        const Input<Vec3f> vertices("scalp", scene.scalp);
        const auto sources = live.groom.scalp->sourceVertices();
        std::size_t needed = 0;
        for (const std::uint32_t source : sources) needed = std::max<std::size_t>(needed, source + 1);
        if (vertices.held.size < needed)
            raiseArgument("scalp", fmt::format("has {} rows", vertices.held.size),
                          fmt::format("at least {}, the vertices that the scalp was made from", needed));
        pose.scalpPositions_ws.reserve(sources.size());
        for (const std::uint32_t source : sources)
            pose.scalpPositions_ws.push_back(vertices.values()[source]);
    }
    if (!scene.bones.is_none()) {
        if (!live.groom.body)
            raiseArgument("bones", "is given", "None, since the groom has no body (set_body)");
        const Input<Vec4f> rows("bones", scene.bones);
        std::size_t needed = 1;
        for (const std::size_t bone : live.bones) needed = std::max(needed, bone + 1);
        if (rows.held.size % 4 != 0 || rows.held.size < 4 * needed)
            raiseArgument("bones", fmt::format("has {} rows", rows.held.size),
                          fmt::format("4 for each of at least {} bones", needed));
        if (live.bones.empty()) pose.body_ws.push_back(matrixOf(rows.values().subspan(0, 4)));
        for (const std::size_t bone : live.bones)
            pose.body_ws.push_back(matrixOf(rows.values().subspan(4 * bone, 4)));
    }
    if (!scene.spheres.is_none()) {
        live.spheres_ws = spheresOf("spheres", scene.spheres, live.spheres_ws.value_or(live.groom.spheres));
        for (const CollisionSphere& ball : *live.spheres_ws) pose.sphereCentres_ws.push_back(ball.centre);
        if (live.simulation) live.simulation->setSpheres(*live.spheres_ws, false);
    }
    return pose;
}

void resetLive(PyLive& live, nb::handle scalp, nb::handle head, nb::handle spheres, nb::handle bones) {
    const Use use(live.inUse, kTheLive);
    const HeadPose pose = poseOf(live, {scalp, head, spheres, bones});
    auto made = withoutGil([&] { return Simulation::make(live.groom, pose); });
    live.simulation.emplace(unwrap(std::move(made)));
    if (live.spheres_ws) live.simulation->setSpheres(*live.spheres_ws, false);
    live.time = 0;
}

std::unique_ptr<PyLive> makeLive(PyGroom& groom, nb::handle scalp, nb::handle head, nb::handle spheres,
                                 nb::handle bones) {
    auto live = std::make_unique<PyLive>();
    {
        const Use use(groom.inUse, kTheGroom);
        live->groom = groom.groom;
    }
    if (live->groom.body) {
        for (const runtime::String& name : live->groom.body->bones) {
            std::size_t number = live->bones.size();  // of a body that has names of its own
            std::size_t parsed = 0;
            const char* const end = name.data() + name.size();
            const auto read = std::from_chars(name.data(), end, parsed);
            if (read.ec == std::errc() && read.ptr == end) number = parsed;
            live->bones.push_back(number);
        }
    }
    resetLive(*live, scalp, head, spheres, bones);
    return live;
}

void stepLive(PyLive& live, double dt, nb::handle scalp, nb::handle head, nb::handle spheres,
              nb::handle bones, const std::optional<std::array<float, 3>>& wind) {
    const Use use(live.inUse, kTheLive);
    if (!(dt > 0 && dt <= 0.1)) raiseArgument("dt", fmt::format("is {}", dt), "above 0 s, at most 0.1 s");
    const auto given = wind.value_or(std::array<float, 3>{});
    const Vec3f velocity(given[0], given[1], given[2]);
    // Before the scene, whose spheres the simulation keeps.
    if (!(velocity.norm() <= 200))
        raiseArgument("wind", fmt::format("is {} m/s", velocity.norm()), "at most 200 m/s");
    HeadPose pose = poseOf(live, {scalp, head, spheres, bones});
    if (wind) pose.wind_ws = velocity;
    unwrap(withoutGil([&] {
        live.simulation->step(static_cast<float>(dt), pose);
        return live.simulation->status();
    }));
    live.time += dt;
}

nb::object livePositions(PyLive& live) {
    const Use use(live.inUse, kTheLive);
    const auto points = live.simulation->positions_ws();
    return arrayOf(std::vector<Vec3f>(points.begin(), points.end()));
}

void setLiveSettings(PyLive& live, nb::handle given) {
    const Use use(live.inUse, kTheLive);
    const auto json = unwrap(parseJson("settings", jsonOf(given)));
    JsonReader reader(json, "settings");
    auto settings = live.groom.simulation;
    readSettings(reader, settings);
    unwrap(reader.status());
    unwrap(live.simulation->setSettings(settings));
    live.groom.simulation = settings;
}

nb::dict liveStats(PyLive& live) {
    const Use use(live.inUse, kTheLive);
    return statsOf(live.simulation->stats());
}

}  // namespace

void bindLive(nb::module_& module) {
    nb::class_<PyLive>(module, "LiveSimulation",
                       "Hair that follows a scene of yours, frame by frame. Groom.live() makes it. It has a "
                       "copy of the groom.")
        .def("step", &stepLive, "dt"_a, "scalp"_a.none() = nb::none(), "head"_a.none() = nb::none(),
             "spheres"_a.none() = nb::none(), "bones"_a.none() = nb::none(), "wind"_a.none() = nb::none(),
             nb::sig("def step(self, dt: float, scalp: object | None = None, head: object | None = None, "
                     "spheres: object | None = None, bones: object | None = None, wind: tuple[float, float, "
                     "float] | None = None) -> None"),
             "Advances by dt seconds, above 0 and at most 0.1, to the scene at the end of the frame. "
             "Releases the GIL.\n\nscalp: float32 (vertices, 3), metres, world space, the vertices that "
             "set_scalp() was given, where they are now. head: float32 (4, 4), the rigid motion of strands "
             "and spheres without a scalp. spheres: float32 (k, 4), centre and radius > 0, world space, in "
             "place of the groom's. Sphere i is sphere i of the frame before. bones: float32 (4 · count, 4), "
             "the rows of a matrix for each bone of set_body(), from rest to the world. wind: m/s, at most "
             "200, in place of the settings'.\n\nRaises ArgumentError for other types or shapes.")
        .def("reset", &resetLive, "scalp"_a.none() = nb::none(), "head"_a.none() = nb::none(),
             "spheres"_a.none() = nb::none(), "bones"_a.none() = nb::none(),
             nb::sig("def reset(self, scalp: object | None = None, head: object | None = None, spheres: "
                     "object | None = None, bones: object | None = None) -> None"),
             "Places all strands in their rest shape on this scene, without speed.")
        .def("positions", &livePositions,
             nb::sig("def positions(self) -> numpy.typing.NDArray[numpy.float32]"),
             "float32 (points, 3), metres, world space, in the order of the groom's points. A copy.")
        .def("set_settings", &setLiveSettings, "settings"_a,
             nb::sig("def set_settings(self, settings: collections.abc.Mapping[str, typing.Any]) -> None"),
             "Changes settings of 'simulation' from the next step on. What you leave out keeps its "
             "value.\n\nRaises Error for an unknown name or a value out of range.")
        .def_prop_ro(
            "time", [](const PyLive& live) { return live.time; }, "Seconds since the last reset().")
        .def("stats", &liveStats, nb::sig("def stats(self) -> dict[str, typing.Any]"),
             "As of Simulation.stats().");
}

void bindLiveOf(nb::class_<PyGroom>& groom) {
    groom.def("live", &makeLive, "scalp"_a.none() = nb::none(), "head"_a.none() = nb::none(),
              "spheres"_a.none() = nb::none(), "bones"_a.none() = nb::none(),
              nb::sig("def live(self, scalp: object | None = None, head: object | None = None, spheres: "
                      "object | None = None, bones: object | None = None) -> LiveSimulation"),
              "A simulation that you move yourself, at rest on the scene that LiveSimulation.step() "
              "describes.\n\nRaises Error for a groom without strands or with errors (validate()).");
}

}  // namespace hairloom::python
