// SPDX-License-Identifier: GPL-3.0-or-later
// The scene checked and brought to the device.
#include <fmt/format.h>

#include <algorithm>

#include "core/base/random.h"
#include "core/render/picture_internal.h"

namespace hairloom::render {
namespace {

constexpr std::uint32_t kMaxCurvePointsPerBatch = 2u << 20u;
constexpr std::uint32_t kRestart = 0xffffffffu;

Status checkMesh(const RenderMesh& mesh) {
    const std::size_t vertices = mesh.positions_ws.size();
    if (mesh.indices.size() % 3 != 0) return fail("a mesh whose indices are not three a triangle");
    if (!mesh.normals_ws.empty() && mesh.normals_ws.size() != vertices) {
        return fail(fmt::format("a mesh of {} vertices with {} normals", vertices, mesh.normals_ws.size()));
    }
    if (!mesh.triangleAlbedo.empty() && mesh.triangleAlbedo.size() != mesh.indices.size() / 3) {
        return fail(fmt::format("a mesh of {} triangles with {} colours", mesh.indices.size() / 3,
                                mesh.triangleAlbedo.size()));
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
    const std::size_t count = strands.offsets.size() - 1;
    if (!strands.colours.empty() && strands.colours.size() != count) {
        return fail(fmt::format("{} strands with {} colours", count, strands.colours.size()));
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

std::vector<Vec3f> averagedNormals(const RenderMesh& mesh) {
    std::vector<Vec3f> normals(mesh.positions_ws.size(), Vec3f::Zero());
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const Vec3f& a = mesh.positions_ws[mesh.indices[i]];
        const Vec3f cross =
            (mesh.positions_ws[mesh.indices[i + 1]] - a).cross(mesh.positions_ws[mesh.indices[i + 2]] - a);
        for (std::size_t k = 0; k < 3; ++k) normals[mesh.indices[i + k]] += cross;
    }
    for (Vec3f& n : normals) {
        const float length = n.norm();
        n = length > 0 ? Vec3f(n / length) : Vec3f::UnitY();
    }
    return normals;
}

shaders::float4 toFloat4(const Vec3f& v, float w) {
    return {v.x(), v.y(), v.z(), w};
}

template <class T>
Result<gpu::BufferPtr> structured(gpu::Device& device, const char* name, const std::vector<T>& content,
                                  gpu::Usage usage = gpu::Usage::ShaderRead) {
    gpu::BufferDesc desc;
    desc.name = name;
    desc.size = content.size() * sizeof(T);
    desc.elementBytes = has(usage, gpu::Usage::ShaderRead) ? sizeof(T) : 0;
    desc.usage = usage;
    return device.createBuffer(desc, std::as_bytes(std::span(content)));
}

Result<gpu::BufferPtr> written(gpu::Device& device, const char* name, std::uint64_t count,
                               std::uint32_t element) {
    gpu::BufferDesc desc;
    desc.name = name;
    desc.size = count * element;
    desc.elementBytes = element;
    desc.usage = gpu::Usage::ShaderRead | gpu::Usage::UnorderedAccess;
    return device.createBuffer(desc);
}

/// Moves results into their places and remembers the first error.
class Gather {
  public:
    template <class T>
    Gather& operator()(T& target, Result<T> result) {
        if (result) {
            target = std::move(*result);
        } else if (status_) {
            status_ = tl::unexpected(result.error());
        }
        return *this;
    }
    const Status& status() const { return status_; }

  private:
    Status status_;
};

Status uploadMesh(gpu::Device& device, const RenderMesh& mesh, SceneOnDevice& scene) {
    if (mesh.indices.empty()) return {};
    std::vector<Vec3f> computed;
    if (mesh.normals_ws.empty()) computed = averagedNormals(mesh);
    const std::span<const Vec3f> normals = mesh.normals_ws.empty() ? computed : mesh.normals_ws;
    std::vector<shaders::float4> positions4, normals4, albedo4;
    for (std::size_t i = 0; i < mesh.positions_ws.size(); ++i) {
        positions4.push_back(toFloat4(mesh.positions_ws[i], 1));
        normals4.push_back(toFloat4(normals[i], 0));
        scene.bounds_ws.extend(mesh.positions_ws[i]);
    }
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        albedo4.push_back(toFloat4(mesh.triangleAlbedo.empty() ? mesh.albedo : mesh.triangleAlbedo[t], 1));
    }
    MeshOnDevice result;
    result.corners = static_cast<std::uint32_t>(mesh.indices.size());
    Gather gather;
    gather(result.positions, structured(device, "mesh positions", positions4));
    gather(result.normals, structured(device, "mesh normals", normals4));
    gather(result.albedo, structured(device, "mesh colours", albedo4));
    gather(result.indices, structured(device, "mesh indices",
                                      std::vector<std::uint32_t>(mesh.indices.begin(), mesh.indices.end())));
    if (!gather.status()) return gather.status();
    scene.meshes.push_back(std::move(result));
    scene.triangles += mesh.indices.size() / 3;
    return {};
}

struct BatchContent {
    std::vector<shaders::StrandHeader> headers;
    std::vector<shaders::float4> points;
    std::vector<std::uint32_t> indices;
    std::uint32_t curvePoints = 0;
};

void appendStrand(BatchContent& batch, const RenderStrands& strands, std::size_t strand,
                  std::uint32_t curvePoints) {
    const std::uint32_t begin = strands.offsets[strand];
    const std::uint32_t count = strands.offsets[strand + 1] - begin;
    const HairMaterial& material = strands.material;
    const Vec3f albedo = strands.colours.empty() ? material.albedo : strands.colours[strand];
    Random random(1, strand);
    batch.headers.push_back({static_cast<std::uint32_t>(batch.points.size()), count, batch.curvePoints,
                             random.uniform(), toFloat4(albedo, 1)});
    for (std::uint32_t i = 0; i < count; ++i) {
        const float along = static_cast<float>(i) / static_cast<float>(count - 1);
        const float radius = strands.radii.empty()
                                 ? material.radius * (1 + (material.tipScale - 1) * along * along)
                                 : strands.radii[begin + i];
        batch.points.push_back(toFloat4(strands.positions_ws[begin + i], radius));
    }
    for (std::uint32_t i = 0; i < 2 * curvePoints; ++i) batch.indices.push_back(2 * batch.curvePoints + i);
    batch.indices.push_back(kRestart);
    batch.curvePoints += curvePoints;
}

Status uploadBatch(gpu::Device& device, BatchContent& content, std::size_t group, SceneOnDevice& scene) {
    if (content.headers.empty()) return {};
    StrandBatch batch;
    batch.strandCount = static_cast<std::uint32_t>(content.headers.size());
    batch.curvePoints = content.curvePoints;
    batch.indexCount = static_cast<std::uint32_t>(content.indices.size());
    batch.group = group;
    Gather gather;
    gather(batch.headers, structured(device, "strands", content.headers));
    gather(batch.points, structured(device, "strand points", content.points));
    gather(batch.indices, structured(device, "ribbon indices", content.indices, gpu::Usage::Index));
    gather(batch.curve, written(device, "curve points", content.curvePoints, sizeof(shaders::CurvePoint)));
    gather(batch.colour, written(device, "curve colours", content.curvePoints, sizeof(shaders::float4)));
    if (!gather.status()) return gather.status();
    scene.strands += batch.strandCount;
    scene.curvePoints += batch.curvePoints;
    scene.batches.push_back(std::move(batch));
    content = {};
    return {};
}

Status uploadStrands(gpu::Device& device, const RenderStrands& strands, std::size_t group,
                     std::uint32_t subdivisions, SceneOnDevice& scene) {
    BatchContent content;
    for (std::size_t i = 0; i + 1 < strands.offsets.size(); ++i) {
        const std::uint64_t count = strands.offsets[i + 1] - strands.offsets[i];
        if (count < 2) continue;
        const std::uint64_t curvePoints = (count - 1) * subdivisions + 1;
        if (curvePoints > kMaxCurvePointsPerBatch) {
            return fail(fmt::format("strand {} has {} points", i, count),
                        fmt::format("at most {}", kMaxCurvePointsPerBatch / subdivisions));
        }
        if (content.curvePoints + curvePoints > kMaxCurvePointsPerBatch) {
            if (auto status = uploadBatch(device, content, group, scene); !status) return status;
        }
        appendStrand(content, strands, i, static_cast<std::uint32_t>(curvePoints));
        for (std::uint32_t p = strands.offsets[i]; p < strands.offsets[i + 1]; ++p) {
            scene.hairBounds_ws.extend(strands.positions_ws[p]);
        }
    }
    return uploadBatch(device, content, group, scene);
}

}  // namespace

Status checkScene(const RenderScene& scene) {
    if (auto status = check(scene.camera); !status) return status;
    if (scene.lights.size() > kMaxLights) {
        return fail(fmt::format("{} lights", scene.lights.size()), fmt::format("at most {}", kMaxLights));
    }
    for (const Light& light : scene.lights) {
        if (!light.toLight_ws.allFinite() || !(light.toLight_ws.norm() > 0) ||
            !light.irradiance.allFinite()) {
            return fail("a light without a direction or with a colour that is not finite");
        }
    }
    for (const RenderMesh& mesh : scene.meshes) {
        if (auto status = checkMesh(mesh); !status) return status;
    }
    for (const RenderStrands& strands : scene.strands) {
        if (auto status = checkStrands(strands); !status) return status;
    }
    return {};
}

Result<SceneOnDevice> uploadScene(gpu::Device& device, const RenderScene& scene, std::uint32_t subdivisions) {
    SceneOnDevice result;
    for (const RenderMesh& mesh : scene.meshes) {
        if (auto status = uploadMesh(device, mesh, result); !status) return tl::unexpected(status.error());
    }
    for (std::size_t i = 0; i < scene.strands.size(); ++i) {
        if (auto status = uploadStrands(device, scene.strands[i], i, subdivisions, result); !status) {
            return tl::unexpected(status.error());
        }
    }
    result.bounds_ws.extend(result.hairBounds_ws);
    return result;
}

Box3f boundsOf(const RenderScene& scene) {
    Box3f box;
    for (const RenderMesh& mesh : scene.meshes) {
        for (const Vec3f& p : mesh.positions_ws) box.extend(p);
    }
    for (const RenderStrands& strands : scene.strands) {
        for (const Vec3f& p : strands.positions_ws) box.extend(p);
    }
    return box;
}

}  // namespace hairloom::render
