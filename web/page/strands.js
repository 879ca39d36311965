// SPDX-License-Identifier: MIT
// Hairs as ribbons that face the camera. Positions are a texture, one texel a point; a vertex knows by its number which point and
// side it is.
// Light: Kajiya and Kay 1989 with two shifted highlights (Scheuermann 2004); what hair lies between a point
// and the light takes of it is told by the depth of the first hair the light meets.
import * as THREE from 'three';
import {displayGlsl} from './display.js';

const vertexCommon = /* glsl */ `
uniform highp sampler2D points;
uniform int pointsPerHair;
uniform uint hairs;
uniform float radius, tipScale, pixel, least;

vec3 pointOf(int hair, int p) {
    int texel = hair * pointsPerHair + clamp(p, 0, pointsPerHair - 1);
    return texelFetch(points, ivec2(texel & 1023, texel >> 10), 0).xyz;
}
// The first ribbons are hairs from everywhere: those of one guide follow each other in the texture.
int hairNow() {
    return int((uint(gl_VertexID / (2 * pointsPerHair)) * 7919u) % hairs);
}
int pointNow() {
    return (gl_VertexID >> 1) % pointsPerHair;
}
float sideNow() {
    return (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
}
float noise(int hair, int salt) {
    uint x = uint(hair) * 747796405u + uint(salt) * 2891336453u;
    x = ((x >> ((x >> 28u) + 4u)) ^ x) * 277803737u;
    return float((x >> 22u) ^ x) / 4294967295.0;
}
`;

const vertexShader = vertexCommon + /* glsl */ `
out vec3 at, along;
out float share, cover, across, tone;
void main() {
    int p = pointNow(), hair = hairNow();
    vec3 here = pointOf(hair, p);
    vec3 tangent = pointOf(hair, p + 1) - pointOf(hair, p - 1);
    along = tangent / max(length(tangent), 1e-9);
    share = float(p) / float(pointsPerHair - 1);
    vec3 eye = cameraPosition - here;
    vec3 side = cross(along, eye);
    side /= max(length(side), 1e-9);
    float half_ = radius * mix(1.0, tipScale, share);
    float narrowest = 0.5 * least * pixel * length(eye);
    cover = clamp(half_ / narrowest, 0.0, 1.0);
    across = sideNow();
    at = here + side * (across * max(half_, narrowest));
    tone = noise(hair, 1);
    gl_Position = projectionMatrix * viewMatrix * vec4(at, 1.0);
}
`;

const fragmentShader = displayGlsl + /* glsl */ `
uniform vec3 rootColour, tipColour, lightColour, skyColour, groundColour, rimColour, light, rim, middle;
uniform float variation, absorption;
uniform highp sampler2D depths;
uniform mat4 toLight;
uniform float lightDepth;
in vec3 at, along;
in float share, cover, across, tone;
out vec4 colour;

float lit() {
    vec4 seen = toLight * vec4(at, 1.0);
    vec3 map = seen.xyz * 0.5 + 0.5;
    float sum = 0.0;
    vec2 texel = 1.3 / vec2(textureSize(depths, 0));
    for (int i = 0; i < 4; ++i) {
        vec2 offset = vec2(float(i & 1) * 2.0 - 1.0, float(i >> 1) * 2.0 - 1.0) * texel;
        float behind = max(0.0, map.z - texture(depths, map.xy + offset.yx * (0.6 + tone)).r) * lightDepth;
        sum += exp(-absorption * behind);
    }
    return 0.25 * sum;
}
float lobe(vec3 tangent, vec3 halfway, float sharpness) {
    float d = dot(tangent, halfway);
    float facing = smoothstep(-1.0, 0.0, d);
    return facing * pow(sqrt(max(0.0, 1.0 - d * d)), sharpness);
}
vec3 shine(vec3 base, vec3 towards, vec3 eye, vec3 normal, vec3 power) {
    vec3 halfway = normalize(towards + eye);
    vec3 t1 = normalize(along + normal * (0.09 + 0.10 * (tone - 0.5)));
    vec3 t2 = normalize(along - normal * (0.12 - 0.14 * (tone - 0.5)));
    float d = dot(along, towards);
    float diffuse = sqrt(max(0.0, 1.0 - d * d)) * clamp(0.55 + 0.45 * dot(normal, towards), 0.0, 1.0);
    vec3 warm = sqrt(base) * base * 3.0 + base * 0.4;
    return power * (base * diffuse * 0.85 + vec3(0.055) * lobe(t1, halfway, 90.0) + warm * 0.55 * lobe(t2, halfway, 22.0));
}
void main() {
    vec3 eye = normalize(cameraPosition - at);
    vec3 outward = normalize(at - middle);
    vec3 normal = normalize(outward - along * dot(outward, along) + 1e-4);
    vec3 base = mix(rootColour, tipColour, smoothstep(0.0, 1.0, share)) * (1.0 + variation * 1.6 * (tone - 0.5));
    float reach = lit();
    vec3 sum = shine(base, light, eye, normal, lightColour * reach);
    sum += shine(base, rim, eye, normal, rimColour * smoothstep(-0.2, 0.6, dot(outward, rim)));
    float inner = mix(0.45, 1.0, smoothstep(0.0, 0.35, share)) * mix(0.5, 1.0, reach);
    sum += base * mix(groundColour, skyColour, 0.5 + 0.5 * normal.y) * inner;
    float alpha = cover * smoothstep(1.0, 0.82, abs(across) * share) * 1.35;
    colour = vec4(shown(sum), min(1.0, alpha + 0.18 * (tone - 0.5)));
}
`;

const depthVertex = vertexCommon + /* glsl */ `
uniform vec3 light;
void main() {
    int p = pointNow(), hair = hairNow();
    vec3 here = pointOf(hair, p);
    vec3 tangent = pointOf(hair, p + 1) - pointOf(hair, p - 1);
    vec3 side = cross(tangent, light);
    side /= max(length(side), 1e-9);
    gl_Position = projectionMatrix * viewMatrix * vec4(here + side * (sideNow() * radius * 3.0), 1.0);
}
`;

/** Two triangles a segment of every hair. */
function ribbons(hairs, points) {
    const triangles = new Uint32Array(hairs * (points - 1) * 6);
    let at = 0;
    for (let hair = 0; hair < hairs; ++hair) {
        for (let p = 0; p + 1 < points; ++p) {
            const v = 2 * (hair * points + p);
            triangles.set([v, v + 1, v + 2, v + 2, v + 1, v + 3], at);
            at += 6;
        }
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
    return geometry;
}

export class Strands {
    /** `look`: rootColour, tipColour, rootRadius, tipScale, colourVariation of the material. `display`: displayParts(). */
    constructor(hairs, pointsPerHair, look, lights, display) {
        const rows = Math.ceil((hairs * pointsPerHair) / 1024);
        this.texture = new THREE.DataTexture(new Float32Array(3 * 1024 * rows), 1024, rows, THREE.RGBFormat, THREE.FloatType);
        this.texture.internalFormat = 'RGB32F';
        const geometry = ribbons(hairs, pointsPerHair);
        this.hairs = hairs;
        this.indicesPerHair = (pointsPerHair - 1) * 6;
        this.rootRadius = look.rootRadius;
        const shared = {
            points: {value: this.texture},
            pointsPerHair: {value: pointsPerHair},
            hairs: {value: hairs},
            radius: {value: look.rootRadius},
            tipScale: {value: look.tipScale},
            light: lights.light,
        };
        const colour = (rgb) => ({value: new THREE.Vector3(...rgb)});
        this.material = new THREE.ShaderMaterial({
            glslVersion: THREE.GLSL3, vertexShader, fragmentShader, side: THREE.DoubleSide, alphaToCoverage: true,
            defines: display.defines,
            uniforms: {
                ...shared, ...lights, ...display.uniforms,
                pixel: {value: 0.001}, least: {value: 1.1},
                rootColour: colour(look.rootColour), tipColour: colour(look.tipColour),
                variation: {value: look.colourVariation}, absorption: {value: 75},
            },
        });
        this.depthMaterial = new THREE.ShaderMaterial({
            glslVersion: THREE.GLSL3, vertexShader: depthVertex, side: THREE.DoubleSide, uniforms: shared,
            fragmentShader: 'out vec4 colour; void main() { colour = vec4(1.0); }',
        });
        this.mesh = new THREE.Mesh(geometry, this.material);
        this.mesh.frustumCulled = false;
        this.setShare(1);
    }

    /** Draws that share of the hairs, evenly over the head, and wider: they stand for the hundred thousand of a head. */
    setShare(share) {
        const count = Math.max(1, Math.round(this.hairs * share));
        this.mesh.geometry.setDrawRange(0, count * this.indicesPerHair);
        this.material.uniforms.radius.value = this.rootRadius * Math.min(4, Math.sqrt(100000 / count));
    }

    /** Positions as Hair.readHairs() gives them. */
    take(positions) {
        this.texture.image.data = positions;
        this.texture.needsUpdate = true;
    }
}
