// SPDX-License-Identifier: MIT
#pragma once
// The random numbers of follow hairs: PCG-XSH-RR 64/32 (O'Neill 2014), which depend on seed and stream alone.

#include <cstdint>

namespace hairloom::runtime {

class Random {
  public:
    Random(std::uint64_t seed, std::uint64_t stream) : increment_((mix(stream) << 1u) | 1u) {
        next();
        state_ += mix(seed);
        next();
    }
    std::uint32_t next() {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005ull + increment_;
        const auto shifted = static_cast<std::uint32_t>(((old >> 18u) ^ old) >> 27u);
        const auto rotation = static_cast<std::uint32_t>(old >> 59u);
        return (shifted >> rotation) | (shifted << ((32u - rotation) & 31u));
    }
    /// In [0, 1), a multiple of 2^-24.
    float uniform() { return static_cast<float>(next() >> 8u) * 0x1p-24f; }

  private:
    /// SplitMix64's finaliser: spreads neighbouring seeds apart.
    static constexpr std::uint64_t mix(std::uint64_t z) {
        z += 0x9e3779b97f4a7c15ull;
        z = (z ^ (z >> 30u)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27u)) * 0x94d049bb133111ebull;
        return z ^ (z >> 31u);
    }

    std::uint64_t state_ = 0;
    std::uint64_t increment_;
};

}  // namespace hairloom::runtime
