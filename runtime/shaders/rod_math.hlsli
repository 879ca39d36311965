// SPDX-License-Identifier: MIT
// rod.h for the strand of a thread.

float negMad(float a, float b, float c) { return mad(-a, b, c); }
/// a s + b and b − a s.
float3 mad3(float3 a, float s, float3 b) { return mad(a, float3(s, s, s), b); }
float3 negMad3(float3 a, float s, float3 b) { return mad(-a, float3(s, s, s), b); }
float maximum(float a, float b) { return max(a, b); }
float minimum(float a, float b) { return min(a, b); }
float absolute(float a) { return abs(a); }
float root(float a) { return sqrt(a); }
float3 xyz(float4 q) { return q.xyz; }
float3 real3(float x, float y, float z) { return float3(x, y, z); }
float4 real4(float3 v, float w) { return float4(v, w); }
float withSignOf(float v, float sign) { return asfloat(asuint(v) ^ (asuint(sign) & 0x80000000u)); }
float3 withSignOf(float3 v, float sign) { return asfloat(asuint(v) ^ (asuint(sign) & 0x80000000u)); }

bool both(bool a, bool b) { return a && b; }
bool either(bool a, bool b) { return a || b; }
float choose(bool which, float yes, float no) { return which ? yes : no; }
float3 choose(bool which, float3 yes, float3 no) { return which ? yes : no; }

#define RodMask bool
#define Real float
#define Real3 float3
#define Real4 float4
#define ROD_FUNCTION
#define ROD_INOUT(Type) inout Type
#define ROD_OUT(Type) out Type
#define ROD_UNROLL [unroll]
#define ROD_NUMBER(value) value
#include "rod.h"
#include "rod_capsule.h"
#include "rod_contact.h"

RodForm noForm() {
    RodForm form;
    [unroll] for (uint i = 0; i < 6; ++i) form.P[i] = form.U[i] = 0.0;
    [unroll] for (uint j = 0; j < 9; ++j) form.R[j] = 0.0;
    form.gx = form.gu = form.force = float3(0, 0, 0);
    return form;
}

float3 twice(float4 relative) { return relative.xyz + relative.xyz; }
