// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/device_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/random.h"

namespace hairloom::render {
namespace {

// Curves 32 times as fine still fit the smallest buffers that devices offer, of 128 MiB.
constexpr std::uint32_t kMaxPointsPerBatch = 1u << 17u;
constexpr std::uint32_t kRestart = 0xffffffffu;

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

/// Errors: a point that is not finite, called "`what` N".
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

shaders::float4 toFloat4(const Vec3f& v, float w) {
    return {v.x(), v.y(), v.z(), w};
}

/// A buffer of elements that shaders read; `floats` of plain numbers such as the components of vectors.
Result<gpu::BufferPtr> structured(gpu::Device& device, const char* name, std::uint32_t elementBytes,
                                  std::span<const std::byte> content) {
    gpu::BufferDesc desc;
    desc.name = name;
    desc.size = content.size();
    desc.elementBytes = elementBytes;
    return device.createBuffer(desc, content);
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

template <class T>
std::span<const std::byte> bytes(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

Result<MeshOnDevice> uploadMesh(gpu::Device& device, const RenderMesh& mesh) {
    MeshOnDevice result;
    result.indices.assign(mesh.indices.begin(), mesh.indices.end());
    result.vertexCount = mesh.positions_ws.size();
    result.matte = mesh.matte;
    for (const Vec3f& p : mesh.positions_ws) result.bounds_ws.extend(p);
    std::vector<Vec3f> computed;
    if (mesh.normals_ws.empty()) computed = averagedNormals(mesh.positions_ws, mesh.indices);
    const std::span<const Vec3f> normals = mesh.normals_ws.empty() ? computed : mesh.normals_ws;
    std::vector<shaders::float4> albedo;
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        albedo.push_back(toFloat4(mesh.triangleAlbedo.empty() ? mesh.albedo : mesh.triangleAlbedo[t], 1));
    }
    Gather gather;
    gather(result.positions, structured(device, "mesh positions", 4, std::as_bytes(mesh.positions_ws)));
    gather(result.normals, structured(device, "mesh normals", 4, std::as_bytes(normals)));
    gather(result.albedo, structured(device, "mesh colours", sizeof(shaders::float4), bytes(albedo)));
    gather(result.indexBuffer, structured(device, "mesh indices", 4, std::as_bytes(mesh.indices)));
    if (!gather.status()) return tl::unexpected(gather.status().error());
    return result;
}

/// Strands first…last - 1 of a group that have segments, in an order of chance.
std::vector<std::size_t> drawingOrder(const RenderStrands& strands, std::size_t first, std::size_t last) {
    std::vector<std::size_t> order;
    for (std::size_t i = first; i < last; ++i) {
        if (strands.offsets[i + 1] - strands.offsets[i] >= 2) order.push_back(i);
    }
    Random random(2, first);
    for (std::size_t i = order.size(); i > 1; --i) {
        std::swap(order[i - 1], order[random.below(static_cast<std::uint32_t>(i))]);
    }
    return order;
}

/// Strands first…last - 1 of a group.
Status uploadBatch(gpu::Device& device, const RenderStrands& strands, std::size_t group, std::size_t first,
                   std::size_t last, std::vector<StrandBatch>& batches) {
    StrandBatch batch;
    batch.group = group;
    batch.firstPoint = strands.offsets[first];
    batch.pointCount = strands.offsets[last] - strands.offsets[first];
    batch.segmentsBefore = {0};
    std::vector<shaders::StrandHeader> headers;
    for (const std::size_t i : drawingOrder(strands, first, last)) {
        shaders::StrandHeader header;
        header.firstPoint = strands.offsets[i] - strands.offsets[first];
        header.pointCount = strands.offsets[i + 1] - strands.offsets[i];
        header.segmentsBefore = batch.segmentsBefore.back();
        header.random = Random(1, i).uniform();
        header.albedo = strands.colours.empty() ? shaders::float4{} : toFloat4(strands.colours[i], 1);
        header.source = static_cast<std::uint32_t>(i);
        header.streak = strands.streaks.empty() ? 0 : strands.streaks[i];
        header.dye = strands.dyes.empty() ? 0 : strands.dyes[i];
        headers.push_back(header);
        batch.segmentsBefore.push_back(header.segmentsBefore + header.pointCount - 1);
    }
    if (headers.empty()) return {};
    const std::vector<float> none(1, 0.0f);
    const auto radii = strands.radii.empty() ? std::span<const float>(none)
                                             : strands.radii.subspan(batch.firstPoint, batch.pointCount);
    Gather gather;
    gather(batch.headers, structured(device, "strands", sizeof(shaders::StrandHeader), bytes(headers)));
    gather(batch.positions,
           structured(device, "strand points", 4,
                      std::as_bytes(strands.positions_ws.subspan(batch.firstPoint, batch.pointCount))));
    gather(batch.radii, structured(device, "strand radii", 4, std::as_bytes(radii)));
    if (!gather.status()) return gather.status();
    batches.push_back(std::move(batch));
    return {};
}

Status uploadStrands(gpu::Device& device, const RenderStrands& strands, std::size_t group,
                     std::vector<StrandBatch>& batches) {
    const std::size_t count = strands.offsets.empty() ? 0 : strands.offsets.size() - 1;
    std::size_t first = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t points = strands.offsets[i + 1] - strands.offsets[i];
        if (points > kMaxPointsPerBatch) {
            return fail(fmt::format("strand {} has {} points", i, points),
                        fmt::format("at most {}", kMaxPointsPerBatch));
        }
        if (strands.offsets[i + 1] - strands.offsets[first] > kMaxPointsPerBatch) {
            if (auto status = uploadBatch(device, strands, group, first, i, batches); !status) return status;
            first = i;
        }
    }
    return count > first ? uploadBatch(device, strands, group, first, count, batches) : Status{};
}

std::vector<std::uint32_t> ribbonIndices(const StrandBatch& batch, std::uint32_t subdivisions) {
    std::vector<std::uint32_t> indices;
    indices.reserve(batch.indexCount(batch.strandCount(), subdivisions));
    std::uint32_t next = 0;
    for (std::uint32_t strand = 0; strand < batch.strandCount(); ++strand) {
        const std::uint32_t segments = batch.segmentsBefore[strand + 1] - batch.segmentsBefore[strand];
        for (std::uint32_t i = 0; i < 2 * (segments * subdivisions + 1); ++i) indices.push_back(next++);
        indices.push_back(kRestart);
    }
    return indices;
}

/// Strands of more than 32 points become several patches that overlap, so that each knows its neighbours'
/// tangents.
std::vector<shaders::StrandPatch> strandPatches(StrandBatch& batch) {
    constexpr std::uint32_t kControlPoints = HAIRLOOM_PATCH_POINTS;
    std::vector<shaders::StrandPatch> patches;
    batch.patchesBefore = {0};
    for (std::uint32_t strand = 0; strand < batch.strandCount(); ++strand) {
        const std::uint32_t segments = batch.segmentsBefore[strand + 1] - batch.segmentsBefore[strand];
        for (std::uint32_t done = 0; done < segments;) {
            shaders::StrandPatch patch;
            const std::uint32_t before = done > 0 ? 1 : 0;
            patch.strand = strand;
            patch.firstPoint = done - before;
            patch.pointCount = std::min(segments + 1 - patch.firstPoint, kControlPoints);
            const bool ends = patch.firstPoint + patch.pointCount == segments + 1;
            patch.segments = patch.pointCount - 1 - before - (ends ? 0 : 1);
            done += patch.segments;
            patches.push_back(patch);
        }
        batch.patchesBefore.push_back(static_cast<std::uint32_t>(patches.size()));
    }
    return patches;
}

std::uint64_t cellOf(const Vec3f& p, float size) {
    const auto place = [&](float x) {
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x / size)) + (1 << 20)) &
               0x1fffffu;
    };
    return place(p.x()) | place(p.y()) << 21u | place(p.z()) << 42u;
}

std::size_t countDistinct(std::vector<std::uint64_t> cells) {
    std::ranges::sort(cells);
    return static_cast<std::size_t>(std::unique(cells.begin(), cells.end()) - cells.begin());
}

/// About kSampleSize points, spread over all strands.
std::vector<std::uint32_t> samplePoints(std::size_t points) {
    constexpr std::size_t kSampleSize = 1u << 16u;
    const std::size_t step =
        std::max<std::size_t>(1, points / kSampleSize) | 1u;  // odd: no stride of strands
    std::vector<std::uint32_t> sample;
    for (std::size_t i = 0; i < points; i += step) sample.push_back(static_cast<std::uint32_t>(i));
    return sample;
}

void takeSample(StrandGroup& group, std::span<const Vec3f> positions_ws) {
    group.sample_ws.resize(group.sampled.size());
    std::ranges::transform(group.sampled, group.sample_ws.begin(),
                           [&](std::uint32_t i) { return positions_ws[i]; });
}

}  // namespace

float HairDetail::widening() const {
    const float full = 0.9f * share;
    const float none = 1.1f * share;
    if (full >= 1) return 1;
    if (none <= 1) return 1 / share;
    // The mean over all strands of the factors of levelWidth() in shaders/curve.comp.hlsl.
    const float fading = (none - full) * (none - full) - (none - 1) * (none - 1);
    return 1 / (full + fading / (2 * (none - full)));
}

std::uint32_t StrandBatch::strandCount(const HairDetail& detail) const {
    const float wanted = std::ceil(std::min(1.1f * detail.share, 1.0f) * static_cast<float>(strandCount()));
    return std::clamp(static_cast<std::uint32_t>(wanted), 1u, strandCount());
}

Result<DeviceScene> DeviceScene::upload(gpu::Device& device, const RenderScene& scene) {
    DeviceScene result;
    for (const RenderMesh& mesh : scene.meshes) {
        if (mesh.indices.empty()) {
            result.meshes.emplace_back();  // keeps the places of those after it
            continue;
        }
        auto uploaded = uploadMesh(device, mesh);
        if (!uploaded) return tl::unexpected(uploaded.error());
        result.meshes.push_back(std::move(*uploaded));
    }
    for (std::size_t i = 0; i < scene.strands.size(); ++i) {
        const RenderStrands& strands = scene.strands[i];
        StrandGroup group;
        group.material = strands.material;
        group.strandCount = strands.offsets.empty() ? 0 : strands.offsets.size() - 1;
        group.pointCount = strands.positions_ws.size();
        group.hasRadii = !strands.radii.empty();
        for (const Vec3f& p : strands.positions_ws) group.bounds_ws.extend(p);
        group.sampled = samplePoints(group.pointCount);
        takeSample(group, strands.positions_ws);
        result.groups.push_back(std::move(group));
        if (auto status = uploadStrands(device, strands, i, result.batches); !status) {
            return tl::unexpected(status.error());
        }
    }
    result.measureSpace(scene);
    return result;
}

void DeviceScene::measureSpace(const RenderScene& scene) {
    constexpr float kCell = 0.01f;  // metres, about a wisp
    std::vector<std::uint64_t> cells;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const RenderStrands& strands = scene.strands[g];
        StrandGroup& group = groups[g];
        for (std::size_t i = 0; i + 1 < strands.offsets.size(); ++i) {
            for (std::uint32_t p = strands.offsets[i] + 1; p < strands.offsets[i + 1]; ++p) {
                const Vec3f& a = strands.positions_ws[p - 1];
                const Vec3f& b = strands.positions_ws[p];
                const double step = static_cast<double>((b - a).norm());
                group.length += step;
                ++group.segments;
                if (group.hasRadii) {
                    group.ownRadius +=
                        step * static_cast<double>(0.5f * (strands.radii[p - 1] + strands.radii[p]));
                }
                cells.push_back(cellOf(0.5f * (a + b), kCell));
            }
        }
        if (group.length > 0) group.ownRadius /= group.length;
    }
    const double cell = static_cast<double>(kCell);
    for (const unsigned axis : {0u, 21u, 42u}) {
        auto flat = cells;
        for (std::uint64_t& c : flat) c &= ~(std::uint64_t{0x1fffff} << axis);
        hairShadow_ += static_cast<double>(countDistinct(std::move(flat))) * cell * cell / 3;
    }
    hairVolume_ = static_cast<double>(countDistinct(std::move(cells))) * cell * cell * cell;
}

HairMeasure DeviceScene::measure() const {
    double length = 0, surface = 0;
    std::size_t segments = 0;
    for (const StrandGroup& group : groups) {
        // The profile of shaders/curve.comp.hlsl has this mean.
        const double authored =
            static_cast<double>(group.material.radius * (2 + group.material.tipScale) / 3);
        length += group.length;
        surface += group.length * 2 * (group.hasRadii ? group.ownRadius : authored);
        segments += group.segments;
    }
    HairMeasure result;
    if (!(length > 0) || !(hairVolume_ > 0)) return result;
    result.segment = static_cast<float>(length / static_cast<double>(segments));
    result.diameter = static_cast<float>(surface / length);
    // Of cylinders in all directions a ray sees π/4 of length times diameter.
    const double crossed = surface * static_cast<double>(kPi) / 4;
    result.fibresPerMetre = static_cast<float>(crossed / hairVolume_);
    result.fibresThrough = static_cast<float>(crossed / hairShadow_);
    return result;
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
    m.bounds_ws = *bounds;
    m.positions_ws.assign(positions_ws.begin(), positions_ws.end());
    if (normals_ws.empty()) {
        m.normals_ws = averagedNormals(positions_ws, m.indices);
    } else {
        m.normals_ws.assign(normals_ws.begin(), normals_ws.end());
    }
    return {};
}

Status DeviceScene::replaceStrands(std::size_t group, std::span<const Vec3f> positions_ws) {
    if (group >= groups.size()) return fail(fmt::format("group {} of {} of strands", group, groups.size()));
    StrandGroup& g = groups[group];
    if (positions_ws.size() != g.pointCount) {
        return fail(fmt::format("{} positions for strands", positions_ws.size()),
                    fmt::format("{}, as they have points", g.pointCount));
    }
    const auto bounds = finiteBounds(positions_ws, "strand point");
    if (!bounds) return tl::unexpected(bounds.error());
    g.bounds_ws = *bounds;
    g.devicePositions = nullptr;
    g.positions_ws.assign(positions_ws.begin(), positions_ws.end());
    takeSample(g, positions_ws);
    return {};
}

Status DeviceScene::replaceStrands(std::size_t group, gpu::BufferPtr positions_ws,
                                   std::uint32_t floatsPerPoint, const Box3f& bounds_ws) {
    if (group >= groups.size()) return fail(fmt::format("group {} of {} of strands", group, groups.size()));
    StrandGroup& g = groups[group];
    std::uint32_t longest = 0;
    for (const StrandBatch& batch : batches) {
        if (batch.group != group) continue;
        for (std::uint32_t i = 0; i < batch.strandCount(); ++i) {
            longest = std::max(longest, batch.segmentsBefore[i + 1] - batch.segmentsBefore[i] + 1);
        }
    }
    const std::uint64_t needed = std::uint64_t{longest} * g.strandCount * floatsPerPoint * sizeof(float);
    if (positions_ws == nullptr || (floatsPerPoint != 3 && floatsPerPoint != 4) ||
        positions_ws->desc().size < needed || !has(positions_ws->desc().usage, gpu::Usage::ShaderRead)) {
        return fail("a buffer that cannot hold these strands",
                    fmt::format("{} bytes that shaders read, of 3 or 4 floats a point", needed));
    }
    if (bounds_ws.isEmpty()) return fail("positions on the device without their bounds");
    g.bounds_ws = bounds_ws;
    g.positions_ws.clear();
    g.sample_ws.clear();
    g.devicePositions = std::move(positions_ws);
    g.floatsPerPoint = floatsPerPoint;
    return {};
}

Status DeviceScene::prepareCurves(gpu::Device& device, std::uint32_t subdivisions) {
    Gather gather;
    for (StrandBatch& batch : batches) {
        const std::uint32_t count = batch.curvePoints(batch.strandCount(), subdivisions);
        if (subdivisions > batch.curveSubdivisions) {
            gather(batch.curve, written(device, "curve points", count, sizeof(shaders::CurvePoint)));
            gather(batch.colour, written(device, "curve colours", count, sizeof(shaders::float4)));
            batch.curveSubdivisions = subdivisions;
        }
        gpu::BufferPtr& indices = batch.indices[subdivisions];
        if (indices != nullptr) continue;
        const auto content = ribbonIndices(batch, subdivisions);
        gpu::BufferDesc desc;
        desc.name = "ribbon indices";
        desc.size = content.size() * sizeof(std::uint32_t);
        desc.usage = gpu::Usage::Index;
        gather(indices, device.createBuffer(desc, bytes(content)));
    }
    return gather.status();
}

Status DeviceScene::prepareFibres(gpu::Device& device) {
    for (StrandGroup& group : groups) {
        if (group.material.tubes) continue;
        const bool varies = group.material.look.has_value();
        if (group.fibre.isFor(group.material.fibre, varies)) continue;
        auto made = FibreTables::make(device, group.material.fibre, varies);
        if (!made) return tl::unexpected(made.error());
        group.fibre = std::move(*made);
    }
    return {};
}

Status DeviceScene::preparePatches(gpu::Device& device) {
    Gather gather;
    for (StrandBatch& batch : batches) {
        if (batch.patches != nullptr) continue;
        const auto patches = strandPatches(batch);
        gather(batch.patches,
               structured(device, "strand patches", sizeof(shaders::StrandPatch), bytes(patches)));
    }
    return gather.status();
}

void DeviceScene::recordUploads(gpu::CommandList& list) {
    for (MeshOnDevice& mesh : meshes) {
        if (mesh.positions_ws.empty()) continue;
        list.updateBuffer(mesh.positions, 0, bytes(mesh.positions_ws));
        list.updateBuffer(mesh.normals, 0, bytes(mesh.normals_ws));
        mesh.positions_ws.clear();
    }
    for (std::size_t i = 0; i < groups.size(); ++i) {
        StrandGroup& group = groups[i];
        if (group.positions_ws.empty()) continue;
        const std::span<const Vec3f> all(group.positions_ws);
        for (const StrandBatch& batch : batches) {
            if (batch.group != i) continue;
            list.updateBuffer(batch.positions, 0,
                              std::as_bytes(all.subspan(batch.firstPoint, batch.pointCount)));
        }
        group.positions_ws.clear();
    }
}

Box3f DeviceScene::meshBounds() const {
    Box3f box;
    for (const MeshOnDevice& mesh : meshes) box.extend(mesh.bounds_ws);
    return box;
}

Box3f DeviceScene::hairBounds() const {
    Box3f box;
    for (const StrandGroup& group : groups) box.extend(group.bounds_ws);
    return box;
}

std::vector<Vec3f> DeviceScene::sample() const {
    std::vector<Vec3f> points;
    for (const StrandGroup& group : groups) {
        points.insert(points.end(), group.sample_ws.begin(), group.sample_ws.end());
        if (!group.sample_ws.empty() || group.bounds_ws.isEmpty()) continue;
        for (int i = 0; i < 8; ++i)
            points.push_back(group.bounds_ws.corner(static_cast<Box3f::CornerType>(i)));
    }
    return points;
}

std::uint64_t DeviceScene::triangles() const {
    std::uint64_t count = 0;
    for (const MeshOnDevice& mesh : meshes) count += mesh.indices.size() / 3;
    return count;
}

}  // namespace hairloom::render
