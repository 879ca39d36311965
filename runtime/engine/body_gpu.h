// SPDX-License-Identifier: MIT
#pragma once
// A body as kernels read it (shaders/body.hlsli).

#include <cstdint>
#include <span>

#include "engine/body_table.h"
#include "engine/moving_body.h"
#include "hairloom/body_field.h"
#include "hairloom/memory.h"
#include "shaders/body_types.h"

namespace hairloom::runtime {

/// What stays from frame to frame.
struct GpuBody {
    Vector<std::uint32_t> table;       ///< arrays of a BodyTable one behind the other, and boxes of bones
    shaders::BodyConstants constants;  ///< of the table; what a frame has is 0
};
GpuBody gpuBodyOf(const BodyField& field, const BodyTable& table);

/// Rows of the buffer of poses for a body on its way through a frame of so many substeps, and what the
/// constants say of them. Keeps the memory of `rows`.
void putBodyPoses(const MovingBody& body, std::uint32_t substeps, shaders::BodyConstants& constants,
                  Vector<shaders::float4>& rows);

}  // namespace hairloom::runtime
