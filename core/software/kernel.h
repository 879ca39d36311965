// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Compute shaders as native code. Each is the shader's own source (cmake/hlsl_to_cpp.cmake), compiled into a
// struct whose members are what is bound to its registers.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/software/hlsl.h"

namespace hairloom::software {

struct TextureView {
    const void* texels = nullptr;  ///< floats
    int width = 0, height = 0;
};

/// What lies at each register. What a shader does not use stays empty.
struct Registers {
    static constexpr std::size_t kMost = 24;
    std::array<const std::byte*, 8> constants{};
    std::array<const std::byte*, kMost> read{};
    std::array<TextureView, kMost> textures{};
    std::array<std::byte*, 8> written{};
};

/// What a shader declares.
struct RegisterNames {
    std::vector<std::uint32_t> constants, read, textures, written;
};

/// Base of the structs. The names are those that the translation writes.
class KernelBase {
  public:
    explicit KernelBase(const Registers& registers, RegisterNames* names = nullptr)
        : registers_(registers), names_(names) {}

  protected:
    template <class T>
    const T& constants(std::uint32_t slot) const {
        if (names_ != nullptr) names_->constants.push_back(slot);
        return *reinterpret_cast<const T*>(registers_.constants[slot]);
    }
    struct Read {
        const std::byte* bytes;
        template <class T>
        operator StructuredBuffer<T>() const {
            return {reinterpret_cast<const T*>(bytes)};
        }
    };
    Read read(std::uint32_t slot) const {
        if (names_ != nullptr) names_->read.push_back(slot);
        return {registers_.read[slot]};
    }
    struct Written {
        std::byte* bytes;
        template <class T>
        operator RWStructuredBuffer<T>() const {
            return {reinterpret_cast<T*>(bytes)};
        }
    };
    Written written(std::uint32_t slot) const {
        if (names_ != nullptr) names_->written.push_back(slot);
        return {registers_.written[slot]};
    }
    struct Seen {
        TextureView view;
        template <class T>
        operator Texture2D<T>() const {
            return {static_cast<const T*>(view.texels), view.width, view.height};
        }
    };
    Seen texture(std::uint32_t slot) const {
        if (names_ != nullptr) names_->textures.push_back(slot);
        return {registers_.textures[slot]};
    }

  private:
    const Registers& registers_;
    RegisterNames* names_;
};

/// A shader as the device has it.
struct KernelEntry {
    std::string_view name;  ///< of the shader, "NAME.comp" or "NAME.frag"
    RegisterNames (*names)() = nullptr;
    /// Runs all threads of the groups begin … end - 1 (by x, then y, then z) of a dispatch of so many; null
    /// for a pixel shader.
    void (*run)(const Registers& registers, const std::array<std::uint32_t, 3>& groups, std::size_t begin,
                std::size_t end) = nullptr;
    /// Runs those threads; null for a pixel shader and where a thread is not named by one number alone.
    void (*runThreads)(const Registers& registers, std::span<const uint3> threads) = nullptr;
    /// Of a pixel shader over a whole target: `count` pixels of a row from its left edge on.
    void (*fillRow)(const Registers& registers, std::uint32_t row, std::uint32_t count,
                    float4* pixels) = nullptr;
};

/// Nothing for a shader that has no native form.
const KernelEntry* findKernel(std::string_view name);

template <class Kernel>
concept TakesGroups = requires(Kernel kernel) {
    kernel.main(uint3(0u), uint{0});
};

#ifdef __GNUC__
// Shaders are written for compilers that know no calls.
#define HAIRLOOM_FLATTEN [[gnu::flatten]]
#else
#define HAIRLOOM_FLATTEN
#endif

template <class Kernel>
HAIRLOOM_FLATTEN void runKernel(const Registers& registers, const std::array<std::uint32_t, 3>& groups,
                                std::size_t begin, std::size_t end) {
    Kernel kernel(registers);
    constexpr auto& size = Kernel::kGroup;
    for (std::size_t g = begin; g < end; ++g) {
        const auto x = static_cast<uint>(g % groups[0]);
        const auto y = static_cast<uint>(g / groups[0] % groups[1]);
        const auto z = static_cast<uint>(g / groups[0] / groups[1]);
        if constexpr (TakesGroups<Kernel>) {
            for (uint t = 0; t < size[0] * size[1] * size[2]; ++t) kernel.main(uint3(x, y, z), t);
        } else {
            for (uint k = 0; k < size[2]; ++k) {
                for (uint j = 0; j < size[1]; ++j) {
                    for (uint i = 0; i < size[0]; ++i)
                        kernel.main(uint3(x * size[0] + i, y * size[1] + j, z * size[2] + k));
                }
            }
        }
    }
}

template <class Kernel>
HAIRLOOM_FLATTEN void runThreads(const Registers& registers, std::span<const uint3> threads) {
    Kernel kernel(registers);
    for (const uint3& thread : threads) kernel.main(thread);
}

template <class Kernel>
HAIRLOOM_FLATTEN void fillRow(const Registers& registers, std::uint32_t row, std::uint32_t count,
                              float4* pixels) {
    Kernel kernel(registers);
    for (std::uint32_t x = 0; x < count; ++x)
        pixels[x] = kernel.main(float4(static_cast<float>(x) + 0.5f, static_cast<float>(row) + 0.5f, 0, 1));
}

template <class Kernel>
RegisterNames registerNames() {
    const Registers nothing;
    RegisterNames names;
    const Kernel kernel(nothing, &names);
    return names;
}

template <class Kernel>
constexpr KernelEntry computeKernel(std::string_view name) {
    KernelEntry entry{name, &registerNames<Kernel>, &runKernel<Kernel>, nullptr, nullptr};
    if constexpr (!TakesGroups<Kernel>) entry.runThreads = &runThreads<Kernel>;
    return entry;
}
template <class Kernel>
constexpr KernelEntry pixelKernel(std::string_view name) {
    return {name, &registerNames<Kernel>, nullptr, nullptr, &fillRow<Kernel>};
}

}  // namespace hairloom::software
