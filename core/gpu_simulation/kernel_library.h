// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Strand kernels by their key: those that were compiled with the program, those of earlier runs on disk, and
// what a thread of its own compiles while others serve.

#include <cstdint>
#include <filesystem>
#include <memory>

#include "core/gpu/device.h"
#include "core/gpu_simulation/kernel_key.h"

namespace hairloom::gpu_simulation {

/// The user's folder for kernels of earlier runs; empty where the system names none.
std::filesystem::path userKernelFolder();

class KernelLibrary {
  public:
    /// Where kernels have come from since the start.
    struct Sources {
        std::uint32_t builtIn = 0;
        std::uint32_t disk = 0;
        std::uint32_t compiled = 0;
    };

    /// `device` outlives the library. An empty folder: nothing is kept on disk. A folder that cannot be
    /// written or holds damaged files costs time only.
    KernelLibrary(gpu::Device& device, std::filesystem::path folder);
    KernelLibrary(const KernelLibrary&) = delete;
    KernelLibrary& operator=(const KernelLibrary&) = delete;
    ~KernelLibrary();

    /// The kernel, or null while it is being made. Errors: it cannot be made.
    Result<gpu::ComputePipelinePtr> poll(const KernelKey& key);
    /// Waits for it.
    Result<gpu::ComputePipelinePtr> get(const KernelKey& key);

    Sources sources() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace hairloom::gpu_simulation
