// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A head that moves on the device: its vertices on their bones (linear blend skinning), and the roots of
// strands on them. Bones go up each frame, and vertices where morph targets move them; nothing comes back.

#include <memory>
#include <span>
#include <vector>

#include "core/animation/skinning.h"
#include "core/geometry/scalp_mesh.h"
#include "core/gpu_simulation/strand_engine.h"

namespace hairloom::gpu_simulation {

/// What a head is at rest. The mesh is kept, nothing of the spans.
struct HeadAtRest {
    std::shared_ptr<const ScalpMesh> mesh;  ///< null: roots alone
    const SkinWeights* skin = nullptr;      ///< of its vertices; null: all go with the first bone
    std::span<const Vec3f> roots;           ///< first points of the strands
    /// Of these; empty: roots go with the first bone, rigidly. Read where there is a skin.
    std::span<const SurfacePoint> bindings;
};

class GpuHead {
  public:
    /// Errors: what the device says.
    static Result<GpuHead> make(gpu::Device& device, const HeadAtRest& head);

    /// Records vertices and roots of this moment, outside a pass. `bones_ws`: from the head at rest to the
    /// world, as many as the skin has, or one. `morphed_ss`: the vertices before bones move them, or empty
    /// where no morph target does. Before the first record() all is at rest. Errors: what the device says of
    /// memory for the first vertices that are morphed.
    Status record(gpu::CommandList& list, std::span<const Eigen::Affine3f> bones_ws,
                  std::span<const Vec3f> morphed_ss = {});

    /// Of the last record(), in the form that StrandEngine takes; valid while this lives.
    const DeviceRoots& roots() const { return roots_; }
    /// Three floats a vertex; null without a mesh.
    const gpu::BufferPtr& positions_ws() const { return positions_; }
    const gpu::BufferPtr& normals_ws() const { return normals_; }
    /// Holds all vertices of the last record(); empty without a mesh.
    const Box3f& bounds_ws() const { return bounds_; }

  private:
    Status makeBuffers(gpu::Device& device, const HeadAtRest& head);
    void measure(const HeadAtRest& head);
    void follow(std::span<const Eigen::Affine3f> bones_ws, std::span<const Vec3f> morphed_ss);
    /// What morph targets do in a frame; metres in the head's rest space.
    struct Morphing {
        bool changes = false;   ///< since the frame before
        float wayOfRoots = 0;   ///< since then, the longest
        float rootsOff = 0;     ///< from rest at most, in this frame and the one before
        float verticesOff = 0;  ///< from rest at most
    };
    Morphing morph(std::span<const Vec3f> morphed_ss);
    Status upload(gpu::CommandList& list);

    gpu::Device* device_ = nullptr;
    std::shared_ptr<const ScalpMesh> mesh_;
    std::uint32_t vertexCount_ = 0, rootCount_ = 0, boneCount_ = 1;
    bool skinned_ = false, bound_ = false;
    std::vector<Eigen::Affine3f> bones_;          // of the last frame; one that stays at rest stands last
    std::vector<Box3f> vertexBoxes_, rootBoxes_;  // at rest, of what each bone has a share of
    std::vector<std::uint32_t> rootVertices_;     // corners of the triangles of bound roots, each once
    std::vector<Vec3f> morphed_ss_;               // of the last frame; empty: at rest
    gpu::BufferPtr bonesBuffer_, rest_, restNormals_, boneOf_, weights_, rootsAtRest_, positions_, normals_,
        frames_;
    gpu::BufferPtr morphed_, morphedNormals_;  // from the first frame on in which morph targets move vertices
    gpu::ComputePipelinePtr vertexKernel_, rootKernel_;
    DeviceRoots roots_;
    Box3f bounds_;
};

}  // namespace hairloom::gpu_simulation
