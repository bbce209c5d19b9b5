#!/usr/bin/python3
"""Tests of scripts/score_cases on cases of example_case.py, and of the recomputed gap.

score_cases_test.py MESSAGES DISCREPANCY SIMULATE: the folder of the Python messages, and the two programs.
"""

import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import rosbag
import yaml

HERE = pathlib.Path(__file__).resolve().parent
SCORE = HERE.parent.parent / "scripts" / "score_cases"
sys.path.insert(0, str(HERE))
import cases  # noqa: E402
import recompute  # noqa: E402

MESSAGES, DISCREPANCY, SIMULATE = "", "", ""
MADE = None  # folder of two example cases, made once


def make(folder, *more):
    subprocess.run([str(HERE / "example_case.py"), str(folder), *more], check=True,
                   env={"PYTHONPATH": MESSAGES, "PATH": "/usr/bin:/bin"})


def setUpModule():
    global MADE
    MADE = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(MADE.cleanup)
    make(pathlib.Path(MADE.name, "loop"))
    make(pathlib.Path(MADE.name, "quiet"), "none")


class Folder(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.root = pathlib.Path(self.temporary.name)
        self.cases = self.root / "cases"
        shutil.copytree(MADE.name, self.cases)

    def run_score(self, *words, answer="hysteresis"):
        """With a command that always gives the same answer, in an empty environment."""
        return subprocess.run([str(SCORE), str(self.cases), "--command", "%s {bags} --output {output}" % (HERE / "fake_discrepancy"),
                               "--simulate", str(HERE / "fake_simulate.py"), *words], capture_output=True, text=True,
                              env={"FAKE_ANSWER": answer, "FAKE_LOG": str(self.root / "log"), "PYTHONDONTWRITEBYTECODE": "1"})

    def summary(self, name="summary.json"):
        return json.loads((self.cases / name).read_text())

    def rows(self):
        return {row["case"]: row for row in csv.DictReader((self.cases / "cases.csv").read_text().splitlines())}

    def edit(self, path, **changes):
        data = yaml.safe_load((self.cases / path).read_text())
        data.update(changes)
        (self.cases / path).write_text(yaml.safe_dump(data))


class RealTools(Folder):
    def test_an_example_of_a_case_is_made_answered_and_scored(self):
        done = subprocess.run([str(SCORE), str(self.cases), "--command",
                               DISCREPANCY + " {bags} --output {output} --no-report --threads 1", "--simulate", SIMULATE],
                              capture_output=True, text=True, env={})
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = self.rows()
        self.assertEqual((rows["loop"]["truth"], rows["loop"]["answer"], rows["loop"]["outcome"]), ("hysteresis", "hysteresis", "right"))
        self.assertEqual((rows["quiet"]["verdict"], rows["quiet"]["outcome"]), ("none", "right"))
        for row in rows.values():  # the loop leaves 1 %, noise 0.15 % of full scale; a recomputed gap is no less than the noise
            self.assertGreater(float(row["recomputed_after"]), 0.0014)
            self.assertLess(abs(float(row["ratio_before"]) - 1), 0.2, row)
        self.assertGreater(float(rows["loop"]["recomputed_before"]), 0.008)


class Scores(Folder):
    def test_an_answer_is_kept_and_not_asked_for_again(self):
        self.assertEqual(self.run_score().returncode, 0)
        self.assertEqual({case: row["outcome"] for case, row in self.rows().items()}, {"loop": "right", "quiet": "false_alarm"})
        self.run_score(answer="none")
        self.assertEqual(self.rows()["quiet"]["outcome"], "false_alarm")
        self.assertEqual(len((self.root / "log").read_text().splitlines()), 2)

    def test_a_refusal_is_an_answer_and_never_right(self):
        self.assertEqual(self.run_score(answer="refuse").returncode, 0)
        self.assertEqual({case: row["outcome"] for case, row in self.rows().items()}, {"loop": "refused", "quiet": "refused"})
        figure = next(f for f in self.summary()["figures"] if f["figure"].startswith("nothing hidden, false"))
        self.assertEqual((figure["value"]["k"], figure["value"]["n"]), (0, 1))
        self.assertEqual(self.summary()["refused"], {"N cycles, but at least N are needed": 2})
        self.run_score(answer="none")  # it is not asked again
        self.assertEqual(self.summary()["outcomes"]["nothing"], {"refused": 1})

    def test_verdicts_of_another_folder_are_scored(self):
        self.run_score()
        for case in ("loop", "quiet"):
            shutil.move(str(self.cases / case / "found"), str(self.root / "mine" / case))
        done = self.run_score("--verdicts", str(self.root / "mine"), "--output", str(self.root / "out"), answer="none")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads((self.root / "out" / "summary.json").read_text())["cases"], 2)

    def test_shards_are_parts_of_the_same_list(self):
        self.run_score("--shard", "1/2")
        self.assertEqual(self.summary("summary_1_of_2.json")["cases"], 1)
        self.run_score("--shard", "2/2")
        self.run_score(answer="crash")  # both have an answer now
        self.assertEqual(self.summary()["cases"], 2)

    def test_bad_cases_are_named_in_one_sentence_and_counted_and_the_rest_is_scored(self):
        self.run_score()
        for name in ("no_key", "old_key", "old_verdict", "no_bags", "no_yaml", "half_a_key"):
            shutil.copytree(self.cases / "loop", self.cases / name)
        (self.cases / "no_key" / "key.yaml").unlink()
        self.edit("old_key/key.yaml", schema=1)
        self.edit("old_verdict/found/verdict.yaml", version="0.0.1")
        for path in ("found", "bags"):
            shutil.rmtree(self.cases / "no_bags" / path)
        (self.cases / "no_yaml" / "key.yaml").write_text("truth: [")
        self.edit("half_a_key/key.yaml", effects=[{"id": "hysteresis"}])
        done = self.run_score()
        self.assertEqual(done.returncode, 1)
        self.assertEqual(self.summary()["cases"], 2)
        self.assertEqual(self.summary()["not_scored"], {
            "no key": 1, "key of another schema": 1, "verdict of another version": 1, "bags missing": 1, "key cannot be read": 1,
            "key or verdict not as documented": 1})
        said = [line for line in done.stderr.splitlines() if "cases, about" not in line]
        self.assertEqual(len(said), 6, done.stderr)
        for words in ("no_key has no key.yaml", "has schema 1, but must have schema 2", "is of version 0.0.1", "holds no bag",
                      "cannot be read", "'form' is missing"):
            self.assertEqual(sum(words in line for line in said), 1, words)
        self.assertIn("6 cases are not scored", done.stdout)
        self.assertEqual(self.run_score("--any-version").returncode, 1)
        self.assertEqual(self.summary()["cases"], 3)

    def test_without_bags_an_answer_is_scored_but_its_gap_is_missing(self):
        self.run_score("--no-gap")
        shutil.rmtree(self.cases / "loop" / "bags")
        done = self.run_score()
        self.assertEqual((done.returncode, self.summary()["cases"], self.summary()["not_scored"]), (1, 2, {}))
        self.assertEqual(self.summary()["gap_not_recomputed"]["bags missing"], 1)
        self.assertIn("so its gap is not recomputed", done.stderr)

    def test_refuses_what_it_does_not_know(self):
        for words, said in [(["--jbos", "2"], "--jbos"), (["--shard", "0/2"], "0/2"), (["--verdicts", "/nowhere"], "/nowhere")]:
            done = self.run_score(*words)
            self.assertEqual(done.returncode, 2, words)
            self.assertIn(said, done.stderr)
        self.assertIn("--verdicts FOUND", self.run_score("--help").stdout)
        empty = subprocess.run([str(SCORE), str(self.root / "nothing")], capture_output=True, text=True, env={})
        self.assertEqual(empty.returncode, 2)


class Recomputed(Folder):
    """fake_simulate.py adds a number of counts, so the gap is that number, as a share of 4095."""

    def gap(self, cycles, before=8, after=2):
        found = self.root / "found"
        found.mkdir(exist_ok=True)
        noise = "effects:\n  white_noise:\n    absolute: 2\n    relative: 0.01\n  converter: {}\n"
        (found / "base.yaml").write_text(noise + "add: %d\n" % before)
        (found / "simulation.yaml").write_text(noise + "add: %d\n" % after)
        bags = cases.bags_of(self.cases / "loop")
        return recompute.recompute([str(HERE / "fake_simulate.py")], bags, {"hold_out": cycles}, found, self.root / "work",
                                   dict(os.environ, FAKE_LOG=str(self.root / "log")))

    def test_leaves_out_what_is_random(self):
        (self.root / "rig.yaml").write_text("effects:\n  white_noise:\n    absolute: 2\n  repositioning: {gain: 0.1}\n  drift:\n"
                                            "    rate: 0.2\n    rate_walk: 0.1  # a\n  row_fault:\n    loss: 1\n  column_fault:\n"
                                            "    loss: 1\n    spells: [1]\n  mains_pickup:\n    gain: 1\nseed: 1\n")
        self.assertEqual(recompute.expected_copy(self.root / "rig.yaml", self.root / "copy").read_text(),
                         "effects:\n  drift:\n    rate: 0.2\n    rate_walk: 0\n  column_fault:\n    loss: 1\n    spells: [1]\nseed: 1\n")

    def stamps(self, bag):
        return recompute.Scans(self.cases / "loop" / "bags" / bag).stamps / 1e9

    def test_is_the_rms_over_the_named_scans_alone(self):
        stamps = self.stamps("1_flat.bag")
        gap = self.gap([{"file": "1_flat.bag", "cycles": [[stamps[100], stamps[149]], [stamps[200], stamps[209]]]}])
        self.assertNotIn("problem", gap)
        self.assertAlmostEqual(gap["before"], 8 / 4095, places=12)
        self.assertAlmostEqual(gap["after"], 2 / 4095, places=12)
        self.assertEqual(gap["scans"], 60)

    def test_drives_all_bags_in_time_order(self):
        stamps = self.stamps("2_cylinder_7cm.bag")
        self.gap([{"file": "2_cylinder_7cm.bag", "cycles": [[stamps[0], stamps[50]]]}])
        self.assertEqual((self.root / "log").read_text(), 2 * "simulate 1_flat.bag 2_cylinder_7cm.bag\n")

    def test_says_why_it_cannot(self):
        self.assertIn("no hold-out cycle", self.gap([])["problem"])
        self.assertIn("no scan", self.gap([{"file": "1_flat.bag", "cycles": [[1.0, 2.0]]}])["problem"])
        (self.cases / "loop" / "bags" / "1_flat.bag").write_text("no bag")
        self.assertIn("ROSBag", self.gap([{"file": "1_flat.bag", "cycles": [[1.0, 2.0]]}])["problem"])

    def test_reads_scans_as_rosbag_does(self):
        path = self.cases / "loop" / "bags" / "1_flat.bag"
        scans = recompute.Scans(path)
        with rosbag.Bag(str(path)) as bag:
            messages = [message for _, message, _ in bag.read_messages(topics=["/fsr/raw"])]
        self.assertEqual(scans.full_scale, messages[0].full_scale)
        self.assertEqual([m.header.stamp.to_nsec() for m in messages], scans.stamps.tolist())
        self.assertEqual([list(m.counts) for m in messages[:50]], scans.counts[:50].tolist())


if __name__ == "__main__":
    MESSAGES, DISCREPANCY, SIMULATE = sys.argv[1:4]
    del sys.argv[1:4]
    unittest.main()
