#!/usr/bin/python3
"""Tests of scripts/blind_trials with a generator and a command that only pretend."""

import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import shards  # noqa: E402
TRIALS = HERE.parent.parent / "scripts" / "blind_trials"
GRID = ["--effects", "creep:log_time,seal_leak", "--kpa", "", "--pairs", "1"]
# Effects that discrepancy cannot name: parts of every rig, what a uniform pressure does not show, what no version looks for.
NOT_NAMED = {"static_curve", "white_noise", "converter", "bending_preload", "bending_gain", "turn_on", "trapped_gas",
             "edge_stiffness", "crosstalk", "supply_droop", "transducer_error", "scan_skew", "session_offset"}


class Trials(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.output = pathlib.Path(self.folder.name, "results")
        self.log = pathlib.Path(self.folder.name, "calls")

    def start_trials(self, answer, *words):
        """In an empty environment, as cron would."""
        command = "%s {bags} --output {output}" % (HERE / "fake_discrepancy")
        usual = [str(TRIALS), "--output", str(self.output), "--generator", str(HERE / "fake_blind_case.py"), "--command", command]
        return subprocess.Popen([*usual, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
                                env={"FAKE_ANSWER": answer, "FAKE_LOG": str(self.log), "PYTHONDONTWRITEBYTECODE": "1"})

    def run_trials(self, answer, *more, grid=GRID):
        run = self.start_trials(answer, *grid, *more)
        out, err = run.communicate()
        return subprocess.CompletedProcess(run.args, run.returncode, out, err)

    def summary(self):
        return json.loads((self.output / "summary.json").read_text())

    def figure(self, name):
        value = next(f["value"] for f in self.summary()["figures"] if f["figure"] == name)
        return value["k"], value["n"]

    def calls(self):
        return self.log.read_text().splitlines() if self.log.exists() else []

    def names(self):
        return sorted(path.parent.name for path in self.output.glob("cases/*/run.json"))

    def test_every_case_is_asked_once_and_scored(self):
        done = self.run_trials("creep")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.summary()["outcomes"], {
            "nothing": {"false_alarm": 3}, "pair": {"incomplete": 1}, "single": {"right": 1, "wrong_name": 1}}, self.names())
        self.assertEqual(self.figure("nothing hidden, false alarms"), (3, 3))
        self.assertIn("| creep | 1 of 1 |", done.stdout)
        self.assertEqual((self.output / "cases.csv").read_text().count("\n"), 7)

    def test_nothing_is_hidden_as_often_as_all_else_together(self):
        self.run_trials("none", "--snr", "4,1", "--kpa", "10", "--seeds", "2", grid=["--effects", "creep"])
        self.assertEqual(self.summary()["kinds"], {"single": 12, "nothing": 12})
        self.assertIn("A.creep.two_terms.kpa10.0002", self.names())

    def test_forms_of_the_other_set_are_not_used(self):
        self.run_trials("none", "--set", "B", grid=["--kpa", "", "--nothing", "0"])
        self.assertEqual(self.names(), ["B.creep.sealed.snr1.0001"])

    def test_the_command_sees_nothing_of_the_case_but_its_bags(self):
        self.run_trials("none")
        for call in self.calls():
            for word in ("creep", "seal_leak", "snr", "key"):
                self.assertNotIn(word, call)
        self.assertEqual(list(self.output.glob("cases/*/bags")), [])  # the bags were removed

    def test_goes_on_where_it_stopped(self):
        self.run_trials("none", grid=["--effects", "creep:log_time", "--kpa", "", "--nothing", "2"])
        self.assertEqual(len(self.calls()), 3)
        self.run_trials("none", grid=["--effects", "creep:log_time", "--kpa", "", "--nothing", "2"])
        self.assertEqual(len(self.calls()), 3)
        next(self.output.glob("cases/A.creep*/run.json")).unlink()  # as if the run had been stopped here
        self.run_trials("none", grid=["--effects", "creep:log_time", "--kpa", "", "--nothing", "2"])
        self.assertEqual(len(self.calls()), 4)

    def test_an_interrupted_case_is_finished_and_none_is_lost(self):
        run = self.start_trials("slow", *GRID, "--jobs", "2")
        while not self.calls() and run.poll() is None:
            time.sleep(0.02)
        os.killpg(run.pid, signal.SIGINT)  # as Ctrl-C in a terminal does
        said = run.communicate()[1]
        self.assertEqual(run.returncode, 1)
        self.assertIn("goes on from here", said)
        self.assertLess(len(self.names()), 6)
        done = self.run_trials("none")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((self.summary()["cases"], len(self.calls())), (6, 6))

    def test_stops_in_time_and_goes_on(self):
        done = self.run_trials("none", "--minutes", "0.0001", "--jobs", "1")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stderr, r"[56] cases are left")
        self.run_trials("none")
        self.assertEqual(len(self.names()), 6)

    def run_shards(self, number=2, **options):
        for shard in range(1, number + 1):
            self.run_trials("creep", "--shard", "%d/%d" % (shard, number), **options)

    def pretend_shard(self, shard, number, **campaign):
        """Its files, without a run: two cases that are done."""
        names = ["A.creep.log_time.snr1.%04d" % (2 * shard + i) for i in (0, 1)]
        for name in names:
            (self.output / "cases" / name).mkdir(parents=True, exist_ok=True)
            (self.output / "cases" / name / "run.json").write_text(json.dumps({"status": "done", "case": name}))
        shards.write(self.output, (shard, number), {"snr": "1", **campaign}, dict.fromkeys(names, "done"))

    def merge(self):
        return self.run_trials("creep", "--merge", grid=[])

    def files(self):
        return {name: (self.output / name).read_bytes() for name in ("summary.json", "summary.md", "cases.csv")}

    def assert_unfit(self, *sentence_parts):
        done = self.merge()
        self.assertEqual(done.returncode, 2, done.stderr)
        said = done.stderr.strip().splitlines()[-1]
        for part in sentence_parts:
            self.assertIn(part, said)
        self.assertFalse((self.output / "summary.json").exists())

    def edit(self, name, change):
        path = self.output / name
        data = json.loads(path.read_text())
        change(data)
        data["campaign_sha256"] = shards.digest(data["campaign"])
        path.write_text(json.dumps(data))

    def test_shards_share_the_campaign(self):
        self.run_trials("none", "--shard", "1/2")
        first = set(self.names())
        self.run_trials("none", "--shard", "2/2")
        self.assertEqual((len(first), len(self.names())), (3, 6))
        for name in ("shard_1_of_2.json", "summary_1_of_2.md", "summary_2_of_2.json", "cases_2_of_2.csv"):
            self.assertTrue((self.output / name).exists(), name)
        self.assertFalse((self.output / "summary.md").exists())  # shards never write the same file
        self.assertEqual(set(json.loads((self.output / "shard_1_of_2.json").read_text())["cases"]), first)

    def test_merged_shards_give_the_bytes_of_one_run(self):
        self.run_shards(3)
        done = self.merge()
        self.assertEqual(done.returncode, 0, done.stderr)
        merged = self.files()
        self.assertEqual(self.run_trials("creep").returncode, 0)  # the whole campaign: every case is answered already
        self.assertEqual((merged, len(self.calls())), (self.files(), 6))

    def test_merge_names_a_shard_that_is_missing(self):
        self.pretend_shard(1, 3)
        self.pretend_shard(3, 3)
        self.assert_unfit("shard 2 of 3 is missing", "--shard 2/3")

    def test_merge_refuses_shards_that_do_not_belong_together(self):
        first, second = (self.output / ("shard_%d_of_2.json" % i) for i in (1, 2))

        def same_case(data):
            data["cases"]["A.creep.log_time.snr1.0002"] = "done"
        for damage, parts in [
                (lambda: (self.output / "shard_1_of_2 copy.json").write_bytes(first.read_bytes()),
                 ("shard_1_of_2 copy.json", "shard_1_of_2.json", "are both shard 1 of 2")),
                (lambda: self.edit(second.name, same_case), ("both have the case A.creep.log_time.snr1.0002", second.name)),
                (lambda: self.edit(second.name, lambda data: data.update(version="0.0.9")),
                 ("shard_2_of_2.json is of version 0.0.9", first.name)),
                (lambda: self.pretend_shard(2, 2, snr="2"),
                 ("shard_2_of_2.json has other options", '--snr is "2" here and "1" there')),
                (lambda: (second.unlink(), self.pretend_shard(2, 3)),
                 ("shard_2_of_3.json is of a campaign of 3 shards", "shard_1_of_2.json of a campaign of 2 shards")),
                # As if its folder had not been copied.
                (lambda: next(self.output.glob("cases/*/run.json")).unlink(), ("as missing; copy the folders of all shards into one",)),
                (lambda: second.write_text(second.read_text()[:100]), ("shard_2_of_2.json cannot be read",)),
                (lambda: second.write_text(second.read_text().replace('"snr": "1"', '"snr": "2"')),
                 ("shard_2_of_2.json is not a shard of blind_trials as it was written",))]:
            shutil.rmtree(self.output, ignore_errors=True)
            self.pretend_shard(1, 2)
            self.pretend_shard(2, 2)
            damage()
            with self.subTest(parts[0]):
                self.assert_unfit(*parts)

    def test_merge_refuses_a_shard_that_stopped_in_between(self):
        self.pretend_shard(1, 2)
        self.run_trials("creep", "--shard", "2/2", "--minutes", "0.0001", "--jobs", "1")
        campaign = json.loads((self.output / "shard_2_of_2.json").read_text())["campaign"]
        self.edit("shard_1_of_2.json", lambda data: data.update(campaign=campaign))
        self.assert_unfit("shard_2_of_2.json", "cases are left")

    def test_a_shard_that_is_killed_leaves_no_file_and_goes_on(self):
        self.run_trials("creep", "--shard", "2/2")
        run = self.start_trials("slow", *GRID, "--jobs", "1", "--shard", "1/2")
        while len(self.calls()) < 4 and run.poll() is None:
            time.sleep(0.02)
        os.killpg(run.pid, signal.SIGKILL)
        run.communicate()
        self.assert_unfit("shard 1 of 2 is missing")
        self.run_trials("none", "--shard", "1/2")
        self.assertEqual(self.merge().returncode, 0)
        self.assertEqual(self.summary()["cases"], 6)

    def test_a_command_that_fails_is_counted_and_tried_again_when_asked(self):
        done = self.run_trials("crash")
        self.assertEqual(done.returncode, 1)
        self.assertEqual(self.summary()["not_scored"], {"command failed": len(self.names())})
        self.assertIn("it fell over", done.stderr)
        self.assertEqual(self.run_trials("none").returncode, 1)
        self.assertEqual(self.run_trials("none", "--retry-failed").returncode, 0)
        self.assertEqual(self.figure("nothing hidden, false alarms")[0], 0)

    def test_what_the_generator_refuses_is_set_aside(self):
        done = self.run_trials("none", grid=["--effects", "repositioning", "--kpa", "", "--nothing", "1"])
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("1 cases were refused", done.stderr)
        self.assertEqual(self.summary()["cases"], 1)

    def test_makes_a_data_set_without_asking_anybody(self):
        done = self.run_trials("none", "--make-only")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.calls(), [])
        self.assertEqual(len(list(self.output.glob("cases/*/bags/*.bag"))), len(self.names()))

    def test_answers_a_data_set_and_leaves_its_bags(self):
        self.run_trials("none", "--make-only")
        done = self.run_trials("none")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((self.summary()["cases"], len(self.calls())), (6, 6))
        self.assertEqual(len(list(self.output.glob("cases/*/bags/*.bag"))), 6)
        self.assertEqual(self.run_trials("none", "--make-only").returncode, 0)

    def test_makes_no_data_set_of_answers_without_bags(self):
        self.run_trials("none")
        done = self.run_trials("none", "--make-only")
        self.assertEqual(done.returncode, 2)
        self.assertIn("6 cases are answered and their bags removed; choose another --output", done.stderr)
        self.run_trials("crash")
        self.assertEqual(self.summary()["cases"], 6)

    def test_refuses_what_it_does_not_know(self):
        for words, said in [(["--effects", "creeep"], "creeep"), (["--snrs", "1"], "--snrs"), (["--shard", "3/2"], "3/2"),
                            (["--shard", "1/2", "--merge"], "--merge"),
                            (["--snr", "loud"], "loud")]:
            done = self.run_trials("none", grid=words)
            self.assertEqual(done.returncode, 2, words)
            self.assertIn(said, done.stderr)
        self.assertIn("--shard I/N", self.run_trials("none", "--help").stdout)

    def test_the_fixed_campaign_fails_beyond_its_bounds_and_where_it_lacks_a_class_or_an_effect(self):
        always_named = self.run_trials("wear", grid=["--fixed"])
        self.assertEqual(always_named.returncode, 1)
        for figure in ("nothing hidden, false alarms: 8 of 8", "something hidden, wrong name", "could be told, any size, right"):
            self.assertIn("beyond its bounds: " + figure, always_named.stderr)
        self.output = self.output.with_name("silent")
        silent = self.run_trials("none", grid=["--fixed"])  # this generator refuses the repositioning and has a class `short`
        self.assertEqual(silent.returncode, 1)
        self.assertNotIn("false alarms", silent.stderr)
        self.assertIn("beyond its bounds: could be told, any size, right: 0 of ", silent.stderr)
        self.assertIn("the fixed campaign lacks short, repositioning; change", silent.stderr)
        self.assertEqual(self.run_trials("none", "--shard", "1/2", grid=["--fixed"]).returncode, 0)  # a part need not hold all

    def test_the_fixed_campaign_names_each_case_once(self):
        names = [n for n in (HERE / "fixed_campaign.txt").read_text().split("\n") if n and not n.startswith("#")]
        self.assertEqual(len(names), len(set(names)))
        for name in names:
            self.assertTrue(re.fullmatch(r"A\.(none|[a-z0-9_]+\.[a-z0-9_]+\.(snr|kpa)[0-9.]+)\.\d{4}", name), name)

    def test_the_proof_has_a_case_of_every_effect_that_can_be_named(self):
        all_effects = HERE.parent / "benchmark" / "all_effects.yaml"
        effects = set(re.findall(r"(?m)^  (\w+): {", all_effects.read_text()))
        cases = [n for n in (HERE / "proof_campaign.txt").read_text().split("\n") if n and not n.startswith("#")]
        self.assertEqual(sorted({name.split(".")[1] for name in cases}), sorted(effects - NOT_NAMED))
        self.assertEqual(len(cases), len(set(cases)))


if __name__ == "__main__":
    unittest.main()
