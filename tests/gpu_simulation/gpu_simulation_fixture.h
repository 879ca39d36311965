// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "core/gpu/device.h"
#include "core/gpu_simulation/strand_engine.h"
#include "tests/gpu/test_backend.h"

namespace hairloom::gpu_simulation {

/// One device with validation and one library for all cases of the program. They go before the program's
/// statics do: the layers keep statics of their own.
class SharedDevice : public testing::Environment {
  public:
    static std::unique_ptr<gpu::Device>& device() {
        static std::unique_ptr<gpu::Device> device;
        return device;
    }
    static std::shared_ptr<KernelLibrary>& library() {
        static std::shared_ptr<KernelLibrary> library;
        return library;
    }
    void TearDown() override {
        library().reset();
        device().reset();
    }
};
inline testing::Environment* const kSharedDevice = testing::AddGlobalTestEnvironment(new SharedDevice);

/// The layouts whose results are held against the CPU. Lavapipe takes long to compile unrolled loops; its
/// waves of 8 threads hold strands of 16 points in pairs, where waves are asked for.
inline const LayoutOptions kHeldLayouts[] = {
    {.storage = StrandStorage::threads, .unroll = false, .members = 1},
    {StrandStorage::lanes, false, {}, 1},
    {StrandStorage::lanes, false, {}, 2},
    {StrandStorage::lanes, false, {}, 2, false},
    {StrandStorage::wisps, false}};
/// A thread for each rod, and as many as share one of few.
inline const LayoutOptions kRodLayouts[] = {
    kHeldLayouts[0], {.storage = StrandStorage::threads, .unroll = false, .members = 16}};
inline std::string nameOf(const LayoutOptions& layout) {
    constexpr const char* kNames[] = {"threads", "groups", "buffers", "lanes", "wisps"};
    const bool pairs = layout.perThread == 2u;
    if (pairs) return layout.waves ? "pairs" : "pairsWithoutWaves";
    return kNames[static_cast<std::size_t>(*layout.storage)];
}
inline void PrintTo(const LayoutOptions& layout, std::ostream* out) {
    *out << nameOf(layout);
}

/// On the shared device; any message fails the case in which it came.
class GpuSimulationTest : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        if (device() != nullptr) return;
        auto made = gpu::createDevice(gpu::testDevice());
        ASSERT_TRUE(made) << made.error().message();
        device() = std::move(*made);
        library() = std::make_shared<KernelLibrary>(*device(), keptKernels());
    }
    void SetUp() override {
        ASSERT_NE(device(), nullptr);
        messages_ = device()->validationMessages().size();
    }
    void TearDown() override {
        if (device() == nullptr) return;
        const auto messages = device()->validationMessages();
        for (std::size_t i = messages_; i < messages.size(); ++i) ADD_FAILURE() << messages[i];
    }

    static std::unique_ptr<gpu::Device>& device() { return SharedDevice::device(); }
    static std::shared_ptr<KernelLibrary>& library() { return SharedDevice::library(); }

    static EngineOptions options(const LayoutOptions& layout = kHeldLayouts[0]) {
        EngineOptions options;
        options.layout = layout;
        return options;
    }
    static StrandEngine engineOf(const runtime::StrandsView& strands,
                                 const runtime::SimulationSettings& settings, const EngineOptions& options) {
        auto made = StrandEngine::make(*device(), library(), strands, settings, options);
        if (!made) throw std::runtime_error(made.error().message());
        return std::move(*made);
    }

  private:
    /// The folder HAIRLOOM_TEST_KERNELS keeps kernels for the next run, where one takes long to compile.
    static std::filesystem::path keptKernels() {
        const char* const folder = std::getenv("HAIRLOOM_TEST_KERNELS");  // NOLINT(concurrency-mt-unsafe)
        return folder == nullptr ? "" : folder;
    }

    std::size_t messages_ = 0;
};

}  // namespace hairloom::gpu_simulation
