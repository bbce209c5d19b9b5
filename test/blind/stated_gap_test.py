#!/usr/bin/python3
"""stated_gap_test.py DISCREPANCY SIMULATE: the gap that is stated is the one that anybody recomputes.

For each hidden effect: `simulate` makes bags, `discrepancy` answers, and the gap is recomputed twice: with the command that
verdict.yaml names, and by recompute.py, which drives the written simulations with `simulate --drive` and subtracts the bags itself.
Other effects: test/discrepancy/answer.h, without files.
"""

import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

import yaml

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import recompute  # noqa: E402

DISCREPANCY, SIMULATE = "", ""
TOLERANCE = 0.02
RIG = """
simulation: stated gap
seed: 7
matrix: {rows: 3, columns: 4}
board: {scan_rate: 2.5, transducer_rate: 2.5}
program:
  - cycles: {peak: 620000, rate: 40000, dwell_peak: 8, cycles: 5}
  - cycles: {peak: 620000, rate: 8000, dwell_peak: 8, cycles: 3}
  - cycles: {peak: 620000, rate: 40000, dwell_peak: 8, cycles: 3}
session:
  - {surface: flat, flat: true}
  - {surface: cylinder_9cm, cylinder: {radius: 0.09, axis: y}, pause: 300}
  - {surface: cylinder_5cm, cylinder: {radius: 0.05, axis: y}, pause: 300}
climate: {room: [{time: 0, temperature: 20}, {time: 4000, temperature: 32}]}
effects:
  static_curve: {conductance: 3.2e-4, exponent: 0.85, conductance_scatter: 0.05}
  bending_preload: {amplitude: 30000}
  bending_gain: {change: -0.15}
  white_noise: {absolute: 8}
  converter: {}
"""
HIDDEN = {
    "none": "",
    "hysteresis": "{loop_width: 0.05}",
    "temperature": "{}",
    "column_fault": "{share: 0.04, line: 1, burst: 3, depth: 0.7}",
    "dead_taxel": "{taxels: 1, first: 5, start: 700}",
}


class StatedGap(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.root = pathlib.Path(temporary.name)
        self.environment = dict(os.environ, ROS_HOME=str(self.root / "ros_home"))

    def run_tool(self, *words):
        done = subprocess.run([str(w) for w in words], capture_output=True, text=True, env=self.environment, cwd=self.root)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def answer(self, effect, values):
        """The verdict on bags with a hidden effect; the simulation to start from lacks it."""
        (self.root / "base.yaml").write_text(RIG)
        (self.root / "hidden.yaml").write_text(RIG + ("  %s: %s\n" % (effect, values) if values else ""))
        self.run_tool(SIMULATE, "--simulation", "hidden.yaml", "--output", "bags")
        bags = sorted((self.root / "bags").glob("*.bag"))
        self.run_tool(DISCREPANCY, *bags, "--simulation", "base.yaml", "--output", "found", "--no-report", "--threads", "1")
        return bags, yaml.safe_load((self.root / "found" / "verdict.yaml").read_text())

    def by_the_named_command(self, verdict, bags):
        """{(file, surface or None): (recomputed, stated)} [% of full scale]. The command has names only, so the
        bags lie beside the verdict's folder."""
        for bag in bags:
            (self.root / bag.name).symlink_to(bag)
        words = shlex.split(verdict["recompute"])
        self.assertEqual(words[:3], ["rosrun", "fsr_pressure_map", "simulate"])
        said, file = {}, None
        for line in self.run_tool(SIMULATE, *words[3:]).splitlines():
            gap = re.fullmatch(r"Gap of (\S+): (\S+) % of full scale, stated (\S+) % of full scale", line)
            surface = re.fullmatch(r"  on (\S+): (\S+) % of full scale, stated (\S+) % of full scale", line)
            file = gap.group(1) if gap else file
            found = gap or surface
            said[file, None if gap else surface.group(1)] = float(found.group(2)), float(found.group(3))
        return said

    def assert_near(self, a, b, what):
        self.assertLess(abs(a - b), TOLERANCE * b, "%s: %g, but %g" % (what, a, b))

    def check_gap(self, effect, bags, verdict):
        gap = verdict["gap"]
        again = recompute.recompute([SIMULATE], bags, verdict, self.root / "found", self.root / "work", self.environment)
        self.assertNotIn("problem", again)
        said = self.by_the_named_command(verdict, bags)
        self.assertEqual(len(said), 2 * (1 + len(gap["surfaces"])))
        for when, file in (("before", "base.yaml"), ("after", "simulation.yaml")):
            self.assert_near(gap[when], again[when], "%s %s, stated and by simulate --drive" % (effect, when))
            self.assert_near(said[file, None][0] / 100, again[when], "%s %s, by the named command" % (effect, when))
            self.assert_near(said[file, None][1] / 100, gap[when], "%s %s, repeated" % (effect, when))
            for surface in gap["surfaces"]:
                self.assert_near(surface[when], said[file, surface["surface"]][0] / 100, "%s %s %s" % (effect, when, surface))
        found = [e["id"] for e in verdict["effects"]]
        self.assertEqual(found, [effect] if HIDDEN[effect] else [])
        if not found:
            self.assertIsNone(gap["closed"])
        else:
            share = (gap["before"]**2 - gap["after"]**2) / (gap["before"]**2 - gap["floor"]**2)
            self.assertAlmostEqual(gap["closed"], share, places=3)
            self.assertGreater(share, 0.9)
        self.assertLessEqual(*gap["floor_bracket"])

    def test_of_none(self):
        bags, verdict = self.answer("none", "")
        self.check_gap("none", bags, verdict)
        words = [SIMULATE, "--gap", "found/verdict.yaml", "--drive"]
        done = subprocess.run([*words, *map(str, bags[1:])], capture_output=True, text=True, env=self.environment, cwd=self.root)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("was made from %s, which is not among the bags" % bags[0].name, done.stderr)
        done = subprocess.run(words[:3], capture_output=True, text=True, env=self.environment, cwd=self.root)
        self.assertIn("--gap: give the bags of the verdict with --drive", done.stderr)


for name in filter(HIDDEN.get, HIDDEN):
    setattr(StatedGap, "test_of_" + name, lambda self, effect=name: self.check_gap(effect, *self.answer(effect, HIDDEN[effect])))

if __name__ == "__main__":
    DISCREPANCY, SIMULATE = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1])
