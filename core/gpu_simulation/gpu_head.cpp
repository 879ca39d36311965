// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/gpu_simulation/gpu_head.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "core/animation/morphs.h"
#include "core/gpu_simulation/compiled_kernel.h"
#include "core/gpu_simulation/strand_batch.h"
#include "runtime/shaders/live_types.h"

namespace hairloom::gpu_simulation {
namespace {

using gpu::Binding;
using gpu::Usage;

constexpr Usage kReadWrite = Usage::ShaderRead | Usage::UnorderedAccess;

std::uint32_t groupsOf(std::uint32_t count) {
    return (count + HAIRLOOM_LIVE_GROUP - 1) / HAIRLOOM_LIVE_GROUP;
}

Vec3f cornerOf(const Box3f& box, int corner) {
    return box.corner(static_cast<Box3f::CornerType>(corner));
}

Box3f grown(const Box3f& box, float by) {
    const Vec3f around = Vec3f::Constant(by);
    return box.isEmpty() ? box : Box3f(box.min() - around, box.max() + around);
}

/// Where the box of a bone's share may be, of points that are so far from it at most: linear blends lie
/// between what the bones alone would make.
Box3f movedBox(std::span<const Box3f> boxes, std::span<const Eigen::Affine3f> bones, float off) {
    Box3f all;
    for (std::size_t b = 0; b < boxes.size(); ++b) {
        const Box3f box = grown(boxes[b], off);
        for (int i = 0; i < 8 && !box.isEmpty(); ++i) all.extend(bones[b] * cornerOf(box, i));
    }
    return all;
}

/// The farthest that a way can become when bones turn and scale it.
float stretchOf(std::span<const Eigen::Affine3f> bones) {
    float most = 0;
    for (const Eigen::Affine3f& bone : bones) most = std::max(most, bone.linear().norm());
    return most;
}

runtime::Float3 toFloat3(const Vec3f& v) {
    return {v.x(), v.y(), v.z()};
}

}  // namespace

void GpuHead::measure(const HeadAtRest& head) {
    vertexBoxes_.assign(boneCount_ + 1, {});
    rootBoxes_.assign(boneCount_ + 1, {});
    const auto addVertex = [&](std::vector<Box3f>& boxes, std::uint32_t vertex, const Vec3f& position) {
        if (!skinned_) return void(boxes[0].extend(position));
        float sum = 0;
        for (std::size_t slot = 0; slot < 4; ++slot) {
            const float weight = head.skin->weights[vertex][slot];
            if (weight > 0) boxes[head.skin->bones[vertex][slot]].extend(position);
            sum += weight;
        }
        if (sum == 0) boxes[boneCount_].extend(position);
    };
    for (std::uint32_t v = 0; v < vertexCount_; ++v) addVertex(vertexBoxes_, v, head.mesh->positions()[v]);
    for (std::size_t r = 0; r < head.roots.size(); ++r) {
        if (!bound_) {
            rootBoxes_[0].extend(head.roots[r]);
            continue;
        }
        for (const std::uint32_t vertex : head.mesh->triangles()[head.bindings[r].triangle]) {
            addVertex(rootBoxes_, vertex, head.mesh->positions()[vertex]);
            rootVertices_.push_back(vertex);
        }
    }
    std::ranges::sort(rootVertices_);
    rootVertices_.erase(std::unique(rootVertices_.begin(), rootVertices_.end()), rootVertices_.end());
}

Status GpuHead::makeBuffers(gpu::Device& device, const HeadAtRest& head) {
    Status status;
    const auto keep = [&](gpu::BufferPtr& buffer, Result<gpu::BufferPtr> made) {
        if (status && made) buffer = std::move(*made);
        if (status && !made) status = tl::unexpected(made.error());
    };
    static_assert(kBonesOfVertex == 8);  // as head_vertices.comp.hlsl reads them
    std::vector<shaders::uint4> boneOf(2);
    std::vector<shaders::float4> weights(2);
    if (skinned_) {
        boneOf.clear();
        weights.clear();
        for (std::uint32_t v = 0; v < vertexCount_; ++v) {
            const auto& bones = head.skin->bones[v];
            const auto& w = head.skin->weights[v];
            // What no bone moves is on one that stays.
            const bool moves = std::ranges::any_of(w, [](float weight) { return weight > 0; });
            boneOf.push_back(moves ? shaders::uint4{bones[0], bones[1], bones[2], bones[3]}
                                   : shaders::uint4{boneCount_, boneCount_, boneCount_, boneCount_});
            weights.push_back(moves ? shaders::float4{w[0], w[1], w[2], w[3]} : shaders::float4{1, 0, 0, 0});
            boneOf.push_back({bones[4], bones[5], bones[6], bones[7]});
            weights.push_back({w[4], w[5], w[6], w[7]});
        }
    }
    std::vector<shaders::HeadRoot> roots;
    for (std::size_t r = 0; r < head.roots.size(); ++r) {
        shaders::HeadRoot root;
        root.rest = {head.roots[r].x(), head.roots[r].y(), head.roots[r].z(), 1};
        if (bound_) {
            const Vec3f& b = head.bindings[r].barycentric;
            const Triangle& triangle = head.mesh->triangles()[head.bindings[r].triangle];
            root.barycentric = {b.x(), b.y(), b.z(), 0};
            root.corners = {triangle[0], triangle[1], triangle[2], 0};
        }
        roots.push_back(root);
    }
    const std::size_t floats = std::max<std::size_t>(std::size_t{vertexCount_} * 3, 1);
    const std::vector<float> nothing(floats);
    const auto floatsOf = [&](std::span<const Vec3f> values) {
        return values.empty() ? std::span<const float>(nothing)
                              : std::span<const float>(values.front().data(), values.size() * 3);
    };
    const auto positions = head.mesh ? head.mesh->positions() : std::span<const Vec3f>();
    const auto normals = head.mesh ? head.mesh->normals() : std::span<const Vec3f>();
    keep(bonesBuffer_, makeBuffer<shaders::float4>(device, "bones", Usage::ShaderRead,
                                                   std::size_t{boneCount_ + 1} * 3, {}));
    keep(rest_, makeBuffer<float>(device, "head at rest", Usage::ShaderRead, floats, floatsOf(positions)));
    keep(restNormals_,
         makeBuffer<float>(device, "normals at rest", Usage::ShaderRead, floats, floatsOf(normals)));
    keep(boneOf_,
         makeBuffer<shaders::uint4>(device, "bones of vertices", Usage::ShaderRead, boneOf.size(), boneOf));
    keep(weights_, makeBuffer<shaders::float4>(device, "weights of vertices", Usage::ShaderRead,
                                               weights.size(), weights));
    keep(rootsAtRest_,
         makeBuffer<shaders::HeadRoot>(device, "roots at rest", Usage::ShaderRead, roots.size(), roots));
    keep(positions_, makeBuffer<float>(device, "head", kReadWrite, floats, floatsOf(positions)));
    keep(normals_, makeBuffer<float>(device, "normals of the head", kReadWrite, floats, floatsOf(normals)));
    keep(frames_, makeBuffer<shaders::float4>(device, "roots", kReadWrite, roots.size() * 2, {}));
    return status;
}

Result<GpuHead> GpuHead::make(gpu::Device& device, const HeadAtRest& head) {
    assert(!head.roots.empty());
    GpuHead made;
    made.device_ = &device;
    made.mesh_ = head.mesh;
    made.rootCount_ = static_cast<std::uint32_t>(head.roots.size());
    made.vertexCount_ = head.mesh ? static_cast<std::uint32_t>(head.mesh->vertexCount()) : 0;
    made.skinned_ = head.mesh != nullptr && head.skin != nullptr;
    made.bound_ = made.skinned_ && !head.bindings.empty();
    if (made.skinned_) {
        for (const auto& bones : head.skin->bones)
            made.boneCount_ = std::max(made.boneCount_, *std::ranges::max_element(bones) + 1);
    }
    made.measure(head);
    if (auto buffers = made.makeBuffers(device, head); !buffers) return tl::unexpected(buffers.error());
    made.roots_.frames_ws = made.frames_;
    for (auto& [kernel, name] :
         {std::pair{&made.vertexKernel_, "head_vertices"}, {&made.rootKernel_, "head_roots"}}) {
        auto compiled = compiledKernel(device, name);
        if (!compiled) return tl::unexpected(compiled.error());
        *kernel = std::move(*compiled);
    }
    return made;
}

/// Keeps what morph targets make of the vertices.
GpuHead::Morphing GpuHead::morph(std::span<const Vec3f> morphed_ss) {
    Morphing morphing;
    if (morphed_ss_.empty() && morphed_ss.empty()) return morphing;
    const auto rest = mesh_->positions();
    const auto was = morphed_ss_.empty() ? rest : std::span<const Vec3f>(morphed_ss_);
    const auto is = morphed_ss.empty() ? rest : morphed_ss;
    assert(is.size() == rest.size());
    morphing.changes = !std::ranges::equal(was, is);
    for (const std::uint32_t v : rootVertices_) {
        morphing.wayOfRoots = std::max(morphing.wayOfRoots, (is[v] - was[v]).norm());
        morphing.rootsOff =
            std::max(morphing.rootsOff, std::max((is[v] - rest[v]).norm(), (was[v] - rest[v]).norm()));
    }
    for (std::uint32_t v = 0; v < vertexCount_; ++v)
        morphing.verticesOff = std::max(morphing.verticesOff, (is[v] - rest[v]).norm());
    morphed_ss_.assign(morphed_ss.begin(), morphed_ss.end());
    return morphing;
}

/// Boxes and the longest way of a root; whether any bone or vertex has moved.
void GpuHead::follow(std::span<const Eigen::Affine3f> bones_ws, std::span<const Vec3f> morphed_ss) {
    std::vector<Eigen::Affine3f> now(boneCount_ + 1, Eigen::Affine3f::Identity());
    for (std::size_t b = 0; b < boneCount_; ++b) now[b] = bones_ws[std::min(b, bones_ws.size() - 1)];
    const bool isFirst = bones_.empty();
    const Morphing morphing = morph(morphed_ss);
    roots_.moved = isFirst || morphing.changes;
    roots_.motion = 0.0f;
    for (std::size_t b = 0; b < now.size() && !isFirst; ++b) {
        if (now[b].matrix() == bones_[b].matrix()) continue;
        roots_.moved = true;
        // The way of a point is a convex function of its position, so that none goes farther than a corner.
        const Box3f box = grown(rootBoxes_[b], morphing.rootsOff);
        for (int i = 0; i < 8 && !box.isEmpty(); ++i) {
            const Vec3f corner = cornerOf(box, i);
            roots_.motion = std::max(roots_.motion, (now[b] * corner - bones_[b] * corner).norm());
        }
    }
    if (!isFirst && morphing.wayOfRoots > 0) roots_.motion += morphing.wayOfRoots * stretchOf(now);
    bones_ = std::move(now);
    bounds_ = movedBox(vertexBoxes_, bones_, morphing.verticesOff);
    const Box3f roots = movedBox(rootBoxes_, bones_, morphing.rootsOff);
    roots_.min_ws = toFloat3(roots.min());
    roots_.max_ws = toFloat3(roots.max());
}

/// Vertices and normals before bones move them, where morph targets do.
Status GpuHead::upload(gpu::CommandList& list) {
    if (morphed_ss_.empty()) return {};
    const std::size_t floats = std::size_t{vertexCount_} * 3;
    for (auto& [buffer, name] :
         {std::pair{&morphed_, "morphed head"}, {&morphedNormals_, "morphed normals"}}) {
        if (*buffer != nullptr) continue;
        auto made = makeBuffer<float>(*device_, name, Usage::ShaderRead, floats, {});
        if (!made) return tl::unexpected(made.error());
        *buffer = std::move(*made);
    }
    list.updateBuffer(morphed_, 0, std::as_bytes(std::span(morphed_ss_)));
    const std::vector<Vec3f> normals = morphedNormals(*mesh_, morphed_ss_);
    list.updateBuffer(morphedNormals_, 0, std::as_bytes(std::span(normals)));
    return {};
}

Status GpuHead::record(gpu::CommandList& list, std::span<const Eigen::Affine3f> bones_ws,
                       std::span<const Vec3f> morphed_ss) {
    assert(!bones_ws.empty());
    follow(bones_ws, morphed_ss);
    if (!roots_.moved) return {};
    if (auto uploaded = upload(list); !uploaded) return uploaded;
    const bool isMorphed = !morphed_ss_.empty();
    std::vector<shaders::float4> rows;
    for (const Eigen::Affine3f& bone : bones_) {
        for (int r = 0; r < 3; ++r) {
            const auto row = bone.matrix().row(r);
            rows.push_back({row[0], row[1], row[2], row[3]});
        }
    }
    list.updateBuffer(bonesBuffer_, 0, std::as_bytes(std::span(rows)));
    const Quatf turn = Quatf(bones_.front().linear()).normalized();
    shaders::HeadConstants constants{
        vertexCount_, skinned_ ? 1u : 0u, bound_ ? 1u : 0u, 0, {turn.x(), turn.y(), turn.z(), turn.w()}};
    gpu::PassDesc pass;
    pass.name = "head";
    list.beginPass(pass);
    if (vertexCount_ > 0) {
        list.setPipeline(vertexKernel_);
        const std::array<Binding, 7> bound{Binding::read(0, bonesBuffer_),
                                           Binding::read(1, isMorphed ? morphed_ : rest_),
                                           Binding::read(2, isMorphed ? morphedNormals_ : restNormals_),
                                           Binding::read(3, boneOf_),
                                           Binding::read(4, weights_),
                                           Binding::write(0, positions_),
                                           Binding::write(1, normals_)};
        list.bind(bound);
        list.setConstants(0, gpu::bytesOf(constants));
        list.dispatch(groupsOf(vertexCount_));
    }
    list.endPass();
    pass.name = "roots";
    list.beginPass(pass);
    constants.count = rootCount_;
    list.setPipeline(rootKernel_);
    const std::array<Binding, 5> bound{Binding::read(0, bonesBuffer_), Binding::read(1, rootsAtRest_),
                                       Binding::read(2, rest_), Binding::read(3, positions_),
                                       Binding::write(0, frames_)};
    list.bind(bound);
    list.setConstants(0, gpu::bytesOf(constants));
    list.dispatch(groupsOf(rootCount_));
    list.endPass();
    return {};
}

}  // namespace hairloom::gpu_simulation
