// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/simulation/simulation.h"
#include "core/simulation/time_line_motion.h"

#include <fmt/format.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <optional>

#include "core/documents/motions.h"
#include "python/src/arrays.h"
#include "python/src/frame.h"
#include "python/src/groom.h"
#include "python/src/json_values.h"

namespace hairloom::python {
namespace {

using namespace nb::literals;

/// hairloom.Simulation: a groom of its own, its motion, and where the hair is.
struct PySimulation {
    Groom groom;
    std::unique_ptr<HeadMotion> motion;
    HeadPose last;  ///< where the last step ended
    std::optional<KeyedSettings> keyed;
    std::optional<Simulation> simulation;
    std::uint64_t next = 1;
    MotionSpan span;
    std::atomic<bool> inUse = false;
};

constexpr const char* kTheSimulation = "the simulation";

Status setWind(Groom& groom, const std::optional<std::array<float, 3>>& wind) {
    if (!wind) return {};
    const Vec3f velocity((*wind)[0], (*wind)[1], (*wind)[2]);
    const float speed = velocity.norm();
    if (!(speed <= 200)) return fail(fmt::format("wind is {} m/s", speed), "expected at most 200 m/s");
    groom.simulation.windSpeed = speed;
    if (speed > 0) {
        const Vec3f direction = velocity / speed;
        groom.simulation.windDirection = {direction.x(), direction.y(), direction.z()};
    }
    return {};
}

Status begin(PySimulation& run, const std::string& motion, const std::string& character) {
    auto moving = makeMotion(motion, character, run.groom);
    if (!moving) return tl::unexpected(moving.error());
    run.motion = std::move(*moving);
    run.keyed.emplace(*run.motion, run.groom.simulation);
    run.groom.simulation = run.keyed->first();
    run.last = run.motion->poseAt(0);
    auto made = Simulation::make(run.groom, run.last);
    if (!made) return tl::unexpected(made.error());
    run.simulation.emplace(std::move(*made));
    const FramePace& pace = run.span.pace;
    for (std::uint64_t i = 0; i < pace.preRoll * pace.steps(); ++i) run.simulation->step(pace.dt(), run.last);
    return run.simulation->status();
}

std::unique_ptr<PySimulation> simulate(PyGroom& groom, nb::handle motion, std::optional<std::int64_t> frames,
                                       std::optional<double> fps,
                                       const std::optional<std::array<float, 3>>& wind,
                                       std::optional<std::int64_t> preRoll,
                                       const std::filesystem::path& character) {
    if (frames && (*frames < 1 || *frames > 1'000'000))
        raiseArgument("frames", fmt::format("is {}", *frames), "1 to 1000000");
    if (fps && !(*fps >= 1 && *fps <= 1000)) raiseArgument("fps", fmt::format("is {}", *fps), "1 to 1000");
    if (preRoll && (*preRoll < 0 || *preRoll > 100'000))
        raiseArgument("pre_roll", fmt::format("is {}", *preRoll), "0 to 100000");
    auto run = std::make_unique<PySimulation>();
    {
        const Use use(groom.inUse, kTheGroom);
        run->groom = groom.groom;
    }
    unwrap(setWind(run->groom, wind));
    const MotionFile moves(motion);
    const auto asked = [](const auto& number) -> std::optional<std::uint64_t> {
        if (!number) return std::nullopt;
        return static_cast<std::uint64_t>(*number);
    };
    run->span = motionSpanOf(moves.name(), run->groom,
                             fps ? std::optional<float>(static_cast<float>(*fps)) : std::nullopt,
                             asked(frames), asked(preRoll));
    unwrap(withoutGil([&] { return begin(*run, moves.name(), character.string()); }));
    return run;
}

PyFrame nextFrame(PySimulation& run) {
    const Use use(run.inUse, kTheSimulation);
    if (run.next > run.span.frames) throw nb::stop_iteration();
    const FramePace& pace = run.span.pace;
    PyFrame frame{
        run.next, static_cast<double>(run.next) / static_cast<double>(pace.framesPerSecond), {}, {}, {}};
    unwrap(withoutGil([&]() -> Status {
        for (std::uint32_t step = 1; step <= pace.steps(); ++step) {
            const float time = pace.timeOf(static_cast<float>(run.next), step);
            if (auto given = run.keyed->give(*run.simulation, time); !given) return given;
            HeadStep head = stepOf(*run.motion, run.last, time - pace.dt(), time);
            run.simulation->step(pace.dt(), head);
            run.last = std::move(head.end);
        }
        const auto points = run.simulation->positions_ws();
        frame.positions_ws = std::make_shared<const std::vector<Vec3f>>(points.begin(), points.end());
        frame.velocities_ws = std::make_shared<const std::vector<Vec3f>>(run.simulation->velocities_ws());
        frame.pose = std::make_shared<const HeadPose>(inWorld(run.last));
        return run.simulation->status();
    }));
    ++run.next;
    return frame;
}

nb::dict stats(PySimulation& run) {
    const Use use(run.inUse, kTheSimulation);
    return statsOf(withoutGil([&] { return run.simulation->stats(); }));
}

}  // namespace

nb::dict statsOf(const SimulationStats& stats) {
    nb::dict answer;
    answer["frames"] = stats.frames;
    answer["ms_per_frame"] = stats.millisecondsPerFrame;
    answer["max_stretch"] = stats.maxStretch;
    answer["max_penetration_mm"] = stats.maxPenetrationMm;
    answer["nan_count"] = stats.nanCount;
    answer["state_hash"] = fmt::format("{:016x}", stats.stateHash);
    return answer;
}

void bindSimulation(nb::module_& module) {
    nb::class_<PyFrame>(module, "Frame", "The hair at one time of a simulation.")
        .def_prop_ro(
            "number", [](const PyFrame& frame) { return frame.number; }, "From 1.")
        .def_prop_ro(
            "time", [](const PyFrame& frame) { return frame.time; }, "Seconds since the start.")
        .def_prop_ro(
            "positions",
            [](const PyFrame& frame) { return viewOf(std::span(*frame.positions_ws), frame.positions_ws); },
            nb::sig("def positions(self) -> numpy.typing.NDArray[numpy.float32]"),
            "float32 (points, 3), metres, world space, in the order of the groom's points. A read-only view.")
        .def_prop_ro(
            "velocities",
            [](const PyFrame& frame) { return viewOf(std::span(*frame.velocities_ws), frame.velocities_ws); },
            nb::sig("def velocities(self) -> numpy.typing.NDArray[numpy.float32]"),
            "float32 (points, 3), m/s, likewise.");
    nb::class_<PySimulation>(module, "Simulation",
                             "Frames of a moving groom, one after the other. Groom.simulate() makes it. It "
                             "has a copy of the groom.")
        .def(
            "__iter__", [](nb::handle self) { return nb::borrow(self); },
            nb::sig("def __iter__(self) -> Simulation"))
        .def("__next__", &nextFrame, "The next frame. Raises BusyError while another thread asks for one.")
        .def("__len__", [](const PySimulation& run) { return run.span.frames; })
        .def("stats", &stats, nb::sig("def stats(self) -> dict[str, typing.Any]"),
             "frames, ms_per_frame, max_stretch (share of the length), max_penetration_mm, nan_count, and "
             "state_hash, which is "
             "equal for any number of threads.");
}

void bindSimulate(nb::class_<PyGroom>& groom) {
    groom.def(
        "simulate", &simulate, "motion"_a = "none", "frames"_a.none() = nb::none(),
        "fps"_a.none() = nb::none(), "wind"_a.none() = nb::none(), "pre_roll"_a.none() = nb::none(),
        "character"_a = "",
        nb::sig("def simulate(self, motion: str | os.PathLike[str] | collections.abc.Mapping[str, "
                "typing.Any] = 'none', "
                "frames: int | None = None, fps: float | None = "
                "None, wind: tuple[float, float, float] | None = None, pre_roll: int | None = None, "
                "character: str | os.PathLike[str] = '') -> Simulation"),
        "An iterator of frames, simulated as you ask for them, on the CPU with all cores. The groom "
        "itself does not change.\n\n"
        "motion: none, spin, nod, clip:NAME, timeline, a keyframe file F.json, or its content as a dict "
        "(docs/formats/motion.md). frames: "
        "1 to 1000000, by default 60. fps: 1 to 1000, by default 60. wind: m/s, at most 200, in place of "
        "the groom's own. pre_roll: frames before the first, on the first pose, by default none. The "
        "motion timeline has the time line's defaults for these three. character: file with skeleton and "
        "clips, if other than the "
        "scalp's.\n\nRaises ArgumentError for "
        "values out of range, and Error for an unknown motion or a damaged file.");
}

}  // namespace hairloom::python
