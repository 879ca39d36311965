# SPDX-License-Identifier: GPL-3.0-or-later
"""What is said of the results, on results that are made up."""
import unittest

import summary


def row(ms, error, setting="s"):
    return {"ms_per_frame": str(ms), "error_rms_mm": str(error), "setting": setting}


class SummaryTest(unittest.TestCase):
    OURS = [row(1, 5), row(2, 1), row(4, 0.1)]

    def test_the_cheapest_that_is_exact_enough(self):
        self.assertIs(summary.cheapest(self.OURS, 1.0), self.OURS[1])
        self.assertIs(summary.cheapest(self.OURS, 100.0), self.OURS[0])
        self.assertIsNone(summary.cheapest(self.OURS, 0.01))

    def test_factors_are_of_times_at_the_same_error_or_a_smaller_one(self):
        found = [factor for _, factor in summary.factors([row(20, 6), row(30, 2), row(40, 0.01)], self.OURS)]
        self.assertEqual(found, [20.0, 15.0, None])

    def test_less_than_ten_times_is_said(self):
        words = summary.sentence("P", [row(20, 6), row(6, 2, "quick")], self.OURS)
        self.assertIn("3 to 20 times less. It is less than ten times at quick.", words)

    def test_what_is_more_exact_than_ours_is_said(self):
        words = summary.sentence("P", [row(40, 0.01, "fine")], self.OURS)
        self.assertIn("at fine it is more exact (0.01 mm) than ours at any setting here (0.1 mm), for 10 times the time.", words)

    def test_labels_do_not_lie_on_each_other(self):
        self.assertEqual(len(summary.labels([(100, 100, "10×10", "#000000"), (300, 100, "10×10", "#000000")])), 2)
        self.assertEqual(len(summary.labels([(100, 100, "10×10", "#000000")] * 9)), 3)

    def test_numbers_have_two_digits(self):
        self.assertEqual([summary.short(x) for x in (21987, 104.2, 10.4, 5.54, 0.0491, 0.0, 2.8e-5)],
                         ["22,000", "100", "10", "5.5", "0.049", "0", "2.8·10⁻⁵"])


if __name__ == "__main__":
    unittest.main()
