#version 330
// SPDX-License-Identifier: GPL-3.0-or-later
in vec3 vertex, normal;
in float uv0;
out vec3 pointPosition, pointTangent;
out float pointRadius;
void main() {
    pointPosition = vertex;
    pointTangent = normal;
    pointRadius = uv0;
}
