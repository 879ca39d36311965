// SPDX-License-Identifier: MIT
// Plays what hair.js has: an asset, the head, and how to show them.
import {Hair} from './engine.js';
import {Follower, headMatrix, sway} from './motion.js';
import {Stage} from './stage.js';

const kStep = 1 / 60;
const byId = (id) => document.getElementById(id);

function bytesOf(base64) {
    const text = atob(base64), bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    return bytes;
}

function lookOf(hair) {
    const number = (name, otherwise) => {
        const [value] = hair.numbers(name, 1);
        return Number.isNaN(value) ? otherwise : value;
    };
    return {
        rootColour: hair.numbers('material.rootColour', 3),
        tipColour: hair.numbers('material.tipColour', 3),
        rootRadius: number('material.rootRadius', 0.00004),
        tipScale: number('material.tipScale', 0.4),
        colourVariation: number('material.colourVariation', 0.2),
    };
}

class Page {
    constructor(scene, hair) {
        this.hair = hair;
        this.pivot = scene.pivot;
        const head = scene.head && {
            positions: new Float32Array(bytesOf(scene.head.positions).buffer),
            normals: new Int16Array(bytesOf(scene.head.normals).buffer),
            triangles: new Uint32Array(bytesOf(scene.head.triangles).buffer),
        };
        const view = scene.view && {...scene.view, codes: new Uint16Array(bytesOf(scene.view.codes).buffer)};
        const bounds = {middle: scene.middle, radius: scene.radius, pivot: scene.pivot};
        this.stage = new Stage(document.querySelector('canvas'), hair, lookOf(hair), head, bounds, view);
        this.playing = true;
        this.rest();
        document.querySelector('#panel h1').textContent = scene.title;
        document.title = scene.title;
        this.wind = byId('wind');
        this.from = byId('from');
        this.wind.value = Math.hypot(scene.wind[0], scene.wind[2]);
        this.from.value = this.wind.value > 0 ? (Math.atan2(scene.wind[0], scene.wind[2]) * 180) / Math.PI : 90;
        this.#bind();
    }

    #bind() {
        const show = () => {
            byId('windValue').value = `${Number(this.wind.value).toFixed(1)} m/s`;
            byId('fromValue').value = `${this.from.value}°`;
            byId('turnValue').value = `${byId('turn').value}°`;
        };
        for (const id of ['wind', 'from', 'turn']) byId(id).addEventListener('input', show);
        show();
        this.isShareChosen = false;
        byId('share').addEventListener('input', () => {
            this.isShareChosen = true;
            this.setShare(Number(byId('share').value) / 100);
        });
        this.setShare(0.25);
        byId('play').addEventListener('click', () => {
            this.playing = !this.playing;
            byId('play').textContent = this.playing ? 'Pause' : 'Play';
        });
        byId('rest').addEventListener('click', () => this.rest());
    }

    setShare(share) {
        this.share = share;
        byId('share').value = Math.round(100 * share);
        byId('shareValue').value = `${Math.round(100 * share)} %`;
        this.stage.setShare(share);
    }

    /** As many hairs as the machine can draw, unless somebody has said how many. */
    #easeTo(picturesPerSecond) {
        if (this.isShareChosen) return;
        if (picturesPerSecond < 20 && this.share > 0.1) this.setShare(Math.max(0.1, 0.7 * this.share));
        if (picturesPerSecond > 45 && this.share < 1) this.setShare(Math.min(1, 1.5 * this.share));
    }

    rest() {
        this.time = 0;
        this.frame = 0;
        this.turn = new Follower();
        this.nod = new Follower();
        this.hair.reset();
        this.show([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]);
    }

    show(matrix) {
        this.stage.setHead(matrix);
        this.stage.strands.take(this.hair.readHairs());
    }

    windNow() {
        const speed = Number(this.wind.value), angle = (Number(this.from.value) * Math.PI) / 180;
        return [speed * Math.sin(angle), 0, speed * Math.cos(angle)];
    }

    headAt(yaw, nod) {
        return headMatrix(yaw, nod, this.pivot);
    }

    /** One frame of 1/60 s with the head at a matrix. */
    step(matrix, wind) {
        ++this.frame;
        this.hair.setHead(matrix);
        this.hair.step(kStep, this.frame * kStep, wind);
        this.matrix = matrix;
    }

    /** One frame as the controls say. */
    advance() {
        this.time += kStep;
        const own = byId('sway').checked ? sway(this.time) : {yaw: 0, nod: 0};
        if (!byId('sway').checked) this.time = 0;
        const yaw = this.turn.step((Number(byId('turn').value) * Math.PI) / 180 + own.yaw, kStep);
        this.step(this.headAt(yaw, this.nod.step(own.nod, kStep)), this.windNow());
    }

    run() {
        let last = performance.now(), owed = 0, shown = last, frames = 0, spent = 0;
        const tick = (now) => {
            owed = Math.min(owed + (now - last) / 1000, 2 * kStep);
            last = now;
            const begin = performance.now();
            let moved = false;
            for (; this.playing && owed >= kStep; owed -= kStep) {
                this.advance();
                moved = true;
            }
            if (moved) this.show(this.matrix);
            spent += performance.now() - begin;
            if (this.stage.draw(moved)) ++frames;
            if (now - shown > 500) {
                const each = (spent / Math.max(frames, 1)).toFixed(1);
                byId('state').textContent = `${this.hair.hairs.toLocaleString('en')} hairs on ` +
                    `${this.hair.guides.toLocaleString('en')} guides · ${Math.round((frames * 1000) / (now - shown))} pictures a second · ${each} ms of motion`;
                if (this.playing) this.#easeTo((frames * 1000) / (now - shown));
                shown = now;
                frames = spent = 0;
            }
            requestAnimationFrame(tick);
        };
        requestAnimationFrame(tick);
    }
}

async function start() {
    const scene = globalThis.hairloomScene;
    if (!scene) throw new Error('hair.js is missing beside this page');
    const page = new Page(scene, await Hair.open(bytesOf(scene.asset)));
    page.run();
    return page;
}

/** The page once it runs; what tests ask. */
globalThis.hairloomPage = start().catch((error) => {
    const trouble = byId('trouble');
    trouble.textContent = `This page cannot show its hair: ${error.message}`;
    trouble.hidden = false;
    throw error;
});
