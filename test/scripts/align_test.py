#!/usr/bin/python3
"""scripts/align on made recordings whose offset and drift are known."""
import csv
import math
import pathlib
import re
import subprocess
import tempfile
import unittest

import numpy as np

SCRIPT = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts/align"
BEGIN = 1.7e9  # stamp of our first scan [s]


def load(time, seed, period=None):
    """Steps at unequal distances, or at equal ones with a period [s]."""
    random = np.random.default_rng(seed)
    begins = np.arange(0, 200, period) if period else np.cumsum(random.uniform(0.9, 1.5, 200)) - 5
    sizes = np.ones(len(begins)) if period else random.uniform(0.8, 1.2, len(begins))
    force = np.zeros(len(time))
    for begin, size in zip(begins, sizes):
        phase = (time - begin) / 0.6
        force += np.where((phase > 0) & (phase < 1), size * np.sin(np.pi * np.clip(phase, 0, 1)), 0)
    return 400 * force


class Align(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def make(self, offset=12.3456, ppm=80, seed=1, period=None, other=None, seconds=40):
        random = np.random.default_rng(seed)
        ours = np.arange(0, seconds, 0.01)
        jitter = random.normal(0, 0.001, len(ours))
        with open(self.folder / "ours.csv", "w") as file:
            file.write("stamp_s,region,force_N\n")
            for t, y in zip(ours + jitter, load(ours, seed, period) + random.normal(0, 5, len(ours))):
                file.write(f"{BEGIN + t:.6f},whole_matrix,{y:.4f}\n{BEGIN + t:.6f},heel,0\n")
        theirs = np.arange(5, seconds + 20, 0.002)  # on their clock
        true = (theirs - offset - seconds / 2) / (1 + 1e-6 * ppm) + seconds / 2
        force = load(true, seed if other is None else other, period)
        with open(self.folder / "theirs.csv", "w") as file:
            file.write("Vicon\nFrame;time;Fz;knee\n")
            for k, (t, y) in enumerate(zip(theirs, force + random.normal(0, 2, len(theirs)))):
                file.write(f"{k};{t:.4f};{-0.9 * y + 30:.3f};{true[k]:.6f}\n")

    def run_script(self, *more):
        return subprocess.run([SCRIPT, self.folder / "ours.csv", self.folder / "theirs.csv", "--skip-lines", "1", "--signal", "Fz", "--output",
                               self.folder / "aligned.csv", *more], text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def test_offset_and_rate_are_found_within_their_intervals(self):
        covered = []
        for seed in range(8):
            self.make(offset=12 + 0.37 * seed, ppm=20 * seed - 100, seed=seed)
            ran = self.run_script()
            self.assertEqual(ran.returncode, 0, ran.stderr)
            offset, offset_95, at = map(float, re.search(r"our time (\S+) s \+- (\S+) at stamp (\S+) ", ran.stdout).groups())
            rate, rate_95 = map(float, re.search(r"runs (\S+) ppm \+- (\S+) ", ran.stdout).groups())
            true = 12 + 0.37 * seed + 1e-6 * (20 * seed - 100) * (at - BEGIN - 20) - BEGIN
            covered += [abs(offset - true) <= offset_95, abs(rate - (20 * seed - 100)) <= rate_95]
            self.assertLess(abs(offset - true), 0.002)
            self.assertLess(abs(rate - (20 * seed - 100)), 80)
            self.assertIn("opposite signs", ran.stdout)
            (self.folder / "aligned.csv").unlink()
        self.assertGreaterEqual(sum(covered), 13, "of 16 intervals of 95 %")

    def test_columns_stand_at_our_stamps(self):
        self.make()
        self.run_script()
        with open(self.folder / "aligned.csv") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 4000)
        errors = [float(row["knee"]) - (float(row["stamp_s"]) - BEGIN) for row in rows if row["knee"] != "NA"]
        self.assertGreater(len(errors), 3900)
        self.assertLess(np.abs(errors).max(), 0.003)

    def test_equal_steps_fit_in_several_places(self):
        self.make(period=1.2)
        ran = self.run_script()
        self.assertEqual(ran.returncode, 2)
        self.assertRegex(ran.stderr, r"^align: the signals fit at offsets of .* alike; give --near SECONDS\n$")
        self.assertFalse((self.folder / "aligned.csv").exists())
        ran = self.run_script("--near", str(12.2 - BEGIN), "--within", "0.5")
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertLess(abs(float(re.search(r"our time (\S+) s", ran.stdout)[1]) + BEGIN - 12.3456), 0.005)

    def test_what_has_nothing_in_common_is_refused(self):
        self.make(other=99)
        ran = self.run_script()
        self.assertEqual(ran.returncode, 2)
        self.assertRegex(ran.stderr, "^align: the signals have no common course: .*\n$")

    def test_wrong_columns_and_files_are_named(self):
        self.make()
        self.assertIn("theirs.csv: has no column Fx, but Frame, time, Fz, knee", self.run_script("--signal", "Fx").stderr)
        self.assertIn("has no region toe", self.run_script("--region", "toe").stderr)
        (self.folder / "theirs.csv").unlink()
        self.assertIn("theirs.csv: there is no such file", self.run_script().stderr)


if __name__ == "__main__":
    unittest.main()
