#version 330
// SPDX-License-Identifier: GPL-3.0-or-later
// Clay, shaded by hair as hair is.
uniform vec3 eye, sun, sunPosition, middle;
uniform sampler2D depths;
uniform mat4 toLight;
in vec3 at, facing;
out vec4 colour;
void main() {
    vec3 n = normalize(facing), towards = normalize(eye - at);
    vec2 map = (toLight * vec4(at, 1.0)).xy, texel = 2.0 / vec2(textureSize(depths, 0));
    float depth = dot(sunPosition - at, sun) - 0.004, reach = 0.0;
    for (int i = 0; i < 9; ++i) {
        vec2 offset = vec2(float(i % 3) - 1.0, float(i / 3) - 1.0) * texel;
        reach += exp(-160.0 * max(0.0, depth - texture(depths, map + offset).r)) / 9.0;
    }
    vec3 skin = vec3(0.27, 0.205, 0.172);
    float wrap = clamp((dot(n, sun) + 0.25) / 1.25, 0.0, 1.0);
    vec3 sum = skin * vec3(2.0, 1.9, 1.75) * wrap * mix(vec3(1.0, 0.55, 0.45) * 0.08, vec3(1.0), reach);
    sum += skin * mix(vec3(0.20, 0.175, 0.155), vec3(0.40, 0.45, 0.53), 0.5 + 0.5 * n.y) * mix(0.55, 1.0, reach);
    sum += 0.06 * reach * pow(max(dot(n, normalize(sun + towards)), 0.0), 28.0);
    colour = vec4(pow(1.0 - exp(-1.25 * sum), vec3(1.0 / 2.2)), 1.0);
}
