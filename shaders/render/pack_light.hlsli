// SPDX-License-Identifier: GPL-3.0-or-later
// Light in a word.
#ifndef HAIRLOOM_PACK_LIGHT_HLSLI
#define HAIRLOOM_PACK_LIGHT_HLSLI

float powerOfTwo(int n) { return asfloat(uint(127 + n) << 23u); }

// Three mantissas of 9 bits and one exponent, up to 65,408; off by at most 1 / 1,022 of the largest channel.
uint packLight(float3 light) {
    const float3 l = clamp(light, 0.0, 65408.0);
    const float maximum = max(l.x, max(l.y, l.z));
    int exponent = max(int(asuint(maximum) >> 23u) - 127, -16) + 16;
    if (uint(maximum * powerOfTwo(24 - exponent) + 0.5) > 511u) exponent += 1;
    const uint3 m = uint3(l * powerOfTwo(24 - exponent) + 0.5);
    return (uint(exponent) << 27u) | (m.z << 18u) | (m.y << 9u) | m.x;
}

float3 unpackLight(uint packed) {
    const uint3 m = uint3(packed, packed >> 9u, packed >> 18u) & 511u;
    return float3(m) * powerOfTwo(int(packed >> 27u) - 24);
}
#endif
