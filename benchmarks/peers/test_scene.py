# SPDX-License-Identifier: GPL-3.0-or-later
"""The measure, on motions whose errors are known."""
import math
import unittest

import numpy

import scene


class SceneTest(unittest.TestCase):
    def setUp(self):
        self.rest = scene.rest_strands(4)
        self.still = numpy.repeat(self.rest[None], 3, axis=0)

    def test_equal_runs_have_no_error(self):
        self.assertEqual(scene.error_mm(self.still, self.still), (0.0, 0.0))

    def test_a_shift_of_all_points_is_the_error(self):
        rms, largest = scene.error_mm(self.still + [0.0, 0.003, 0.004], self.still)
        self.assertAlmostEqual(rms, 5.0)
        self.assertAlmostEqual(largest, 5.0)

    def test_one_point_of_many_counts_by_its_share(self):
        moved = self.still.copy()
        moved[1, 2, 3, 0] += 0.012
        rms, largest = scene.error_mm(moved, self.still)
        self.assertAlmostEqual(rms, 12.0 / math.sqrt(3 * 4 * scene.POINTS))
        self.assertAlmostEqual(largest, 12.0)

    def test_exploded_runs_are_infinitely_wrong(self):
        moved = self.still.copy()
        moved[2, 0, 0, 0] = math.nan
        self.assertEqual(scene.error_mm(moved, self.still), (math.inf, math.inf))

    def test_runs_of_other_frames_are_refused(self):
        with self.assertRaises(ValueError):
            scene.error_mm(self.still[1:], self.still)

    def test_stretch_sees_longer_and_shorter(self):
        mean, largest = scene.stretch_percent(1.02 * self.still, self.rest)
        self.assertAlmostEqual(mean, 2.0)
        self.assertAlmostEqual(largest, 2.0)
        moved = self.still.copy()
        moved[:, :, -1] = moved[:, :, -2] + 0.9 * (moved[:, :, -1] - moved[:, :, -2])
        mean, largest = scene.stretch_percent(moved, self.rest)
        self.assertAlmostEqual(mean, 10.0 / (scene.POINTS - 1))
        self.assertAlmostEqual(largest, 10.0)

    def test_turning_is_that_of_a_right_hand_and_keeps_lengths(self):
        self.assertTrue(numpy.allclose(scene.turned(numpy.array([1.0, 2.0, 0.0]), math.pi / 2), [0.0, 2.0, -1.0]))
        self.assertAlmostEqual(scene.stretch_percent(scene.turned(self.still, 0.7), self.rest)[1], 0.0)

    def test_the_head_starts_still_and_turns_to_both_sides_of_its_middle(self):
        angles = [scene.angle(f / scene.FPS) for f in range(scene.FRAMES + 1)]
        self.assertEqual(angles[0], 0.0)
        self.assertAlmostEqual(max(angles), 2 * scene.TURN)
        self.assertAlmostEqual(angles[-1], 0.0)
        self.assertAlmostEqual(scene.angle(10.5 / scene.FPS), (angles[10] + angles[11]) / 2)

    def test_strands_have_their_length(self):
        lengths = numpy.linalg.norm(numpy.diff(self.rest, axis=1), axis=2).sum(axis=1)
        self.assertTrue(numpy.allclose(lengths, scene.LENGTH))

    def test_the_elasticas_tip_has_no_error_and_a_straight_beam_has(self):
        beam = scene.cantilever_strand()
        bent = numpy.repeat(beam[None], 2, axis=0)
        self.assertGreater(scene.cantilever_error_mm(bent, beam), 50.0)
        bent[-1, 0, -1] = beam[0, 0] + [*scene.CANTILEVER_TIP, 0.0]
        self.assertAlmostEqual(scene.cantilever_error_mm(bent, beam), 0.0)


if __name__ == "__main__":
    unittest.main()
