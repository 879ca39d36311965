// SPDX-License-Identifier: MIT
// What a game does with the engine, in short; prints the state that it comes to.
#include <hairloom/engine.h>

#include <cmath>
#include <cstdio>
#include <vector>

int main() {
    using namespace hairloom::runtime;
    constexpr std::uint32_t kStrands = 40, kPoints = 12;
    std::vector<std::uint32_t> offsets{0};
    std::vector<Float3> points;
    for (std::uint32_t s = 0; s < kStrands; ++s) {
        for (std::uint32_t p = 0; p < kPoints; ++p) {
            const float along = 0.012f * static_cast<float>(p);
            points.push_back(
                {0.005f * static_cast<float>(s), 0.2f - along, 0.004f * std::sin(90.0f * along)});
        }
        offsets.push_back(static_cast<std::uint32_t>(points.size()));
    }
    SimulationSettings settings;
    settings.windSpeed = 3.0f;
    Engine::Result made = Engine::make({offsets, points}, settings);
    if (!made.engine) {
        std::fprintf(stderr, "%s\n", made.error.c_str());
        return 1;
    }
    std::vector<RootFrame> roots(kStrands);
    const Sphere head{{0.1f, 0.1f, 0.0f}, 0.05f};
    for (int f = 1; f <= 20; ++f) {
        for (std::uint32_t s = 0; s < kStrands; ++s)
            roots[s] = {points[offsets[s]] + Float3{0.01f * static_cast<float>(f % 5), 0.0f, 0.0f}, {}};
        FrameInput input;
        input.time = f / 60.0;
        input.roots_ws = roots;
        input.spheres = {&head, 1};
        made.engine->step(input);
    }
    std::printf("%016llx\n", static_cast<unsigned long long>(made.engine->stateHash()));
    return 0;
}
