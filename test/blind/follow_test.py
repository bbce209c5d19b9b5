#!/usr/bin/python3
"""Tests of follow.py, which scripts/follow_trials uses, with tools that only pretend."""

import argparse
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import follow  # noqa: E402

TRIAL = follow.Trial("creep.log_time.paper.0001", "creep", "log_time", 1, 4, "paper")


class Pretending:
    """Says of the first recordings what it is told, and names the hidden effect once the third was recorded."""

    def __init__(self, verdict, confirms):
        self.verdict, self.confirms, self.calls = verdict, confirms, []

    def make(self, trial, effect, folder):
        self.calls.append(("make", effect))

    def follow(self, key, protocol, folder):
        self.calls.append(("follow", key.parent.name, protocol))

    def investigate(self, folders, output):
        return {"verdict": "named", "credible_set": [["creep"]]} if len(folders) == 2 else self.verdict

    def confirm(self, verdict, folder, output):
        return {"passed": self.confirms[folder.name], "predicted": [0.9, 1.2]}


def verdict(kind, *names, protocol=None):
    return {"verdict": kind, "credible_set": [[name] for name in names],
            "prediction": {"size": [0.9, 1.1]} if names else None, "next_experiment": {"protocol": protocol} if protocol else None}


class Follow(unittest.TestCase):
    def rows(self, tools):
        with tempfile.TemporaryDirectory() as keep:
            return follow.rows_of(TRIAL, tools, pathlib.Path(keep))

    def test_a_right_prediction_is_held_against_later_recordings_and_against_another_effect(self):
        tools = Pretending(verdict("named", "creep"), {"second": True, "another_second": False})
        rows = self.rows(tools)
        self.assertEqual([(row["kind"], row["passed"]) for row in rows], [("right", True), ("another effect", False)])
        self.assertAlmostEqual(rows[0]["width"], 0.3)
        self.assertEqual(tools.calls, [("make", "creep:log_time"), ("follow", "first", "two_speeds"), ("make", "time_skew"),
                                       ("follow", "another", "two_speeds")])

    def test_a_prediction_under_a_wrong_name_should_fail(self):
        rows = self.rows(Pretending(verdict("named", "hysteresis"), {"second": True}))
        self.assertEqual([(row["kind"], row["passed"]) for row in rows], [("wrong name", True)])
        self.assertEqual(follow.figures(rows)[1][1]["rate"], 0)

    def test_the_recommended_experiment_is_followed_under_its_protocol(self):
        tools = Pretending(verdict("ambiguous", "hysteresis", "creep", protocol="step_hold"), {"second": False})
        rows = self.rows(tools)
        self.assertEqual([row["kind"] for row in rows], ["wrong name", "advised"])
        self.assertTrue(rows[1]["right"] and rows[1]["alone"])
        self.assertIn(("follow", "first", "step_hold"), tools.calls)

    def test_nothing_found_predicts_nothing(self):
        rows = self.rows(Pretending(verdict("none"), {}))
        self.assertEqual(rows, [])
        self.assertEqual(follow.text_of(follow.figures(rows)[0][1]), "no trial")

    def test_every_second_trial_is_at_one_pace(self):
        options = argparse.Namespace(seeds=2, snr=1, first="two_speeds")
        firsts = [trial.first for trial in follow.trials_of([("creep", "a"), ("creep", "b")], options)]
        self.assertEqual(firsts, ["two_speeds", "paper", "paper", "two_speeds"])


if __name__ == "__main__":
    unittest.main()
