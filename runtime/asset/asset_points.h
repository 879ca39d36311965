// SPDX-License-Identifier: MIT
#pragma once
// The points of an asset's strands as whole numbers of their grids.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "hairloom/asset_format.h"

namespace hairloom::runtime {

using AssetGrid = std::array<std::int64_t, 3>;

template <class T>
T load(const std::byte* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

/// Ten bits as a signed number.
inline std::int64_t tenBits(std::uint32_t bits) {
    return static_cast<std::int64_t>(bits & 1023u) - ((bits & 512u) != 0 ? 1024 : 0);
}

inline AssetGrid residualAt(const std::byte* at, std::uint8_t bytes) {
    if (bytes == 4) {
        const auto packed = load<std::uint32_t>(at);
        return {tenBits(packed), tenBits(packed >> 10u), tenBits(packed >> 20u)};
    }
    if (bytes == 6) {
        const auto packed = load<std::array<std::int16_t, 3>>(at);
        return {packed[0], packed[1], packed[2]};
    }
    const auto packed = load<std::array<std::int32_t, 3>>(at);
    return {packed[0], packed[1], packed[2]};
}

/// Calls visit(grid) for each point of the strand, whose residuals begin at `residual`, and moves that behind
/// them.
template <class Visit>
void forPoints(const asset::Strand& strand, const std::byte*& residual, const Visit& visit) {
    AssetGrid before{strand.root[0], strand.root[1], strand.root[2]};
    AssetGrid at{before[0] + strand.first[0], before[1] + strand.first[1], before[2] + strand.first[2]};
    visit(before);
    visit(at);
    for (std::uint32_t p = 2; p < strand.points; ++p, residual += strand.residualBytes) {
        const AssetGrid farther = residualAt(residual, strand.residualBytes);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int64_t next = 2 * at[axis] - before[axis] + farther[axis];
            before[axis] = at[axis];
            at[axis] = next;
        }
        visit(at);
    }
}

}  // namespace hairloom::runtime
