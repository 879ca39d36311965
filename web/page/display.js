// SPDX-License-Identifier: MIT
// From light to what the screen is sent: by the view of a colour config that the page was exported with, else by a tone curve.
import * as THREE from 'three';

/** Shaders are given shown(): light to code values of sRGB. */
export const displayGlsl = /* glsl */ `
#ifdef VIEW_SIDE
uniform highp sampler3D viewCodes;
uniform float viewToe, viewTop;

vec3 shown(vec3 light) {
    vec3 lit = log2(1.0 + viewToe * clamp(1.25 * light, 0.0, viewTop));
    vec3 place = lit * (float(VIEW_SIDE - 1) / log2(1.0 + viewToe * viewTop));
    vec3 cell = min(floor(place), float(VIEW_SIDE - 2)), part = place - cell;
    // From the first corner of the cell to the last along the channel with the largest part, then the next.
    ivec3 one = ivec3(1, 0, 0), two = ivec3(1, 1, 0);
    vec3 order = part;
    if (part.x >= part.y) {
        if (part.y < part.z) {
            if (part.z > part.x) { one = ivec3(0, 0, 1); two = ivec3(1, 0, 1); order = part.zxy; }
            else { two = ivec3(1, 0, 1); order = part.xzy; }
        }
    } else if (part.y >= part.z) {
        one = ivec3(0, 1, 0);
        if (part.z > part.x) { two = ivec3(0, 1, 1); order = part.yzx; }
        else { order = part.yxz; }
    } else {
        one = ivec3(0, 0, 1);
        two = ivec3(0, 1, 1);
        order = part.zyx;
    }
    ivec3 at = ivec3(cell);
    vec3 sum = texelFetch(viewCodes, at, 0).rgb * (1.0 - order.x);
    sum += texelFetch(viewCodes, at + one, 0).rgb * (order.x - order.y);
    sum += texelFetch(viewCodes, at + two, 0).rgb * (order.y - order.z);
    sum += texelFetch(viewCodes, at + 1, 0).rgb * order.z;
    return clamp(sum, 0.0, 1.0);
}
#else
vec3 shown(vec3 light) {
    return linearToOutputTexel(vec4(1.0 - exp(-light * 1.25), 1.0)).rgb;
}
#endif
`;

/** `view`: side, toe, top and codes (halves) of a table, or null. What materials with displayGlsl take. */
export function displayParts(view) {
    if (!view) return {defines: {}, uniforms: {}};
    const {side} = view;
    const codes = new THREE.Data3DTexture(view.codes, side, side, side);
    codes.format = THREE.RGBFormat;
    codes.internalFormat = 'RGB16F';
    codes.type = THREE.HalfFloatType;
    codes.needsUpdate = true;
    return {
        defines: {VIEW_SIDE: side},
        uniforms: {viewCodes: {value: codes}, viewToe: {value: view.toe}, viewTop: {value: view.top}},
    };
}
