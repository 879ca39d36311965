// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/render/device_scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/random.h"
#include "core/render/device_buffers.h"
#include "core/render/device_mesh.h"

namespace hairloom::render {
namespace {

/// Curves 32 times as fine still fit one of the device's buffers; the smallest that are offered have 128 MiB.
std::uint32_t maxPointsPerBatch(const gpu::DeviceInfo& device) {
    constexpr std::uint64_t kMin = 1u << 17u, kMax = 1u << 20u;
    return static_cast<std::uint32_t>(
        std::clamp(device.maxBufferBytes / (32 * sizeof(shaders::CurvePoint)), kMin, kMax));
}

/// Strands first…last - 1 of a group that are drawn and have segments, in an order of chance.
std::vector<std::size_t> drawingOrder(const RenderStrands& strands, std::size_t first, std::size_t last) {
    std::vector<std::size_t> order;
    for (std::size_t i = first; i < last; ++i) {
        const bool drawn = strands.materials.empty() || strands.materials[i] != kNotDrawn;
        if (drawn && strands.offsets[i + 1] - strands.offsets[i] >= 2) order.push_back(i);
    }
    Random random(2, first);
    for (std::size_t i = order.size(); i > 1; --i) {
        std::swap(order[i - 1], order[random.below(static_cast<std::uint32_t>(i))]);
    }
    return order;
}

constexpr std::size_t kSomeStrands = 64;  // a batch

/// Of strands in a part of a group, and the batch's segments.
std::vector<shaders::StrandHeader> headersOf(const RenderStrands& strands, std::span<const std::size_t> order,
                                             std::size_t first, DrawBatch& batch) {
    batch.segmentsBefore = {0};
    std::vector<shaders::StrandHeader> headers;
    for (const std::size_t i : order) {
        shaders::StrandHeader header;
        header.firstPoint = strands.offsets[i] - strands.offsets[first];
        header.pointCount = strands.offsets[i + 1] - strands.offsets[i];
        header.segmentsBefore = batch.segmentsBefore.back();
        header.random = Random(1, i).uniform();
        header.albedo = strands.colours.empty() ? shaders::float4{} : toFloat4(strands.colours[i], 1);
        header.source = static_cast<std::uint32_t>(i);
        header.streak = strands.streaks.empty() ? 0 : strands.streaks[i];
        header.dye = strands.dyes.empty() ? 0 : strands.dyes[i];
        header.hasPointDyes = strands.pointDyes.empty() ? 0 : 1;
        header.pigment = strands.pigments.empty() ? 1 : strands.pigments[i];
        header.length = strands.lengths.empty() ? 0 : strands.lengths[i];
        header.unused0 = header.unused1 = 0;
        headers.push_back(header);
        batch.segmentsBefore.push_back(header.segmentsBefore + header.pointCount - 1);
    }
    return headers;
}

void uploadPoints(gpu::Device& device, const RenderStrands& strands, DrawBatch& batch, Gather& gather) {
    const std::vector<float> none(1, 0.0f);
    const auto radii = strands.radii.empty() ? std::span<const float>(none)
                                             : strands.radii.subspan(batch.firstPoint, batch.pointCount);
    const auto dyes = strands.pointDyes.empty()
                          ? std::span<const float>(none)
                          : strands.pointDyes.subspan(batch.firstPoint, batch.pointCount);
    gather(batch.positions,
           structured(device, "strand points", 4,
                      std::as_bytes(strands.positions_ws.subspan(batch.firstPoint, batch.pointCount))));
    gather(batch.radii, structured(device, "strand radii", 4, std::as_bytes(radii)));
    gather(batch.pointDyes, structured(device, "strand dyes", 4, std::as_bytes(dyes)));
}

/// Strands first…last - 1 of a group: a batch for each of their materials.
Status uploadBatches(gpu::Device& device, const RenderStrands& strands, std::size_t group, std::size_t first,
                     std::size_t last, std::vector<StrandGroup>& groups, std::vector<DrawBatch>& batches) {
    std::vector<MaterialOnDevice>& materials = groups[group].materials;
    std::vector<std::vector<std::size_t>> orders(materials.size());
    for (const std::size_t i : drawingOrder(strands, first, last))
        orders[strands.materials.empty() ? 0 : strands.materials[i]].push_back(i);
    bool shares = false;
    for (std::size_t material = 0; material < orders.size(); ++material) {
        if (orders[material].empty()) continue;
        DrawBatch batch;
        batch.group = group;
        batch.material = material;
        batch.firstPoint = strands.offsets[first];
        batch.pointCount = strands.offsets[last] - strands.offsets[first];
        const std::vector<shaders::StrandHeader> headers = headersOf(strands, orders[material], first, batch);
        const std::size_t some = std::min(headers.size(), kSomeStrands);
        auto& someStrands = materials[material].someStrands;
        for (std::size_t i = 0; i < some; ++i) {
            someStrands.push_back(headers[i]);
            someStrands.back().firstPoint += static_cast<std::uint32_t>(batch.firstPoint);
        }
        Gather gather;
        gather(batch.headers, structured(device, "strands", sizeof(shaders::StrandHeader), bytes(headers)));
        if (shares) {
            batch.sharesPoints = true;
            batch.positions = batches.back().positions;
            batch.radii = batches.back().radii;
            batch.pointDyes = batches.back().pointDyes;
        } else {
            uploadPoints(device, strands, batch, gather);
        }
        if (!gather.status()) return gather.status();
        batches.push_back(std::move(batch));
        shares = true;
    }
    return {};
}

Status uploadStrands(gpu::Device& device, const RenderStrands& strands, std::size_t group,
                     std::vector<StrandGroup>& groups, std::vector<DrawBatch>& batches) {
    const std::size_t count = strands.offsets.empty() ? 0 : strands.offsets.size() - 1;
    const std::uint32_t maximum = maxPointsPerBatch(device.info());
    std::size_t first = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t points = strands.offsets[i + 1] - strands.offsets[i];
        if (points > maximum) {
            return fail(fmt::format("strand {} has {} points", i, points),
                        fmt::format("at most {}", maximum));
        }
        if (strands.offsets[i + 1] - strands.offsets[first] > maximum) {
            if (auto status = uploadBatches(device, strands, group, first, i, groups, batches); !status) {
                return status;
            }
            first = i;
        }
    }
    return count > first ? uploadBatches(device, strands, group, first, count, groups, batches) : Status{};
}

void takeMeanDyes(StrandGroup& group, std::span<const float> pointDyes) {
    for (MaterialOnDevice& material : group.materials) {
        material.someDyes.assign(material.someStrands.size(), 1.0f);
        for (std::size_t i = 0; i < material.someStrands.size() && !pointDyes.empty(); ++i) {
            const shaders::StrandHeader& strand = material.someStrands[i];
            float sum = 0;
            for (const float dye : pointDyes.subspan(strand.firstPoint, strand.pointCount)) sum += dye;
            material.someDyes[i] = sum / static_cast<float>(strand.pointCount);
        }
    }
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

bool needsFibre(const MaterialOnDevice& material) {
    const StrandShading& shading = material.shading;
    return !shading.tubes &&
           !(material.hasFibre && material.fibre.isFor(shading.fibre, shading.look.has_value()));
}

}  // namespace

std::uint32_t DrawBatch::strandCount(const HairDetail& detail) const {
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
        group.materials.resize(1 + strands.others.size());
        group.materials[0].shading = strands.material;
        for (std::size_t m = 0; m < strands.others.size(); ++m)
            group.materials[m + 1].shading = strands.others[m];
        group.strandCount = strands.offsets.empty() ? 0 : strands.offsets.size() - 1;
        group.pointCount = strands.positions_ws.size();
        group.hasRadii = !strands.radii.empty();
        group.radiiOfAll = strands.radiiOfAll;
        group.hasPointDyes = !strands.pointDyes.empty();
        for (const Vec3f& p : strands.positions_ws) group.bounds_ws.extend(p);
        group.sampled = samplePoints(group.pointCount);
        takeSample(group, strands.positions_ws);
        result.groups.push_back(std::move(group));
        if (auto status = uploadStrands(device, strands, i, result.groups, result.batches); !status) {
            return tl::unexpected(status.error());
        }
        takeMeanDyes(result.groups.back(), strands.pointDyes);
    }
    result.measureSpace(scene);
    result.clumping = scene.clumping;
    return result;
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

Status DeviceScene::replacePointDyes(std::size_t group, std::span<const float> dyes) {
    if (group >= groups.size()) return fail(fmt::format("group {} of {} of strands", group, groups.size()));
    StrandGroup& g = groups[group];
    if (!g.hasPointDyes || dyes.size() != g.pointCount) {
        return fail(
            fmt::format("{} shares of dye for strands", dyes.size()),
            fmt::format("{}, as they have points with such shares", g.hasPointDyes ? g.pointCount : 0));
    }
    g.pointDyes.assign(dyes.begin(), dyes.end());
    takeMeanDyes(g, dyes);
    return {};
}

Status DeviceScene::replaceRadii(std::size_t group, std::span<const float> radii) {
    if (group >= groups.size()) return fail(fmt::format("group {} of {} of strands", group, groups.size()));
    StrandGroup& g = groups[group];
    if (!g.hasRadii || radii.size() != g.pointCount) {
        return fail(fmt::format("{} radii for strands", radii.size()),
                    fmt::format("{}, as they have points with radii", g.hasRadii ? g.pointCount : 0));
    }
    for (std::size_t p = 0; p < radii.size(); ++p) {
        if (!(radii[p] >= 0 && radii[p] < 1))
            return fail(fmt::format("the radius of point {} is {} m", p, radii[p]), "0 to 1 m");
    }
    g.radii.assign(radii.begin(), radii.end());
    return {};
}

Status DeviceScene::replaceStrands(gpu::Device& device, std::size_t group, gpu::BufferPtr positions_ws,
                                   std::uint32_t floatsPerPoint, const Box3f& bounds_ws,
                                   std::span<const Vec3f> sample_ws) {
    if (group >= groups.size()) return fail(fmt::format("group {} of {} of strands", group, groups.size()));
    StrandGroup& g = groups[group];
    const std::uint64_t needed = std::uint64_t{g.pointCount} * floatsPerPoint * sizeof(float);
    if (positions_ws == nullptr || (floatsPerPoint != 3 && floatsPerPoint != 4) ||
        positions_ws->desc().size < needed || !has(positions_ws->desc().usage, gpu::Usage::ShaderRead)) {
        return fail("a buffer that cannot hold these strands",
                    fmt::format("{} bytes that shaders read, of 3 or 4 floats a point", needed));
    }
    if (bounds_ws.isEmpty()) return fail("positions on the device without their bounds");
    const bool asTheyAre = device.info().backend != gpu::Backend::Direct3D11 ||
                           positions_ws->desc().elementBytes == sizeof(float);
    if (asTheyAre) g.deviceFloats = nullptr;
    if (!asTheyAre && (g.deviceFloats == nullptr || g.deviceFloats->desc().size != needed)) {
        gpu::BufferDesc desc;
        desc.name = "strand points of the device";
        desc.size = needed;
        desc.usage = gpu::Usage::ShaderRead;
        desc.elementBytes = sizeof(float);
        auto made = device.createBuffer(desc);
        if (!made) return tl::unexpected(made.error());
        g.deviceFloats = std::move(*made);
    }
    g.bounds_ws = bounds_ws;
    g.positions_ws.clear();
    g.sample_ws.assign(sample_ws.begin(), sample_ws.end());
    g.devicePositions = std::move(positions_ws);
    g.floatsPerPoint = floatsPerPoint;
    return {};
}

Result<bool> DeviceScene::prepareFibres(gpu::Device& device, bool behind) {
    bool areNew = false;
    const auto use = [&](MaterialOnDevice& material, FibreTables tables) -> Status {
        if (auto status = tables.upload(device); !status) return status;
        material.fibre = std::move(tables);
        material.hasFibre = areNew = true;
        return {};
    };
    const auto prepare = [&](MaterialOnDevice& material) -> Status {
        const StrandShading& shading = material.shading;
        auto baked = material.bake.take();
        if (!needsFibre(material)) return {};
        // While a control moves these are of a moment ago, and nearer to what is wished than older ones.
        if (baked && baked->hasShaderFor(shading)) {
            if (auto status = use(material, std::move(*baked)); !status) return status;
            if (!needsFibre(material)) return {};
        }
        if (behind && material.hasFibre && material.fibre.hasShaderFor(shading)) {
            if (!material.bake.isRunning()) material.bake.start(shading.fibre, shading.look.has_value());
            return {};
        }
        return use(material, FibreTables::bake(shading.fibre, shading.look.has_value()));
    };
    for (StrandGroup& group : groups) {
        for (MaterialOnDevice& material : group.materials) {
            if (auto status = prepare(material); !status) return tl::unexpected(status.error());
        }
    }
    return areNew;
}

bool DeviceScene::awaitsFibres() const {
    return std::ranges::any_of(
        groups, [](const StrandGroup& group) { return std::ranges::any_of(group.materials, needsFibre); });
}

void DeviceScene::recordUploads(gpu::CommandList& list) {
    for (MeshOnDevice& mesh : meshes) {
        if (mesh.positions_ws.empty()) continue;
        list.updateBuffer(mesh.positions, 0, bytes(mesh.positions_ws));
        list.updateBuffer(mesh.normals, 0, bytes(mesh.normals_ws));
        mesh.positions_ws.clear();
    }
    for (const DrawBatch& batch : batches) {
        if (batch.sharesPoints) continue;
        const StrandGroup& group = groups[batch.group];
        const auto update = [&](const gpu::BufferPtr& buffer, auto all) {
            if (all.empty()) return;
            list.updateBuffer(buffer, 0, std::as_bytes(all.subspan(batch.firstPoint, batch.pointCount)));
        };
        update(batch.positions, std::span<const Vec3f>(group.positions_ws));
        update(batch.radii, std::span<const float>(group.radii));
        update(batch.pointDyes, std::span<const float>(group.pointDyes));
    }
    for (StrandGroup& group : groups) {
        group.positions_ws.clear();
        group.radii.clear();
        group.pointDyes.clear();
    }
}

Vec3f DeviceScene::groundAlbedo() const {
    Vec3f sum = Vec3f::Zero();
    float area = 0;
    for (const MeshOnDevice& mesh : meshes) {
        sum += mesh.area * mesh.meanAlbedo;
        area += mesh.area;
    }
    return area > 0 ? Vec3f(sum / area) : sum;
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

bool DeviceScene::hasTubes() const {
    return std::ranges::any_of(groups, [](const StrandGroup& group) {
        return std::ranges::any_of(group.materials,
                                   [](const MaterialOnDevice& m) { return m.shading.tubes; });
    });
}

bool DeviceScene::knowsSections() const {
    return std::ranges::any_of(groups, [](const StrandGroup& group) {
        return std::ranges::any_of(group.materials, [](const MaterialOnDevice& m) {
            return !m.shading.tubes && m.shading.fibre.model == ShadingModel::marschner;
        });
    });
}

std::uint32_t DeviceScene::strandsBefore(std::size_t group) const {
    std::size_t count = 0;
    for (std::size_t g = 0; g < group; ++g) count += groups[g].strandCount;
    return static_cast<std::uint32_t>(count);
}

HairCount DeviceScene::hair() const {
    HairCount count;
    for (const StrandGroup& group : groups) {
        count.strands += group.strandCount;
        count.segments += group.segments;
    }
    return count;
}

std::uint64_t DeviceScene::triangles() const {
    std::uint64_t count = 0;
    for (const MeshOnDevice& mesh : meshes) count += mesh.indices.size() / 3;
    return count;
}

}  // namespace hairloom::render
