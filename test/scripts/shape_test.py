#!/usr/bin/python3
"""Tests of scripts/measure_shape and measure_shape_limits, and of check_calibration on a small rig.

shape_test.py PROGRAMS: the folder of the tools. Everything runs in a shell without any environment.
"""
import json
import pathlib
import sys
import tempfile
import unittest

import yaml

sys.dont_write_bytecode = True
from bare_shell import SCRIPTS, run  # noqa: E402

PROGRAMS = None
MEASURED = None  # what measure_shape left, made once


def setUpModule():
    global MEASURED
    folder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(folder.cleanup)
    output = pathlib.Path(folder.name)
    MEASURED = output, run(SCRIPTS / "measure_shape", "--short", "--output", output, "--programs", PROGRAMS)


class MeasureShape(unittest.TestCase):
    def test_states_alarms_and_errors(self):
        folder, done = MEASURED
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        result = json.loads((folder / "shape.json").read_text())
        self.assertEqual(len(result["rows"]), 2 * 5)
        self.assertEqual(result["alarms"]["mounts"], 2 * 4)
        self.assertEqual(result["alarms"]["false_alarms"], 0)
        self.assertEqual(result["errors"]["mounts"], 2 * 4)
        self.assertGreater(result["errors"]["estimated"], 0)
        self.assertIn("cylinder_20cm      5.00 1/m: estimated", done.stdout)
        self.assertTrue((folder / "shape.png").exists())

    def test_says_what_it_cannot_use(self):
        folder = MEASURED[0] / "again"
        for programs, simulation, sentence in [
                (PROGRAMS, "config/study/paper.yaml", "paper.yaml: has no matrix, session and effects; give a simulation"),
                (folder / "none", "config/simulation/demo.yaml", "none/simulate: there is no such program")]:
            done = run(SCRIPTS / "measure_shape", "--short", "--output", folder, "--programs", programs, "--simulation", SCRIPTS.parent / simulation)
            self.assertEqual(done.returncode, 1)
            self.assertIn(sentence, done.stderr)
            self.assertNotIn("Traceback", done.stderr)


class MeasureShapeLimits(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = MEASURED[0] / "limits"
        cls.done = run(SCRIPTS / "measure_shape_limits", "--short", "--output", cls.folder, "--programs", PROGRAMS)
        cls.result, = json.loads((cls.folder / "limits.json").read_text()) if cls.done.returncode == 0 else [{}]

    def test_blames_no_surface_for_a_strap(self):
        self.assertEqual((self.done.returncode, self.done.stderr), (0, ""))
        straps = [row for row in self.result["loads"] if row["where"] != "whole"]
        self.assertEqual([row["outcome"] for row in straps], ["abstains"] * 2)
        self.assertIn("load of   20 kPa, half the rows     agrees 0, abstains 1", self.done.stdout)

    def test_sees_a_cone_and_believes_its_file(self):
        cone, = self.result["cones"]
        self.assertEqual((cone["changes"], cone["verdict"]), (True, "agrees"))

    def test_scores_the_map_with_three_surfaces(self):
        """Each row is of the same readings: a wrong surface costs much, the estimated one little."""
        self.assertEqual(len(self.result["maps"]), 2)
        for row in self.result["maps"]:
            self.assertGreater(row["wrong"], 1.5 * row["true"])
            self.assertLess(abs(row["estimated"] - row["true"]), 0.5 * (row["wrong"] - row["true"]))


class CheckBag(unittest.TestCase):
    """As a user types it, in a shell that knows nothing but the workspace."""

    def type(self, command):
        setup = PROGRAMS.parent.parent / "setup.bash"
        folder = MEASURED[0] / "seed_21"
        done = run("bash", "-c", f"export ROS_HOME=$PWD/ros_home; source {setup}; rosrun fsr_pressure_map {command}", cwd=folder)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def test_prints_the_table(self):
        said = self.type("check_calibration sheet.h5 rig/13_flat.bag rig/16_cylinder_5cm.bag")
        self.assertIn("How the sheet rests before the first load: principal curvature [1/m]\n", said)
        self.assertRegex(said, r"(?m)^13_flat\.bag, flat, mount 13 +0\.00 .* agrees +flat")
        self.assertRegex(said, r"(?m)^16_cylinder_5cm\.bag, cylinder_5cm, mount 16 +20\.00 .* agrees .*cylinder_5cm")
        self.assertNotIn("but the surface file says", said)

    def test_a_bag_that_disagrees_gets_a_sentence(self):
        """The same sheet lies flat while its session says 5 cm: a rig in which bending does nothing."""
        folder = MEASURED[0] / "seed_21"
        rig = yaml.safe_load((folder / "rig.yaml").read_text())
        rig["session"] = rig["session"][:16]
        for effect in ("bending_preload", "bending_gain"):
            del rig["effects"][effect]
        (folder / "wrong.yaml").write_text(yaml.safe_dump(rig, sort_keys=False))
        self.type("simulate --simulation wrong.yaml --seed 21 --output wrong")
        said = self.type("check_calibration sheet.h5 wrong/16_cylinder_5cm.bag")
        self.assertRegex(said, r"(?m)^16_cylinder_5cm\.bag, cylinder_5cm, mount 16 +20\.00 .* disagrees +flat(, cylinder_20cm)?$")
        self.assertRegex(said, r"(?m)^16_cylinder_5cm\.bag, cylinder_5cm, mount 16: the sheet rests as on .*, "
                               r"but the surface file says cylinder_5cm \(5\.0 cm\)$")

    def test_says_nothing_of_the_shape_without_a_calibration(self):
        self.assertNotIn("How the sheet", self.type("check_bag rig/13_flat.bag"))


if __name__ == "__main__":
    PROGRAMS = pathlib.Path(sys.argv.pop(1))
    sys.exit(unittest.main())
