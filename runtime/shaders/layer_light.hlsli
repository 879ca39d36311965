// SPDX-License-Identifier: MIT
// Light inside a layer of hair: the equation of transfer across the fibres as far as the mean light and its direction (P1), over
// hair of finite depth. docs/rendering.md says how, and core/shading/dual_scattering.h is the reference.
#ifndef HAIRLOOM_LAYER_LIGHT_HLSLI
#define HAIRLOOM_LAYER_LIGHT_HLSLI

// What fibres do to light across them: the albedo, and the first two moments of the angle by which they turn it.
struct FibreMoments {
    float3 albedo, first, second;
};

// A fibre's shares of light sent on and back with their variances, and its tilts.
struct FibreAverages {
    float4 forward, backward;
    float4 rest;  // tilt of light sent on, sent back and of all; variance of all
    FibreMoments moments;
};

// What a fibre sends nearly straight on, as much as the second moment says, counts as not stopped.
struct Stopped {
    float3 forward;  // f of delta-Eddington, of the light that meets the fibre
    float3 share;     // of it, the rest
    float3 lost;      // of that, never none
};

Stopped stoppedBy(FibreMoments m) {
    Stopped stopped;
    stopped.forward = max(m.second, 0.0);
    stopped.share = 1.0 - stopped.forward;
    stopped.lost = max(1.0 - (m.albedo - stopped.forward) / stopped.share, 1e-3);
    return stopped;
}

struct LayerLight {
    float3 fluence;  // of diffuse light
    float3 flux;     // away from where the layer is lit
    float3 onward;   // of the beam
};

// The beam must not fade exactly as diffuse light does.
float turnedOf(float lost, float wanted) { return abs(lost * wanted - 1.0) < 0.01 ? 1.01 / lost : wanted; }

// `before` fibres between the point and the lit side, `all` from side to side, on a ground of this albedo; lit straight with
// the irradiance 1.
LayerLight lightInLayer(FibreMoments m, float before, float all, float3 ground) {
    const float kPi = 3.14159265;
    const Stopped stopped = stoppedBy(m);
    const float3 scale = stopped.share;
    const float3 lost = stopped.lost;
    const float3 asymmetric = (m.first - stopped.forward) / scale;
    const float3 omega = 1.0 - lost;
    const float3 wanted = 2.0 * (1.0 - asymmetric);
    const float3 turned =
        float3(turnedOf(lost.x, wanted.x), turnedOf(lost.y, wanted.y), turnedOf(lost.z, wanted.z));
    const float3 rate = sqrt(lost * turned);
    const float3 slope = sqrt(lost / turned);
    const float3 at = scale * before;
    const float3 depth = scale * max(all, before);

    const float3 y = (turned * omega + 2.0 * asymmetric) / (rate * rate - 1.0);
    const float3 x = (2.0 * asymmetric + y) / turned;
    const float3 here = exp(-at);
    const float3 into = y / kPi + 0.5 * x;
    const float3 top = -into;
    const float3 bottom = exp(-depth) * (ground * (1.0 + into) - (y / kPi - 0.5 * x));

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
