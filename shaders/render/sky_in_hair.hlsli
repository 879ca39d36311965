// SPDX-License-Identifier: GPL-3.0-or-later
// How light from around is inside hair.
#ifndef HAIRLOOM_SKY_IN_HAIR_HLSLI
#define HAIRLOOM_SKY_IN_HAIR_HLSLI
#include "runtime/shaders/layer_light.hlsli"
#include "shaders/render/lights.hlsli"
#include "shaders/render/sky_maps.hlsli"

// How much light from around there is inside hair, against that without: even + d . (x, y, z) in the direction d.
struct SkyInHair {
    float3 even, x, y, z;
};

// Where no map tells which fibres stand around.
SkyInHair openSky() {
    SkyInHair sky;
    sky.even = 1;
    sky.x = sky.y = sky.z = 0;
    return sky;
}

// Between fibres that stop half of what they meet and all of it, for each channel: shares fall with a power of it.
float3 betweenShares(float halved, float whole, float3 part) {
    return max(halved, 1e-5) * pow(max(whole, 1e-5) / max(halved, 1e-5), part);
}

// Of what fibres around a place send on, as if they all had the light of the place itself: in the midst of thin hair they do;
// behind the surface of thick hair they have less, and send on 1 - sqrt(lost) of the surface's (a half-space of isotropic
// scatterers). Which of them it is shows in the logarithms of what is open: fibres that stop half as much leave the surface
// as open, and the midst by a square root more. Between both visible light of slabs is within 6 % of the equation of transfer.
float3 sentOnFrom(float3 lost, SkyShares whole, SkyShares halved) {
    const float all = max(1.0 - whole.blocked, 1e-3);
    const float open = clamp(whole.open / all, 1e-4, 0.999);
    const float thinner = clamp(halved.open / all, open, 0.9999);
    const float surface = max(2.0 * log(thinner) / log(open) - 1.0, 0.05);
    return 1.0 - pow(lost, 0.5 * pow(surface, -0.55));
}

// Light comes from the sky, from other fibres and from the head. What fibres send nearly straight on counts as not stopped
// (as in lightInLayer); the rest they send on as the mean light in this place, and the head as what comes to it from the
// other sides. With nothing absorbed all of it is as bright as the sky, with nothing sent on it is what is seen of that.
SkyInHair skyInHair(SkySeen seen, FibreMoments fibre, float3 ground) {
    const SkyShares whole = seen.whole;
    const SkyShares halved = seen.halved;
    const Stopped stopped = stoppedBy(fibre);
    const float3 sentOn = sentOnFrom(stopped.lost, whole, halved);
    const float3 part = 2.0 * stopped.share - 1.0;
    const float3 open = betweenShares(halved.open, whole.open, part);
    const float3 blocked = min(betweenShares(halved.blocked, whole.blocked, part), 1.0 - open);
    const float3 hair = 1.0 - open - blocked;
    const float3 fromHead = ground / max(1.0 - blocked, 1e-3);
    const float3 onHead = 1.0 + blocked * fromHead;
    SkyInHair sky;
    sky.even = onHead * open / (1.0 - onHead * hair * sentOn);
    const float3 hairLight = sentOn * sky.even;
    const float3 headLight = fromHead * (open + hair * hairLight);
    const float3 bySky = open * (1.0 - hairLight);
    const float3 byHead = blocked * (headLight - hairLight);
    const float3 skyNear = halved.from / max(halved.open, 1e-5);
    const float3 skyFar = whole.from / max(whole.open, 1e-5);
    const float3 headNear = halved.towards / max(halved.blocked, 1e-5);
    const float3 headFar = whole.towards / max(whole.blocked, 1e-5);
    sky.x = bySky * lerp(skyNear.x, skyFar.x, part) + byHead * lerp(headNear.x, headFar.x, part);
    sky.y = bySky * lerp(skyNear.y, skyFar.y, part) + byHead * lerp(headNear.y, headFar.y, part);
    sky.z = bySky * lerp(skyNear.z, skyFar.z, part) + byHead * lerp(headNear.z, headFar.z, part);
    return sky;
}

// Mean radiance around a fibre, weighted by the sine of the angle to its tangent: by Funk and Hecke the bands are scaled
// by 1, 0 and -1/8; of the product of two first bands a quarter is left along the fibre and 3/8 across it.
float3 environmentOnHair(ShadeConstants shade, float3 t, SkyInHair sky) {
    const EnvironmentBands bands = environmentBands(shade, t);
    const float3 bx = 0.48860251 * shade.environment[3].rgb;
    const float3 by = 0.48860251 * shade.environment[1].rgb;
    const float3 bz = 0.48860251 * shade.environment[2].rgb;
    const float3 along = bands.first * (sky.x * t.x + sky.y * t.y + sky.z * t.z);
    const float3 all = bx * sky.x + by * sky.y + bz * sky.z;
    return max((bands.flat - 0.125 * bands.second) * sky.even + 0.375 * all - 0.125 * along, 0.0);
}
#endif
