// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/simulation/motion.h"

namespace hairloom::python {

/// hairloom.Frame. It shares its arrays with the views that Python has of them.
struct PyFrame {
    std::uint64_t number = 0;  ///< from 1
    double time = 0;           ///< seconds
    std::shared_ptr<const std::vector<Vec3f>> positions_ws, velocities_ws;
    std::shared_ptr<const HeadPose> pose;  ///< measured from the origin of the world
};

}  // namespace hairloom::python
