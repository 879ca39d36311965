// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Meshes and strands on the device, and what of them has changed.

#include <map>
#include <span>

#include "core/gpu/device.h"
#include "core/render/fibre_bake.h"
#include "core/render/opacity_layers.h"
#include "core/render/scene.h"
#include "shaders/shared/render_types.h"

namespace hairloom::render {

/// How much of the hair is drawn, and how fine.
struct HairDetail {
    std::uint32_t subdivisions = 1;  ///< curve segments per segment of a strand
    /// Strands stand in an order of chance; those in the first `share` of it are drawn. Between 0.9 and 1.1
    /// of it they grow thinner, so that none comes or goes at once. From 1 / 0.9 on all are drawn.
    float share = 2;

    bool operator==(const HairDetail&) const = default;
    /// What the strands that are drawn must be widened by to cover what all would.
    float widening() const;
};

/// Strands of one material in a part of a group that fits the device's buffers.
struct DrawBatch {
    std::size_t group = 0;     ///< of RenderScene::strands
    std::size_t material = 0;  ///< of its group's
    /// It has the points of the batch before it, of which that one draws strands of another material.
    bool sharesPoints = false;
    std::size_t firstPoint = 0;  ///< in the group's arrays
    std::size_t pointCount = 0;
    std::vector<std::uint32_t>
        segmentsBefore;  ///< each strand, as given, in the order of drawing; then of all
    gpu::BufferPtr headers, positions, radii, pointDyes;
    gpu::BufferPtr curve, colour;                     ///< hold what `curveSubdivisions` calls for
    gpu::BufferPtr litColour;                         ///< the same without shadows, once it was asked for
    gpu::BufferPtr seen;                              ///< of the sky, once it was asked for
    gpu::BufferPtr across;                            ///< light over the width, once it was asked for
    gpu::BufferPtr albedo, past;                      ///< and curves of a frame ago, likewise
    std::uint32_t pastSubdivisions = 0;               ///< 0: none were recorded
    std::uint32_t pastStrands = 0;                    ///< that were
    std::map<std::uint32_t, gpu::BufferPtr> indices;  ///< of the ribbons, by subdivisions
    gpu::BufferPtr patches;                           ///< of tessellated ribbons, once these were asked for
    std::vector<std::uint32_t> patchesBefore;         ///< each strand; then of all
    std::uint32_t curveSubdivisions = 0;

    std::uint32_t strandCount() const { return static_cast<std::uint32_t>(segmentsBefore.size() - 1); }
    std::uint32_t strandCount(const HairDetail& detail) const;  ///< that are drawn
    std::uint32_t curvePoints(std::uint32_t strands, std::uint32_t subdivisions) const {
        return segmentsBefore[strands] * subdivisions + strands;
    }
    std::uint32_t indexCount(std::uint32_t strands, std::uint32_t subdivisions) const {
        return 2 * curvePoints(strands, subdivisions) + strands;
    }
};

struct MaterialOnDevice {
    StrandShading shading;
    FibreTables fibre;  ///< once they were asked for
    bool hasFibre = false;
    FibreBake bake;        ///< of tables that shall take their place
    double length = 0;     ///< metres of its strands together, where they stood when they were set
    double ownRadius = 0;  ///< metres, mean along the strands, where their points have their own
    std::vector<shaders::StrandHeader>
        someStrands;              ///< by chance, for means of the look; points of the group
    std::vector<float> someDyes;  ///< of these, mean of what their points have of the dye
};

struct StrandGroup {
    StrandGroup() = default;
    StrandGroup(StrandGroup&&) = default;  // a bake that runs has no copy
    StrandGroup& operator=(StrandGroup&&) = default;

    std::vector<MaterialOnDevice> materials;
    std::size_t strandCount = 0;  ///< also those too short to be drawn
    std::size_t pointCount = 0;
    bool hasRadii = false, radiiOfAll = false;
    bool hasRadiiOf(std::size_t material) const { return hasRadii && (radiiOfAll || material == 0); }
    std::vector<float> radii;  ///< waiting for their upload
    bool hasPointDyes = false;
    std::vector<float> pointDyes;     ///< waiting for their upload
    std::vector<Vec3f> positions_ws;  ///< waiting for their upload
    gpu::BufferPtr devicePositions;   ///< of all points, in place of the batches' own
    /// Of their content in single floats, as Direct3D's shaders see it: a buffer has one size of elements
    /// there. Null where devicePositions themselves can be read so.
    gpu::BufferPtr deviceFloats;
    std::uint32_t floatsPerPoint = 3;  ///< of devicePositions: 3 or 4
    Box3f bounds_ws;
    double length = 0;  ///< metres of all strands together, where they stood when they were set
    std::size_t segments = 0;
    std::vector<Vec3f> sample_ws;        ///< points that lights are fitted to
    std::vector<std::uint32_t> sampled;  ///< their places among the group's points
};

/// How hair fills space, measured where the strands stood when they were set.
struct HairMeasure {
    float diameter = 0;        ///< metres, mean
    float segment = 0;         ///< metres, mean length of one
    float fibresPerMetre = 0;  ///< that a ray crosses inside hair, mean
    float fibresThrough = 0;   ///< that a ray crosses from side to side, mean
};

struct MeshOnDevice {
    std::vector<std::uint32_t> indices;
    std::size_t vertexCount = 0;
    std::vector<Vec3f> positions_ws, normals_ws;  ///< waiting for their upload
    gpu::BufferPtr positions, normals, indexBuffer, albedo;
    gpu::BufferPtr devicePositions, deviceNormals;  ///< in place of its own
    gpu::BufferPtr past;                            ///< positions a frame ago, once they were asked for
    bool hasPast = false;                           ///< these were recorded
    Box3f bounds_ws;
    bool hasLooseVertices = false;  ///< that no triangle has
    bool matte = false;
    std::vector<float>
        areas;       ///< m² of each vertex, a third of its triangles', where it stood when it was set
    float area = 0;  ///< of all of them
    Vec3f meanAlbedo = Vec3f::Zero();

    const gpu::BufferPtr& drawnPositions() const { return devicePositions ? devicePositions : positions; }
    const gpu::BufferPtr& drawnNormals() const { return devicePositions ? deviceNormals : normals; }
};

class DeviceScene {
  public:
    static Result<DeviceScene> upload(gpu::Device& device, const RenderScene& scene);

    Status replaceMesh(std::size_t mesh, std::span<const Vec3f> positions_ws,
                       std::span<const Vec3f> normals_ws);
    Status replaceMesh(std::size_t mesh, gpu::BufferPtr positions_ws, gpu::BufferPtr normals_ws,
                       const Box3f& bounds_ws);
    Status replaceMeshAlbedo(gpu::Device& device, std::size_t mesh, std::span<const Vec3f> albedo);
    Status replaceStrands(std::size_t group, std::span<const Vec3f> positions_ws);
    Status replacePointDyes(std::size_t group, std::span<const float> dyes);
    Status replaceRadii(std::size_t group, std::span<const float> radii);
    Status replaceStrands(gpu::Device& device, std::size_t group, gpu::BufferPtr positions_ws,
                          std::uint32_t floatsPerPoint, const Box3f& bounds_ws,
                          std::span<const Vec3f> sample_ws);

    /// Makes room for curves of that fineness, `twice` for their light with shadows and without, and for what
    /// their points see of the `sky`; nothing happens when there is.
    Status prepareCurves(gpu::Device& device, std::uint32_t subdivisions, bool twice = false,
                         bool sky = false);
    /// Makes room for light over the width of hair where that is wanted, or takes it away; prepareCurves()
    /// comes before. True: some is new, and holds nothing.
    Result<bool> prepareAcross(gpu::Device& device, bool wanted);
    /// Makes room for what Pass::surface tells; nothing happens when there is. prepareCurves() comes before.
    Status prepareSurface(gpu::Device& device);
    /// Bakes the tables of materials that have changed. `behind`: on another thread, while those that are
    /// there serve; only where there are some and hair varies in both or in neither. True: tables are new.
    Result<bool> prepareFibres(gpu::Device& device, bool behind);
    /// Tables of materials as they are now are still to come.
    bool awaitsFibres() const;
    /// Makes the patches of tessellated ribbons; nothing happens when they are there.
    Status preparePatches(gpu::Device& device);
    /// Records the uploads that wait.
    void recordUploads(gpu::CommandList& list);

    /// Mean albedo of all meshes.
    Vec3f groundAlbedo() const;
    Box3f meshBounds() const;
    Box3f hairBounds() const;
    std::uint64_t triangles() const;
    HairCount hair() const;
    const MaterialOnDevice& materialOf(const DrawBatch& batch) const {
        return groups[batch.group].materials[batch.material];
    }
    bool hasTubes() const;
    /// Of some hair is known which side of it is brighter.
    bool knowsSections() const;
    std::uint32_t strandsBefore(std::size_t group) const;  ///< in all groups before that one
    std::vector<Vec3f> sample()
        const;  ///< of the points of all hair; corners of its bounds where only those are known

    std::vector<MeshOnDevice> meshes;
    std::vector<StrandGroup> groups;
    std::vector<DrawBatch> batches;
    Clumping clumping;
    /// With the radii of now.
    HairMeasure measure() const;
    /// What the hair of the first group lets through to the skin, by the material that has most of it;
    /// prepareFibres() comes before.
    HairFlux flux() const;

  private:
    void measureSpace(const RenderScene& scene);

    double hairVolume_ = 0;  ///< m³ that hair is in, where it stood when it was set
    double hairShadow_ = 0;  ///< m² that it shades, mean of the axes
};

}  // namespace hairloom::render
