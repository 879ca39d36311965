// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a picture shows: heads and strands, seen through spans, with camera and lights.

#include <optional>
#include <span>
#include <vector>

#include "core/base/math.h"
#include "core/base/result.h"
#include "core/render/camera.h"
#include "core/render/clumping.h"
#include "core/render/environment.h"
#include "core/render/fibre_material.h"
#include "core/render/light.h"
#include "core/shading/strand_look.h"

namespace hairloom::render {

/// A triangle mesh, shaded as skin.
struct RenderMesh {
    std::span<const Vec3f> positions_ws;
    std::span<const Vec3f> normals_ws;         ///< one a vertex; empty: averaged from the faces
    std::span<const std::uint32_t> indices;    ///< three a triangle
    std::span<const Vec3f> vertexAlbedo;       ///< linear RGB, one a vertex; empty: `albedo`
    Vec3f albedo = Vec3f(0.5f, 0.35f, 0.27f);  ///< linear RGB
    bool matte = false;                        ///< a plain Lambertian: no light under the skin, no highlight
};

/// How strands are drawn: what core/live/hair_look.h makes of an authored material. Colours are linear RGB.
struct StrandShading {
    Vec3f albedo = Vec3f(0.21f, 0.115f, 0.06f);  ///< 0…1; where a strand has no colour of its own
    float radius = 0.00004f;    ///< metres at the root, where points have none; 25–60 µm are human
    float tipScale = 0.3f;      ///< radius at the tip, times that at the root; 0…1
    float radiusVariation = 0;  ///< random spread of the radius from strand to strand, ±, 0…1
    float diffuse = 0.55f;      ///< c_d, 0…1
    Vec3f primary = Vec3f::Constant(0.10f);   ///< c_s of the first highlight, which has the light's colour
    float primaryExponent = 90;               ///< m: higher is narrower, 0…1000
    float primaryShift = 4.0f;                ///< degrees towards the root
    Vec3f secondary = Vec3f::Constant(0.8f);  ///< c_s of the second highlight, times the albedo
    float secondaryExponent = 22;
    float secondaryShift = -6.0f;
    float scattering = 0.55f;      ///< light that other fibres pass on, 0: none
    float rootBrightness = 0.72f;  ///< factor on the albedo at the root
    float tipBrightness = 1.10f;   ///< and at the tip
    float variation = 0.18f;       ///< random brightness per strand, ±
    float axisRatio = 1;    ///< of an elliptic fibre of Kajiya-Kay: strands show different sides of theirs
    bool bounded = true;    ///< no fibre of Kajiya-Kay sends out more light than it gets; false: as published
    float opacity = 0.65f;  ///< 0…1: how much one fibre takes from the light behind it
    float rootOpacity = 1;  ///< 0…1, times how much of a ribbon the hair covers; changes evenly
    float tipOpacity = 1;
    /// Strands are round and have skin, shaded once a pixel: a wrapped diffuse term of the albedo or the
    /// look, and the first highlight.
    bool tubes = false;
    Vec3f fibreColour =
        Vec3f(0.21f, 0.115f, 0.06f);  ///< that much hair of these fibres has, for surfaces told
    FibreMaterial fibre;              ///< which model, and what the others than Kajiya-Kay take
    /// For hair that does not look the same everywhere: in place of albedo and the two brightnesses, or of
    /// the fibre's absorption. Nothing: neither its shader nor its tables are used.
    std::optional<shading::StrandLook> look;
};

inline constexpr std::uint32_t kNotDrawn = 0xffffffff;

/// Strand i has the points offsets[i] … offsets[i + 1] - 1, root first.
struct RenderStrands {
    std::span<const std::uint32_t>
        offsets;  ///< strands + 1, ascending; strands of fewer than 2 points are left out
    std::span<const Vec3f> positions_ws;
    std::span<const float> radii;      ///< metres, one a point, of strands with `material`; empty: from it
    bool radiiOfAll = false;           ///< the radii are those of strands with `others`, too
    std::span<const Vec3f> colours;    ///< albedo, one a strand; empty: from the material
    std::span<const float> streaks;    ///< 0…1, one a strand, for the look; empty: none is in a streak
    std::span<const float> dyes;       ///< 0…1, one a strand, for the look; empty: none is dyed
    std::span<const float> pointDyes;  ///< 0…1, one a point, shares of that; empty: 1 everywhere
    std::span<const float> pigments;   ///< 0…8, one a strand, for the look; empty: 1
    std::span<const float> lengths;    ///< metres, one a strand, for a look whose dye has grown out
    StrandShading material;
    std::vector<StrandShading> others;  ///< what some strands have in its place
    /// One a strand: 0 for `material`, n for the n-th of `others`, kNotDrawn; empty: all have `material`.
    std::span<const std::uint32_t> materials;
};

/// Of strand `s`; null: it is not drawn.
const StrandShading* shadingOf(const RenderStrands& strands, std::size_t s);
/// What shaders/render/curve.comp.hlsl draws, but for the random part of a strand: metres, at point `p` of a
/// strand with this material and the points first … last - 1.
float radiusAt(const RenderStrands& strands, const StrandShading& material, std::uint32_t first,
               std::uint32_t last, std::uint32_t p);

struct RenderScene {
    std::vector<RenderMesh> meshes;
    std::vector<RenderStrands> strands;
    Clumping
        clumping;  ///< of all strands at rest, as measureClumping() finds it; by default of fibres at random
    Camera camera;
    std::vector<Light> lights;  ///< any number: cutLights()
    /// Light from around; by default that of a room under a clear sky.
    Environment environment = Environment::gradient(Vec3f(0.22f, 0.235f, 0.26f), Vec3f(0.11f, 0.10f, 0.09f));
    Vec3f background = Vec3f(0.085f, 0.09f, 0.10f);  ///< linear RGB
};

/// Of the vertices that triangles have; others, as of groups that are hidden, do not count.
Box3f boundsOf(std::span<const Vec3f> positions, std::span<const std::uint32_t> indices);
/// Of all meshes and strands.
Box3f boundsOf(const RenderScene& scene);

/// Errors: indices or offsets outside the arrays, arrays of different lengths, numbers that are not finite
/// (the strand or vertex is named), a camera or light that cannot be.
Status check(const RenderScene& scene);

}  // namespace hairloom::render
