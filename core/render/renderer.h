// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Pictures frame after frame: what has not changed since the last frame is not done again.
//
// A scene goes to the device once; then positions, materials, camera, lights and marks are replaced one by
// one, and options come with each frame. record() writes commands and does not wait for the device; the times
// of its passes are Submission::passTimes() of the list that it recorded into. In steady state (same scene,
// options and target format) it creates nothing on the device. Used from one thread at a time, as the device
// is.

#include <memory>
#include <span>

#include "core/render/options.h"
#include "core/render/overlay.h"
#include "core/render/plan.h"
#include "core/render/scene.h"

namespace hairloom::gpu {
class CommandList;
class Device;
}  // namespace hairloom::gpu

namespace hairloom::render {

class Renderer {
  public:
    /// `device` outlives the renderer.
    explicit Renderer(gpu::Device& device);
    ~Renderer();
    Renderer(Renderer&& other) noexcept;
    Renderer& operator=(Renderer&& other) noexcept;

    /// Takes all of the scene to the device; nothing of its spans is kept. Errors: as check(RenderScene), and
    /// what the device reports; the scene is then empty.
    Status setScene(const RenderScene& scene);

    // What follows replaces parts of the scene. Each takes effect with the next record() and keeps what was
    // there when it fails: arrays of another length, numbers that are not finite, no such mesh or group.

    /// One position a vertex of RenderScene::meshes[mesh]. Without normals they are averaged from the faces.
    Status setMeshPositions(std::size_t mesh, std::span<const Vec3f> positions_ws,
                            std::span<const Vec3f> normals_ws = {});
    /// The same from buffers that the device itself writes, three floats a vertex.
    Status setMeshPositions(std::size_t mesh, gpu::BufferPtr positions_ws, gpu::BufferPtr normals_ws,
                            const Box3f& bounds_ws);
    /// One linear RGB a vertex of RenderScene::meshes[mesh].
    Status setMeshAlbedo(std::size_t mesh, std::span<const Vec3f> albedo);
    /// One position a point of RenderScene::strands[group], strand after strand as its offsets say.
    Status setStrandPositions(std::size_t group, std::span<const Vec3f> positions_ws);
    /// The same from a buffer that the device itself writes, in the same order, 3 or 4 floats a point (a
    /// fourth is ignored). Call it again whenever the content has changed. `bounds_ws` holds all points:
    /// depth is fitted to it, and light to `sample_ws`, points in which the hair is, or the bounds where it
    /// is empty.
    Status setStrandPositions(std::size_t group, gpu::BufferPtr positions_ws, std::uint32_t floatsPerPoint,
                              const Box3f& bounds_ws, std::span<const Vec3f> sample_ws = {});
    /// Metres, one a point, where RenderStrands::radii had some. Errors: another number, one that is not 0 to
    /// 1 m.
    Status setRadii(std::size_t group, std::span<const float> radii);
    /// One share of the dye a point, where RenderStrands::pointDyes had some.
    Status setPointDyes(std::size_t group, std::span<const float> dyes);
    /// `others`: as many as RenderStrands::others had.
    Status setMaterial(std::size_t group, const StrandShading& material,
                       std::span<const StrandShading> others = {});
    /// `cut`: it has not moved there, and velocities tell nothing of it.
    Status setCamera(const Camera& camera, bool cut = false);
    Status setLights(std::span<const Light> lights);
    void setEnvironment(const Environment& environment);
    void setBackground(const Vec3f& linear);
    /// Does not restart the average: marks are drawn over the finished picture.
    Status setOverlay(Overlay overlay);

    /// Records what this frame needs: uploads and preparation where something changed, one more frame of the
    /// average unless it has `options.frames` already, and, where there is a target, the picture with its
    /// marks. The average starts anew when anything but the overlay or the exposure has changed. The target
    /// has one sample a pixel, the options' size and any colour format; floats get the values that 8 bits
    /// would be rounded from. Errors: as check(RenderOptions), a target of another size, what the device
    /// reports. Some errors only show when the list is submitted.
    Status record(gpu::CommandList& list, const RenderOptions& options, const gpu::TexturePtr& target);

    /// Takes hair, head and camera as they stand for those of a frame ago, which SurfacePixel's velocity
    /// counts from; without it, and after setScene(), it is 0. `options` as those of the next record().
    Status recordPast(gpu::CommandList& list, const RenderOptions& options);

    /// Forgets the average, as after a change.
    void restart();
    /// What the last record() recorded was not done, but for its uploads, or not to the end: the next does
    /// it.
    void takeBack();
    /// While true, maps of light that are there are not drawn anew for hair, head or lights that have moved:
    /// lights stay where they were. Once it is false they are.
    void holdMaps(bool on);
    /// While true, no frame joins an average that has one: record() shows it with its marks.
    void holdAverage(bool on);
    /// Frames in the average, 0 before the first.
    std::uint32_t accumulated() const;
    /// 255ths by which the view of the last options may be shown wrongly (DisplayTable::worst); 0 without
    /// one.
    int displayError() const;
    /// False while tables are baked behind (RenderOptions::bakeBehind): a later frame restarts the average.
    bool isSettled() const;
    /// Sum of accumulated() frames: linear RGB before exposure, and coverage; four floats a pixel, the upper
    /// row first.
    const gpu::BufferPtr& linearSum() const;
    /// shaders::SurfacePixel a pixel, the upper row first, of the middle of pixels that no average moves;
    /// null where the options have no `surface`. Hair counts where its ribbon, at least a pixel wide, covers
    /// that middle.
    const gpu::BufferPtr& surface() const;

    /// Of adaptive shadow maps, two a map, those of the lights in their order and then close ones: pieces of
    /// hair in its texels, and those that its lists took; null for other shadows.
    const gpu::BufferPtr& fragmentCounts() const;

    Box3f bounds() const;  ///< of all meshes and strands
    std::uint64_t triangles() const;
    std::uint64_t strands() const;      ///< drawn in the last frame
    std::uint64_t curvePoints() const;  ///< of these
    /// Of the last frame.
    const RenderPlan& plan() const;

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace hairloom::render
