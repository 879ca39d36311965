#version 330
// SPDX-License-Identifier: GPL-3.0-or-later
// A segment of a hair becomes a ribbon that faces the eye. What is narrower than a pixel is drawn a pixel wide and covers less.
layout(lines) in;
layout(triangle_strip, max_vertices = 4) out;
uniform mat4 viewProjection, projection;
uniform vec3 eye;
uniform vec4 viewport;
uniform float widening;
in vec3 pointPosition[], pointTangent[];
in float pointRadius[];
out vec3 at, along;
out float cover, across, tone;

// Hairs of one guide follow each other: by the root's place each has a tone of its own.
float noise(int n) {
    uint x = uint(n) * 747796405u + 2891336453u;
    x = ((x >> ((x >> 28u) + 4u)) ^ x) * 277803737u;
    return float((x >> 22u) ^ x) / 4294967295.0;
}
uniform int segments;

void main() {
    tone = noise(gl_PrimitiveIDIn / segments);
    float tones = tone;
    for (int p = 0; p < 2; ++p) {
        vec3 towards = eye - pointPosition[p];
        vec3 side = cross(pointTangent[p], towards);
        side /= max(length(side), 1e-9);
        float narrowest = 1.1 * length(towards) / (abs(projection[1][1]) * viewport.y);
        float half_ = pointRadius[p] * widening;
        for (int s = -1; s <= 1; s += 2) {
            at = pointPosition[p] + side * (float(s) * max(half_, narrowest));
            along = pointTangent[p];
            cover = clamp(half_ / narrowest, 0.0, 1.0);
            across = float(s);
            tone = tones;
            gl_Position = viewProjection * vec4(at, 1.0);
            EmitVertex();
        }
    }
    EndPrimitive();
}
