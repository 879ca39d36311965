// SPDX-License-Identifier: GPL-3.0-or-later
#include "samples/bust/spheres.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "samples/bust/rig.h"

namespace hairloom::bust {
namespace {

constexpr double kGrid = 0.006;
constexpr double kWantedDepth = 0.005;  ///< of the spheres below the scalp
constexpr int kHeadSpheres = 10;

double rounded(double metres) {
    return std::round(metres * 1e4) / 1e4;
}

/// Largest radius at a centre for which the sphere stands out by no more than kProtrusion.
double radiusAt(const Vec3d& centre, const PatchMesh& mesh) {
    double nearest = 1e9;
    for (const Vec3d& p : mesh.positions) nearest = std::min(nearest, (p - centre).norm());
    return std::floor((nearest + 0.9 * kProtrusion) * 1e4) / 1e4;
}

std::vector<Vec3d> scalpPoints(const PatchMesh& mesh) {
    std::vector<Vec3d> points;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (mesh.patches[t] != Patch::Scalp) continue;
        const auto& v = mesh.triangles[t];
        points.push_back((mesh.positions[v[0]] + mesh.positions[v[1]] + mesh.positions[v[2]]) / 3.0);
    }
    return points;
}

struct Candidate {
    Vec3d centre;
    double radius;
};

/// Centres with x >= 0 inside the head.
std::vector<Candidate> candidates(const PatchMesh& mesh) {
    std::vector<Candidate> result;
    for (double x = 0.0; x < 0.07; x += kGrid) {
        for (double y = -0.09; y < 0.1; y += kGrid) {
            for (double z = -0.09; z < 0.09; z += kGrid) {
                const Vec3d centre(rounded(x), rounded(kEyeHeight + y), rounded(z));
                if (surface(centre) > -0.02) continue;
                result.push_back({centre, radiusAt(centre, mesh)});
            }
        }
    }
    return result;
}

double excess(const std::vector<double>& depths) {
    double sum = 0.0;
    for (const double depth : depths) sum += std::pow(std::max(0.0, depth - kWantedDepth), 2);
    return sum;
}

std::vector<double> lowered(std::vector<double> depths, const std::vector<Vec3d>& points,
                            const Candidate& sphere) {
    const Vec3d mirrored(-sphere.centre.x(), sphere.centre.y(), sphere.centre.z());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double distance = std::min((points[i] - sphere.centre).norm(), (points[i] - mirrored).norm());
        depths[i] = std::min(depths[i], distance - sphere.radius);
    }
    return depths;
}

void add(std::vector<Sphere>& spheres, const std::string& name, const Candidate& sphere, int bone) {
    if (sphere.centre.x() == 0.0) {
        spheres.push_back({name, sphere.centre, sphere.radius, bone});
        return;
    }
    spheres.push_back({name + "_left", sphere.centre, sphere.radius, bone});
    spheres.push_back(
        {name + "_right", {-sphere.centre.x(), sphere.centre.y(), sphere.centre.z()}, sphere.radius, bone});
}

}  // namespace

std::vector<Sphere> fitSpheres(const PatchMesh& mesh) {
    std::vector<Sphere> spheres;
    const std::vector<Vec3d> points = scalpPoints(mesh);
    const std::vector<Candidate> all = candidates(mesh);
    std::vector<double> depths(points.size(), 0.1);
    int number = 1;
    while (static_cast<int>(spheres.size()) + 1 < kHeadSpheres && excess(depths) > 0.0) {
        const Candidate* best = nullptr;
        double bestGain = 0.0;
        for (const Candidate& candidate : all) {
            const double gain = excess(depths) - excess(lowered(depths, points, candidate));
            const double each = candidate.centre.x() == 0.0 ? gain : 0.5 * gain;
            if (each <= bestGain) continue;
            bestGain = each;
            best = &candidate;
        }
        if (best == nullptr) break;
        depths = lowered(depths, points, *best);
        add(spheres, "skull_" + std::to_string(number++), *best, 2);
    }
    const auto fixed = [&](const char* name, const Vec3d& place, int bone) {
        const Vec3d centre(place.x(), rounded(place.y() + kEyeHeight), place.z());
        add(spheres, name, {centre, radiusAt(centre, mesh)}, bone);
    };
    fixed("neck", {0.0, -0.125, -0.032}, 1);
    fixed("neck_base", {0.0, -0.175, -0.040}, 1);
    fixed("chest", {0.0, -0.225, -0.040}, 0);
    fixed("shoulder", {0.080, -0.235, -0.046}, 0);
    return spheres;
}

std::string spheresJson(const std::vector<Sphere>& spheres) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Sphere& sphere : spheres) {
        const Vec3d c = sphere.centre;
        list.push_back({{"name", sphere.name},
                        {"centre", {rounded(c.x()), rounded(c.y()), rounded(c.z())}},
                        {"radius", sphere.radius},
                        {"bone", bones()[sphere.bone].name}});
    }
    return list.dump(1) + "\n";
}

}  // namespace hairloom::bust
