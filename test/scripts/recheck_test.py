#!/usr/bin/python3
"""Tests of scripts/measure_recheck on a small rig.

recheck_test.py PROGRAMS: the folder of the tools. Everything runs in a shell without any environment.
"""
import json
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
from bare_shell import SCRIPTS, run  # noqa: E402

PROGRAMS = None


class MeasureRecheck(unittest.TestCase):
    def test_compares_parent_child_and_a_calibration_that_is_trained_anew(self):
        with tempfile.TemporaryDirectory() as folder:
            done = run(SCRIPTS / "measure_recheck", "--short", "--output", folder, "--programs", PROGRAMS)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            result = json.loads((pathlib.Path(folder) / "recheck.json").read_text())
        self.assertEqual([row["seed"] for row in result["rows"]], [1, 2])
        for row in result["rows"]:
            self.assertIn(row["verdict"], ("still good", "corrected", "cannot tell", "recalibrate"))
            self.assertAlmostEqual(row["ratio"], row["child"] / row["anew"])
            self.assertGreater(row["parent"], row["anew"])
        for key, of in (("verdicts", "verdict"), ("verdicts_without_wear", "unworn_verdict")):
            self.assertEqual(sum(result[key].values()), 2)
            self.assertEqual(result[key]["cannot tell"], sum(row[of] == "cannot tell" for row in result["rows"]))
        self.assertIn("2 worn sheets: ", done.stdout)

    def test_takes_no_correction_of_one_new_mount_of_sheets_without_wear(self):
        with tempfile.TemporaryDirectory() as folder:
            done = run(SCRIPTS / "measure_recheck", "--short", "--unworn", "--output", folder, "--programs", PROGRAMS)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            result = json.loads((pathlib.Path(folder) / "recheck.json").read_text())
        self.assertEqual(result["verdicts_without_wear"]["corrected"], 0)


if __name__ == "__main__":
    PROGRAMS = pathlib.Path(sys.argv.pop(1))
    sys.exit(unittest.main())
