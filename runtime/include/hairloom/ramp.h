// SPDX-License-Identifier: MIT
#pragma once
// A number that changes from one end of a strand to the other, authored by keys: what tools call a ramp.

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <span>
#include <string>

namespace hairloom::runtime {

/// A curve over 0…1 that is straight between its keys. Plain data: validationError() says whether it is
/// sound.
struct Ramp {
    static constexpr std::uint32_t kMaxKeys = 16;
    struct Key {
        float at = 0.0f;     ///< 0…1: 0 is the root, 1 the tip
        float value = 0.0f;  ///< 0…1
        friend bool operator==(const Key&, const Key&) = default;
    };

    std::uint32_t count = 2;  ///< 2…kMaxKeys
    /// The first at 0, the last at 1, each behind the one before; those past `count` mean nothing.
    std::array<Key, kMaxKeys> keys{{{0.0f, 1.0f}, {1.0f, 1.0f}}};

    static constexpr Ramp straight(float first, float last) {
        Ramp ramp;
        ramp.keys[0].value = first;
        ramp.keys[1].value = last;
        return ramp;
    }
    /// Of 2…kMaxKeys keys.
    static constexpr Ramp of(std::span<const Key> keys) {
        assert(keys.size() <= kMaxKeys);
        Ramp ramp;
        ramp.count = static_cast<std::uint32_t>(keys.size());
        std::copy(keys.begin(), keys.end(), ramp.keys.begin());
        return ramp;
    }

    std::span<const Key> inUse() const { return {keys.data(), std::min(count, kMaxKeys)}; }

    /// The value at 0 ≤ x ≤ 1 of a sound ramp.
    template <class Real>
    Real at(Real x) const {
        std::uint32_t next = 1;
        while (next + 1 < count && static_cast<Real>(keys[next].at) <= x) ++next;
        const Key &before = keys[next - 1], &after = keys[next];
        const Real from = static_cast<Real>(before.at), low = static_cast<Real>(before.value);
        const Real share = (x - from) / (static_cast<Real>(after.at) - from);
        return low + (static_cast<Real>(after.value) - low) * share;
    }
    float greatest() const {
        float maximum = 0.0f;
        for (const Key& key : inUse()) maximum = std::max(maximum, key.value);
        return maximum;
    }

    friend bool operator==(const Ramp& a, const Ramp& b) {
        const auto left = a.inUse(), right = b.inUse();
        return std::equal(left.begin(), left.end(), right.begin(), right.end());
    }
};

/// What is wrong with it, "has 1 keys; expected 2 to 16", or nothing.
std::string validationError(const Ramp& ramp);

}  // namespace hairloom::runtime
