// SPDX-License-Identifier: GPL-3.0-or-later
#include "samples/bust/rig.h"

#include <algorithm>
#include <cmath>

#include "samples/bust/head_shape.h"

namespace hairloom::bust {
namespace {

constexpr double kTurnSeconds = 1.4;
constexpr double kNodStart = 1.1;
constexpr double kClipSeconds = 2.0;
constexpr double kTurnDegrees = 38.0;
constexpr double kNodDegrees = 20.0;
constexpr double kNeckShare = 0.4;  ///< of each rotation; the head makes the rest

double smoothStep(double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

}  // namespace

const std::array<Bone, kBoneCount>& bones() {
    static const std::array<Bone, kBoneCount> all = {{{"root", -1, {0.0, kEyeHeight - 0.215, -0.045}},
                                                      {"neck", 0, {0.0, kEyeHeight - 0.155, -0.040}},
                                                      {"head", 1, {0.0, kEyeHeight - 0.045, -0.020}}}};
    return all;
}

Vec3d skinWeights(const Vec3d& p) {
    // Height above a sheet that runs under the chin and below the hair in the nape.
    const double aboveJaw = p.y() - kEyeHeight + 0.112 + 0.29 * (p.z() - 0.070);
    const double head = smoothStep(-0.055, 0.0, aboveJaw);
    const double root = (1.0 - head) * (1.0 - smoothStep(-0.205, -0.145, p.y() - kEyeHeight));
    return {root, 1.0 - head - root, head};
}

Eigen::Quaterniond boneRotation(int bone, int frame) {
    if (bone == 0) return Eigen::Quaterniond::Identity();
    const double pi = 3.14159265358979323846;
    const double time = frame / kClipRate;
    // Both curves leave and reach zero with zero slope; 0.6495 is the maximum of sin(2x) sin(x)^2.
    const double turning = std::clamp(time / kTurnSeconds, 0.0, 1.0);
    const double turn =
        kTurnDegrees * std::sin(2 * pi * turning) * std::pow(std::sin(pi * turning), 2) / 0.6495;
    const double nodding = std::clamp((time - kNodStart) / (kClipSeconds - kNodStart), 0.0, 1.0);
    const double nod = kNodDegrees * std::pow(std::sin(pi * nodding), 2);
    const double share = (bone == 1 ? kNeckShare : 1.0 - kNeckShare) * pi / 180.0;
    return Eigen::AngleAxisd(turn * share, Vec3d::UnitY()) * Eigen::AngleAxisd(nod * share, Vec3d::UnitX());
}

}  // namespace hairloom::bust
