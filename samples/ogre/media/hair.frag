#version 330
// SPDX-License-Identifier: GPL-3.0-or-later
// Kajiya and Kay 1989 with two shifted highlights (Scheuermann 2004). The deeper a point lies below the first hair that the sun
// meets, the less of its light comes there.
uniform vec3 rootColour, tipColour, eye, sun, sunPosition, middle;
uniform float variation;
uniform sampler2D depths;
uniform mat4 toLight;
in vec3 at, along;
in float cover, across, tone;
out vec4 colour;

float sunReaches() {
    vec2 map = (toLight * vec4(at, 1.0)).xy;
    vec2 texel = 1.3 / vec2(textureSize(depths, 0));
    float depth = dot(sunPosition - at, sun), sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec2 offset = vec2(float(i & 1) * 2.0 - 1.0, float(i >> 1) * 2.0 - 1.0) * texel;
        sum += exp(-75.0 * max(0.0, depth - texture(depths, map + offset * (0.6 + tone)).r));
    }
    return 0.25 * sum;
}
float lobe(vec3 tangent, vec3 halfway, float sharpness) {
    float d = dot(tangent, halfway);
    return smoothstep(-1.0, 0.0, d) * pow(sqrt(max(0.0, 1.0 - d * d)), sharpness);
}
void main() {
    vec3 towards = normalize(eye - at), outward = normalize(at - middle);
    vec3 fibre = normalize(along);
    vec3 normal = normalize(outward - fibre * dot(outward, fibre) + 1e-4);
    vec3 base = mix(rootColour, tipColour, 0.5) * (1.0 + variation * 1.6 * (tone - 0.5));
    float reach = sunReaches();
    vec3 halfway = normalize(sun + towards);
    float d = dot(fibre, sun);
    float diffuse = sqrt(max(0.0, 1.0 - d * d)) * clamp(0.55 + 0.45 * dot(normal, sun), 0.0, 1.0);
    vec3 warm = sqrt(base) * base * 3.0 + base * 0.4;
    vec3 sum = vec3(2.0, 1.9, 1.75) * reach *
               (base * diffuse * 0.85 + vec3(0.055) * lobe(normalize(fibre + normal * (0.09 + 0.1 * (tone - 0.5))), halfway, 90.0) +
                warm * 0.55 * lobe(normalize(fibre - normal * (0.12 - 0.14 * (tone - 0.5))), halfway, 22.0));
    sum += base * mix(vec3(0.20, 0.175, 0.155), vec3(0.40, 0.45, 0.53), 0.5 + 0.5 * normal.y) * mix(0.5, 1.0, reach);
    colour = vec4(pow(1.0 - exp(-1.25 * sum), vec3(1.0 / 2.2)), min(1.0, 1.35 * cover + 0.18 * (tone - 0.5)));
}
