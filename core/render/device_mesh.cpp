// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/device_mesh.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/parallel.h"
#include "core/render/device_buffers.h"

namespace hairloom::render {
namespace {

std::vector<Vec3f> averagedNormals(std::span<const Vec3f> positions, std::span<const std::uint32_t> indices) {
    std::vector<Vec3f> normals(positions.size(), Vec3f::Zero());
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const Vec3f& a = positions[indices[i]];
        const Vec3f cross = (positions[indices[i + 1]] - a).cross(positions[indices[i + 2]] - a);
        for (std::size_t k = 0; k < 3; ++k) normals[indices[i + k]] += cross;
    }
    for (Vec3f& n : normals) {
        const float length = n.norm();
        n = length > 0 ? Vec3f(n / length) : Vec3f::UnitY();
    }
    return normals;
}

/// By area.
Vec3f meanAlbedoOf(const MeshOnDevice& mesh, std::span<const Vec3f> albedo) {
    Vec3f sum = Vec3f::Zero();
    for (std::size_t v = 0; v < albedo.size(); ++v) sum += mesh.areas[v] * albedo[v];
    return mesh.area > 0 ? Vec3f(sum / mesh.area) : sum;
}

}  // namespace

Result<Box3f> finiteBounds(std::span<const Vec3f> positions, const char* what) {
    constexpr std::size_t kPiece = 16384;
    std::vector<Box3f> boxes((positions.size() + kPiece - 1) / kPiece);
    parallelFor(positions.size(), kPiece, [&](std::size_t begin, std::size_t end) {
        Box3f box;
        bool finite = true;
        for (std::size_t i = begin; i < end; ++i) {
            box.extend(positions[i]);
            finite = finite && positions[i].allFinite();
        }
        // An empty box of a piece that has points stands for a number that is not finite.
        if (finite) boxes[begin / kPiece] = box;
    });
    Box3f all;
    for (std::size_t piece = 0; piece < boxes.size(); ++piece) {
        if (boxes[piece].isEmpty()) {
            std::size_t bad = piece * kPiece;
            while (positions[bad].allFinite()) ++bad;
            return fail(fmt::format("{} {} is not finite", what, bad));
        }
        all.extend(boxes[piece]);
    }
    return all;
}

Result<MeshOnDevice> uploadMesh(gpu::Device& device, const RenderMesh& mesh) {
    MeshOnDevice result;
    result.indices.assign(mesh.indices.begin(), mesh.indices.end());
    result.vertexCount = mesh.positions_ws.size();
    result.matte = mesh.matte;
    result.bounds_ws = boundsOf(mesh.positions_ws, mesh.indices);
    std::vector<bool> isDrawn(result.vertexCount);
    for (const std::uint32_t index : mesh.indices) isDrawn[index] = true;
    result.hasLooseVertices = std::ranges::find(isDrawn, false) != isDrawn.end();
    std::vector<Vec3f> computed;
    if (mesh.normals_ws.empty()) computed = averagedNormals(mesh.positions_ws, mesh.indices);
    const std::span<const Vec3f> normals = mesh.normals_ws.empty() ? computed : mesh.normals_ws;
    std::vector<Vec3f> albedo(mesh.vertexAlbedo.begin(), mesh.vertexAlbedo.end());
    if (albedo.empty()) albedo.assign(result.vertexCount, mesh.albedo);
    result.areas.assign(result.vertexCount, 0.0f);
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        const std::uint32_t* const corner = &mesh.indices[3 * t];
        const Vec3f& a = mesh.positions_ws[corner[0]];
        const float area =
            0.5f * (mesh.positions_ws[corner[1]] - a).cross(mesh.positions_ws[corner[2]] - a).norm();
        result.area += area;
        for (int c = 0; c < 3; ++c) result.areas[corner[c]] += area / 3;
    }
    result.meanAlbedo = meanAlbedoOf(result, albedo);
    Gather gather;
    gather(result.positions, structured(device, "mesh positions", 4, std::as_bytes(mesh.positions_ws)));
    gather(result.normals, structured(device, "mesh normals", 4, std::as_bytes(normals)));
    gather(result.albedo,
           structured(device, "mesh colours", 4, std::as_bytes(std::span<const Vec3f>(albedo))));
    gather(result.indexBuffer, structured(device, "mesh indices", 4, std::as_bytes(mesh.indices)));
    if (!gather.status()) return tl::unexpected(gather.status().error());
    return result;
}

Status DeviceScene::replaceMeshAlbedo(gpu::Device& device, std::size_t mesh, std::span<const Vec3f> albedo) {
    if (mesh >= meshes.size()) return fail(fmt::format("mesh {} of {}", mesh, meshes.size()));
    MeshOnDevice& m = meshes[mesh];
    if (m.indices.empty()) return {};
    if (albedo.size() != m.vertexCount)
        return fail(fmt::format("{} colours for a mesh", albedo.size()),
                    fmt::format("{}, as it has vertices", m.vertexCount));
    auto made = structured(device, "mesh colours", 4, std::as_bytes(albedo));
    if (!made) return tl::unexpected(made.error());
    m.albedo = std::move(*made);
    m.meanAlbedo = meanAlbedoOf(m, albedo);
    return {};
}

Status DeviceScene::replaceMesh(std::size_t mesh, std::span<const Vec3f> positions_ws,
                                std::span<const Vec3f> normals_ws) {
    if (mesh >= meshes.size()) return fail(fmt::format("mesh {} of {}", mesh, meshes.size()));
    MeshOnDevice& m = meshes[mesh];
    if (m.indices.empty()) return {};
    if (positions_ws.size() != m.vertexCount || (!normals_ws.empty() && normals_ws.size() != m.vertexCount)) {
        return fail(
            fmt::format("{} positions and {} normals for a mesh", positions_ws.size(), normals_ws.size()),
            fmt::format("{}, as it has vertices", m.vertexCount));
    }
    const auto bounds = finiteBounds(positions_ws, "mesh vertex");
    if (!bounds) return tl::unexpected(bounds.error());
    m.bounds_ws = m.hasLooseVertices ? boundsOf(positions_ws, m.indices) : *bounds;
    m.devicePositions = m.deviceNormals = nullptr;
    m.positions_ws.assign(positions_ws.begin(), positions_ws.end());
    if (normals_ws.empty()) {
        m.normals_ws = averagedNormals(positions_ws, m.indices);
    } else {
        m.normals_ws.assign(normals_ws.begin(), normals_ws.end());
    }
    return {};
}

Status DeviceScene::replaceMesh(std::size_t mesh, gpu::BufferPtr positions_ws, gpu::BufferPtr normals_ws,
                                const Box3f& bounds_ws) {
    if (mesh >= meshes.size()) return fail(fmt::format("mesh {} of {}", mesh, meshes.size()));
    MeshOnDevice& m = meshes[mesh];
    if (m.indices.empty()) return {};
    const std::uint64_t needed = std::uint64_t{m.vertexCount} * 3 * sizeof(float);
    for (const gpu::BufferPtr& buffer : {positions_ws, normals_ws}) {
        if (buffer != nullptr && buffer->desc().size >= needed) continue;
        return fail("a buffer that cannot hold this mesh",
                    fmt::format("{} bytes, of 3 floats a vertex", needed));
    }
    if (bounds_ws.isEmpty()) return fail("vertices on the device without their bounds");
    m.bounds_ws = bounds_ws;
    m.positions_ws.clear();
    m.devicePositions = std::move(positions_ws);
    m.deviceNormals = std::move(normals_ws);
    return {};
}

}  // namespace hairloom::render
