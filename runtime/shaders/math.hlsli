// SPDX-License-Identifier: MIT
// Rotations as quaternions x i + y j + z k + w.

#ifdef HAIRLOOM_DXBC
// Direct3D leaves open in which order dot() takes its sum, and drivers differ: here it is that of the CPU.
float inOrder(float3 a, float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
float inOrder(float4 a, float4 b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
#define dot(a, b) inOrder(a, b)
#endif

float3 rotate(float4 q, float3 v) {
    const float3 twice = 2.0 * cross(q.xyz, v);
    return v + twice * q.w + cross(q.xyz, twice);
}

/// First b, then a.
float4 multiply(float4 a, float4 b) {
    return float4(a.w * b.xyz + b.w * a.xyz + cross(a.xyz, b.xyz), a.w * b.w - dot(a.xyz, b.xyz));
}

float4 conjugate(float4 q) {
    return float4(-q.xyz, q.w);
}

/// False for infinities and what is no number, whatever the compiler assumes of comparisons.
bool isSound(float3 v) {
    const uint3 bits = asuint(v) & 0x7f800000u;
    return bits.x != 0x7f800000u && bits.y != 0x7f800000u && bits.z != 0x7f800000u;
}

/// A length and a direction.
struct Direction {
    float3 unit;
    float size;
};

/// Of an offset from a sphere's centre; at the very centre it points up.
Direction directionOf(float3 offset) {
    Direction result;
    const float squared = dot(offset, offset);
    const bool centred = squared < 1e-18;
    const float inverse = rsqrt(centred ? 1.0 : squared);
    result.unit = centred ? float3(0, 1, 0) : offset * inverse;
    result.size = squared * inverse;
    return result;
}

/// Of a segment; one without length points down.
Direction edgeOf(float3 edge) {
    Direction result;
    result.size = sqrt(dot(edge, edge));
    const bool flat = result.size < 1e-10;
    result.unit = flat ? float3(0, -1, 0) : edge * (1.0 / (flat ? 1.0 : result.size));
    return result;
}
