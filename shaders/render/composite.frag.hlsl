// SPDX-License-Identifier: GPL-3.0-or-later
// Blended hair over what was drawn before it.
Texture2D<float4> gSum : register(t0);
Texture2D<float4> gRest : register(t1);

float4 main(float4 position : SV_Position) : SV_Target0 {
    const int3 at = int3(int2(position.xy), 0);
    const float4 sum = gSum.Load(at);
    const float through = gRest.Load(at).r;
    if (sum.a <= 0) discard;
    return float4(sum.rgb / max(sum.a, 1e-8), 1.0 - through);
}
