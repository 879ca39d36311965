#version 330
// SPDX-License-Identifier: GPL-3.0-or-later
// Metres from the plane of the sun.
uniform vec3 sun, sunPosition;
in vec3 at;
out float depth;
void main() {
    depth = dot(sunPosition - at, sun);
}
