// SPDX-License-Identifier: GPL-3.0-or-later
// core/render/tone_map.h, for the device.

// Hable 2010, "Uncharted 2: HDR Lighting", the published constants.
float3 hable(float3 x) {
    return (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.50) + 0.06) - 0.02 / 0.30;
}

// The curve reaches 1 at 6.
float3 filmic(float3 linearRgb) { return hable(max(linearRgb, 0.0)) / hable(float3(6.0, 6.0, 6.0)); }

// IEC 61966-2-1.
float3 encodeSrgb(float3 linearRgb) {
    const float3 x = saturate(linearRgb);
    const float3 high = 1.055 * pow(max(x, 0.0031308), 1.0 / 2.4) - 0.055;
    return float3(x.r <= 0.0031308 ? 12.92 * x.r : high.r, x.g <= 0.0031308 ? 12.92 * x.g : high.g,
                  x.b <= 0.0031308 ? 12.92 * x.b : high.b);
}

float3 decodeSrgb(float3 encoded) {
    const float3 x = saturate(encoded);
    const float3 high = pow((x + 0.055) / 1.055, 2.4);
    return float3(x.r <= 0.04045 ? x.r / 12.92 : high.r, x.g <= 0.04045 ? x.g / 12.92 : high.g,
                  x.b <= 0.04045 ? x.b / 12.92 : high.b);
}

// Half on the channels, which bleaches colours, half on luminance, which keeps all of them; 0…1, not yet encoded.
float3 toneCurve(float3 exposed) {
    const float luminance = dot(exposed, float3(0.2126, 0.7152, 0.0722));
    const float scale = luminance > 1e-6 ? filmic(float3(luminance, luminance, luminance)).x / luminance : 0.0;
    return saturate(0.5 * (filmic(exposed) + scale * exposed));
}
