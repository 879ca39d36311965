// SPDX-License-Identifier: GPL-3.0-or-later
#include "hairloom/engine.h"

#include <fmt/format.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>

#include <array>
#include <optional>

#include "core/base/parallel.h"
#include "core/groom/file/json_reader.h"
#include "core/groom/file/settings_json.h"
#include "python/src/arrays.h"
#include "python/src/groom.h"
#include "python/src/json_values.h"

namespace hairloom::python {
namespace {

using namespace nb::literals;
using runtime::Engine;
using runtime::Float3;
using runtime::Quat;
using runtime::RootFrame;
using runtime::Sphere;

static_assert(sizeof(Vec3f) == sizeof(Float3) && sizeof(Vec4f) == sizeof(Quat) &&
              sizeof(Vec4f) == sizeof(Sphere));

/// hairloom.Engine.
struct PyEngine {
    explicit PyEngine(Engine of) : engine(std::move(of)) {}

    Engine engine;
    double time = 0;
    std::atomic<bool> inUse = false;
};

constexpr const char* kTheEngine = "the engine";

Float3 asEngine(const Vec3f& v) {
    return {v.x(), v.y(), v.z()};
}

runtime::SimulationSettings settingsOf(nb::handle given, runtime::SimulationSettings settings) {
    if (given.is_none()) return settings;
    const auto json = unwrap(parseJson("settings", jsonOf(given)));
    JsonReader reader(json, "settings");
    readSettings(reader, settings);
    unwrap(reader.status());
    return settings;
}

std::unique_ptr<PyEngine> makeEngine(nb::handle positions, nb::handle offsets, nb::handle settings,
                                     nb::handle masses, nb::handle stiffness) {
    const Input<Vec3f> points("positions", positions);
    const Input<std::uint32_t> starts("offsets", offsets);
    std::optional<Input<float>> weights, factors;
    if (!masses.is_none()) weights.emplace("masses", masses);
    if (!stiffness.is_none()) factors.emplace("stiffness", stiffness);
    std::vector<Float3> rest;
    for (const Vec3f& point : points.values()) rest.push_back(asEngine(point));
    runtime::StrandsView strands{starts.values(), rest, {}, {}};
    if (weights) strands.masses = weights->values();
    if (factors) strands.stiffness = factors->values();
    const auto authored = settingsOf(settings, {});
    runtime::Host host;
    host.parallelFor = parallelFor;
    auto made = withoutGil([&] { return Engine::make(strands, authored, host); });
    if (!made.engine) raise({{}, {}, made.error, {}});
    return std::make_unique<PyEngine>(std::move(*made.engine));
}

/// Where roots are, with their rotations, or without any.
std::vector<RootFrame> rootsOf(const PyEngine& self, nb::handle positions, nb::handle rotations) {
    const std::size_t count = self.engine.strandCount();
    const Input<Vec3f> at("root_positions", positions);
    std::optional<Input<Vec4f>> turned;
    if (!rotations.is_none()) turned.emplace("root_rotations", rotations);
    const auto checkRows = [&](const char* name, std::size_t rows) {
        if (rows != count)
            raiseArgument(name, fmt::format("has {} rows", rows),
                          fmt::format("{}, one for each strand", count));
    };
    checkRows("root_positions", at.held.size);
    if (turned) checkRows("root_rotations", turned->held.size);
    std::vector<RootFrame> roots(count);
    for (std::size_t s = 0; s < count; ++s) {
        roots[s].position = asEngine(at.values()[s]);
        if (!turned) continue;
        const Vec4f& q = turned->values()[s];
        roots[s].rotation = {q.x(), q.y(), q.z(), q.w()};
    }
    return roots;
}

void reset(PyEngine& self, nb::handle positions, nb::handle rotations) {
    const Use use(self.inUse, kTheEngine);
    const auto roots = rootsOf(self, positions, rotations);
    withoutGil([&] { return self.engine.reset(roots); });
    self.time = 0;
}

/// Pairs of the spheres that a frame has.
std::vector<runtime::Capsule> joinedBy(nb::handle capsules, std::size_t spheres) {
    std::vector<runtime::Capsule> joined;
    if (capsules.is_none()) return joined;
    const Input<std::array<std::uint32_t, 2>> given("capsules", capsules);
    if (given.values().size() > runtime::kMaxCapsules)
        raiseArgument("capsules", fmt::format("has {} rows", given.values().size()),
                      fmt::format("at most {}", runtime::kMaxCapsules));
    for (const auto& [first, second] : given.values()) {
        if (first >= spheres || second >= spheres || first == second)
            raiseArgument("capsules", fmt::format("joins the spheres {} and {}", first, second),
                          fmt::format("two different ones of the {} spheres", spheres));
        joined.push_back({first, second});
    }
    return joined;
}

std::vector<Sphere> spheresOf(nb::handle spheres) {
    std::vector<Sphere> balls;
    if (spheres.is_none()) return balls;
    const Input<Vec4f> given("spheres", spheres);
    for (const Vec4f& ball : given.values()) {
        if (!(ball.w() > 0))
            raiseArgument("spheres", fmt::format("has the radius {}", ball.w()), "radii above 0 m");
        balls.push_back({{ball.x(), ball.y(), ball.z()}, ball.w()});
    }
    return balls;
}

/// What a pose within a frame has.
struct Within {
    std::vector<RootFrame> roots;
    std::vector<Sphere> spheres;
};

std::vector<Within> posesWithin(const PyEngine& self, nb::handle inner, std::size_t spheres) {
    std::vector<Within> poses;
    if (inner.is_none()) return poses;
    constexpr const char* kExpected = "a list of (root_positions, root_rotations, spheres)";
    if (!nb::isinstance<nb::sequence>(inner)) raiseArgument("inner", "is no list", kExpected);
    for (const nb::handle given : nb::cast<nb::sequence>(inner)) {
        if (!nb::isinstance<nb::tuple>(given) || nb::len(given) != 3)
            raiseArgument("inner", "has a pose that is no tuple of three", kExpected);
        const auto pose = nb::cast<nb::tuple>(given);
        poses.push_back({rootsOf(self, pose[0], pose[1]), spheresOf(pose[2])});
        if (poses.back().spheres.size() != spheres)
            raiseArgument("inner", fmt::format("has a pose of {} spheres", poses.back().spheres.size()),
                          fmt::format("{}, as many as the frame", spheres));
    }
    if (poses.size() > runtime::kMaxInnerPoses)
        raiseArgument("inner", fmt::format("has {} poses", poses.size()),
                      fmt::format("at most {}", runtime::kMaxInnerPoses));
    return poses;
}

void step(PyEngine& self, double dt, nb::handle positions, nb::handle rotations, nb::handle spheres,
          const std::optional<std::array<float, 3>>& wind, nb::handle capsules, nb::handle inner, bool cut) {
    const Use use(self.inUse, kTheEngine);
    if (!(dt > 0 && dt <= 1)) raiseArgument("dt", fmt::format("is {}", dt), "above 0 s, at most 1 s");
    const auto roots = rootsOf(self, positions, rotations);
    const std::vector<Sphere> balls = spheresOf(spheres);
    const std::vector<Within> within = posesWithin(self, inner, balls.size());
    std::vector<runtime::InnerPose> poses;
    for (const Within& pose : within) poses.push_back({pose.roots, pose.spheres});
    const std::vector<runtime::Capsule> joined = joinedBy(capsules, balls.size());
    runtime::FrameInput input;
    input.dt = static_cast<float>(dt);
    input.time = self.time + dt;
    input.roots_ws = roots;
    input.spheres = balls;
    input.capsules = joined;
    input.inner = poses;
    input.cut = cut;
    if (wind) {
        const Float3 velocity{(*wind)[0], (*wind)[1], (*wind)[2]};
        if (!(runtime::length(velocity) <= 1000))
            raiseArgument("wind", fmt::format("is {} m/s", runtime::length(velocity)), "at most 1000 m/s");
        input.wind_ws = velocity;
    }
    withoutGil([&] { return self.engine.step(input); });
    self.time += dt;
}

/// Into `out`, or into an array of its own.
template <class Read>
nb::object readInto(PyEngine& self, nb::handle out, const Read& read) {
    const Use use(self.inUse, kTheEngine);
    const std::size_t count = self.engine.pointCount();
    if (out.is_none()) {
        std::vector<Vec3f> values(count);
        const std::span into(reinterpret_cast<Float3*>(values.data()), count);
        withoutGil([&] { return read(self.engine, into); });
        return arrayOf(std::move(values));
    }
    const std::string expected = fmt::format("a writable contiguous float32 array of shape ({}, 3)", count);
    nb::ndarray<float, nb::ndim<2>, nb::c_contig, nb::device::cpu> array;
    // Not converted: a copy would be filled and lost.
    if (!nb::ndarray_check(out) || !nb::try_cast(out, array, false))
        raiseArgument("out", "has another type or shape, is not contiguous, or cannot be written", expected);
    if (array.shape(0) != count || array.shape(1) != 3)
        raiseArgument("out", fmt::format("has the shape ({}, {})", array.shape(0), array.shape(1)), expected);
    const std::span into(reinterpret_cast<Float3*>(array.data()), count);
    withoutGil([&] { return read(self.engine, into); });
    return nb::borrow(out);
}

nb::object enginePositions(PyEngine& self, nb::handle out) {
    return readInto(self, out,
                    [](const Engine& engine, std::span<Float3> into) { return engine.readPositions(into); });
}
nb::object engineVelocities(PyEngine& self, nb::handle out) {
    return readInto(self, out,
                    [](const Engine& engine, std::span<Float3> into) { return engine.readVelocities(into); });
}

nb::dict measure(PyEngine& self) {
    const Use use(self.inUse, kTheEngine);
    const runtime::Measurements measured = withoutGil([&] { return self.engine.measure(); });
    nb::dict answer;
    answer["nan_count"] = measured.nanCount;
    answer["max_stretch"] = measured.maxStretch;
    answer["max_penetration"] = measured.maxPenetration;
    answer["kinetic_energy"] = measured.kineticEnergy;
    answer["potential_energy"] = measured.potentialEnergy;
    answer["fastest"] = measured.fastest;
    answer["asleep"] = measured.asleep;
    return answer;
}

}  // namespace

void bindEngine(nb::module_& module) {
    nb::class_<PyEngine>(
        module, "Engine",
        "The strand engine alone: rods (or springs) in arrays, out of arrays. It needs no groom. Each engine "
        "may run on "
        "a thread of its own, since calls release the GIL. One thread uses an engine at a time: another gets "
        "BusyError.")
        .def(nb::new_(&makeEngine), "positions"_a.none(), "offsets"_a.none(),
             "settings"_a.none() = nb::none(), "masses"_a.none() = nb::none(),
             "stiffness"_a.none() = nb::none(),
             "Strands at rest.\n\npositions: float32 (n, 3), metres, root first. offsets: uint32 (strands + "
             "1,), strand s owns the "
             "points offsets[s] to offsets[s + 1], 2 to 512 of them. settings: fields of 'simulation' in "
             "docs/reference.md. masses: "
             "float32 (n,) above 0, only ratios within a strand count. stiffness: float32 (strands,), 0 to "
             "1000, times the bending and torsional stiffness of the settings.\n\nRaises ArgumentError for "
             "other "
             "types or shapes, and Error for "
             "a setting out of range or a strand that is too short or too long.")
        .def("reset", &reset, "root_positions"_a.none(), "root_rotations"_a.none() = nb::none(),
             nb::sig("def reset(self, root_positions: object, root_rotations: object | None = None) -> None"),
             "Places all strands in their rest shape on these roots, without speed.\n\nroot_positions: "
             "float32 (strands, 3), metres, "
             "world space. root_rotations: float32 (strands, 4), quaternions x, y, z, w. None leaves the "
             "strands as authored.")
        .def(
            "step", &step, "dt"_a, "root_positions"_a.none(), "root_rotations"_a.none() = nb::none(),
            "spheres"_a.none() = nb::none(), "wind"_a.none() = nb::none(), "capsules"_a.none() = nb::none(),
            "inner"_a.none() = nb::none(), "cut"_a = false,
            nb::sig("def step(self, dt: float, root_positions: object, root_rotations: object | None = "
                    "None, spheres: object | "
                    "None = None, wind: tuple[float, float, float] | None = None, capsules: object | None = "
                    "None, inner: list[tuple[object, object | None, object | None]] | None = None, cut: bool "
                    "= False) -> None"),
            "Advances by dt seconds, above 0 and at most 1, to the roots at the end of the frame. Releases "
            "the GIL.\n\n"
            "root_positions and root_rotations as in reset(). spheres: float32 (k, 4), centre and radius > "
            "0, metres, world space. "
            "Sphere i is sphere i of the frame before. wind: m/s, at most 1000, in place of the settings' "
            "own. capsules: uint32 (k, 2), at most 256, the numbers of two of the spheres each, whose hull "
            "is a tapered capsule. inner: at most 15 poses on the way there, at equal shares of dt, each a "
            "tuple (root_positions, root_rotations, spheres), so that three are those at the quarters of the "
            "frame. cut: the frame does not continue from the one before, and hair jumps along with its "
            "roots.\n\n"
            "Raises ArgumentError for other types or shapes, and BusyError while another thread uses this "
            "engine.")
        .def("positions", &enginePositions, "out"_a.none() = nb::none(),
             nb::sig("def positions(self, out: numpy.typing.NDArray[numpy.float32] | None = None) -> "
                     "numpy.typing.NDArray[numpy.float32]"),
             "float32 (points, 3), metres, world space, strand after strand, root to tip. Fills `out` where "
             "it is given, a writable "
             "contiguous float32 array of that shape, and returns it.")
        .def("velocities", &engineVelocities, "out"_a.none() = nb::none(),
             nb::sig("def velocities(self, out: numpy.typing.NDArray[numpy.float32] | None = None) -> "
                     "numpy.typing.NDArray[numpy.float32]"),
             "float32 (points, 3), m/s over the last substep, likewise.")
        .def("measure", &measure, nb::sig("def measure(self) -> dict[str, float]"),
             "nan_count, max_stretch (share of the length), max_penetration (m), kinetic_energy and "
             "potential_energy (J), fastest "
             "(m/s) and asleep (strands). Costs about one substep.")
        .def(
            "set_settings",
            [](PyEngine& self, nb::handle settings) {
                const Use use(self.inUse, kTheEngine);
                const std::string problem =
                    self.engine.setSettings(settingsOf(settings, self.engine.settings()));
                if (!problem.empty()) raise({{}, {}, problem, {}});
            },
            "settings"_a,
            nb::sig("def set_settings(self, settings: collections.abc.Mapping[str, typing.Any]) -> None"),
            "Changes settings from the next step on. What you leave out keeps its value.\n\nRaises Error for "
            "an unknown name or a "
            "value out of range.")
        .def_prop_ro(
            "strand_count", [](PyEngine& self) { return self.engine.strandCount(); }, "Number of strands.")
        .def_prop_ro(
            "point_count", [](PyEngine& self) { return self.engine.pointCount(); }, "Number of points.")
        .def_prop_ro(
            "time", [](PyEngine& self) { return self.time; }, "Seconds since reset().")
        .def_prop_ro(
            "state_hash",
            [](PyEngine& self) {
                const Use use(self.inUse, kTheEngine);
                return fmt::format("{:016x}", self.engine.stateHash());
            },
            "Of all positions and speeds. Equal for any number of threads.");
}

}  // namespace hairloom::python
