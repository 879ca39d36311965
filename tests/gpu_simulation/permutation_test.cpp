// SPDX-License-Identifier: GPL-3.0-or-later
// Which kernel runs a plan, where it comes from, and that what is off is not there.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <set>
#include <thread>

#include "core/base/file.h"
#include "core/gpu/validation.h"
#include "core/gpu_simulation/strand_model.h"
#include "core/stability/strand_set.h"
#include "runtime/shaders/simulation_types.h"
#include "shaders/shaders.h"
#include "tests/gpu_simulation/gpu_simulation_fixture.h"
#include "tests/support/spring_settings.h"
#include "tests/support/temporary_folder.h"

namespace hairloom::shaders {
std::span<const Shader> table_test_gpu_simulation();  // NOLINT(readability-identifier-naming)
}

namespace hairloom::gpu_simulation {
namespace {

using runtime::SimulationSettings;
using runtime::springSettings;
using testing::Contains;
using testing::IsSupersetOf;
using testing::Not;

class Permutation : public GpuSimulationTest {
  protected:
    static gpu::ValidationDevice& watched() { return *gpu::validationOf(*device()); }
    static std::vector<std::string> livingNames() {
        std::vector<std::string> names;
        for (const gpu::LivingResource& resource : watched().living()) names.push_back(resource.name);
        return names;
    }
    /// Names that the dispatches of a frame read and write.
    std::vector<std::string> usedBy(StrandEngine& engine, std::span<const runtime::Sphere> spheres = {}) {
        watched().clearRecord();
        runtime::FrameInput input;
        const auto roots = strands.roots();
        input.roots_ws = roots;
        input.spheres = spheres;
        EXPECT_TRUE(engine.step(input));
        // What is under way keeps its buffers.
        EXPECT_TRUE(engine.wait());
        std::vector<std::string> names;
        for (const gpu::RecordedWork& work : watched().record()) {
            if (work.kind != gpu::RecordedWork::Kind::Dispatch) continue;
            for (const auto* list : {&work.reads, &work.writes}) {
                // "buffer 'positions'"
                for (const std::string& resource : *list) {
                    const std::size_t quote = resource.find('\'') + 1;
                    names.push_back(resource.substr(quote, resource.rfind('\'') - quote));
                }
            }
        }
        return names;
    }

    StrandSet strands = curved(tuft(6));

  private:
    static StrandSet curved(StrandSet set) {
        for (std::size_t p = 0; p < set.points.size(); ++p)
            set.points[p].z += 0.004f * std::sin(1.3f * static_cast<float>(p));
        return set;
    }
};

SimulationSettings withoutAll() {
    SimulationSettings s = springSettings();
    s.gravity = {};
    s.dampingTime = 0.0f;
    s.airDrag = 0.0f;
    s.angularStiffness = 0.0f;
    s.lengthIterations = 0;
    s.sleepSpeed = 0.0f;
    return s;
}

TEST_F(Permutation, WhatIsOffHasNoBufferAndIsNotRead) {
    const std::vector<std::string> ofEffects{"angular springs", "rest directions", "rests",   "spheres",
                                             "waking spheres",  "scratch",         "gathered"};
    StrandEngine engine = engineOf(strands.view(), withoutAll(), options());
    const std::vector<std::string> used = usedBy(engine);
    EXPECT_THAT(used, IsSupersetOf({"state", "roots", "positions"}));
    for (const std::string& name : ofEffects) {
        EXPECT_THAT(used, Not(Contains(name)));
        EXPECT_THAT(livingNames(), Not(Contains(name)));
    }
    for (std::uint32_t effect = 0; effect < runtime::kEffectCount; ++effect)
        EXPECT_EQ(engine.effectBytes(static_cast<runtime::Effect>(effect)), 0u);
}

TEST_F(Permutation, BuffersComeAndGoWithTheirEffects) {
    SimulationSettings s = springSettings();
    StrandEngine engine = engineOf(strands.view(), s, options());
    const std::vector<std::string> curved{"angular springs", "rest directions", "rests"};
    EXPECT_THAT(usedBy(engine), IsSupersetOf(curved));
    EXPECT_GT(engine.effectBytes(runtime::Effect::torsion), 0u);
    // Hair that does not bend needs no frames.
    s.angularStiffness = 0.0f;
    ASSERT_TRUE(engine.setSettings(s));
    const auto used = usedBy(engine);
    EXPECT_THAT(used, Not(Contains("angular springs")));
    EXPECT_THAT(used, Not(Contains("rest directions")));
    EXPECT_THAT(livingNames(), Not(Contains("rest directions")));
}

TEST_F(Permutation, RodsHaveBuffersAndAKernelOfTheirOwn) {
    const std::vector<std::string> ofRods{"rods", "rods at rest", "masses of rods", "curved blocks",
                                          "scratch"};
    const std::vector<std::string> ofSprings{"angular springs", "rest directions"};
    SimulationSettings s = springSettings();
    s.strandModel = runtime::StrandModel::rods;
    StrandEngine engine = engineOf(strands.view(), s, options());
    const auto used = usedBy(engine);
    EXPECT_THAT(used, IsSupersetOf(ofRods));
    for (const std::string& name : ofSprings) EXPECT_THAT(livingNames(), Not(Contains(name)));
    EXPECT_GT(engine.effectBytes(runtime::Effect::angular), 0u);
    s.strandModel = runtime::StrandModel::springs;
    ASSERT_TRUE(engine.setSettings(s));
    EXPECT_THAT(usedBy(engine), IsSupersetOf(ofSprings));
    for (const std::string& name : ofRods) EXPECT_THAT(livingNames(), Not(Contains(name)));
}

/// One for every number of points and storage; what is off is not in it.
TEST_F(Permutation, RodsOfAllPointCountsShareAKernel) {
    runtime::PlanInput scene;
    scene.settings.strandModel = runtime::StrandModel::rods;
    scene.strandCount = 1;
    scene.longestStrand = 1.0f;
    const auto keyOf = [&](std::uint32_t points, StrandStorage storage) {
        scene.longestPointCount = points;
        return keyFor(runtime::plan(scene), scene.settings, {points, true, true, storage}, 0, false);
    };
    const KernelKey key = keyOf(16, StrandStorage::threads);
    EXPECT_STREQ(key.source(), "rods.hlsli");
    EXPECT_EQ(key.shape.strands, runtime::kBlockLanes);
    EXPECT_THAT(key.defines(), testing::HasSubstr("HAIR_RODS 1"));
    EXPECT_THAT(key.defines(), testing::HasSubstr("HAIR_WIND 0"));
    EXPECT_EQ(key.defines(), keyOf(512, StrandStorage::buffers).defines());
    EXPECT_EQ(key.defines(), keyOf(3, StrandStorage::wisps).defines());
    scene.settings.windSpeed = 3.0f;
    EXPECT_THAT(keyOf(16, StrandStorage::threads).defines(), testing::HasSubstr("HAIR_WIND 1"));
    scene.settings.strandModel = runtime::StrandModel::springs;
    EXPECT_STREQ(keyOf(16, StrandStorage::threads).source(), "strands.hlsli");
}

TEST_F(Permutation, ManySpheresStandInABuffer) {
    SimulationSettings s = withoutAll();
    s.lengthIterations = 1;
    StrandEngine engine = engineOf(strands.view(), s, options());
    const std::vector<runtime::Sphere> few(HAIRLOOM_CONSTANT_SPHERES, {{0.0f, 0.05f, 0.0f}, 0.01f}),
        many(HAIRLOOM_CONSTANT_SPHERES + 1, few.front());
    EXPECT_THAT(usedBy(engine, few), Not(Contains("spheres")));
    EXPECT_THAT(usedBy(engine, many), Contains("spheres"));
    EXPECT_THAT(usedBy(engine), Not(Contains("spheres")));
    EXPECT_THAT(livingNames(), Not(Contains("spheres")));
}

TEST_F(Permutation, KernelsOfTheProgramAreThoseOfDefaultPlans) {
    KernelLibrary own(*device(), {});
    runtime::PlanInput scene;
    scene.strandCount = 1;
    scene.longestPointCount = 16;
    scene.longestStrand = 1.0f;
    const runtime::Sphere sphere{{}, 0.1f};
    BatchShape one{16, true, true, StrandStorage::threads}, shared = one;
    shared.members = 16;
    std::vector<std::string> asked;
    for (const float wind : {0.0f, 3.0f}) {
        for (const std::size_t spheres : {0u, 1u}) {
            scene.settings.windSpeed = wind;
            scene.spheres = {&sphere, spheres};
            const runtime::EffectPlan plan = runtime::plan(scene);
            for (const bool velocities : {false, true}) {
                for (const BatchShape& shape : {one, shared}) {
                    asked.push_back(keyFor(plan, scene.settings, shape, spheres, velocities).defines());
                    // Beside skin, whose kernel is the same without spheres.
                    const auto skin =
                        keyFor(plan, scene.settings, shape, spheres, velocities, true).defines();
                    if (spheres > 0)
                        asked.push_back(skin);
                    else
                        EXPECT_EQ(skin.find("HAIR_SPHERES 0"), std::string::npos);
                }
            }
        }
    }
    std::vector<std::string> built;
    for (const shaders::Source& source : shaders::sources()) {
        if (!source.path.ends_with(".comp.hlsl")) continue;
        const std::string name = std::filesystem::path(source.path).stem().string();
        ASSERT_NE(shaders::find(name), nullptr) << name;
        std::string defines;
        for (std::size_t at = 0; at < source.text.size();) {
            const std::size_t end = source.text.find('\n', at) + 1;
            if (source.text.substr(at).starts_with("#define ")) defines += source.text.substr(at, end - at);
            at = end;
        }
        // Other kernels have no permutations.
        if (defines.find("HAIR_STAGES") != std::string::npos) built.push_back(defines);
    }
    EXPECT_THAT(built, testing::UnorderedElementsAreArray(asked));
}

TEST_F(Permutation, KernelsAreKeptOnDiskAndDamageIsFound) {
    const TemporaryFolder own;
    const std::filesystem::path folder = own / "kernels";
    KernelKey key;
    key.shape = {3, true, false, StrandStorage::threads};
    key.stages = "stageRoots(); stageVerlet();";
    const auto made = [&] {
        KernelLibrary library(*device(), folder);
        EXPECT_TRUE(library.get(key));
        EXPECT_TRUE(library.get(key));
        return library.sources();
    };
    EXPECT_EQ(made().compiled, 1u);
    EXPECT_EQ(made().disk, 1u);
    const auto file = std::filesystem::directory_iterator(folder)->path();
    auto bytes = readFile(file).value();
    bytes[bytes.size() / 2] ^= std::byte{1};
    ASSERT_TRUE(writeFileAtomically(file, bytes));
    EXPECT_EQ(made().compiled, 1u);
    EXPECT_EQ(made().disk, 1u);
}

TEST_F(Permutation, AKernelThatDoesNotCompileIsAnError) {
    KernelKey key;
    key.shape = {3, true, false, StrandStorage::threads};
    key.stages = "stageNobodyKnows();";
    const auto kernel = library()->get(key);
    ASSERT_FALSE(kernel);
    EXPECT_THAT(kernel.error().message(), testing::HasSubstr("stageNobodyKnows"));
}

/// The old plan goes on while the new kernel is made in the background, and then gives way.
TEST_F(Permutation, PlansChangeWithoutWaiting) {
    EngineOptions patient = options();
    patient.waitForKernels = false;
    SimulationSettings s = withoutAll();
    s.gravity = {0.0f, -9.81f, 0.0f};
    auto own = std::make_shared<KernelLibrary>(*device(), std::filesystem::path());
    auto made = StrandEngine::make(*device(), own, strands.view(), s, patient);
    ASSERT_TRUE(made);
    StrandEngine& engine = *made;
    usedBy(engine);
    ASSERT_FALSE(engine.plan().on(runtime::Effect::length));
    s.lengthIterations = 1;
    s.gravity = {};
    ASSERT_TRUE(engine.setSettings(s));
    usedBy(engine);
    // Compiling takes longer than a frame of a few strands; where it did not, there is nothing to see.
    int served = 0;
    const auto begin = std::chrono::steady_clock::now();
    while (!engine.plan().on(runtime::Effect::length) &&
           std::chrono::steady_clock::now() - begin < std::chrono::seconds(60)) {
        EXPECT_FLOAT_EQ(engine.settings().gravity.y, -9.81f);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        usedBy(engine);
        ++served;
    }
    EXPECT_GT(served, 0);
    EXPECT_TRUE(engine.plan().on(runtime::Effect::length));
    EXPECT_FLOAT_EQ(engine.settings().gravity.y, 0.0f);
}

/// Feature level 11.0 of Direct3D has eight writable buffers, u0 to u7, and no two of a kernel share one.
TEST_F(Permutation, AGroupPerWispWritesToEightBuffersAtMost) {
    runtime::PlanInput scene;
    scene.settings = springSettings();
    scene.strandCount = 1;
    scene.longestPointCount = 16;
    scene.longestStrand = 1.0f;
    BatchShape wisps{16, true, false, StrandStorage::wisps};
    wisps.strands = 1;
    wisps.together = true;
    const KernelKey key = keyFor(runtime::plan(scene), scene.settings, wisps, 0, true);
    ASSERT_TRUE(key.sleep && key.velocities);
    const GpuModel& springs = gpuModelOf(key.model);
    std::set<std::uint32_t> slots{0, 1, 2, 3, 4};  // state, roots, rests, report, positions
    slots.insert({springs.gatheredSlot, springs.velocitySlot(key)});
    EXPECT_EQ(slots.size(), 7u);
    EXPECT_LT(*slots.rbegin(), 8u);
}

/// Its system of coil springs has a thread for each strand, whatever the batch is laid out for; no other is
/// compiled for its arrays.
TEST_F(Permutation, BackwardEulerOfCoilsHasAThreadForEachStrand) {
    runtime::PlanInput scene;
    scene.settings = springSettings();
    scene.strandCount = 1;
    scene.longestPointCount = 16;
    scene.longestStrand = 1.0f;
    BatchShape lanes{16, true, true, StrandStorage::lanes};
    lanes.strands = 2;
    lanes.together = true;
    lanes.perThread = 2;
    lanes.wave = 8;
    const auto definesOf = [&](runtime::Integrator integrator, runtime::LengthMethod lengths) {
        scene.settings.integrator = integrator;
        scene.settings.lengthMethod = lengths;
        EXPECT_EQ(kernelError(scene.settings), "");
        return keyFor(runtime::plan(scene), scene.settings, lanes, 0, false).defines();
    };
    using runtime::Integrator;
    using runtime::LengthMethod;
    const std::string coils = definesOf(Integrator::implicitEuler, LengthMethod::springs);
    for (const char* line : {"HAIR_STORAGE 0", "HAIR_STRANDS 32", "HAIR_TOGETHER 1", "HAIR_PER_THREAD 1",
                             "HAIR_WAVE 0", "HAIR_UNROLL 0", "HAIR_EVALUATION 3"})
        EXPECT_THAT(coils, testing::HasSubstr(line));
    const std::string held = definesOf(Integrator::implicitEuler, LengthMethod::constraint);
    for (const char* line : {"HAIR_STORAGE 3", "HAIR_PER_THREAD 2", "HAIR_EVALUATION 1"})
        EXPECT_THAT(held, testing::HasSubstr(line));
    EXPECT_THAT(definesOf(Integrator::verlet, LengthMethod::springs), testing::HasSubstr("HAIR_STORAGE 3"));
}

TEST_F(Permutation, WhatTheCpuAloneHasIsRefusedInWords) {
    SimulationSettings s = springSettings();
    s.windShelter = 0.5f;
    EXPECT_THAT(kernelError(s), testing::HasSubstr("windShelter"));
    s = springSettings();
    s.collisionSegments = true;
    EXPECT_THAT(kernelError(s), testing::HasSubstr("collisionSegments"));
    // Rods have no such segments, and do not fall back for what they ignore.
    s.strandModel = runtime::StrandModel::rods;
    EXPECT_EQ(kernelError(s), "");
}

/// Structs are where shader and C++ think they are.
TEST_F(Permutation, ConstantsArriveWhereTheyAreRead) {
    std::array<float, sizeof(shaders::SimulationConstants) / 4> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(i + 1);
    const shaders::Shader& echo = shaders::table_test_gpu_simulation().front();
    const auto shader =
        device()
            ->createShader({"echo", gpu::ShaderStage::Compute, std::as_bytes(echo.spirv), echo.dxbc})
            .value();
    const auto pipeline = device()->createComputePipeline({"echo", shader}).value();
    std::array<shaders::SphereConstants, 2> spheres{};
    spheres[1] = {{1.0f, 2.0f, 3.0f, 4.0f}, {5.0f, 6.0f, 7.0f, 8.0f}};
    const auto input =
        makeBuffer<shaders::SphereConstants>(*device(), "two spheres", gpu::Usage::ShaderRead, 2, spheres)
            .value();
    constexpr std::size_t kResults = 24;
    const std::vector<shaders::float4> nothing(kResults);
    const auto output =
        makeBuffer<shaders::float4>(*device(), "results", gpu::Usage::UnorderedAccess, kResults, nothing)
            .value();
    auto list = device()->createCommandList().value();
    gpu::PassDesc pass;
    pass.name = "echo";
    list->beginPass(pass);
    list->setPipeline(pipeline);
    const std::array<gpu::Binding, 2> bindings{gpu::Binding::read(0, input), gpu::Binding::write(0, output)};
    list->bind(bindings);
    list->setConstants(0, std::as_bytes(std::span(numbers)));
    list->dispatch(1);
    list->endPass();
    ASSERT_TRUE(device()->submit(std::move(list)).value()->wait());
    std::array<float, kResults * 4> results{};
    ASSERT_TRUE(device()->readBuffer(output, 0, std::as_writable_bytes(std::span(results))));
    for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(results[i], numbers[i]) << i;
    for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(results[numbers.size() + i], static_cast<float>(i + 1));
}

}  // namespace
}  // namespace hairloom::gpu_simulation
