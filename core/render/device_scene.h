// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Meshes and strands on the device, and what of them has changed.

#include <map>
#include <span>

#include "core/gpu/device.h"
#include "core/render/scene.h"
#include "shaders/shared/render_types.h"

namespace hairloom::render {

/// A part of a group of strands that fits the device's buffers.
struct StrandBatch {
    std::size_t group = 0;  ///< of RenderScene::strands
    std::uint32_t strandCount = 0;
    std::uint32_t segments = 0;  ///< of all strands, as given
    std::size_t firstPoint = 0;  ///< in the group's arrays
    std::size_t pointCount = 0;
    std::vector<std::uint32_t> pointCounts;  ///< of each strand
    gpu::BufferPtr headers, positions, radii;
    gpu::BufferPtr curve, colour;                     ///< hold what `curveSubdivisions` calls for
    std::map<std::uint32_t, gpu::BufferPtr> indices;  ///< of the ribbons, by subdivisions
    std::uint32_t curveSubdivisions = 0;

    std::uint32_t curvePoints(std::uint32_t subdivisions) const {
        return segments * subdivisions + strandCount;
    }
    std::uint32_t indexCount(std::uint32_t subdivisions) const {
        return 2 * curvePoints(subdivisions) + strandCount;
    }
};

/// Strands of one material.
struct StrandGroup {
    HairMaterial material;
    std::size_t strandCount = 0;  ///< also those too short to be drawn
    std::size_t pointCount = 0;
    bool hasRadii = false;
    std::vector<Vec3f> positions_ws;   ///< waiting for their upload
    gpu::BufferPtr devicePositions;    ///< in place of the batches' own: particle * strandCount + strand
    std::uint32_t floatsPerPoint = 3;  ///< of devicePositions: 3 or 4
    Box3f bounds_ws;
};

struct MeshOnDevice {
    std::vector<std::uint32_t> indices;
    std::size_t vertexCount = 0;
    std::vector<Vec3f> positions_ws, normals_ws;  ///< waiting for their upload
    gpu::BufferPtr positions, normals, indexBuffer, albedo;
    Box3f bounds_ws;
};

class DeviceScene {
  public:
    static Result<DeviceScene> upload(gpu::Device& device, const RenderScene& scene);

    Status replaceMesh(std::size_t mesh, std::span<const Vec3f> positions_ws,
                       std::span<const Vec3f> normals_ws);
    Status replaceStrands(std::size_t group, std::span<const Vec3f> positions_ws);
    Status replaceStrands(std::size_t group, gpu::BufferPtr positions_ws, std::uint32_t floatsPerPoint,
                          const Box3f& bounds_ws);

    /// Makes room for curves of that fineness; nothing happens when there is.
    Status prepareCurves(gpu::Device& device, std::uint32_t subdivisions);
    /// Records the uploads that wait.
    void recordUploads(gpu::CommandList& list);

    Box3f meshBounds() const;
    Box3f hairBounds() const;
    std::uint64_t triangles() const;
    std::uint64_t strands() const;

    std::vector<MeshOnDevice> meshes;
    std::vector<StrandGroup> groups;
    std::vector<StrandBatch> batches;
};

}  // namespace hairloom::render
