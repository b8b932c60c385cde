#!/usr/bin/env python3
"""The parts of scripts/perf that measure nothing: how figures come from measurements, and what is said where a peer is missing.

usage: perf_test.py SOURCE_DIR
"""
import contextlib
import io
import pathlib
import subprocess
import sys
import unittest
from unittest import mock

source = pathlib.Path(sys.argv.pop())
sys.path.insert(0, str(source / "scripts"))
sys.dont_write_bytecode = True
import cube_camera_targets  # noqa: E402
import cycles_targets  # noqa: E402
import ray_tracer_targets  # noqa: E402
import sweep_targets  # noqa: E402
from measure import Skip, Targets, geometric_mean, ratio_of_rounds  # noqa: E402


def shown(show):
    """What show(targets) prints, and how many targets are missed."""
    targets, output = Targets(), io.StringIO()
    with contextlib.redirect_stdout(output):
        show(targets)
    return output.getvalue().splitlines(), targets.missed


class Figures(unittest.TestCase):
    def test_limits_are_met_at_the_limit(self):
        lines, missed = shown(lambda t: (t.show("a", 1.35, 1.35), t.show("b", 1.36, 1.35),
                                         t.show("c", 2, 2, at_most=False), t.show("d", 1.99, 2, at_most=False)))
        self.assertEqual([line.split()[-1] for line in lines], ["met", "MISSED", "met", "MISSED"])
        self.assertEqual(missed, 2)

    def test_ratios_are_of_rounds_not_of_medians(self):
        # One round in which the machine was twice as slow: the ratio is 3 in all of them.
        self.assertEqual(ratio_of_rounds([3, 60, 9], [1, 20, 3]), 3)
        self.assertEqual(ratio_of_rounds([3, 6, 9], [1, 3, 1]), 3)

    def test_geometric_mean(self):
        self.assertAlmostEqual(geometric_mean([1, 4, 16]), 4)

    def test_time_to_an_error_follows_straight_lines_in_log_log(self):
        points = [(1e-2, 1.0), (1e-3, 10.0), (1e-5, 100.0)]
        self.assertAlmostEqual(cycles_targets.seconds_to(1e-3, points), 10.0)
        self.assertAlmostEqual(cycles_targets.seconds_to(1e-4, points), 10.0 * 10 ** 0.5)
        self.assertAlmostEqual(cycles_targets.seconds_to(1e-7, points), 1000.0)

    def test_frames_are_shown_by_cell_with_their_mean(self):
        rounds = {"1:1:64": [((8, 6), (2, 1)), ((10, 6), (2, 2)), ((9, 6), (3, 1))], "8:3:512": [((16, 6), (1, 6))]}
        lines, missed = shown(lambda t: cube_camera_targets.show(t, rounds))
        self.assertEqual([line.split()[-4] for line in lines], ["4.000", "16.000", "8.000", "6.000", "1.000", "2.449"])
        self.assertEqual(missed, 2)
        self.assertIn("wall 9 / 2 ms", lines[0])

    def test_rays_of_povray_have_those_of_shadows(self):
        text = "Pixels:     230400   Samples:   0\nRays:             276771   Saved:    0\nShadow Ray Tests:   100   Succeeded: 3\n"
        self.assertEqual(ray_tracer_targets.rays_of_povray(text), 276871)
        self.assertEqual(ray_tracer_targets.rays_of_povray(text.split("Shadow")[0]), 276771)

    def test_a_sample_is_the_slope_between_two_numbers_of_samples(self):
        self.assertAlmostEqual(ray_tracer_targets.slope(lambda spp: 5 + 0.25 * spp, 4, 20), 0.25)

    def test_every_row_of_the_growth_has_one_limit(self):
        rows = [line.split('"')[1] for line in (source / "scripts/growth").read_text().splitlines() if line.startswith('    ("')]
        table = "\n".join(["| cost |", "| --- |"] + [f"| {row} | 1 | 2 | 0.5 | 0.6 |" for row in rows])
        self.assertEqual(sweep_targets.exponents(table), [(row, 0.5, 0.6) for row in rows])
        for row in rows:
            self.assertEqual(sum(row.startswith(beginning) for beginning in sweep_targets.LARGEST_EXPONENTS), 1, row)


class Programs(unittest.TestCase):
    def test_help_names_every_part(self):
        perf = source / "scripts/perf"
        usage = subprocess.run([sys.executable, perf, "--help"], check=True, capture_output=True, text=True).stdout
        for name in ("start", "load", "metrics", "incremental", "intersect", "rays", "resume", "growth", "survey", "frames", "cycles"):
            self.assertRegex(usage, rf"\n  {name} +[\d.]+ min  ")

    def test_peers_that_are_missing_are_skipped_with_one_line(self):
        with mock.patch("shutil.which", return_value=None), self.assertRaisesRegex(Skip, "Blender is not installed"):
            cycles_targets.check(None, None)


unittest.main()
