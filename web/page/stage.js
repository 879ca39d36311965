// SPDX-License-Identifier: MIT
// What is seen: head, hair, lights, and the map of depths from the light.
import * as THREE from 'three';
import {OrbitControls} from 'three/examples/jsm/controls/OrbitControls.js';
import {displayGlsl, displayParts} from './display.js';
import {Strands} from './strands.js';

const kMap = 1024;

/** The head's mesh in clay, shadowed by hair as hair is. */
const headFragment = displayGlsl + /* glsl */ `
uniform vec3 lightColour, skyColour, groundColour, rimColour, light, rim;
uniform highp sampler2D depths;
uniform mat4 toLight;
uniform float lightDepth;
in vec3 at, normal_ws;
out vec4 colour;
void main() {
    vec3 n = normalize(normal_ws), eye = normalize(cameraPosition - at);
    vec3 map = (toLight * vec4(at + n * 0.002, 1.0)).xyz * 0.5 + 0.5;
    float reach = 0.0;
    vec2 texel = 2.0 / vec2(textureSize(depths, 0));
    for (int i = 0; i < 9; ++i) {
        vec2 offset = vec2(float(i % 3) - 1.0, float(i / 3) - 1.0) * texel;
        float behind = max(0.0, map.z - texture(depths, map.xy + offset).r - 0.002) * lightDepth;
        reach += exp(-160.0 * behind) / 9.0;
    }
    vec3 skin = vec3(0.27, 0.205, 0.172);
    float wrap = clamp((dot(n, light) + 0.25) / 1.25, 0.0, 1.0);
    vec3 sum = skin * lightColour * wrap * mix(vec3(1.0, 0.55, 0.45) * 0.08, vec3(1.0), reach);
    sum += skin * mix(groundColour, skyColour, 0.5 + 0.5 * n.y) * mix(0.55, 1.0, reach);
    sum += rimColour * 0.25 * skin * pow(1.0 - max(dot(n, eye), 0.0), 3.0) * max(dot(n, rim), 0.0);
    float gloss = pow(max(dot(n, normalize(light + eye)), 0.0), 28.0);
    sum += lightColour * 0.03 * gloss * reach;
    colour = vec4(shown(sum), 1.0);
}
`;
const headVertex = /* glsl */ `
out vec3 at, normal_ws;
void main() {
    at = (modelMatrix * vec4(position, 1.0)).xyz;
    normal_ws = mat3(modelMatrix) * normal;
    gl_Position = projectionMatrix * viewMatrix * vec4(at, 1.0);
}
`;

export class Stage {
    /** `view`: as displayParts() takes it. */
    constructor(canvas, hair, look, head, bounds, view) {
        this.renderer = new THREE.WebGLRenderer({canvas, antialias: true, powerPreference: 'high-performance'});
        this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
        this.scene = new THREE.Scene();
        this.scene.background = new THREE.Color(0x2a2c31);
        this.camera = new THREE.PerspectiveCamera(28, 1, 0.02, 20);
        this.controls = new OrbitControls(this.camera, canvas);
        const middle = new THREE.Vector3(...bounds.middle);
        const reach = bounds.radius;
        this.camera.position.copy(middle).add(new THREE.Vector3(0.55, 0.18, 0.85).normalize().multiplyScalar(reach * 4.6));
        this.controls.target.copy(middle);
        this.controls.enableDamping = true;
        this.controls.minDistance = reach * 0.8;
        this.controls.maxDistance = reach * 15;
        this.controls.enablePan = false;

        this.depthTarget = new THREE.WebGLRenderTarget(kMap, kMap, {depthTexture: new THREE.DepthTexture(kMap, kMap, THREE.FloatType)});
        const towards = new THREE.Vector3(0.75, 0.9, 0.65).normalize();
        this.sun = new THREE.OrthographicCamera(-reach * 1.5, reach * 1.5, reach * 1.5, -reach * 1.5, reach, reach * 5);
        this.sun.position.copy(middle).addScaledVector(towards, reach * 3);
        this.sun.lookAt(middle);
        this.sun.updateMatrixWorld();
        const toLight = new THREE.Matrix4().multiplyMatrices(this.sun.projectionMatrix, this.sun.matrixWorldInverse);
        const lights = {
            light: {value: towards},
            rim: {value: new THREE.Vector3(-0.7, 0.45, -0.75).normalize()},
            lightColour: {value: new THREE.Vector3(2.0, 1.9, 1.75)},
            rimColour: {value: new THREE.Vector3(1.3, 1.45, 1.7)},
            skyColour: {value: new THREE.Vector3(0.40, 0.45, 0.53)},
            groundColour: {value: new THREE.Vector3(0.20, 0.175, 0.155)},
            middle: {value: new THREE.Vector3(...bounds.pivot)},
            depths: {value: this.depthTarget.depthTexture},
            toLight: {value: toLight},
            lightDepth: {value: reach * 4},
        };
        const display = displayParts(view);
        this.strands = new Strands(hair.hairs, hair.pointsPerHair, look, lights, display);
        this.scene.add(this.strands.mesh);
        this.head = null;
        if (head) this.#addHead(head, lights, display);
        new ResizeObserver(() => this.#fit()).observe(canvas);
        this.#fit();
    }

    #addHead(head, lights, display) {
        const geometry = new THREE.BufferGeometry();
        geometry.setAttribute('position', new THREE.BufferAttribute(head.positions, 3));
        geometry.setAttribute('normal', new THREE.BufferAttribute(head.normals, 3, true));
        geometry.setIndex(new THREE.BufferAttribute(head.triangles, 1));
        this.headMaterial = new THREE.ShaderMaterial({
            glslVersion: THREE.GLSL3, vertexShader: headVertex, fragmentShader: headFragment, defines: display.defines,
            uniforms: {...lights, ...display.uniforms}, side: THREE.DoubleSide});
        this.headDepth = new THREE.MeshBasicMaterial({side: THREE.DoubleSide});
        this.head = new THREE.Mesh(geometry, this.headMaterial);
        this.head.matrixAutoUpdate = false;
        this.head.frustumCulled = false;
        this.scene.add(this.head);
    }

    #fit() {
        const canvas = this.renderer.domElement;
        const width = canvas.clientWidth || 1, height = canvas.clientHeight || 1;
        this.renderer.setSize(width, height, false);
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
        const pixels = height * this.renderer.getPixelRatio();
        this.isStale = true;
        this.strands.material.uniforms.pixel.value = 2 * Math.tan((this.camera.fov * Math.PI) / 360) / pixels;
    }

    /** Three rows of four. */
    setHead(rows) {
        this.isStale = true;
        if (!this.head) return;
        this.head.matrix.set(...rows, 0, 0, 0, 1);
        this.head.matrixWorldNeedsUpdate = true;
    }

    /** Draws that share of the hairs. */
    setShare(share) {
        this.strands.setShare(share);
        this.isStale = true;
    }

    /** A picture, where hair, camera or window have changed since the last; whether they have. */
    draw(hairMoved) {
        if (!this.controls.update() && !hairMoved && !this.isStale) return false;
        this.isStale = false;
        const {strands, renderer, scene} = this;
        strands.mesh.material = strands.depthMaterial;
        if (this.head) this.head.material = this.headDepth;
        renderer.setRenderTarget(this.depthTarget);
        renderer.clear();
        renderer.render(scene, this.sun);
        strands.mesh.material = strands.material;
        if (this.head) this.head.material = this.headMaterial;
        renderer.setRenderTarget(null);
        renderer.render(scene, this.camera);
        return true;
    }
}
