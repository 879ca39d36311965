// SPDX-License-Identifier: GPL-3.0-or-later
// Opens an exported page from the disk in headless Chromium: it logs no error and asks for nothing from outside, its hair moves,
// and after four seconds of a fixed motion its points lie within 0.05 mm of those of
// the native engine NATIVE_POSITIONS. A page of a colour config shows light within one code value of OpenColorIO's own, which
// VIEW_CODES tells (view_codes.cpp).
//   node page_test.mjs FOLDER NATIVE_POSITIONS PICTURE.png [VIEW_CODES CONFIG DISPLAY VIEW]
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import {pathToFileURL} from 'node:url';
import puppeteer from 'puppeteer-core';

const [folder, native, picture, viewCodes, ...view] = process.argv.slice(2);
const kFrames = 240, kWind = [2, 0, 1.5], kLargestMm = 0.05;

/** Light of all amounts and hues, black and far above white: 64 x 64 pixels of red, green and blue. */
function lights() {
    let state = 1;
    const random = () => (state = (state * 48271) % 2147483647) / 2147483647;
    const all = new Float32Array(3 * 64 * 64);
    for (let i = 0; i < 64 * 64; ++i) {
        const amount = i % 64 === 0 ? 0 : 2 ** (-12 + 20 * random()), hue = i % 4 === 0 ? 0 : random();
        for (let c = 0; c < 3; ++c) all[3 * i + c] = amount * (1 - hue * random());
    }
    return all;
}

/** Those lights as the page's own shader shows them, before its exposure of 1.25: bytes of red, green and blue. */
const shownByPage = (page, light) => page.evaluate(async (numbers) => {
    const {stage} = await globalThis.hairloomPage, {strands, headMaterial, renderer} = stage;
    const Texture = strands.texture.constructor, Geometry = strands.mesh.geometry.constructor;
    const texture = new Texture(new Float32Array(numbers), 64, 64, strands.texture.format, strands.texture.type);
    texture.internalFormat = strands.texture.internalFormat;
    texture.needsUpdate = true;
    const fragmentShader = headMaterial.fragmentShader.split('void main()')[0] + `
        uniform highp sampler2D testLight;
        void main() { colour = vec4(shown(texelFetch(testLight, ivec2(gl_FragCoord.xy), 0).rgb / 1.25), 1.0); }`;
    const material = new strands.material.constructor({
        glslVersion: headMaterial.glslVersion, defines: headMaterial.defines, fragmentShader, depthTest: false,
        uniforms: {...headMaterial.uniforms, testLight: {value: texture}},
        vertexShader: `out vec3 at, normal_ws;
            void main() {
                at = normal_ws = vec3(0.0);
                gl_Position = vec4(float(gl_VertexID & 1) * 4.0 - 1.0, float(gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
            }`,
    });
    const geometry = new Geometry();
    geometry.setIndex(new strands.mesh.geometry.index.constructor(new Uint32Array([0, 1, 2]), 1));
    const mesh = new strands.mesh.constructor(geometry, material);
    mesh.frustumCulled = false;
    const target = new stage.depthTarget.constructor(64, 64), pixels = new Uint8Array(4 * 64 * 64);
    renderer.setRenderTarget(target);
    renderer.render(mesh, stage.camera);
    renderer.readRenderTargetPixels(target, 0, 0, 64, 64, pixels);
    renderer.setRenderTarget(null);
    return Array.from(pixels).filter((_, i) => i % 4 !== 3);
}, Array.from(light));

const browser = await puppeteer.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', '--disable-dev-shm-usage'],
    protocolTimeout: 600000,
});
let failures = 0;
const expect = (good, what) => {
    console.log(`${good ? 'ok  ' : 'FAIL'} ${what}`);
    failures += good ? 0 : 1;
};
try {
    const page = await browser.newPage();
    await page.setViewport({width: 1000, height: 750});
    const complaints = [], asked = [];
    page.on('console', (message) => ['error', 'warn'].includes(message.type()) && complaints.push(message.text()));
    page.on('pageerror', (error) => complaints.push(String(error)));
    page.on('requestfailed', (request) => complaints.push(`${request.url()}: ${request.failure()?.errorText}`));
    page.on('request', (request) => asked.push(request.url()));
    await page.goto(pathToFileURL(path.resolve(folder, 'index.html')).href);
    await page.evaluate(async () => { (await globalThis.hairloomPage).setShare(0.05); });
    await page.waitForFunction(async () => (await globalThis.hairloomPage).frame >= 4, {timeout: 300000, polling: 500});
    // Here the processor draws, so most of the motion is not drawn.
    await page.evaluate(async () => {
        document.getElementById('play').click();
        const shown = await globalThis.hairloomPage;
        shown.setShare(0.25);
        while (shown.frame < 80) shown.advance();
        shown.show(shown.matrix);
    });
    if (picture) await page.screenshot({path: picture});
    const moved = await page.evaluate(async () => {
        const shown = await globalThis.hairloomPage;
        shown.setShare(0.01);
        const points = Float32Array.from(shown.hair.readHairs());
        shown.hair.reset();
        const rest = shown.hair.readHairs();
        let farthest = 0;
        for (let i = 0; i < shown.hair.hairs * shown.hair.pointsPerHair * 3; ++i) farthest = Math.max(farthest, Math.abs(points[i] - rest[i]));
        return farthest;
    });
    expect(moved > 0.005, `hair moves: ${(1000 * moved).toFixed(1)} mm from where it was`);
    const played = await page.evaluate(async (frames, wind) => {
        const shown = await globalThis.hairloomPage;
        shown.rest();
        const matrices = new Float32Array(12 * frames);
        let milliseconds = 0;
        for (let f = 0; f < frames; ++f) {
            const t = (f + 1) / 60, ease = Math.min(t, 1) ** 2 * (3 - 2 * Math.min(t, 1));
            const matrix = Float32Array.from(shown.headAt(0.9 * ease * Math.sin(2 * t), 0.25 * ease * Math.sin(3 * t)));
            matrices.set(matrix, 12 * f);
            const begin = performance.now();
            shown.step(matrix, wind);
            milliseconds += performance.now() - begin;
        }
        const begin = performance.now();
        const hairs = shown.hair.readHairs().slice(0, 3 * shown.hair.hairs * shown.hair.pointsPerHair);
        const read = performance.now() - begin;
        const text = (floats) => {
            const bytes = new Uint8Array(floats.buffer, floats.byteOffset, floats.byteLength);
            let binary = '';
            for (let i = 0; i < bytes.length; i += 32768) binary += String.fromCharCode(...bytes.subarray(i, i + 32768));
            return btoa(binary);
        };
        return {matrices: text(matrices), guides: text(shown.hair.readGuides().slice()), hairs: text(hairs), step: milliseconds / frames, read};
    }, kFrames, kWind);
    const work = fs.mkdtempSync(path.join(folder, 'test-'));
    fs.writeFileSync(path.join(work, 'matrices'), Buffer.from(played.matrices, 'base64'));
    execFileSync(native, [path.join(folder, 'hair.hairrt'), path.join(work, 'matrices'), ...kWind.map(String), path.join(work, 'positions')]);
    const wanted = fs.readFileSync(path.join(work, 'positions'));
    fs.rmSync(work, {recursive: true});
    const got = Buffer.concat([Buffer.from(played.guides, 'base64'), Buffer.from(played.hairs, 'base64')]);
    expect(got.length === wanted.length, `as many points: ${got.length / 12} of ${wanted.length / 12}`);
    let farthest = 0, sum = 0;
    const points = Math.min(got.length, wanted.length) / 12;
    for (let p = 0; p < points; ++p) {
        const d = [0, 4, 8].map((at) => got.readFloatLE(12 * p + at) - wanted.readFloatLE(12 * p + at));
        const apart = 1000 * Math.hypot(...d);
        farthest = Number.isFinite(apart) ? Math.max(farthest, apart) : Infinity;
        sum += apart;
    }
    expect(farthest <= kLargestMm, `after ${kFrames} frames points are at most ${farthest.toPrecision(3)} mm from the native ones, ` +
        `${(sum / points).toPrecision(3)} mm on average`);
    console.log(`     step ${played.step.toFixed(1)} ms, hairs read in ${played.read.toFixed(1)} ms`);
    if (viewCodes) {
        const light = lights(), files = ['light', 'codes'].map((name) => path.join(folder, name));
        fs.writeFileSync(files[0], Buffer.from(light.buffer));
        execFileSync(viewCodes, [...view, ...files]);
        const exact = fs.readFileSync(files[1]), shown = await shownByPage(page, light);
        for (const file of files) fs.rmSync(file);
        let worst = 0, lit = 0;
        for (let i = 0; i < exact.length; ++i) {
            worst = Math.max(worst, Math.abs(exact[i] - shown[i]));
            lit += shown[i] > 0 && shown[i] < 255;
        }
        expect(exact.length === shown.length && lit > 1000 && worst <= 1,
            `light is shown within ${worst} of 255 code values of OpenColorIO's own`);
    }
    expect(complaints.length === 0, `nothing is complained of${complaints.map((text) => `\n     ${text}`).join('')}`);
    const outside = asked.filter((url) => !url.startsWith('file:') && !url.startsWith('data:') && !url.startsWith('blob:'));
    expect(outside.length === 0, `nothing is asked for from outside ${outside.join(' ')}`);
} finally {
    await browser.close();
}
process.exit(failures === 0 ? 0 : 1);
