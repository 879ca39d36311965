// SPDX-License-Identifier: GPL-3.0-or-later
#include "exporters/usd_physics.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "hairloom/settings.h"

namespace hairloom {
namespace {

/// A unit vector across another.
Vec3f across(const Vec3f& along) {
    Eigen::Index axis = 0;
    along.cwiseAbs().minCoeff(&axis);
    return along.cross(Vec3f(Vec3f::Unit(axis))).normalized();
}

UsdField number(const char* name, double value) {
    return {"float", name, false, {}, static_cast<float>(value)};
}
UsdField token(const char* name, const char* text) {
    return {"token", name, true, {}, std::string(text)};
}

/// Metres.
double meanThickness(const PreparedStrands& strands, std::span<const ExportedPart> parts) {
    double sum = 0;
    std::size_t count = 0;
    for (const ExportedPart& part : parts) {
        for (const float width : part.widths(strands)) sum += double{width};
        count += part.pointCount;
    }
    return sum / static_cast<double>(count) * double{strands.metresPerUnit};
}

UsdNode materialOf(const runtime::SimulationSettings& settings, double thickness, double metresPerUnit) {
    constexpr double kMostSoft = 1e-6;  // of 1 − s: beyond it hair is as good as rigid
    const double s = static_cast<double>(settings.angularStiffness);
    const double bending = runtime::kHairBendingStiffness * s / std::max(1 - s, kMostSoft);
    // EI/(ρA) of a round fibre is E d²/(16 ρ), and its J is 2 I.
    const double young = 16 * runtime::kHairDensity * bending / (thickness * thickness);
    const double shear = static_cast<double>(settings.torsionRatio) * young / 2;
    UsdNode material{"Material", "hair", {"PhysicsMaterialAPI", "PhysicsCurvesDeformableMaterialAPI"},
                     {},         {},     {}};
    // Forces over areas have a length below, and densities three.
    material.fields = {number("physics:thickness", thickness / metresPerUnit),
                       number("physics:density", runtime::kHairDensity * std::pow(metresPerUnit, 3)),
                       number("physics:dynamicFriction", static_cast<double>(settings.friction)),
                       number("physics:stretchStiffness", runtime::kYoungsModulus * metresPerUnit),
                       number("physics:bendStiffness", young * metresPerUnit),
                       number("physics:twistStiffness", shear * metresPerUnit)};
    return material;
}

UsdNode sceneOf(const runtime::SimulationSettings& settings, const PreparedStrands& strands) {
    StrandExportOptions turned;
    turned.up = strands.up;
    const Vec3f gravity = toFile(Vec3f(settings.gravity.x, settings.gravity.y, settings.gravity.z), turned);
    UsdNode scene{"PhysicsScene", "scene", {}, {}, {}, {}};
    const float strength = gravity.norm();
    scene.fields = {
        {"vector3f",
         "physics:gravityDirection",
         false,
         {},
         Vec3f(strength > 0 ? Vec3f(gravity / strength) : gravity)},
        number("physics:gravityMagnitude", static_cast<double>(strength) / double{strands.metresPerUnit})};
    return scene;
}

}  // namespace

std::vector<Vec3f> framesAlong(std::span<const Vec3f> strand) {
    std::vector<Vec3f> frames;
    Vec3f along = Vec3f::Zero(), normal = Vec3f::Zero();
    for (std::size_t i = 0; i + 1 < strand.size(); ++i) {
        const Vec3f step = strand[i + 1] - strand[i];
        const float length = step.norm();
        if (length > 0) {
            along = step / length;
            const Vec3f carried = normal - normal.dot(along) * along;
            constexpr float kLost = 1e-3f;
            normal = carried.norm() > kLost ? Vec3f(carried.normalized()) : across(along);
        }
        frames.push_back(normal);
    }
    // Behind the last point goes no segment; before the first that has a length any will do.
    frames.push_back(normal);
    for (Vec3f& frame : frames) {
        if (frame.isZero()) frame = Vec3f::UnitX();
    }
    return frames;
}

UsdPhysics usdPhysics(const Groom& groom, const PreparedStrands& strands, std::span<const ExportedPart> parts,
                      const std::string& name) {
    const bool hasGuides = std::ranges::any_of(parts, &ExportedPart::areGuides);
    std::vector<ExportedPart> simulated;
    std::ranges::copy_if(parts, std::back_inserter(simulated),
                         [&](const ExportedPart& part) { return part.areGuides == hasGuides; });
    UsdPhysics made;
    made.beside = {"Scope", name, {}, {}, {}, {}};
    made.beside.children = {
        sceneOf(groom.simulation, strands),
        materialOf(groom.simulation, meanThickness(strands, simulated), double{strands.metresPerUnit})};
    NameGiver names(isLegalInUsd);
    for (const UsdNode& child : made.beside.children) names.reserve(child.name);
    for (const ExportedPart& part : parts) {
        UsdNode& more = made.ofParts.emplace_back();
        if (part.areGuides != hasGuides) continue;
        more.schemas = {"PhysicsDeformableBodyAPI", "PhysicsCurvesDeformableSimAPI"};
        more.targets = {{"material:binding:physics", "/groom/" + name + "/hair"}};
        UsdNode roots{"PhysicsAttachment", names.give(part.name), {}, {}, {}, {}};
        std::vector<std::int32_t> held;
        std::vector<Vec3f> places, normals;
        for (std::size_t s = part.firstStrand; s < part.firstStrand + part.strandCount; ++s) {
            const std::size_t first = strands.offsets[s], count = strands.offsets[s + 1] - first;
            const auto points = std::span(strands.positions).subspan(first, count);
            const std::size_t clamped = std::min<std::size_t>(groom.simulation.clampedPoints, count);
            for (std::size_t p = 0; p < clamped; ++p) {
                held.push_back(static_cast<std::int32_t>(first + p - part.firstPoint));
                places.push_back(points[p]);
            }
            for (const Vec3f& normal : framesAlong(points)) normals.push_back(normal);
        }
        const auto all = part.points(strands.positions);
        more.fields = {
            {"normal3f[]", "normals", false, "vertex", normals},
            {"point3f[]", "physics:restShapePoints", false, {}, std::vector<Vec3f>(all.begin(), all.end())},
            {"normal3f[]", "physics:restNormals", false, {}, normals}};
        roots.targets = {{"physics:src0", "/groom/" + part.name}, {"physics:src1", "/groom"}};
        roots.fields = {token("physics:type0", "point"),
                        token("physics:type1", "xform"),
                        {"int[]", "physics:indices0", false, {}, std::move(held)},
                        {"vector3f[]", "physics:coords1", false, {}, std::move(places)}};
        made.beside.children.push_back(std::move(roots));
    }
    return made;
}

}  // namespace hairloom
