// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which engine moves a hairstyle: the one on the CPU or the one on a GPU, and why.

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/gpu_simulation/kernel_library.h"
#include "core/groom/groom.h"

namespace hairloom {

enum class EngineKind { cpu, gpu };
enum class EngineWish { automatic, gpu, cpu };
/// "auto", "gpu", "cpu", by EngineWish.
std::span<const std::string_view> engineWishNames();
std::string_view engineName(EngineKind kind);

struct EngineChoice {
    EngineKind kind = EngineKind::cpu;
    std::string why;  ///< "0.3 ms per frame on NVIDIA H100, 4.1 on the CPU"

    bool operator==(const EngineChoice&) const = default;
};

/// Milliseconds that a frame takes on the CPU, follow hairs included, and on the GPU.
struct EngineTimes {
    double cpu = 0, gpu = 0;
};

/// What was measured in earlier runs, by device and size of the hairstyle. A file that cannot be read or
/// written costs a measurement, nothing else.
class EngineMemory {
  public:
    /// Empty: nothing is kept.
    explicit EngineMemory(std::filesystem::path file) : file_(std::move(file)) {}
    /// In the user's folder of caches.
    static EngineMemory ofUser();

    std::optional<EngineTimes> find(const std::string& key) const;
    void keep(const std::string& key, const EngineTimes& times) const;

  private:
    std::filesystem::path file_;
};

/// Automatic is the GPU where the device is one and was measured to be faster with a hairstyle of that size,
/// at first use and then from memory. A wish for a GPU that cannot be fulfilled is the CPU, and `why` says
/// what stands in the way. `device` may be null: there is none.
EngineChoice chooseEngine(EngineWish wish, gpu::Device* device,
                          const std::shared_ptr<gpu_simulation::KernelLibrary>& kernels, const Groom& groom,
                          const EngineMemory& memory);

/// The same with a measurement of the caller's, which may fail.
EngineChoice chooseEngine(EngineWish wish, gpu::Device* device, const Groom& groom,
                          const EngineMemory& memory, const std::function<Result<EngineTimes>()>& measure);

}  // namespace hairloom
