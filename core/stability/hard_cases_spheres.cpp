// SPDX-License-Identifier: GPL-3.0-or-later
// Hard cases: collision spheres.
#include <algorithm>
#include <cmath>

#include "core/stability/hard_cases.h"

namespace hairloom::hardcases {
namespace {

constexpr const char* kRinged =
    "the pushes of spheres placed evenly around a point cancel, and it stays between them";

using runtime::Float3;
using runtime::Sphere;

constexpr float kSegment = 0.012f;  // metres
/// Frames that points have to leave a sphere that appears around them.
constexpr int kToLeave = 30;

StrandSet oneDown() {
    StrandSet strands;
    strands.add({0.0f, 0.1f, 0.0f}, {0.0f, -1.0f, 0.0f}, kSegment, 16);
    return strands;
}

void leaveSpheres(HardCaseRun& caseRun, std::vector<Sphere> spheres) {
    caseRun.setSpheres(std::move(spheres));
    caseRun.frames(kToLeave);
    caseRun.watchSpheres();
    caseRun.frames(250);
    caseRun.watchSpheres(false);
    caseRun.setSpheres({});
}

}  // namespace

void pointAtCentre(HardCaseRun& caseRun) {
    caseRun.start(oneDown());
    const Float3 point = caseRun.positions()[8];
    leaveSpheres(caseRun, {{point, 0.02f}});
    caseRun.settle();
}

void overlappingSpheres(HardCaseRun& caseRun) {
    if (caseRun.method().rods()) caseRun.disclaim(kRinged);
    caseRun.start(oneDown());
    const Float3 point = caseRun.positions()[8];
    leaveSpheres(caseRun,
                 {{point + Float3{0.01f, 0.0f, 0.0f}, 0.02f}, {point - Float3{0.01f, 0.0f, 0.0f}, 0.02f}});
    caseRun.frames(250);
    std::vector<Sphere> ring;
    for (int i = 0; i < 5; ++i) {
        const float angle = 1.2566371f * static_cast<float>(i);
        ring.push_back({point + Float3{std::cos(angle), 0.0f, std::sin(angle)} * 0.01f, 0.015f});
    }
    leaveSpheres(caseRun, ring);
    caseRun.settle();
}

void rootThroughSphere(HardCaseRun& caseRun) {
    caseRun.start(tuft());
    constexpr float kRadius = 0.05f;
    const Float3 centre{0.25f, 0.1f, 0.0f};
    caseRun.setSpheres({{centre, kRadius}});
    for (int f = 1; f <= 60; ++f) {
        const Float3 shift{0.5f * static_cast<float>(f) / 60.0f, 0.0f, 0.0f};
        caseRun.moveRoots(shift);
        // Hair whose root is inside cannot be outside.
        float nearest = 1e30f;
        for (const runtime::RootFrame& root : caseRun.strands().roots(shift))
            nearest = std::min(nearest, length(root.position - centre));
        caseRun.watchSpheres(nearest > kRadius + 2.0f * kSegment);
        caseRun.frame();
    }
    caseRun.watchSpheres();
    caseRun.frames(200);
    caseRun.settle();
}

void shrinkingSphere(HardCaseRun& caseRun) {
    caseRun.start(oneDown());
    const auto sphereOf = [](float radius) { return Sphere{{0.01f, 0.0f, 0.0f}, radius}; };
    caseRun.setSpheres({sphereOf(0.04f)});
    caseRun.frames(kToLeave);
    caseRun.watchSpheres();
    for (int f = 1; f <= 120; ++f) {
        caseRun.setSpheres({sphereOf(0.04f * (1.0f - static_cast<float>(f) / 120.0f))});
        caseRun.frame();
    }
    caseRun.expect("a sphere without radius kept", "",
                   caseRun.engine().lastStep().rejectedSpheres == 1 ? 0.0 : 1.0, 0.0);
    caseRun.watchSpheres(false);
    caseRun.settle();
}

void negativeRadius(HardCaseRun& caseRun) {
    caseRun.start(oneDown());
    const auto without = caseRun.another(caseRun.settings());
    const std::vector<runtime::RootFrame> roots = caseRun.strands().roots();
    caseRun.setSpheres({{{0.0f, 0.0f, 0.0f}, -0.05f}});
    std::uint32_t kept = 0;
    for (int f = 1; f <= 250 && !caseRun.over(); ++f) {
        caseRun.frame();
        without->step({kFrame, caseRun.time(), roots, {}});
        if (caseRun.engine().lastStep().rejectedSpheres != 1) ++kept;
    }
    caseRun.expect("frames that kept the sphere", "", kept, 0.0);
    caseRun.expect("it changed the hair", "",
                   caseRun.engine().stateHash() == without->stateHash() ? 0.0 : 1.0, 0.0);
}

}  // namespace hairloom::hardcases
