#!/usr/bin/python3
"""Tests of scripts/measure_training on a small rig.

training_test.py PROGRAMS: the folder of the tools. Everything runs in a shell without any environment.
"""
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
from bare_shell import SCRIPTS, run  # noqa: E402

PROGRAMS = None


class MeasureTraining(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def measure(self, *words, programs=None):
        return run(SCRIPTS / "measure_training", "--output", self.folder, "--bags", "3,2", "--rows", "1", "--columns", "2", "--cycles", "2",
                   "--programs", programs or PROGRAMS, *words)

    def test_states_parts_that_add_up_to_the_whole(self):
        done = self.measure()
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        head, names, *rows = done.stdout.splitlines()
        self.assertEqual(head, "1 x 2 taxels, 1500 scans a bag, 1 threads; CPU time [s]")
        self.assertEqual(names.split(), ["bags", "reading", "rest", "bandwidth", "tare", "memory", "whole", "wall", "MB"])
        self.assertEqual([row.split()[0] for row in rows], ["2", "3"])
        for row in rows:
            *parts, whole, wall, memory = map(float, row.split()[1:])
            self.assertAlmostEqual(sum(parts), whole, delta=0.004, msg=row)
            self.assertGreater(parts[0], 0)
            self.assertGreater(memory, 1)
        self.assertEqual(len(list(self.folder.glob("seed_1/bags_3/*.bag"))), 3)

    def test_says_what_it_cannot_use(self):
        done = self.measure(programs=self.folder / "none")
        self.assertEqual(done.returncode, 1)
        self.assertIn("none/simulate: there is no such program", done.stderr)
        done = self.measure("--simulation", SCRIPTS.parent / "config/study/paper.yaml")
        self.assertEqual(done.returncode, 1)
        self.assertIn("paper.yaml: has no matrix, session and effects", done.stderr)


if __name__ == "__main__":
    PROGRAMS = pathlib.Path(sys.argv.pop(1))
    sys.exit(unittest.main())
