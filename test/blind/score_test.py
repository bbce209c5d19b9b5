#!/usr/bin/python3
"""Tests of the rules of score.py, of the rates and of the tables, on keys and verdicts written by hand."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import rates  # noqa: E402
import score  # noqa: E402
import summary  # noqa: E402


def key(*ids, truth="named", form="f", snr=1, kpa=10, protocol="regular", depends_on=(), hidden=(), **more):
    """A case with these effects; `hidden`: {id: reason} of those that could not be told, with what they look like."""
    where = {"taxels": [0, 1, 2, 3], "conditions": ["flat"], "pressure": [0, 400000]}
    effects = [{"id": i, "form": form, "where": where, "depends_on": list(depends_on), "snr": snr, "kpa_at_map": kpa}
               for i in ids]
    told = [{"id": i, "could_be_told": i not in dict(hidden), "reason": dict(hidden).get(i), "confused_with": []} for i in ids]
    return dict({"schema": 2, "truth": truth if ids else "none", "protocol_class": protocol, "effects": effects,
                 "identifiable": {"effects": told}, "sheet": {"rows": 3, "columns": 4}, "protocol": {"peak_pa": 620e3},
                 "conditions": ["flat", "cylinder_5cm"]}, **more)


def verdict(kind, *explanations, **more):
    effects = [{"id": i} for i in explanations[0]] if explanations and kind in score.NAMING else []
    return dict({"verdict": kind, "effects": effects, "credible_set": [list(e) for e in explanations]}, **more)


def outcome(k, v):
    return score.score_case(k, v)["outcome"]


class Names(unittest.TestCase):
    def test_the_right_name_is_right(self):
        row = score.score_case(key("creep"), verdict("named", ["creep"]))
        self.assertEqual((row["outcome"], row["truth_in_set"], row["set_size"], row["false_members"]), ("right", True, 1, 0))
        self.assertEqual(outcome(key("hysteresis"), verdict("wrong_form", ["hysteresis"])), "right")

    def test_another_name_is_a_wrong_name(self):
        row = score.score_case(key("creep"), verdict("named", ["drift"]))
        self.assertEqual((row["outcome"], row["truth_in_set"], row["false_members"]), ("wrong_name", False, 1))

    def test_a_set_is_judged_by_its_first_member(self):
        right = score.score_case(key("creep"), verdict("ambiguous", ["creep"], ["drift"]))
        wrong = score.score_case(key("creep"), verdict("ambiguous", ["drift"], ["creep"]))
        self.assertEqual((right["outcome"], wrong["outcome"]), ("right", "wrong_name"))
        self.assertTrue(right["truth_in_set"] and wrong["truth_in_set"])
        self.assertEqual((right["false_members"], wrong["set_size"]), (1, 2))

    def test_a_pair_with_a_wrong_partner_is_wrong(self):
        pair = key("creep", "drift")
        self.assertEqual(outcome(pair, verdict("named", ["drift", "creep"])), "right")
        self.assertEqual(outcome(pair, verdict("named", ["creep"])), "incomplete")
        self.assertEqual(outcome(pair, verdict("named", ["creep", "wear"])), "wrong_name")
        self.assertEqual(outcome(key("creep"), verdict("named", ["creep", "wear"])), "wrong_name")

    def test_silence_is_no_wrong_name_but_not_right_either(self):
        self.assertEqual(outcome(key("creep"), verdict("none")), "silent")
        self.assertEqual(outcome(key("creep"), verdict("unknown")), "unknown")

    def test_with_nothing_hidden_every_verdict_but_none_is_a_false_alarm(self):
        self.assertEqual(outcome(key(), verdict("none")), "right")
        for kind in ("unknown", "ambiguous", "named", "wrong_form"):
            row = score.score_case(key(), verdict(kind, ["creep"]))
            self.assertEqual((row["outcome"], row["right"]), ("false_alarm", False))

    def test_a_foreign_effect_is_unknown_and_any_name_is_wrong(self):
        foreign = key("foreign", truth="unknown", depends_on=["pressure_rate", "curvature"])
        self.assertEqual(outcome(foreign, verdict("unknown")), "right")
        self.assertEqual(outcome(foreign, verdict("none")), "silent")
        self.assertEqual(outcome(foreign, verdict("named", ["creep"])), "wrong_name")
        self.assertEqual(outcome(foreign, verdict("ambiguous", ["creep"], ["drift"])), "wrong_name")

    def test_unknown_wants_its_covariates_and_at_most_one_more(self):
        foreign = key("foreign", truth="unknown", depends_on=["pressure_rate", "curvature"])
        told = lambda *names: score.score_case(foreign, verdict("unknown", depends_on=list(names)))["covariates"]
        self.assertTrue(told("dP/dt", "curvature"))
        self.assertTrue(told("pressure_rate", "curvature", "pressure"))
        self.assertFalse(told("pressure_rate"))
        self.assertFalse(told("pressure_rate", "curvature", "pressure", "mount"))

    def test_a_verdict_that_does_not_exist_is_refused(self):
        with self.assertRaisesRegex(ValueError, "maybe"):
            score.score_case(key("creep"), verdict("maybe"))
        with self.assertRaisesRegex(ValueError, "perhaps"):
            score.score_case(key("creep", truth="perhaps"), verdict("none"))


class Abstention(unittest.TestCase):
    def untold(self, reason, v):
        return outcome(key("creep", hidden=[("creep", reason)]), v)

    def test_a_name_is_wrong_even_the_right_one(self):
        for name in ("creep", "drift"):
            self.assertEqual(self.untold("one_pace", verdict("named", [name])), "wrong_name")

    def test_ambiguous_is_right_with_the_truth_in_the_set_and_an_experiment_that_helps(self):
        v = lambda experiment: verdict("ambiguous", ["hysteresis"], ["creep"], next_experiment={"protocol": experiment})
        self.assertEqual(self.untold("one_pace", v("two_speeds")), "abstained")
        self.assertEqual(self.untold("one_pace", v("two_ambients")), "wrong_reason")
        self.assertEqual(self.untold("one_pace", verdict("ambiguous", ["hysteresis"], ["creep"])), "wrong_reason")
        self.assertEqual(self.untold("no_thermometer", v("two_ambients")), "abstained")
        without = verdict("ambiguous", ["hysteresis"], ["drift"], next_experiment={"protocol": "two_speeds"})
        self.assertEqual(self.untold("one_pace", without), "wrong_name")

    def test_a_partner_that_does_not_look_alike_is_no_reason(self):
        v = verdict("ambiguous", ["creep"], ["drift"], ["wear"], next_experiment={"protocol": "hours_apart"})
        self.assertEqual(self.untold("collinear_with:drift", v), "wrong_reason")
        alike = key("creep", hidden=[("creep", "collinear_with:drift")])
        alike["identifiable"]["effects"][0]["confused_with"] = ["wear"]
        self.assertEqual(outcome(alike, v), "abstained")

    def test_none_is_right_for_what_is_too_small_or_listed_as_not_identifiable(self):
        self.assertEqual(self.untold("too_small", verdict("none")), "abstained")
        self.assertEqual(self.untold("one_mount", verdict("none")), "wrong_reason")
        listed = verdict("none", not_identifiable=[{"id": "creep", "experiment": "remount"}])
        self.assertEqual(self.untold("one_mount", listed), "abstained")
        self.assertEqual(self.untold("one_pace", listed), "wrong_reason")

    def test_what_is_said_of_effects_that_are_not_hidden_does_not_count(self):
        k = key("creep")
        k["identifiable"]["effects"].append({"id": "drift", "could_be_told": False, "reason": "no_thermometer"})
        self.assertEqual(outcome(k, verdict("named", ["creep"])), "right")
        self.assertTrue(score.score_case(k, verdict("none"))["could_be_told"])

    def test_of_a_pair_only_what_could_be_told_must_be_named(self):
        pair = key("creep", "drift", hidden=[("drift", "no_thermometer")])
        self.assertEqual(outcome(pair, verdict("named", ["creep"])), "right")
        self.assertEqual(outcome(pair, verdict("named", ["creep", "drift"])), "wrong_name")
        self.assertEqual(outcome(pair, verdict("ambiguous", ["creep", "drift"], ["creep"])), "right")


class Place(unittest.TestCase):
    def f1(self, **where):
        return score.score_case(key("creep"), verdict("named", ["creep"], where=where or None))["f1"]

    def test_is_the_overlap_with_the_truth(self):
        f1 = self.f1(taxels=[0, 1, 2, 3], conditions=["flat"], pressure=[0, 400000])
        self.assertEqual(f1, {"taxels": 1, "conditions": 1, "pressure": 1, "mean": 1})
        self.assertAlmostEqual(self.f1(taxels="all", conditions=["flat"])["taxels"], 2 * 4 / (4 + 12))
        self.assertAlmostEqual(self.f1(pressure=[200e3, 400e3])["pressure"], 2 * 200 / 600)
        self.assertAlmostEqual(self.f1(pressure="all")["pressure"], 2 * 400 / 1020)
        self.assertIsNone(self.f1())


class Parameters(unittest.TestCase):
    def test_are_compared_where_name_and_unit_are_the_same(self):
        k = key("creep")
        k["effects"][0]["parameters"] = [
            {"name": "a", "value": 0.05, "unit": None, "library_parameter": "per_decade"},
            {"name": "b", "value": 3, "unit": "s", "library_parameter": "time"},
            {"name": "c", "value": 1, "unit": "s", "library_parameter": None}]
        told = [{"name": "per_decade", "value": 0.04, "unit": None, "interval": [0.03, 0.045]},
                {"name": "time", "value": 3, "unit": "ms", "interval": [2, 4]}]
        row = score.score_case(k, {"verdict": "named", "effects": [{"id": "creep", "parameters": told}], "credible_set": [["creep"]]})
        self.assertEqual([(i["parameter"], i["held"]) for i in row["intervals"]], [("per_decade", False)])
        told[0]["interval"] = [0.03, None]
        row = score.score_case(k, {"verdict": "named", "effects": [{"id": "creep", "parameters": told}], "credible_set": [["creep"]]})
        self.assertEqual([(i["parameter"], i["held"]) for i in row["intervals"]], [("per_decade", True)], "no upper end")


class Rates(unittest.TestCase):
    def test_exact_intervals_are_those_of_scipy(self):
        # scipy 1.10.1: scipy.stats.binomtest(k, n).proportion_ci(method="exact")
        for k, n, low, high in [(0, 20, 0, 0.16843347098308536), (3, 1000, 0.0006190999316499173, 0.008742023238657654),
                                (19, 20, 0.7512672372279723, 0.998734910502044), (20, 20, 0.8315665290169146, 1)]:
            got = rates.clopper_pearson(k, n)
            self.assertAlmostEqual(got[0], low, places=10)
            self.assertAlmostEqual(got[1], high, places=10)
        self.assertEqual(rates.clopper_pearson(0, 0), (0.0, 1.0))

    def rows(self, clusters, size, right):
        """`right(cluster)` of `size` cases of each cluster are right; every case has its own sheet."""
        return [{"cluster": c, "sheet": (c, i), "right": i < right(c)} for c in range(clusters) for i in range(size)]

    def test_cases_of_one_form_that_agree_count_little_more_than_one(self):
        rows = self.rows(20, 50, lambda c: 50 * (c % 2))  # ten forms always right, ten never
        value = rates.rate(rows, lambda r: r["right"])
        self.assertEqual((value["k"], value["n"]), (500, 1000))
        self.assertLess(value["naive"][1] - value["naive"][0], 0.07)
        # standard error of a rate of 0.5 over 20 independent clusters: 0.112
        self.assertAlmostEqual(value["clustered"][0], 0.5 - 1.96 * 0.112, delta=0.05)
        self.assertAlmostEqual(value["clustered"][1], 0.5 + 1.96 * 0.112, delta=0.05)

    def test_cases_of_one_sheet_count_likewise(self):
        rows = [dict(r, cluster=r["sheet"], sheet=r["cluster"]) for r in self.rows(20, 50, lambda c: 50 * (c % 2))]
        value = rates.rate(rows, lambda r: r["right"])
        self.assertGreater(value["clustered"][1] - value["clustered"][0], 0.3)

    def test_independent_cases_have_the_same_width_either_way(self):
        rows = [{"cluster": i, "sheet": i, "right": i % 4 == 0} for i in range(400)]
        value = rates.rate(rows, lambda r: r["right"])
        for clustered, naive in zip(value["clustered"], value["naive"]):
            self.assertAlmostEqual(clustered, naive, delta=0.01)

    def test_clusters_that_all_agree_still_have_an_interval(self):
        value = rates.rate(self.rows(5, 40, lambda c: 40), lambda r: r["right"])
        self.assertEqual(value["clustered"], rates.clopper_pearson(5, 5))
        self.assertIsNone(rates.rate(self.rows(1, 40, lambda c: 40), lambda r: r["right"])["clustered"])

    def test_cases_without_a_value_do_not_count(self):
        value = rates.rate([{"cluster": 1, "sheet": 1}] * 3, lambda r: None)
        self.assertEqual((value["n"], value["rate"]), (0, None))


class Gap(unittest.TestCase):
    def row(self, stated, recomputed):
        row = score.score_case(key("creep"), verdict("named", ["creep"], gap={"before": stated, "after": stated}))
        score.add_gap(row, recomputed)
        return row

    def figure(self, *rows):
        figures = summary.summarise(list(rows))["figures"]
        value = next(f["value"] for f in figures if f["figure"].startswith("gap before"))
        return value["k"], value["n"]

    def test_is_the_ratio_of_stated_to_recomputed(self):
        row = self.row(0.03, {"before": 0.02, "after": 0.03})
        self.assertAlmostEqual(row["ratio_before"], 1.5)
        self.assertEqual(self.figure(row, self.row(0.0201, {"before": 0.02, "after": 0.01})), (1, 2))

    def test_a_gap_that_cannot_be_recomputed_counts_as_missed_but_not_one_that_nobody_asked_for(self):
        self.assertEqual(self.figure(self.row(0.02, {"problem": "simulate: no"})), (0, 1))
        self.assertEqual(self.figure(self.row(0.02, {"problem": None})), (0, 0))
        self.assertEqual(self.figure(self.row(None, {"before": 0.02, "after": 0.02})), (0, 0))


class Table(unittest.TestCase):
    def setUp(self):
        self.rows = [score.score_case(k, v, "case_%d" % i) for i, (k, v) in enumerate([
            (key("creep", form="log", snr=0.9), verdict("named", ["creep"])),
            (key("creep", form="log", snr=1.2, protocol="dwells"), verdict("named", ["drift"])),
            (key("creep", form="two", snr=4, kpa=25), verdict("ambiguous", ["creep"], ["drift"])),
            (key(), verdict("none")), (key(), verdict("none")), (key(protocol="dwells"), verdict("unknown"))])]
        self.summary = summary.summarise(self.rows, [{"case": "x", "category": "no key", "sentence": "x has no key.yaml."}])

    def figure(self, start):
        return next(f for f in self.summary["figures"] if f["figure"].startswith(start))

    def share(self, value):
        return value["k"], value["n"]

    def test_counts_every_case_once(self):
        self.assertEqual(self.summary["confusion"], {"creep": {"creep": 2, "drift": 1}, "none": {"none": 2, "unknown": 1}})
        self.assertEqual(sum(cell["cases"] for cell in self.summary["cells"]), 6)
        self.assertEqual(self.summary["not_scored"], {"no key": 1})

    def test_has_a_cell_for_effect_form_class_and_size(self):
        cell = next(c for c in self.summary["cells"] if c["protocol_class"] == "dwells" and c["truth"] == "creep")
        self.assertEqual((cell["form"], cell["snr"], cell["kpa"], cell["cases"], cell["wrong_name"]), ("log", 1, 10, 1, 1))
        self.assertEqual(self.share(self.summary["effect_by_snr"]["creep"][1]), (1, 2))
        self.assertEqual(self.share(self.summary["effect_by_kpa"]["creep"][30]), (1, 1))
        by_snr, by_kpa = self.summary["detection_by_snr"], self.summary["detection"]
        self.assertEqual({snr: self.share(row["right"]) for snr, row in by_snr.items()}, {"1": (1, 2), "4": (1, 1)})
        self.assertEqual({kpa: self.share(row["wrong_name"]) for kpa, row in by_kpa.items()}, {"10": (1, 2), "30": (0, 1)})
        self.assertEqual(self.summary["outcomes_by_effect"], {"creep": {"right": 2, "wrong_name": 1}})
        self.assertEqual(self.share(self.summary["false_alarms"]["dwells"]), (1, 1))
        self.assertEqual(self.share(self.summary["credible_set"]["2"]), (1, 1))

    def test_says_of_each_target_whether_it_is_met(self):
        alarms = self.figure("nothing hidden")
        self.assertEqual((self.share(alarms["value"]), alarms["met"]), ((1, 3), False))
        self.assertEqual(self.share(self.figure("something hidden, wrong name")["value"]), (1, 3))
        self.assertAlmostEqual(self.figure("mean size")["value"], 4 / 3)
        self.assertIsNone(self.figure("pairs that could be told, SNR >= 1, both")["met"])

    def test_prints_rates_with_both_intervals_and_what_is_missing(self):
        text = summary.markdown(self.summary)
        self.assertIn("| nothing hidden, false alarms | 33.3 % (1 of 3) | 0.8 to 90.6 | 0.0 to 100.0 | <= 1 % | no |", text)
        self.assertIn("| 10 | 100.0 % (2 of 2) | - | 50.0 % (1 of 2) | - | 50.0 % (1 of 2) | - |", text)
        self.assertIn("6 cases scored (nothing 3, single 3). 1 cases are not scored (no key: 1).", text)

    def test_writes_one_line_for_each_case(self):
        lines = summary.csv_text(self.rows).splitlines()
        self.assertEqual(len(lines), 7)
        self.assertTrue(lines[0].startswith("case,set,kind,truth,form,protocol_class"))


if __name__ == "__main__":
    unittest.main()
