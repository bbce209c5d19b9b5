#!/usr/bin/python3
"""Tests of score.py on keys and verdicts written by hand."""

import copy
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import score  # noqa: E402


def key(*ids, truth="named", snr=1, protocol="two_speeds", depends_on=()):
    where = {"taxels": [0, 1, 2, 3], "conditions": ["flat"], "pressure": [0, 400000]}
    effects = [{"id": i, "form": "f", "where": where, "depends_on": list(depends_on)} for i in ids]
    return {"truth": truth if ids else "none", "effects": effects, "taxels": 12, "conditions": ["flat", "cylinder_5cm"],
            "spec": {"snr": snr, "protocol": protocol, "thermometer": True}}


def verdict(kind, *explanations, **more):
    effects = [{"id": i} for i in explanations[0]] if explanations and kind in score.NAMING else []
    return dict({"verdict": kind, "effects": effects, "credible_set": [list(e) for e in explanations]}, **more)


def scored(k, v, **run):
    return score.score_case(k, v, run)


class OneCase(unittest.TestCase):
    def test_the_right_name_is_right_and_in_the_set(self):
        case = scored(key("creep"), verdict("named", ["creep"]))
        self.assertTrue(case["right_first"] and case["in_set"])
        self.assertFalse(case["wrong_name"])
        self.assertEqual((case["answer"], case["set_size"]), ("creep", 1))

    def test_another_name_is_a_wrong_name(self):
        case = scored(key("creep"), verdict("named", ["drift"]))
        self.assertTrue(case["wrong_name"])
        self.assertFalse(case["right_first"] or case["in_set"])

    def test_an_ambiguous_answer_is_never_a_wrong_name(self):
        case = scored(key("creep"), verdict("ambiguous", ["drift"], ["creep"]))
        self.assertEqual((case["right_first"], case["in_set"], case["wrong_name"]), (False, True, False))
        self.assertEqual(case["set_size"], 2)

    def test_a_wrong_form_of_the_right_effect_is_the_right_name(self):
        self.assertTrue(scored(key("hysteresis"), verdict("wrong_form", ["hysteresis"]))["right_first"])
        self.assertTrue(scored(key("hysteresis"), verdict("wrong_form", ["creep"]))["wrong_name"])

    def test_silence_is_no_wrong_name_but_not_right_either(self):
        case = scored(key("creep"), verdict("none"))
        self.assertEqual((case["right_first"], case["in_set"], case["wrong_name"]), (False, False, False))
        self.assertEqual(case["answer"], "none")

    def test_unknown_wants_its_covariates_and_at_most_one_more(self):
        foreign = key("foreign", truth="unknown", depends_on=["pressure_rate", "curvature"])
        told = lambda *names: scored(foreign, verdict("unknown", depends_on=list(names)))["covariates"]
        self.assertTrue(told("dP/dt", "curvature"))
        self.assertTrue(told("pressure_rate", "curvature", "pressure"))
        self.assertFalse(told("pressure_rate"))
        self.assertFalse(told("pressure_rate", "curvature", "pressure", "mount"))
        self.assertTrue(scored(foreign, verdict("named", ["creep"]))["wrong_name"])

    def test_a_pair_is_right_as_a_pair_and_counts_what_is_too_much(self):
        pair = key("creep", "drift")
        self.assertTrue(scored(pair, verdict("named", ["drift", "creep"]))["right_first"])
        self.assertFalse(scored(pair, verdict("named", ["creep"]))["right_first"])
        self.assertEqual(scored(pair, verdict("named", ["creep", "wear"]))["extra"], 1)

    def test_a_left_out_effect_wants_unknown_where_no_other_closes_as_much(self):
        right = lambda v, shares: scored(key("creep"), v, left_out="creep", shares_with_it=shares)["right_first"]
        ambiguous, step = verdict("ambiguous", ["drift"], ["wear"]), {"protocol": "step_hold"}
        far = {"creep": 0.9, "drift": 0.7}
        self.assertTrue(right(verdict("unknown"), far))
        self.assertFalse(right(verdict("named", ["drift"]), far))
        self.assertFalse(right(ambiguous | {"next_experiment": step}, far))
        self.assertTrue(right(verdict("unknown"), {"drift": 0.7}))  # found by a detector: no other effect closes anything

    def test_a_left_out_effect_with_a_good_substitute_wants_an_ambiguous_one_and_a_next_step(self):
        right = lambda v: scored(key("creep"), v, left_out="creep", shares_with_it={"creep": 0.9, "drift": 0.85})["right_first"]
        ambiguous, step = verdict("ambiguous", ["drift"], ["wear"]), {"protocol": "step_hold"}
        self.assertTrue(right(ambiguous | {"next_experiment": step}))
        self.assertFalse(right(ambiguous))
        self.assertFalse(right(verdict("unknown")))
        self.assertFalse(right(verdict("named", ["drift"])))

    def test_a_frozen_prediction_counts_by_whether_it_was_right(self):
        told = lambda name, passed: scored(key("creep"), verdict("named", [name]), confirmed=passed)
        self.assertEqual((told("drift", False)["wrong_fails"], told("drift", False)["right_passes"]), (True, None))
        self.assertEqual((told("creep", True)["wrong_fails"], told("creep", True)["right_passes"]), (None, True))
        self.assertIs(told("drift", True)["wrong_fails"], False)

    def test_an_experiment_resolves_what_is_one_right_name_after_it(self):
        after = lambda kind, *ids: scored(key("creep"), verdict("ambiguous", ["wear"], ["creep"]),
                                          follow_up={"verdict": kind, "effects": list(ids)})["resolved"]
        self.assertTrue(after("named", "creep") and after("wrong_form", "creep"))
        self.assertFalse(after("ambiguous", "creep") or after("named", "wear") or after("named", "creep", "wear"))
        self.assertIsNone(scored(key("creep"), verdict("named", ["creep"]))["resolved"])

    def test_a_verdict_that_does_not_exist_is_refused(self):
        with self.assertRaisesRegex(ValueError, "maybe"):
            scored(key("creep"), verdict("maybe"))


class Place(unittest.TestCase):
    def f1(self, **where):
        return scored(key("creep"), verdict("named", ["creep"], where=where))["f1"]

    def test_exact_is_one(self):
        f1 = self.f1(taxels=[0, 1, 2, 3], conditions=["flat"], pressure=[0, 400000])
        self.assertEqual(f1, {"taxels": 1, "conditions": 1, "pressure": 1, "mean": 1})

    def test_all_taxels_for_a_third_of_them_is_one_half(self):
        self.assertAlmostEqual(self.f1(taxels="all", conditions=["flat"])["taxels"], 2 * 4 / (4 + 12))

    def test_pressure_ranges_overlap(self):
        self.assertAlmostEqual(self.f1(pressure=[200e3, 400e3])["pressure"], 2 * 200 / 600)
        self.assertAlmostEqual(self.f1(pressure="all")["pressure"], 2 * 400 / 1020)
        self.assertEqual(self.f1(pressure=[500e3, 600e3])["pressure"], 0)

    def test_a_verdict_without_a_place_has_no_score(self):
        self.assertIsNone(scored(key("creep"), verdict("named", ["creep"], where=None))["f1"])


class Rates(unittest.TestCase):
    def test_intervals_are_those_of_scipy(self):
        # scipy 1.10.1: scipy.stats.binomtest(k, n).proportion_ci(method="exact")
        for k, n, low, high in [(0, 20, 0, 0.16843347098308536), (3, 1000, 0.0006190999316499173, 0.008742023238657654),
                                (19, 20, 0.7512672372279723, 0.998734910502044), (20, 20, 0.8315665290169146, 1)]:
            got = score.clopper_pearson(k, n)
            self.assertAlmostEqual(got[0], low, places=10)
            self.assertAlmostEqual(got[1], high, places=10)

    def test_nothing_known_is_anything(self):
        self.assertEqual(score.clopper_pearson(0, 0), (0.0, 1.0))


class Table(unittest.TestCase):
    def setUp(self):
        right = scored(key("creep"), verdict("named", ["creep"], gap={"closed": 0.9}), seconds=3)
        wrong = scored(key("creep"), verdict("named", ["drift"]))
        quiet = scored(key(), verdict("none"))
        alarm = scored(key(), verdict("unknown"))
        self.cases = [right, wrong, quiet, copy.deepcopy(quiet), alarm]

    def figure(self, start):
        return next(f for f in score.summarise(self.cases)["figures"] if f["figure"].startswith(start))

    def test_counts_every_case_once(self):
        self.assertEqual(score.summarise(self.cases)["confusion"],
                         {"creep": {"creep": 1, "drift": 1}, "none": {"none": 2, "unknown": 1}})

    def test_says_of_each_target_whether_it_is_met(self):
        alarms = self.figure("false alarms")
        self.assertEqual(alarms["value"][:2], [1, 3])
        self.assertFalse(alarms["met"])
        self.assertEqual(self.figure("wrong single name")["value"][:2], [1, 2])
        self.assertTrue(self.figure("gap closed, median")["met"])
        self.assertIsNone(self.figure("two effects, both")["met"])  # no case

    def test_prints_rates_with_their_intervals(self):
        text = score.markdown(score.summarise(self.cases))
        self.assertIn("| wrong single name, any SNR | 50.0 % (1 of 2; 1.3 % to 98.7 %) | <= 0.02 | no |", text)
        self.assertIn("| creep | 1 |", text)


if __name__ == "__main__":
    unittest.main()
