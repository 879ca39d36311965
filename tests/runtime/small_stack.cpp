// SPDX-License-Identifier: GPL-3.0-or-later
// Games call the engine from fibres and threads with small stacks: every stage runs on one of kStackBytes.
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <functional>
#include <set>

#include "hairloom/stable.h"
#include "tests/runtime/instruction_sets.h"
#include "tests/runtime/strand_fixture.h"

namespace hairloom::runtime {
namespace {

/// Runs `body` on a thread with a stack of `bytes`, below which a page faults. Returns how much of it was
/// written, or 0 where there is no such thread.
std::size_t runOnStack(std::size_t bytes, std::function<void()> body) {
    constexpr int kPaint = 0xa5;
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    void* const memory =
        mmap(nullptr, page + bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED || mprotect(memory, page, PROT_NONE) != 0) return 0;
    auto* const stack = static_cast<unsigned char*>(memory) + page;
    std::memset(stack, kPaint, bytes);
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_t thread;
    const auto call = [](void* f) -> void* {
        (*static_cast<std::function<void()>*>(f))();
        return nullptr;
    };
    const bool started = pthread_attr_setstack(&attributes, stack, bytes) == 0 &&
                         pthread_create(&thread, &attributes, call, &body) == 0;
    if (started) pthread_join(thread, nullptr);
    pthread_attr_destroy(&attributes);
    std::size_t untouched = 0;
    while (untouched < bytes && stack[untouched] == kPaint) ++untouched;
    munmap(memory, page + bytes);
    return started ? bytes - untouched : 0;
}

/// Three strands, curled or straight.
struct Hair {
    Strands strands;

    Hair(std::uint32_t points, bool curled) {
        constexpr float kSegment = 0.002f;
        for (std::uint32_t s = 0; s < 3; ++s) {
            const float side = 0.01f * static_cast<float>(s);
            strands.add({side, 0.1f, 0.0f}, {0.0f, -1.0f, 0.0f}, kSegment, points);
            for (std::uint32_t p = 0; curled && p < points; ++p) {
                Float3& at = strands.points[strands.offsets[s] + p];
                const float turn = 0.3f * static_cast<float>(p);
                at = at + Float3{0.004f * std::sin(turn), 0.0f, 0.004f * std::cos(turn)};
            }
        }
    }
};

/// What the calls on the small stack met; looked at on the large one.
struct Met {
    std::set<StageId> stages;
    std::set<std::string> errors;
};

void callEverything(const StrandsView& view, const Strands& strands, const SimulationSettings& settings,
                    Met& met) {
    Engine::Result made = Engine::make(view, settings);
    met.errors.insert(made.error);
    if (!made.engine) return;
    Engine& engine = *made.engine;
    const Sphere spheres[] = {{{0.0f, 0.07f, 0.003f}, 0.01f}, {{0.02f, 0.02f, 0.003f}, 0.015f}};
    std::vector<Float3> values(engine.pointCount());
    bool taken = true;
    for (int f = 1; f <= 2; ++f) {
        const float t = static_cast<float>(f);
        const std::vector<RootFrame> roots = strands.roots({0.02f * t, 0.0f, 0.0f});
        taken = engine.step({1.0f / 60.0f, static_cast<double>(t) / 60.0, roots, spheres}) && taken;
        for (const StageId stage : engine.plan().stages()) met.stages.insert(stage);
        taken = engine.readVelocities(values) && engine.addVelocities(values) && taken;
    }
    taken = engine.readPositions(values) && engine.reset(strands.roots()) && taken;
    Engine copy = engine;
    met.errors.insert(copy.setSettings(settings));
    if (!taken || copy.measure().nanCount > 0) met.errors.insert("a call was refused");
}

/// Calls visit(settings) for all integrators, length methods and angular methods that go together, each with
/// one of the responses to collision.
template <class Visit>
void forEveryMethod(const Visit& visit) {
    using Settings = SimulationSettings;
    Settings s = springSettings();
    s.substeps = 2;
    s.angularStiffness = 0.02f;
    s.windKind = WindKind::turbulent;
    s.collisionRadiusRoot = 0.001f;
    s.sleepSpeed = 0.0f;
    const Field<Settings>* const fields[] = {findField<Settings>("integrator"),
                                             findField<Settings>("lengthMethod"),
                                             findField<Settings>("angularMethod")};
    const Field<Settings>& response = *findField<Settings>("collisionResponse");
    std::size_t total = 1;
    for (const Field<Settings>* field : fields) total *= field->choices.size();
    for (std::size_t i = 0; i < total; ++i) {
        std::size_t left = i;
        for (const Field<Settings>* field : fields) {
            setFieldValue(s, *field, static_cast<double>(left % field->choices.size()));
            left /= field->choices.size();
        }
        setFieldValue(s, response,
                      static_cast<double>((i + i / fields[0]->choices.size()) % response.choices.size()));
        visit(s);
    }
}

TEST(Stack, EveryStageRunsOnASmallOne) {
    std::size_t maximum = 0;
    Met met;
    const auto onSmall = [&](const Hair& hair, const SimulationSettings& settings) {
        const std::size_t used = runOnStack(
            kStackBytes, [&] { callEverything(hair.strands.view(), hair.strands, settings, met); });
        ASSERT_GT(used, 0u);
        maximum = std::max(maximum, used);
    };
    const auto onSmallByEveryMethod = [&](std::uint32_t points, bool curled) {
        const Hair hair(points, curled);
        forEveryMethod([&](SimulationSettings settings) {
            settings.windSpeed = curled ? 4.0f : 0.0f;
            settings.restGravity = curled ? 1.0f : 0.0f;
            onSmall(hair, settings);
        });
        SimulationSettings rods;
        rods.windSpeed = 4.0f;
        onSmall(hair, rods);
    };
    forEveryInstructionSet([&] {
        onSmallByEveryMethod(kMaxPoints, true);
        onSmallByEveryMethod(kMaxPoints, false);
        onSmallByEveryMethod(40, true);
    });
    const Hair hair(kMaxPoints, true);
    const auto advise = [&] { adviseStability(hair.strands.view(), {}, 1.0f / 60.0f); };
    maximum = std::max(maximum, runOnStack(kStackBytes, advise));
    EXPECT_LT(maximum, kStackBytes);
    RecordProperty("bytes", static_cast<int>(maximum));
    EXPECT_EQ(met.errors, std::set<std::string>{""});
    for (std::uint32_t stage = 0; stage < kStageCount; ++stage) {
        EXPECT_TRUE(met.stages.contains(static_cast<StageId>(stage)))
            << stageName(static_cast<StageId>(stage));
    }
}

}  // namespace
}  // namespace hairloom::runtime
