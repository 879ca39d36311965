// SPDX-License-Identifier: MIT
// Numbers of chance that stay: one of each number.
#ifndef HAIRLOOM_HASH_HLSLI
#define HAIRLOOM_HASH_HLSLI

uint hashUint(uint x) {
    x ^= x >> 16u;
    x *= 0x7feb352du;
    x ^= x >> 15u;
    x *= 0x846ca68bu;
    x ^= x >> 16u;
    return x;
}

// 0…1, below 1.
float hashUnit(uint x) { return float(hashUint(x) >> 8u) * (1.0 / 16777216.0); }
#endif
