// SPDX-License-Identifier: GPL-3.0-or-later
// Hard cases: collision spheres.
#include <algorithm>
#include <cmath>

#include "core/accuracy/hard_cases.h"

namespace hairloom::hardcases {
namespace {

using runtime::Float3;
using runtime::Sphere;

constexpr float kSegment = 0.012f;  // metres
/// Frames that points have to leave a sphere that appears around them.
constexpr int kToLeave = 30;

StrandSet oneDown() {
    StrandSet strands;
    strands.addStraight({0.0f, 0.1f, 0.0f}, {0.0f, -1.0f, 0.0f}, kSegment, 16);
    return strands;
}

void leaveSpheres(Trial& trial, std::vector<Sphere> spheres) {
    trial.setSpheres(std::move(spheres));
    trial.frames(kToLeave);
    trial.watchSpheres();
    trial.frames(250);
    trial.watchSpheres(false);
    trial.setSpheres({});
}

}  // namespace

void pointAtCentre(Trial& trial) {
    trial.start(oneDown());
    const Float3 point = trial.positions()[8];
    leaveSpheres(trial, {{point, 0.02f}});
    trial.settle();
}

void overlappingSpheres(Trial& trial) {
    trial.start(oneDown());
    const Float3 point = trial.positions()[8];
    leaveSpheres(trial,
                 {{point + Float3{0.01f, 0.0f, 0.0f}, 0.02f}, {point - Float3{0.01f, 0.0f, 0.0f}, 0.02f}});
    trial.frames(250);
    std::vector<Sphere> ring;
    for (int i = 0; i < 5; ++i) {
        const float angle = 1.2566371f * static_cast<float>(i);
        ring.push_back({point + Float3{std::cos(angle), 0.0f, std::sin(angle)} * 0.01f, 0.015f});
    }
    leaveSpheres(trial, ring);
    trial.settle();
}

void rootThroughSphere(Trial& trial) {
    trial.start(tuft());
    constexpr float kRadius = 0.05f;
    const Float3 centre{0.25f, 0.1f, 0.0f};
    trial.setSpheres({{centre, kRadius}});
    for (int f = 1; f <= 60; ++f) {
        const Float3 shift{0.5f * static_cast<float>(f) / 60.0f, 0.0f, 0.0f};
        trial.moveRoots(shift);
        // Hair whose root is inside cannot be outside.
        float nearest = 1e30f;
        for (const runtime::RootFrame& root : trial.strands().roots(shift))
            nearest = std::min(nearest, length(root.position - centre));
        trial.watchSpheres(nearest > kRadius + 2.0f * kSegment);
        trial.frame();
    }
    trial.watchSpheres();
    trial.frames(200);
    trial.settle();
}

void shrinkingSphere(Trial& trial) {
    trial.start(oneDown());
    const auto sphereOf = [](float radius) { return Sphere{{0.01f, 0.0f, 0.0f}, radius}; };
    trial.setSpheres({sphereOf(0.04f)});
    trial.frames(kToLeave);
    trial.watchSpheres();
    for (int f = 1; f <= 120; ++f) {
        trial.setSpheres({sphereOf(0.04f * (1.0f - static_cast<float>(f) / 120.0f))});
        trial.frame();
    }
    trial.expect("a sphere without radius kept", "",
                 trial.engine().lastStep().rejectedSpheres == 1 ? 0.0 : 1.0, 0.0);
    trial.watchSpheres(false);
    trial.settle();
}

void negativeRadius(Trial& trial) {
    trial.start(oneDown());
    const auto without = trial.another(trial.settings());
    const std::vector<runtime::RootFrame> roots = trial.strands().roots();
    trial.setSpheres({{{0.0f, 0.0f, 0.0f}, -0.05f}});
    std::uint32_t kept = 0;
    for (int f = 1; f <= 250 && !trial.over(); ++f) {
        trial.frame();
        without->step({kFrame, trial.time(), roots, {}});
        if (trial.engine().lastStep().rejectedSpheres != 1) ++kept;
    }
    trial.expect("frames that kept the sphere", "", kept, 0.0);
    trial.expect("it changed the hair", "", trial.engine().stateHash() == without->stateHash() ? 0.0 : 1.0,
                 0.0);
}

}  // namespace hairloom::hardcases
