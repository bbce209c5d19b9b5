#!/usr/bin/python3
"""Tests of scripts/measure_history, history_trials and compare_history, and of the way from a found effect to a calibration, on a small rig.

history_test.py PROGRAMS: the folder of the tools. Everything runs in a shell without any environment.
"""
import csv
import json
import pathlib
import shutil
import sys
import tempfile
import types
import unittest

import numpy
import yaml

sys.dont_write_bytecode = True
from bare_shell import SCRIPTS, module, run  # noqa: E402

compare = module("compare_history")
PROGRAMS = None
MEASURED = None  # what measure_history left, made once


def setUpModule():
    global MEASURED
    folder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(folder.cleanup)
    output = pathlib.Path(folder.name)
    MEASURED = output, run(SCRIPTS / "measure_history", "--short", "--seeds", "1", "--output", output, "--programs", PROGRAMS)


class MeasureHistory(unittest.TestCase):
    def test_states_static_history_and_floor(self):
        folder, done = MEASURED
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        result, = json.loads((folder / "history.json").read_text())
        self.assertLess(result["history"], 0.5 * result["static"])
        self.assertLess(result["floor"], result["history"])
        self.assertGreater(result["settled_share"], 0.5)
        row = done.stdout.splitlines()[2].split()
        self.assertEqual(row[:4], ["1", f"{result['static']:.2f}", f"{result['history']:.2f}", f"{result['floor']:.2f}"])
        self.assertTrue((folder / "history.png").exists())

    def test_states_totals_of_random_programs(self):
        folder = MEASURED[0] / "random"
        done = run(SCRIPTS / "measure_history", "--random", "staircases:cycles", "--seeds", "2", "--output", folder, "--programs", PROGRAMS)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        found = json.loads((folder / "random.json").read_text())
        self.assertEqual([one["start"] for one in found], 4 * ["rest", "early", "late"])
        for row, start in zip(done.stdout.splitlines()[2:], ("rest", "early", "late")):
            own = [one for one in found if one["start"] == start]
            self.assertEqual(row.split()[:4], [start, "4", str(sum(one["model"] for one in own)), f"{sum(one['static'] for one in own) / 4:.1f}"])
        lengths = {start: sum(one["number"] for one in found if one["start"] == start) for start in ("rest", "early", "late")}
        self.assertLess(lengths["late"], lengths["early"])
        self.assertLess(lengths["early"], lengths["rest"])
        refused = run(SCRIPTS / "measure_history", "--random", "cycles", "--output", folder)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("cycles: give cycles or staircases twice, as cycles:staircases", refused.stderr)

    def test_says_what_it_cannot_use(self):
        folder = MEASURED[0] / "again"
        for programs, simulation, sentence in [
                (PROGRAMS, "config/study/paper.yaml", "paper.yaml: has no matrix, session and effects; give a simulation"),
                (folder / "none", "config/simulation/demo.yaml", "none/simulate: there is no such program")]:
            done = run(SCRIPTS / "measure_history", "--short", "--output", folder, "--programs", programs, "--simulation", SCRIPTS.parent / simulation)
            self.assertEqual(done.returncode, 1)
            self.assertIn(sentence, done.stderr)
            self.assertNotIn("Traceback", done.stderr)


class HistoryTrials(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def case(self, name, bags, kpa):
        (self.root / "cases" / name / "bags").mkdir(parents=True)
        for bag in sorted((MEASURED[0] / "seed_1" / bags).glob("*.bag")):
            shutil.copy(bag, self.root / "cases" / name / "bags")
        (self.root / "cases" / name / "key.yaml").write_text(f"case: {name}\neffects:\n- id: hysteresis\n  kpa_at_map: {kpa}\n")

    def trials(self, *words):
        return run(SCRIPTS / "history_trials", self.root / "cases", "--output", self.root / "trials", "--train", PROGRAMS / "train", *words)

    def test_states_what_was_chosen_and_its_worth(self):
        self.case("A.hysteresis.loop.0001", "train", 20)
        self.case("A.none.loop.0001", "floor_train", 0)
        self.case("A.hysteresis.loop+creep.0002", "floor_train", 5)  # two effects: left out
        done = self.trials()
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        rows = {row["effect"]: row for row in csv.DictReader((self.root / "trials/history.csv").read_text().splitlines())}
        self.assertEqual(sorted(rows), ["hysteresis", "none"])
        self.assertNotEqual(rows["hysteresis"]["chosen"], "none")
        self.assertLess(float(rows["hysteresis"]["worst_ratio"]), 1.01)
        static, chosen = float(rows["hysteresis"]["static_kpa"]), float(rows["hysteresis"]["chosen_kpa"])
        self.assertAlmostEqual(float(rows["hysteresis"]["removed"]), (static**2 - chosen**2) / 20**2, 6)
        self.assertGreater(float(rows["hysteresis"]["removed"]), 0.3)
        self.assertEqual((rows["none"]["chosen"], rows["none"]["removed"]), ("none", ""))
        self.assertRegex(done.stdout, r"(?m)^hysteresis +1 +0 +0 ")

    def test_a_case_that_cannot_be_trained_is_named(self):
        self.case("A.creep.log_time.0001", "train", 5)
        for bag in (self.root / "cases/A.creep.log_time.0001/bags").iterdir():
            bag.write_bytes(b"no bag")
        done = self.trials()
        self.assertEqual(done.returncode, 1)
        self.assertIn("failed: A.creep.log_time.0001", done.stdout)


class CompareHistory(unittest.TestCase):
    def test_joins_the_bags_of_a_surface_as_cycles_an_hour_apart(self):
        def bag(*times):
            columns = dict.fromkeys(("truth", "counts", "map", "usable", "settled"), numpy.array(times))
            return types.SimpleNamespace(surface="flat", time=numpy.array(times), cycle=numpy.arange(len(times)) // 2, **columns)
        first = bag(10.0, 11.0, 12.0)
        whole = compare.joined([first, bag(5.0, 7.0)])
        self.assertEqual(list(whole.time), [10, 11, 12, 3612, 3614])
        self.assertEqual(list(whole.cycle), [0, 0, 1, 2, 2])
        self.assertEqual(list(whole.truth), [10, 11, 12, 5, 7])
        self.assertEqual(list(first.time), [10, 11, 12])

    def test_states_errors_and_times_and_does_without_scikit_learn(self):
        folder = MEASURED[0]
        (folder / "python").mkdir()
        (folder / "python/sitecustomize.py").write_text(
            "import importlib.util as u\nfind = u.find_spec\nu.find_spec = lambda name, *more: None if name == 'sklearn' else find(name, *more)\n")
        bags = [["--" + word, *sorted((folder / "seed_1" / name).glob("*_flat.bag"))] for word, name in (("train", "train"), ("test", "check"))]
        done = run("env", f"PYTHONPATH={folder / 'python'}", SCRIPTS / "compare_history", "--output", folder / "compare", *bags[0], *bags[1],
                   "--programs", PROGRAMS, "--taxels", "2")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr, "compare_history: gradient boosting is left out, since scikit-learn is missing; "
                         "`apt-get install python3-sklearn` installs it\n")
        rows = {row["method"]: row for row in json.loads((folder / "compare/compare.json").read_text())}
        self.assertEqual(list(rows), ["static", "history", "past sample", "inverse PI"])
        for name in ("history", "past sample", "inverse PI"):
            self.assertLess(rows[name]["settled_kpa"], rows["static"]["settled_kpa"], name)
        self.assertLess(rows["history"]["settled_kpa"], 0.5 * rows["static"]["settled_kpa"])
        self.assertGreater(rows["past sample"]["one_scan_us"], 0)
        self.assertFalse((folder / "compare/scans.csv").exists())


class FromDiscrepancyToCalibration(unittest.TestCase):
    """As a user types it, in a shell that knows nothing but the workspace."""

    def type(self, command):
        setup = PROGRAMS.parent.parent / "setup.bash"
        done = run("bash", "-c", f"export ROS_HOME=$PWD/ros_home; source {setup}; rosrun fsr_pressure_map {command}", cwd=MEASURED[0] / "seed_1")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def test_the_named_effect_proposes_the_model(self):
        said = self.type("discrepancy train/2_flat.bag --output found --no-report")
        self.assertRegex(said, "Gain for the map: .* train --history verdict.yaml BAG... uses it")
        verdict = yaml.safe_load((MEASURED[0] / "seed_1/found/verdict.yaml").read_text())
        self.assertEqual({effect["id"] for effect in verdict["effects"]}, {"hysteresis"})
        said = self.type("train train/*.bag --history found/verdict.yaml --output proposed.h5")
        self.assertIn("History: plays, as proposed; the error falls by ", said)
        self.assertTrue((MEASURED[0] / "seed_1/proposed.h5").exists())


if __name__ == "__main__":
    PROGRAMS = pathlib.Path(sys.argv.pop(1))
    sys.exit(unittest.main())
