#!/usr/bin/python3
"""Tests of scripts/blind_trials with the real generator and a command that gives the same answer to every case.

trials_test.py GENERATOR, the program blind_case.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
TRIALS = HERE.parent.parent / "scripts" / "blind_trials"
GENERATOR = ""
GRID = ["--size", "small", "--effects", "creep:log_time,seal_leak:orifice", "--protocols", "two_speeds", "--snr", "1",
        "--nothing", "2", "--pairs", "1"]


class Trials(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.output = pathlib.Path(self.folder.name, "results")
        self.log = pathlib.Path(self.folder.name, "calls")

    def run_trials(self, answer, *more, grid=GRID):
        command = str(HERE / "fake_discrepancy") + " {bags} --output {output}"
        return subprocess.run(
            [str(TRIALS), "--output", str(self.output), "--generator", GENERATOR, "--command", command, *grid, *more],
            capture_output=True, text=True, env=dict(os.environ, FAKE_ANSWER=answer, FAKE_LOG=str(self.log)))

    def summary(self):
        return json.loads((self.output / "summary.json").read_text())["summary"]

    def figure(self, name):
        return next(f["value"] for f in self.summary()["figures"] if f["figure"] == name)

    def calls(self):
        return self.log.read_text().splitlines()

    def test_every_case_is_asked_once_and_scored(self):
        done = self.run_trials("creep")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.summary()["confusion"],
                         {"creep": {"creep": 1}, "seal_leak": {"creep": 1}, "none": {"creep": 2}})
        self.assertEqual(self.summary()["pairs"], {"creep + hysteresis": {"creep": 1}})
        self.assertEqual(self.figure("false alarms with nothing hidden")[:2], [2, 2])
        self.assertEqual(self.figure("wrong single name, any SNR")[:2], [1, 2])
        self.assertIn("| creep | 100.0 % (1 of 1;", done.stdout)

    def test_the_command_sees_nothing_of_the_case_but_its_bags(self):
        self.run_trials("none")
        for call in self.calls():
            for word in ("creep", "seal_leak", "snr", "key"):
                self.assertNotIn(word, call)
        self.assertEqual(list(self.output.glob("work/*")), [])  # the bags were removed

    def test_goes_on_where_it_stopped(self):
        self.run_trials("none")
        self.assertEqual(len(self.calls()), 5)
        self.run_trials("none")
        self.assertEqual(len(self.calls()), 5)
        next((self.output / "cases").glob("creep.log_time.*/run.json")).unlink()  # as if the run had been stopped here
        self.run_trials("none")
        self.assertEqual(len(self.calls()), 6)

    def test_a_command_that_fails_is_reported_and_tried_again_when_asked(self):
        done = self.run_trials("crash")
        self.assertEqual(done.returncode, 1)
        self.assertIn("5 cases failed", done.stderr)
        self.assertEqual(self.run_trials("none").returncode, 1)
        self.assertEqual(self.run_trials("none", "--retry-failed").returncode, 0)
        self.assertEqual(self.figure("false alarms with nothing hidden")[:2], [0, 2])

    def test_follows_the_recommended_experiment_with_the_same_sheet(self):
        grid = ["--size", "small", "--effects", "creep:log_time", "--protocols", "paper", "--snr", "1",
                "--nothing", "0", "--pairs", "0", "--follow-up"]
        done = self.run_trials("ambiguous", grid=grid)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.figure("ambiguous, then the recommended experiment: one right name")[:2], [1, 1])
        self.assertEqual(self.figure("a frozen right prediction is confirmed")[:2], [1, 1])
        self.assertIn("--confirm", self.calls()[1])
        self.assertGreater(self.calls()[2].count(".bag"), self.calls()[0].count(".bag"))

    def test_leaves_the_true_effect_out_of_the_library(self):
        grid = ["--size", "small", "--effects", "creep:log_time", "--protocols", "paper", "--snr", "1",
                "--nothing", "0", "--pairs", "0", "--leave-one-out", "1"]
        self.run_trials("none", grid=grid)
        self.assertEqual(sum("--without creep" in call for call in self.calls()), 1)
        self.assertEqual(self.figure("true effect left out, answered right")[:2], [0, 1])

    def test_what_cannot_show_is_set_aside_and_an_unknown_effect_refused(self):
        grid = ["--size", "small", "--effects", "repositioning:tilt", "--protocols", "step_hold", "--snr", "1",
                "--nothing", "0", "--pairs", "0"]
        self.assertEqual(self.run_trials("none", grid=grid).returncode, 0)
        run = json.loads(next((self.output / "cases").glob("*/run.json")).read_text())
        self.assertEqual(run["status"], "refused")
        self.assertIn("remount", run["reason"])
        done = self.run_trials("none", grid=["--effects", "creeep"])
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("creeep", done.stderr)


if __name__ == "__main__":
    GENERATOR = sys.argv.pop(1)
    unittest.main()
