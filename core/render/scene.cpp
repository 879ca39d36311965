// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/scene.h"

#include <fmt/format.h>

#include <algorithm>

namespace hairloom::render {
namespace {

Status checkMesh(const RenderMesh& mesh) {
    const std::size_t vertices = mesh.positions_ws.size();
    if (mesh.indices.size() % 3 != 0) return fail("a mesh whose indices are not three a triangle");
    if (!mesh.normals_ws.empty() && mesh.normals_ws.size() != vertices) {
        return fail(fmt::format("a mesh of {} vertices with {} normals", vertices, mesh.normals_ws.size()));
    }
    if (!mesh.vertexAlbedo.empty() && mesh.vertexAlbedo.size() != vertices) {
        return fail(fmt::format("a mesh of {} vertices with {} colours", vertices, mesh.vertexAlbedo.size()));
    }
    for (std::size_t i = 0; i < vertices; ++i) {
        if (!mesh.positions_ws[i].allFinite()) return fail(fmt::format("mesh vertex {} is not finite", i));
    }
    for (const std::uint32_t index : mesh.indices) {
        if (index >= vertices) return fail(fmt::format("mesh index {} of {} vertices", index, vertices));
    }
    return {};
}

Status checkStrands(const RenderStrands& strands) {
    if (strands.offsets.empty()) return {};
    const std::size_t points = strands.positions_ws.size();
    if (!strands.radii.empty() && strands.radii.size() != points) {
        return fail(fmt::format("{} strand points with {} radii", points, strands.radii.size()));
    }
    if (!strands.pointDyes.empty() && strands.pointDyes.size() != points) {
        return fail(fmt::format("{} strand points with {} shares of dye", points, strands.pointDyes.size()));
    }
    const std::size_t count = strands.offsets.size() - 1;
    if (!strands.colours.empty() && strands.colours.size() != count) {
        return fail(fmt::format("{} strands with {} colours", count, strands.colours.size()));
    }
    if (!strands.materials.empty() && strands.materials.size() != count) {
        return fail(fmt::format("{} strands with {} materials", count, strands.materials.size()));
    }
    for (std::size_t i = 0; i < strands.materials.size(); ++i) {
        if (strands.materials[i] <= strands.others.size() || strands.materials[i] == kNotDrawn) continue;
        return fail(fmt::format("strand {} has the material {} of {}", i, strands.materials[i],
                                strands.others.size() + 1));
    }
    for (const std::span<const float> shares :
         {strands.streaks, strands.dyes, strands.pigments, strands.lengths}) {
        if (!shares.empty() && shares.size() != count) {
            return fail(fmt::format("{} strands with {} values of their look", count, shares.size()));
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        if (strands.offsets[i] > strands.offsets[i + 1] || strands.offsets[i + 1] > points) {
            return fail(fmt::format("strand {} has the points {} to {}, of {}", i, strands.offsets[i],
                                    strands.offsets[i + 1], points));
        }
        for (std::uint32_t p = strands.offsets[i]; p < strands.offsets[i + 1]; ++p) {
            const bool radiusOk = strands.radii.empty() || (strands.radii[p] >= 0 && strands.radii[p] < 1);
            if (strands.positions_ws[p].allFinite() && radiusOk) continue;
            return fail(fmt::format("point {} of strand {} is not finite, or its radius is not 0 to 1 m",
                                    p - strands.offsets[i], i));
        }
    }
    return {};
}

}  // namespace

const StrandShading* shadingOf(const RenderStrands& strands, std::size_t s) {
    const std::uint32_t material = strands.materials.empty() ? 0 : strands.materials[s];
    if (material == kNotDrawn) return nullptr;
    return material == 0 ? &strands.material : &strands.others[material - 1];
}

float radiusAt(const RenderStrands& strands, const StrandShading& material, std::uint32_t first,
               std::uint32_t last, std::uint32_t p) {
    const bool own = strands.radiiOfAll || &material == &strands.material;
    if (!strands.radii.empty() && own) return strands.radii[p];
    const float along = static_cast<float>(p - first) / static_cast<float>(std::max(last - first - 1, 1u));
    return material.radius * (1 + (material.tipScale - 1) * along * along);
}

Status check(const RenderScene& scene) {
    if (auto status = check(scene.camera); !status) return status;
    if (auto status = check(scene.lights); !status) return status;
    for (const RenderMesh& mesh : scene.meshes) {
        if (auto status = checkMesh(mesh); !status) return status;
    }
    for (const RenderStrands& strands : scene.strands) {
        if (auto status = checkStrands(strands); !status) return status;
    }
    return {};
}

Box3f boundsOf(std::span<const Vec3f> positions, std::span<const std::uint32_t> indices) {
    Box3f box;
    for (const std::uint32_t index : indices) box.extend(positions[index]);
    return box;
}

Box3f boundsOf(const RenderScene& scene) {
    Box3f box;
    for (const RenderMesh& mesh : scene.meshes) box.extend(boundsOf(mesh.positions_ws, mesh.indices));
    for (const RenderStrands& strands : scene.strands) {
        for (const Vec3f& p : strands.positions_ws) box.extend(p);
    }
    return box;
}

}  // namespace hairloom::render
