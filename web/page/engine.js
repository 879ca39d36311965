// SPDX-License-Identifier: MIT
// The engine's functions (../engine.cpp) for one asset.
import makeModule from 'hairloom-engine';

export class Hair {
    /** Of an asset's bytes. Throws what the engine says of it. */
    static async open(bytes) {
        const module = await makeModule();
        const at = module._hairReserve(bytes.length);
        module.HEAPU8.set(bytes, at);
        const hair = new Hair(module);
        hair.#must(module._hairOpen(bytes.length));
        return hair;
    }

    constructor(module) {
        this.module = module;
    }
    #must(code) {
        if (code !== 0) throw new Error(this.module.UTF8ToString(this.module._hairWords()));
    }

    get guides() { return this.module._hairGuideCount(); }
    get hairs() { return this.module._hairCount(); }
    get pointsPerHair() { return this.module._hairPointsPerHair(); }

    /** Numbers of a setting: numbers('material.rootColour', 3). */
    numbers(name, count) {
        const module = this.module;
        module.HEAPU8.set(new TextEncoder().encode(name + '\0'), module._hairName());
        return Array.from({length: count}, (_, i) => module._hairNumber(i));
    }

    /** On the head at rest, without speed. */
    reset() {
        this.setHead([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]);
        this.#must(this.module._hairReset());
    }
    /** Three rows of four, from the head at rest to the world. */
    setHead(matrix) {
        this.module.HEAPF32.set(matrix, this.module._hairHeadMatrix() >> 2);
    }
    /** `wind` in m/s; null: what the asset says. */
    step(dt, time, wind) {
        const [x, y, z] = wind ?? [0, 0, 0];
        this.#must(this.module._hairStep(dt, time, x, y, z, wind === null ? 1 : 0));
    }
    #view(at, floats) {
        if (at === 0) this.#must(-1);
        return this.module.HEAPF32.subarray(at >> 2, (at >> 2) + floats);
    }
    /** Positions, hair after hair, root to tip, filled up to whole rows of 1,024 points. Until the next call. */
    readHairs() {
        const points = this.hairs * this.pointsPerHair;
        return this.#view(this.module._hairReadHairs(), 3 * Math.ceil(points / 1024) * 1024);
    }
    readGuides() {
        return this.#view(this.module._hairReadGuides(), 3 * this.module._hairGuidePoints());
    }
}
