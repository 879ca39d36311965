# SPDX-License-Identifier: GPL-3.0-or-later
"""Newton's rods: a capsule a segment and elastic joints, by augmented vertex block descent in single precision, on the CPU.

It raises moments of inertia that are smaller than it trusts, which those of a hair are: mass and stiffness are HEAVIER times those of
hair here, which moves the same. A hair's own resistance to stretching is lost in single precision beside that to bending, and strands
hang limp: they stretch SOFTER times as easily, by up to 1 % under their own weight."""
import time

import newton
import numpy
import warp

import scene

HEAVIER, SOFTER = 1e9, 1e4
AREA = numpy.pi * scene.DIAMETER**2 / 4
EI = HEAVIER * scene.BENDING * scene.DENSITY * AREA
EA = HEAVIER * scene.YOUNG * AREA / SOFTER


def make_model(rest):
    """And the bodies, strands × segments."""
    builder = newton.ModelBuilder(up_axis=newton.Axis.Y, gravity=(0.0, -scene.GRAVITY, 0.0))
    section = builder.default_shape_cfg.copy()
    section.density, section.has_shape_collision = HEAVIER * scene.DENSITY, False
    bodies = []
    for points in rest:
        rod = newton.Rod(points, radius=scene.DIAMETER / 2, stretch_rigidity=EA, shear_rigidity=EA / 3, bend_rigidity=EI,
                         twist_rigidity=scene.TORSION * EI)
        bodies.append(builder.add_rod(rod=rod, cfg=section, wrap_in_articulation=False)[0])
        root = bodies[-1][0]  # without mass: nothing but the head moves it
        builder.body_mass[root] = builder.body_inv_mass[root] = 0.0
        builder.body_inertia[root] = builder.body_inv_inertia[root] = warp.mat33(0.0)
    builder.color()
    return builder.finalize(device="cpu", skip_validation_joints=True), numpy.array(bodies)


def along(quaternions):
    """Where the third axis points, of quaternions x, y, z, w."""
    x, y, z, w = numpy.moveaxis(quaternions, -1, 0)
    return numpy.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], axis=-1)


def points_of(poses, halves):
    """Points where segments meet: half way between the ends of both."""
    ends = along(poses[..., 3:]) * halves[..., None]
    before, after = poses[..., :3] - ends, poses[..., :3] + ends
    return numpy.concatenate([before[:, :1], (after[:, :-1] + before[:, 1:]) / 2, after[:, -1:]], axis=1)


def about_vertical(quaternions, radians):
    """Turned further, as a right hand does."""
    c, s = numpy.cos(radians / 2), numpy.sin(radians / 2)
    x, y, z, w = numpy.moveaxis(quaternions, -1, 0)
    return numpy.stack([c * x + s * z, c * y + s * w, c * z - s * x, c * w - s * y], axis=-1)


def simulate(rest, setting, damping, turning, frames):
    substeps, iterations = setting
    model, bodies = make_model(rest)
    solver = newton.solvers.SolverVBD(model, iterations=iterations)
    now, then, control, step = model.state(), model.state(), model.control(), 1 / (scene.FPS * substeps)
    halves = numpy.linalg.norm(numpy.diff(rest, axis=1), axis=2) / 2
    roots, start = bodies[:, 0], now.body_q.numpy()[bodies[:, 0]].copy()
    keep = numpy.exp(-damping * step)
    positions, seconds = numpy.empty((frames, *rest.shape)), 0.0
    for frame in range(frames):
        before = time.process_time()
        for substep in range(substeps):
            radians = scene.angle((frame + (substep + 1) / substeps) / scene.FPS) if turning else 0.0
            pose = numpy.concatenate([scene.turned(start[:, :3], radians), about_vertical(start[:, 3:], radians)], axis=1)
            now.body_q.numpy()[roots] = then.body_q.numpy()[roots] = pose
            now.body_qd.numpy()[:] *= keep
            now.clear_forces()
            solver.step(now, then, control, None, step)
            now, then = then, now
        if frame > 0 or frames == 1:  # the first one compiles
            seconds += time.process_time() - before
        positions[frame] = points_of(now.body_q.numpy()[bodies], halves)
    return positions, seconds * frames / max(frames - 1, 1)


if __name__ == "__main__":
    warp.config.quiet = True
    ladder = [(2, 5), (5, 10), (10, 10), (10, 20), (10, 40)]
    scene.measure("Newton", newton.__version__, {f"{a} substeps × {b}": (a, b) for a, b in ladder}, ("20 substeps × 80", (20, 80)),
                  ("10 substeps × 80", (10, 80)), simulate, compared=3, timed_frames=4)
