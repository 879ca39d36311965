// SPDX-License-Identifier: MIT
// Kajiya and Kay 1989 as Rünz 2012 condenses it, Eq. 25.
#include "hash.hlsli"

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

// What a fibre's terms are: c_s of the two highlights (the second times the albedo), c_d, one by pi R_O of each, and how much
// light other fibres pass on.
struct KajiyaTerms {
    float3 primary, secondary;
    float primaryExponent, secondaryExponent;
    float primaryNormalisation, secondaryNormalisation, diffuseNormalisation;
    float diffuse, scattering;
    bool bounded;
};

// A place of a fibre: its tangent, and as the two highlights have it; `sparkle` times the second of them.
struct KajiyaFibre {
    float3 tangent, tangent1, tangent2;
    float3 albedo;
    float sparkle;
};

// A tangent turned towards the view by an angle of this tangent.
float3 kajiyaTilt(float3 tangent, float3 toView, float amount) {
    const float3 normal = toView - tangent * dot(toView, tangent);
    return normalize(tangent + normal * (amount * rsqrt(max(dot(normal, normal), 1e-8))));
}

// How wide a fibre is across the view, of one that is as thick as a round one and turned by `turn` of half a circle.
float kajiyaSide(float axisRatio, float turn) {
    if (axisRatio == 1.0) return 1.0;
    const float c = cos(3.14159265 * turn);
    return sqrt(axisRatio * c * c + (1.0 - c * c) / axisRatio);
}

// Strand `number`, whose highlights lie, glitter and turn a little by chance. `tilts`: of both, tangents of angles.
KajiyaFibre kajiyaFibre(uint number, float3 tangent, float3 toView, float3 albedo, float2 tilts, float axisRatio) {
    const float jitter = (hashUnit(number * 2u + 1u) - 0.5) * 0.06;
    KajiyaFibre fibre;
    fibre.tangent = tangent;
    fibre.tangent1 = kajiyaTilt(tangent, toView, tilts.x + jitter);
    fibre.tangent2 = kajiyaTilt(tangent, toView, tilts.y + jitter);
    fibre.albedo = albedo;
    fibre.sparkle = (0.6 + 0.8 * hashUnit(number * 2u)) * kajiyaSide(axisRatio, hashUnit(number * 2u + 7u));
    return fibre;
}

// What a fibre lets pass: the less, the darker it is.
float3 kajiyaPassed(float opacity, float3 albedo) { return saturate(1.0 - opacity * (1.0 - 0.75 * sqrt(albedo))); }

// What each term sends out in all, kept below 1; that of light between fibres lacks the half of a closed fibre's 1 / pi^2.
float kajiyaBoundOf(KajiyaTerms terms, KajiyaFibre fibre) {
    if (!terms.bounded) return 1.0;
    return kajiyaBound(terms.primary + (terms.diffuse + fibre.sparkle * terms.secondary) * fibre.albedo +
                       3.14159265 * terms.scattering * fibre.albedo * fibre.albedo);
}

// Of light straight from the lamp, times its irradiance.
float3 kajiyaSingle(KajiyaTerms terms, KajiyaFibre fibre, float3 toLight, float3 toView) {
    const float diffuse = kajiyaDiffuse(fibre.tangent, toLight);
    const float3 lobe1 = terms.primary * (terms.primaryNormalisation *
                         kajiyaSpecular(fibre.tangent1, toLight, toView, terms.primaryExponent));
    const float3 lobe2 = terms.secondary * fibre.albedo * (fibre.sparkle * terms.secondaryNormalisation *
                         kajiyaSpecular(fibre.tangent2, toLight, toView, terms.secondaryExponent));
    return (terms.diffuse * terms.diffuseNormalisation * fibre.albedo + lobe1 + lobe2) * diffuse;
}

// Light that has bounced between fibres before: an artist's term after Zinke et al. 2008, not derived.
float3 kajiyaMultiple(KajiyaTerms terms, KajiyaFibre fibre, float3 toLight) {
    return terms.scattering * fibre.albedo * fibre.albedo * kajiyaDiffuse(fibre.tangent, toLight) / 3.14159265;
}
