// SPDX-License-Identifier: MIT
// Kajiya and Kay 1989 as Rünz 2012 condenses it, Eq. 25.

// Keeps what the fibre sends out below what it gets, and its hue: by the channel that sends out the most.
float kajiyaBound(float3 weights) { return 1.0 / max(1.0, max(weights.x, max(weights.y, weights.z))); }

float kajiyaDiffuse(float3 tangent, float3 toLight) {
    const float lt = dot(toLight, tangent);
    return sqrt(saturate(1.0 - lt * lt));
}

// cos^m of the angle between the view and the cone of mirrored light.
float kajiyaSpecular(float3 tangent, float3 toLight, float3 toView, float exponent) {
    const float lt = dot(toLight, tangent);
    const float vt = dot(toView, tangent);
    const float c = sqrt(saturate(1.0 - lt * lt)) * sqrt(saturate(1.0 - vt * vt)) - lt * vt;
    return exponent == 0.0 ? (c >= 0.0 ? 1.0 : 0.0) : pow(saturate(c), exponent);
}
