// SPDX-License-Identifier: MIT
#pragma once
// Random numbers that depend on (seed, stream, position) alone, so that any thread can draw those of any
// element and results do not depend on the number of threads.

#include <cstdint>

namespace hairloom::runtime {

/// PCG-XSH-RR 64/32 (O'Neill 2014). Equal sequences on every platform, unlike the standard distributions.
class Random {
  public:
    /// `stream` separates sequences of one seed: one per strand, face, or purpose.
    explicit Random(std::uint64_t seed, std::uint64_t stream = 0)
        : state_(0), increment_((mix(stream) << 1u) | 1u) {
        next();
        state_ += mix(seed);
        next();
    }

    /// Uniform over all 32-bit values.
    std::uint32_t next() {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005ull + increment_;
        const auto shifted = static_cast<std::uint32_t>(((old >> 18u) ^ old) >> 27u);
        const auto rotation = static_cast<std::uint32_t>(old >> 59u);
        return (shifted >> rotation) | (shifted << ((32u - rotation) & 31u));
    }

    /// Uniform in [0, 1), a multiple of 2^-24.
    float uniform() { return static_cast<float>(next() >> 8u) * 0x1p-24f; }

    /// Uniform in [0, 1), a multiple of 2^-53.
    double uniformDouble() {
        const std::uint64_t high = next();
        return static_cast<double>(((high << 32u) | next()) >> 11u) * 0x1p-53;
    }

    float uniform(float low, float high) { return low + (high - low) * uniform(); }

    /// Uniform in [0, count) without modulo bias (Lemire 2019). count > 0.
    std::uint32_t below(std::uint32_t count) {
        std::uint64_t product = static_cast<std::uint64_t>(next()) * count;
        auto low = static_cast<std::uint32_t>(product);
        if (low < count) {
            const std::uint32_t reject = (0u - count) % count;
            while (low < reject) {
                product = static_cast<std::uint64_t>(next()) * count;
                low = static_cast<std::uint32_t>(product);
            }
        }
        return static_cast<std::uint32_t>(product >> 32u);
    }

    /// SplitMix64's finaliser: spreads neighbouring seeds apart.
    static constexpr std::uint64_t mix(std::uint64_t z) {
        z += 0x9e3779b97f4a7c15ull;
        z = (z ^ (z >> 30u)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27u)) * 0x94d049bb133111ebull;
        return z ^ (z >> 31u);
    }

  private:
    std::uint64_t state_;
    std::uint64_t increment_;
};

}  // namespace hairloom::runtime
