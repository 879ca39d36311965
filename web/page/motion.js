// SPDX-License-Identifier: MIT
// How the head moves. Matrices are three rows of four and turn about a pivot.

/** Turned by `yaw` about the upright axis, then by `nod` about the one through the ears; radians. */
export function headMatrix(yaw, nod, pivot) {
    const c = Math.cos(yaw), s = Math.sin(yaw), d = Math.cos(nod), t = Math.sin(nod);
    const rows = [c, s * t, s * d, 0, 0, d, -t, 0, -s, c * t, c * d, 0];
    for (let r = 0; r < 3; ++r) {
        const turned = rows[4 * r] * pivot[0] + rows[4 * r + 1] * pivot[1] + rows[4 * r + 2] * pivot[2];
        rows[4 * r + 3] = pivot[r] - turned;
    }
    return rows;
}

/** What a person does who shows hair; radians at a time in seconds, from rest. */
export function sway(time) {
    const rise = Math.min(time / 1.5, 1), eased = rise * rise * (3 - 2 * rise);
    return {yaw: eased * 0.75 * Math.sin(1.5 * time), nod: eased * 0.16 * Math.sin(2.3 * time)};
}

/** Comes to `target` without a jump in speed: a critically damped spring, exact for any dt. */
export class Follower {
    value = 0;
    speed = 0;
    step(target, dt) {
        const omega = 9, apart = this.value - target, decay = Math.exp(-omega * dt);
        const carried = (this.speed + omega * apart) * dt;
        this.value = target + (apart + carried) * decay;
        this.speed = (this.speed - omega * carried) * decay;
        return this.value;
    }
}
