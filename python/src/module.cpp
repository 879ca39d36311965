// SPDX-License-Identifier: GPL-3.0-or-later
// hairloom._core: what hairloom (python/hairloom) is made of. Not for use by itself.

#include <nanobind/nanobind.h>

#include "python/src/groom.h"

NB_MODULE(_core, module) {
    module.doc() = "Grooms, simulations and engines of Hairloom.";
    hairloom::python::bindSimulation(module);
    hairloom::python::bindLive(module);
    hairloom::python::bindGroom(module);
    hairloom::python::bindEngine(module);
}
