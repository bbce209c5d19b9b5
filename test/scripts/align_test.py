#!/usr/bin/python3
"""scripts/align on made recordings whose offset and drift are known."""
import csv
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

import numpy as np
import rosbag
import rospy
from genpy.dynamic import generate_dynamic

SCRIPT = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts/align"
BEGIN = 1.7e9  # stamp of our first scan [s]


HEADER = "=" * 80 + "\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
STAND_IN = """
import numpy
def c3d(path):
    with numpy.load(path + ".npz") as file:
        return {"data": {"analogs": file["analogs"]}, "parameters": {
            "ANALOG": {"LABELS": {"value": ["Fz ", "knee"]}, "RATE": {"value": numpy.array([250.0])}}}}
"""


def event_class():
    """Event.msg of this source tree."""
    definition = (SCRIPT.parent.parent / "msg/Event.msg").read_text()
    classes = generate_dynamic("fsr_pressure_map/Event", definition + HEADER)
    return classes["fsr_pressure_map/Event"], classes["std_msgs/Header"]


def taps(time, seed):
    """Three short taps [N] behind 3 s and three behind 50 s, at unequal distances."""
    random = np.random.default_rng(seed)
    force = np.zeros(len(time))
    for begin in np.concatenate([3 + np.cumsum(random.uniform(0.6, 1.8, 3)), 50 + np.cumsum(random.uniform(0.6, 1.8, 3))]):
        phase = (time - begin) / random.uniform(0.04, 0.08)
        force += np.where((phase > 0) & (phase < 1), 60 * np.sin(np.pi * np.clip(phase, 0, 1)), 0)
    return force


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

    def make(self, offset=12.3456, ppm=80, seed=1, period=None, other=None, seconds=40, course=load):
        random = np.random.default_rng(seed)
        period = [period] if period else []
        ours = np.arange(0, seconds, 0.01)
        jitter = random.normal(0, 0.001, len(ours))
        with open(self.folder / "ours.csv", "w") as file:
            file.write("stamp_s,region,force_N\n")
            for t, y in zip(ours + jitter, course(ours, seed, *period) + random.normal(0, 5 if course == load else 1, len(ours))):
                file.write(f"{BEGIN + t:.6f},whole_matrix,{y:.4f}\n{BEGIN + t:.6f},heel,0\n")
        theirs = np.arange(5, seconds + 20, 0.004)  # on their clock
        true = (theirs - offset - seconds / 2) / (1 + 1e-6 * ppm) + seconds / 2
        force = course(true, seed if other is None else other, *period)
        with open(self.folder / "theirs.csv", "w") as file:
            file.write("Vicon\nFrame;time;Fz;knee\n")
            for k, (t, y) in enumerate(zip(theirs, force + random.normal(0, 2 if course == load else 0.5, len(theirs)))):
                file.write(f"{k};{t:.4f};{-0.9 * y + 30:.3f};{true[k]:.6f}\n")

    def make_pulses(self, offset=12.3456, ppm=80, seed=1, period=None, seconds=60):
        """Pulses of 20 ms that both saw, some of them one only; ours are events with a jitter of 0.1 ms."""
        random = np.random.default_rng(seed)
        ours = np.arange(0, seconds, 0.1)
        with open(self.folder / "ours.csv", "w") as file:
            file.write("stamp_s,region\n" + "".join(f"{BEGIN + t:.6f},whole_matrix\n" for t in ours))
        begins = np.arange(5, seconds - 5, period) if period else np.cumsum(random.uniform(2, 6, 40))
        begins = begins[begins < seconds - 5]
        event, header = event_class()
        with rosbag.Bag(self.folder / "ours.bag", "w") as bag:
            for begin in begins[random.uniform(size=len(begins)) > (0 if period else 0.1)]:
                for level, at in (("rising", begin), ("falling", begin + 0.02)):
                    stamp = rospy.Time.from_sec(BEGIN + at + random.normal(0, 1e-4))
                    bag.write("/fsr/events", event(header(0, stamp, ""), "sync", f"trigger {level} +- 0.002 ms"), stamp)
            bag.write("/fsr/events", event(header(0, stamp, ""), "sync", "a hand clapped"), stamp)
        theirs = np.arange(0, seconds, 0.001)
        true = (theirs - offset - seconds / 2) / (1 + 1e-6 * ppm) + seconds / 2
        high = np.zeros(len(true), bool)
        for begin in begins[random.uniform(size=len(begins)) > (0 if period else 0.1)]:
            high |= (true >= begin) & (true < begin + 0.02)
        with open(self.folder / "theirs.csv", "w") as file:
            file.write("Vicon\ntime,sync,knee\n")
            for t, level, k, noise in zip(theirs, high, true, random.normal(0, 0.05, len(theirs))):
                file.write(f"{t:.4f},{5 * level + noise:.3f},{k:.6f}\n")
        return "--pulses", "sync", "--bag", self.folder / "ours.bag"

    def run_script(self, *more, signal=("--signal", "Fz"), theirs="theirs.csv", env=None):
        return subprocess.run([SCRIPT, self.folder / "ours.csv", self.folder / theirs, "--skip-lines", "1", *signal, "--output",
                               self.folder / "aligned.csv", *more], text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=env)

    def check(self, ran, offset, ppm, seconds, error):
        """Whether the two intervals contain the truth; the offset is nearer to it than error [s]."""
        self.assertEqual(ran.returncode, 0, ran.stderr)
        found, found_95, at = map(float, re.search(r"our time (\S+) s \+- (\S+) at stamp (\S+) ", ran.stdout).groups())
        rate, rate_95 = map(float, re.search(r"runs (\S+) ppm \+- (\S+) ", ran.stdout).groups())
        true = offset + 1e-6 * ppm * (at - BEGIN - seconds / 2) - BEGIN
        self.assertLess(abs(found - true), error)
        return [abs(found - true) <= found_95, abs(rate - ppm) <= rate_95]

    def test_offset_and_rate_are_found_within_their_intervals(self):
        covered = []
        for seed in range(4):
            self.make(offset=12 + 0.37 * seed, ppm=30 * seed - 100, seed=seed)
            ran = self.run_script()
            covered += self.check(ran, 12 + 0.37 * seed, 30 * seed - 100, 40, 0.0005)
            self.assertIn("opposite signs", ran.stdout)
            (self.folder / "aligned.csv").unlink()
        self.assertGreaterEqual(sum(covered), 6, "of 8 intervals of 95 %")

    def test_taps_on_the_sheet_are_found(self):
        covered = []
        for seed in range(3):
            self.make(offset=12 + 0.37 * seed, ppm=60 * seed - 60, seed=seed, seconds=60, course=taps)
            covered += self.check(self.run_script("--window", "1"), 12 + 0.37 * seed, 60 * seed - 60, 60, 0.002)
            (self.folder / "aligned.csv").unlink()
        self.assertGreaterEqual(sum(covered), 5, "of 6 intervals of 95 %")

    def test_pulses_at_the_trigger_are_paired_without_a_force(self):
        covered = []
        for seed in range(3):
            pulses = self.make_pulses(offset=-10 + 15 * seed, ppm=100 * seed - 100, seed=seed)
            ran = self.run_script(signal=pulses)
            covered += self.check(ran, -10 + 15 * seed, 100 * seed - 100, 60, 0.0006)
            self.assertRegex(ran.stdout, r"\d+ of \d+ pulses agree\n")
            (self.folder / "aligned.csv").unlink()
        self.assertGreaterEqual(sum(covered), 5, "of 6 intervals of at least 95 %")

    def test_falling_edges_may_be_their_rising_ones(self):
        self.check(self.run_script("--edges", "falling", signal=self.make_pulses()), 12.3456 - 0.02, 80, 60, 0.0006)

    def test_pulses_of_the_trigger_output_are_scans(self):
        definition = "Header header\nuint32 sequence\n" + HEADER
        classes = generate_dynamic("fsr_pressure_map/MatrixFrame", definition)
        pulses = self.make_pulses(period=2)
        with rosbag.Bag(self.folder / "ours.bag", "w") as bag:
            for k in range(51, 2951):  # the middle of scan 100 is 7.01 s behind the begin
                stamp = rospy.Time.from_sec(BEGIN + 5.01 + 0.02 * k)
                bag.write("/fsr/raw", classes["fsr_pressure_map/MatrixFrame"](classes["std_msgs/Header"](0, stamp, ""), k), stamp)
        ran = self.run_script("--near", str(12 - BEGIN), "--within", "0.8", "--edges", "output", signal=pulses)
        self.check(ran, 12.3456, 80, 60, 0.0006)

    def test_equal_pulses_need_a_place(self):
        pulses = self.make_pulses(period=2)
        ran = self.run_script(signal=pulses)
        self.assertEqual(ran.returncode, 2)
        self.assertRegex(ran.stderr, r"^align: the pulses fit at offsets of .* alike; give --near SECONDS\n$")
        self.check(self.run_script("--near", str(12 - BEGIN), signal=pulses), 12.3456, 80, 60, 0.0006)

    def test_pulses_that_are_missing_or_elsewhere_are_refused(self):
        pulses = self.make_pulses()
        self.assertIn("--pulses and --bag belong together", self.run_script(signal=pulses[:2]).stderr)
        self.assertIn("theirs.csv: knee has 1 rising edges, but 3 are needed", self.run_script(signal=("--pulses", "knee", *pulses[2:])).stderr)
        self.assertIn("the pulses of the two systems do not overlap in time at --near", self.run_script("--near", "0", signal=pulses).stderr)
        with rosbag.Bag(self.folder / "ours.bag", "w"):
            pass
        self.assertIn("ours.bag: has 0 rising pulses of the trigger, but 3 are needed", self.run_script(signal=pulses).stderr)
        (self.folder / "ours.bag").write_bytes(b"no bag")
        self.assertIn("ours.bag: is no complete bag", self.run_script(signal=pulses).stderr)
        self.assertEqual(list(self.folder.glob("aligned.csv*")), [])

    def test_a_c3d_is_read_by_ezc3d_where_it_is_installed(self):
        self.make()
        with open(self.folder / "theirs.csv") as file:
            rows = list(csv.DictReader(list(file)[1:], delimiter=";"))
        c3d = self.folder / "theirs.c3d"
        c3d.write_bytes(b"")
        np.savez(str(c3d) + ".npz", analogs=np.array([[[float(row["Fz"]) for row in rows], [float(row["knee"]) for row in rows]]]))
        (self.folder / "ezc3d.py").write_text("raise ImportError\n")
        path = {**os.environ, "PYTHONPATH": f"{self.folder}:{os.environ.get('PYTHONPATH', '')}"}
        self.assertIn("theirs.c3d: the Python module ezc3d is not installed; export the file as CSV",
                      self.run_script(theirs="theirs.c3d", env=path).stderr)
        (self.folder / "ezc3d.py").write_text(STAND_IN)
        self.check(self.run_script(theirs="theirs.c3d", env=path), 12.3456 - 5, 80, 40, 0.0005)  # its time begins at 0
        (self.folder / "aligned.csv").unlink()
        np.savez(str(c3d) + ".npz", analogs=np.zeros((1, 0, 100)))
        self.assertIn("theirs.c3d: has no analog channels", self.run_script(theirs="theirs.c3d", env=path).stderr)
        c3d.with_suffix(".c3d.npz").unlink()
        self.assertIn("theirs.c3d: ezc3d cannot read it: ", self.run_script(theirs="theirs.c3d", env=path).stderr)
        self.assertFalse((self.folder / "aligned.csv").exists())

    def test_a_table_that_does_not_overlap_is_refused(self):
        self.make()
        self.assertRegex(self.run_script("--near", "0").stderr, "^align: .*theirs.csv: does not overlap in time with .*ours.csv at --near 0\n$")
        self.assertFalse((self.folder / "aligned.csv").exists())

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
