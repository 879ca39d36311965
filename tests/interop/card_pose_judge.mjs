// SPDX-License-Identifier: GPL-3.0-or-later
// node card_pose_judge.mjs CHARACTER.glb HAIR.glb: three.js plays each clip of the character, poses the hair's bones of the same names, and measures
// how far vertices that hang on the character leave their places on its skin. Fails where more than one in fifty is farther off than a thousandth
// of the character's height, or any than a hundredth: cards reach a little beyond the roots that they move with, where the skin may have other weights.
import fs from "fs";
import { createRequire } from "module";
import path from "path";
import { pathToFileURL } from "url";

const require = createRequire(process.env.NODE_PATH ? `${path.resolve(process.env.NODE_PATH)}/` : import.meta.url);
const THREE = await import(pathToFileURL(require.resolve("three")).href);
const { GLTFLoader } = await import(pathToFileURL(require.resolve("three/addons/loaders/GLTFLoader.js")).href);
globalThis.self = globalThis;

/** The file without pictures, which Node cannot decode. */
function withoutPictures(bytes) {
    const length = bytes.readUInt32LE(12);
    const json = JSON.parse(bytes.subarray(20, 20 + length).toString());
    for (const what of ["images", "textures", "samplers", "materials"]) delete json[what];
    for (const mesh of json.meshes) for (const primitive of mesh.primitives) delete primitive.material;
    let text = Buffer.from(JSON.stringify(json));
    text = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, 32)]);
    const head = Buffer.alloc(20);
    bytes.copy(head, 0, 0, 20);
    head.writeUInt32LE(20 + text.length + bytes.length - 20 - length, 8);
    head.writeUInt32LE(text.length, 12);
    return Buffer.concat([head, text, bytes.subarray(20 + length)]);
}

async function load(file) {
    const bytes = withoutPictures(fs.readFileSync(file));
    const gltf = await new GLTFLoader().parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), "");
    const meshes = [];
    gltf.scene.traverse((node) => node.isSkinnedMesh && meshes.push(node));
    gltf.scene.updateMatrixWorld(true);
    return { scene: gltf.scene, clips: gltf.animations, meshes };
}

/** Where three.js puts a vertex, in the world. */
function posed(mesh, vertex) {
    const at = new THREE.Vector3().fromBufferAttribute(mesh.geometry.attributes.position, vertex);
    return mesh.applyBoneTransform(vertex, at).applyMatrix4(mesh.matrixWorld);
}

const [characterFile, hairFile] = process.argv.slice(2);
const character = await load(characterFile);
const hair = await load(hairFile);
const characterBones = new Map();
for (const mesh of character.meshes)
    mesh.skeleton.bones.forEach((bone, b) => characterBones.set(bone.name, { bone, inverse: mesh.skeleton.boneInverses[b] }));
const cards = hair.meshes[0];
const skeleton = cards.skeleton;
const shared = skeleton.bones.map((bone) => characterBones.get(bone.name));
// From the character as it was bound to the hair's space.
const b = shared.findIndex((one) => one);
if (b < 0) throw new Error("no bone of the hair has the name of one of the character's");
const toHair = skeleton.boneInverses[b].clone().invert().multiply(shared[b].inverse);

const triangles = [];
const bounds = new THREE.Box3();
for (const mesh of character.meshes) {
    const { index, attributes } = mesh.geometry;
    const rest = [];
    for (let v = 0; v < attributes.position.count; ++v) {
        rest.push(new THREE.Vector3().fromBufferAttribute(attributes.position, v).applyMatrix4(mesh.bindMatrix).applyMatrix4(toHair));
        bounds.expandByPoint(rest[v]);
    }
    for (let i = 0; i < index.count; i += 3) {
        const corners = [0, 1, 2].map((k) => index.getX(i + k));
        triangles.push({ mesh, corners, shape: new THREE.Triangle(...corners.map((c) => rest[c])) });
    }
}
const height = bounds.max.y - bounds.min.y;

/** Vertices that no chain moves, with the places on the skin nearest to them. */
const held = [];
const { skinIndex, skinWeight, position } = cards.geometry.attributes;
for (let v = 0; v < position.count; ++v) {
    let share = 0;
    for (let k = 0; k < 4; ++k) share += shared[skinIndex.getComponent(v, k)] ? skinWeight.getComponent(v, k) : 0;
    if (share < 0.9999) continue;
    const at = new THREE.Vector3().fromBufferAttribute(position, v);
    let best = null;
    const near = new THREE.Vector3();
    for (const triangle of triangles) {
        triangle.shape.closestPointToPoint(at, near);
        const off = near.distanceTo(at);
        if (!best || off < best.off) best = { vertex: v, off, triangle, weights: triangle.shape.getBarycoord(near, new THREE.Vector3()) };
    }
    if (best.off < 0.003 * height) held.push(best);
}

const mixer = new THREE.AnimationMixer(character.scene);
let way = 0;
for (const clip of character.clips) {
    mixer.stopAllAction();
    mixer.clipAction(clip).play();
    for (let step = 0; step < 6; ++step) {
        mixer.setTime((clip.duration * step) / 6);
        character.scene.updateMatrixWorld(true);
        // Parents first: traverse() goes that way.
        hair.scene.traverse((node) => {
            const own = characterBones.get(node.name);
            if (own) node.matrixWorld.copy(own.bone.matrixWorld);
            else if (node.parent && !node.isMesh) node.matrixWorld.multiplyMatrices(node.parent.matrixWorld, node.matrix);
        });
        for (const one of held) {
            const there = posed(cards, one.vertex);
            const skin = new THREE.Vector3();
            one.triangle.corners.forEach((corner, k) => skin.addScaledVector(posed(one.triangle.mesh, corner), one.weights.getComponent(k)));
            one.worst = Math.max(one.worst ?? 0, Math.abs(there.distanceTo(skin) - one.off));
            way = Math.max(way, there.distanceTo(new THREE.Vector3().fromBufferAttribute(position, one.vertex)));
        }
    }
}
const most = 0.001 * height;
const worst = Math.max(...held.map((one) => one.worst));
const far = held.filter((one) => one.worst > most).length;
console.log(
    `${hairFile}: ${held.length} of ${position.count} vertices on the skin, ${character.clips.length} clips, which move them up to ` +
        `${(1000 * way).toFixed(1)} mm: at most ${(1000 * worst).toFixed(2)} mm off it, ${far} more than ${(1000 * most).toFixed(2)}`,
);
process.exit(held.length > 0 && way > most && worst <= 10 * most && far <= held.length / 50 ? 0 : 1);
