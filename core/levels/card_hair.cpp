// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/levels/card_hair.h"

#include <algorithm>
#include <array>

#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/base/stopwatch.h"
#include "core/geometry/closest_point.h"
#include "core/geometry/curve.h"

namespace hairloom {
namespace {

/// Random by strand, the same everywhere.
double randomOf(std::size_t strand, std::uint64_t purpose) {
    return static_cast<double>(Random(purpose, strand).uniform());
}

/// Colours along a strand of its material.
class Painter {
  public:
    Painter(const render::RenderStrands& strands, const render::StrandShading& material)
        : strands_(strands), material_(material) {}

    Vec3f at(std::size_t strand, std::size_t point, float along) const {
        const render::StrandShading& m = material_;
        const Vec3f own = strands_.colours.empty() ? m.albedo : strands_.colours[strand];
        Vec3f colour = own * (m.rootBrightness + along * (m.tipBrightness - m.rootBrightness));
        if (m.look) {
            shading::StrandPlace place;
            place.along = static_cast<double>(along);
            place.random = randomOf(strand, 1);
            if (!strands_.streaks.empty()) place.streak = static_cast<double>(strands_.streaks[strand]);
            if (!strands_.dyes.empty()) place.dye = static_cast<double>(strands_.dyes[strand]);
            if (!strands_.pointDyes.empty()) place.dye *= static_cast<double>(strands_.pointDyes[point]);
            if (!strands_.pigments.empty()) place.pigment = static_cast<double>(strands_.pigments[strand]);
            if (!strands_.lengths.empty()) place.length = static_cast<double>(strands_.lengths[strand]);
            const Vec3d ownColour = own.cast<double>();
            if (!strands_.colours.empty()) place.ownColour = &ownColour;
            colour = shading::colourAt(*m.look, place).cast<float>();
        }
        const float bright = 1 + m.variation * static_cast<float>(2 * randomOf(strand, 2) - 1);
        return (bright * colour).cwiseMax(0.0f).cwiseMin(1.0f);
    }

  private:
    const render::RenderStrands& strands_;
    const render::StrandShading& material_;
};

void addStrand(const render::RenderStrands& strands, std::size_t s, cards::Hair& hair) {
    const std::size_t first = strands.offsets[s], count = strands.offsets[s + 1] - first;
    if (count < 2) return;
    const auto points = strands.positions_ws.subspan(first, count);
    if (!(polylineLength(points) > 0)) return;
    const render::StrandShading* const material = render::shadingOf(strands, s);
    if (!material) return;
    const Painter painter(strands, *material);
    const render::StrandShading& m = *material;
    for (std::size_t i = 0; i < count; ++i) {
        const float along = static_cast<float>(i) / static_cast<float>(count - 1);
        hair.positions_ws.push_back(points[i]);
        const bool own = !strands.radii.empty() && (strands.radiiOfAll || material == &strands.material);
        hair.radii.push_back(own ? strands.radii[first + i] : m.radius * (1 + along * (m.tipScale - 1)));
        hair.albedo.push_back(painter.at(s, first + i, along));
    }
    hair.offsets.push_back(static_cast<std::uint32_t>(hair.positions_ws.size()));
}

void setRootNormals(const Groom& groom, cards::Hair& hair) {
    hair.rootNormals_ws.resize(hair.strandCount());
    if (!groom.scalp) {
        Vec3f middle = Vec3f::Zero();
        for (std::size_t s = 0; s < hair.strandCount(); ++s)
            middle += hair.strand(s)[0] / static_cast<float>(hair.strandCount());
        for (std::size_t s = 0; s < hair.strandCount(); ++s) {
            const Vec3f out = hair.strand(s)[0] - middle;
            hair.rootNormals_ws[s] = out.norm() > 0 ? Vec3f(out.normalized()) : Vec3f::UnitY();
        }
        return;
    }
    const SurfaceTree tree(*groom.scalp, groom.scalpSelection);
    parallelFor(hair.strandCount(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            const auto hit = tree.closest(hair.strand(s)[0]);
            hair.rootNormals_ws[s] = groom.scalp->normalAt(hit.surface.triangle, hit.surface.barycentric);
        }
    });
}

}  // namespace

Result<cards::Hair> cardHair(const Groom& groom) {
    const auto made = GroomScene::make(groom, {}, {});
    if (!made) return tl::unexpected(made.error());
    const render::RenderScene scene = made->scene();
    cards::Hair hair;
    for (const render::RenderStrands& strands : scene.strands) {
        for (std::size_t s = 0; s + 1 < strands.offsets.size(); ++s) addStrand(strands, s, hair);
    }
    if (groom.strandCount() > 0 && hair.strandCount() == 0)
        return fail("all strands are hidden or of no length", "at least two to make cards of");
    hair.specular = 0.32f * groom.material.specular;
    hair.shininess = std::max(1.0f, groom.material.shininess);
    for (const render::RenderMesh& mesh : scene.meshes) {
        hair.headPositions_ws.assign(mesh.positions_ws.begin(), mesh.positions_ws.end());
        hair.headIndices.assign(mesh.indices.begin(), mesh.indices.end());
    }
    setRootNormals(groom, hair);
    if (auto status = cards::check(hair); !status) return tl::unexpected(status.error());
    return hair;
}

double followMilliseconds(const Groom& groom) {
    if (groom.interpolation.followPerGuide == 0) return 0;
    auto scene = GroomScene::make(groom, {}, {});
    if (!scene) return 0;
    std::array<double, 3> times{};
    const std::vector<Vec3f> rest(groom.positions().begin(), groom.positions().end());
    for (double& time : times) {
        const Stopwatch watch;
        scene->pose(rest, {}, {});
        time = 1000 * watch.seconds();
    }
    std::ranges::sort(times);
    return times[1];
}

}  // namespace hairloom
