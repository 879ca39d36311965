// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/groom/groom.h"
#include "core/simulation/simulation.h"
#include "python/src/busy.h"

namespace hairloom::python {

/// hairloom.Groom. What Python shows of it are views of arrays that copies of a groom share until one writes,
/// so a view never changes under the caller, and keeps its memory alive.
struct PyGroom {
    explicit PyGroom(Groom of) : groom(std::move(of)) {}

    Groom groom;
    std::atomic<bool> inUse = false;
};

inline constexpr const char* kTheGroom = "the groom";

void bindGroom(nb::module_& module);
void bindSimulation(nb::module_& module);
/// Groom.simulate().
void bindSimulate(nb::class_<PyGroom>& groom);
void bindEngine(nb::module_& module);
/// hairloom.LiveSimulation, and Groom.live().
void bindLive(nb::module_& module);
void bindLiveOf(nb::class_<PyGroom>& groom);
/// What a groom has from the scene around it: scalp, body, spheres, names of layers and groups.
void bindScene(nb::class_<PyGroom>& groom);

/// Of rows of centre and radius. Throws hairloom.ArgumentError.
std::vector<CollisionSphere> spheresOf(const char* name, nb::handle values,
                                       std::span<const CollisionSphere> before);
nb::dict statsOf(const SimulationStats& stats);

/// A frame of a simulation, hairloom.Frame.
struct PyFrame;
/// sRGB, rows from the top, as an array (height, width, 4) of uint8.
nb::object render(PyGroom& groom, std::pair<std::uint32_t, std::uint32_t> size, const std::string& camera,
                  const std::filesystem::path& view, std::uint32_t passes, bool transparent,
                  const PyFrame* frame);

}  // namespace hairloom::python
