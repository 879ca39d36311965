// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Meshes of a DeviceScene: from a RenderScene to buffers.

#include "core/render/device_scene.h"

namespace hairloom::render {

inline shaders::float4 toFloat4(const Vec3f& v, float w) {
    return {v.x(), v.y(), v.z(), w};
}

/// Errors: a point that is not finite, called "`what` N".
Result<Box3f> finiteBounds(std::span<const Vec3f> positions, const char* what);

/// Errors: those of the device.
Result<MeshOnDevice> uploadMesh(gpu::Device& device, const RenderMesh& mesh);

}  // namespace hairloom::render
