// SPDX-License-Identifier: GPL-3.0-or-later
// Light inside a layer of hair; core/shading/dual_scattering.h says how and is the reference.
#ifndef HAIRLOOM_LAYER_LIGHT_HLSLI
#define HAIRLOOM_LAYER_LIGHT_HLSLI

// What fibres do to light across them: the albedo, and the first two moments of the angle by which they turn it.
struct FibreMoments {
    float3 albedo, first, second;
};

struct LayerLight {
    float3 fluence;  // of diffuse light
    float3 flux;     // away from where the layer is lit
    float3 onward;   // of the beam
};

// `before` fibres between the point and the lit side, `all` from side to side, on a ground of this albedo; lit straight with
// the irradiance `beam` and from half of all directions with the radiance `sky`.
LayerLight lightInLayer(FibreMoments m, float before, float all, float3 ground, float beam, float sky) {
    const float kPi = 3.14159265;
    const float3 peak = max(m.second, 0.0);
    const float3 scale = 1.0 - peak;
    const float3 asymmetric = (m.first - peak) / scale;
    const float3 lost = max(1.0 - (m.albedo - peak) / scale, 1e-3);
    const float3 omega = 1.0 - lost;
    // The beam must not fade exactly as diffuse light does.
    const float3 wanted = 2.0 * (1.0 - asymmetric);
    const float3 turned = abs(lost * wanted - 1.0) < 0.01 ? 1.01 / lost : wanted;
    const float3 rate = sqrt(lost * turned);
    const float3 slope = sqrt(lost / turned);
    const float3 at = scale * before;
    const float3 depth = scale * max(all, before);

    const float3 y = (turned * omega + 2.0 * asymmetric) / (rate * rate - 1.0);
    const float3 x = (2.0 * asymmetric + y) / turned;
    const float3 here = beam * exp(-at);
    const float3 into = y / kPi + 0.5 * x;
    const float3 top = 2.0 * sky - beam * into;
    const float3 bottom = beam * exp(-depth) * (ground * (1.0 + into) - (y / kPi - 0.5 * x));

    const float3 t = 1.0 / kPi + 0.5 * slope;
    const float3 u = 1.0 / kPi - 0.5 * slope;
    const float3 deep = exp(-rate * depth);
    const float3 fromTop = deep * (u - ground * t);
    const float3 fromBottom = t - ground * u;
    const float3 determinant = t * fromBottom - deep * u * fromTop;
    const float3 falling = (top * fromBottom - deep * u * bottom) / determinant * exp(-rate * at);
    const float3 rising = (t * bottom - fromTop * top) / determinant * exp(-rate * (depth - at));
    LayerLight light;
    light.fluence = falling + rising + y * here;
    light.flux = slope * (falling - rising) + x * here;
    light.onward = here;
    return light;
}
#endif
