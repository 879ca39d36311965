// SPDX-License-Identifier: GPL-3.0-or-later
Texture2D<float4> gTexture : register(t0);
SamplerState gSampler : register(s0);
RWBuffer<float4> gOut : register(u0);

[numthreads(1, 1, 1)]
void main() {
    gOut[0] = gTexture.SampleLevel(gSampler, float2(0.5, 0.25), 0);
    gOut[1] = gTexture.SampleLevel(gSampler, float2(0.25, 0.75), 0);
    gOut[2] = gTexture.SampleLevel(gSampler, float2(-3, 0.25), 0);
}
