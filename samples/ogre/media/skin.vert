#version 330
// SPDX-License-Identifier: GPL-3.0-or-later
uniform mat4 world, worldViewProjection;
in vec4 vertex;
in vec3 normal;
out vec3 at, facing;
void main() {
    at = (world * vertex).xyz;
    facing = mat3(world) * normal;
    gl_Position = worldViewProjection * vertex;
}
