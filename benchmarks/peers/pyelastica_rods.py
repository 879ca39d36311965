# SPDX-License-Identifier: GPL-3.0-or-later
"""PyElastica: Cosserat rods that stretch and shear, by explicit steps.

Its steps must follow waves across the fibre, so that hair of 80 µm would need some 25 million steps a second: fibres are 1 mm thick
here and as much softer, with the same bending and twist per mass."""
import time
from importlib.metadata import version

import elastica
import numpy

import scene

DIAMETER = 1e-3
YOUNG = scene.BENDING * 16 * scene.DENSITY / DIAMETER**2
SHEAR = scene.TORSION * YOUNG / 2


class Simulator(elastica.BaseSystemCollection, elastica.Constraints, elastica.Forcing, elastica.Damping):
    pass


class Turn:
    """Of the head: rotation and speed, worked out once for all rods."""

    def __init__(self, turning):
        self.turning, self.time = turning, None

    def at(self, time):
        if time != self.time:
            radians, rate = 0.0, 0.0
            if self.turning:
                radians, rate = scene.angle(time), (scene.angle(time + 1e-6) - scene.angle(time - 1e-6)) / 2e-6
            self.time, self.matrix, self.axis = time, scene.turned(numpy.eye(3), radians), numpy.array([0.0, rate, 0.0])
        return self


class Root(elastica.ConstraintBase):
    """Holds the first point and the first segment's frame, and turns them with the head."""

    def __init__(self, turn, **words):
        super().__init__(**words)
        self.turn = turn
        self.position, self.directors = self._system.position_collection[:, 0].copy(), self._system.director_collection[:, :, 0].copy()

    def constrain_values(self, system, time):
        matrix = self.turn.at(time).matrix
        system.position_collection[:, 0] = self.position @ matrix
        system.director_collection[:, :, 0] = self.directors @ matrix

    def constrain_rates(self, system, time):
        axis = self.turn.at(time).axis
        x, _, z = system.position_collection[:, 0]
        system.velocity_collection[:, 0] = axis[1] * z, 0.0, -axis[1] * x
        system.omega_collection[:, 0] = system.director_collection[:, :, 0] @ axis


def make_rod(points):
    edges = numpy.diff(points, axis=0)
    lengths = numpy.linalg.norm(edges, axis=1)
    along = edges / lengths[:, None]
    # Strands bend in a vertical plane, across which one axis of every frame stands.
    across = numpy.cross(along[0], [0.0, 1.0, 0.0])
    across /= numpy.linalg.norm(across)
    frames = numpy.stack([numpy.tile(across, (len(along), 1)), numpy.cross(along, across), along])
    rod = elastica.CosseratRod.straight_rod(
        len(along), points[0], along[0], across, lengths.sum(), DIAMETER / 2, scene.DENSITY, youngs_modulus=YOUNG, shear_modulus=SHEAR,
        position=points.T.copy(), directors=frames.transpose(0, 2, 1).copy())
    rod.compute_internal_forces_and_torques(0.0)
    rod.rest_kappa[:] = rod.kappa
    return rod


def simulate(rest, steps, damping, turning, frames):
    simulator, rods, step, turn = Simulator(), [make_rod(points) for points in rest], 1 / (scene.FPS * steps), Turn(turning)
    for rod in rods:
        simulator.append(rod)
        simulator.constrain(rod).using(Root, turn=turn)
        simulator.add_forcing_to(rod).using(elastica.GravityForces, acc_gravity=numpy.array([0.0, -scene.GRAVITY, 0.0]))
        simulator.dampen(rod).using(elastica.AnalyticalLinearDamper, uniform_damping_constant=damping, time_step=step)
    simulator.finalize()
    stepper, now = elastica.PositionVerlet(), 0.0
    positions = numpy.empty((frames, *rest.shape))
    stepper.step(simulator, now, 1e-12)  # compiles
    before = time.process_time()
    for frame in range(frames):
        for _ in range(steps):
            now = stepper.step(simulator, now, step)
        positions[frame] = [rod.position_collection.T for rod in rods]
    return positions, time.process_time() - before


if __name__ == "__main__":
    scene.measure("PyElastica", version("pyelastica"), {f"{n} steps": n for n in (3000, 4000)}, ("8000 steps", 8000),
                  ("4000 steps", 4000), simulate, compared=3, timed_frames=1)
