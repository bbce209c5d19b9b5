"""The figures and tables of a campaign: summarise() gives data, markdown() text, csv_text() one line for each case."""

import collections
import csv
import io
import json
import re
import statistics

from rates import rate
from score import KPA, SNR

RATIO = (0.98, 1.02)  # stated gap by recomputed gap


def field(name):
    return lambda row: row[name]


def loud(row):
    return row["snr"] is not None and row["snr"] >= 1


def mean(values):
    return statistics.mean(values) if values else None


# --- figures ----------------------------------------------------------------------------------------


def met(value, sense, target):
    number = value["rate"] if isinstance(value, dict) else value
    if number is None or target is None:
        return None
    return {"<=": number <= target, ">=": number >= target}[sense]


def figure(name, value, sense=None, target=None):
    target_text = "%s %g%s" % (sense, *((100 * target, " %") if isinstance(value, dict) else (target, ""))) if sense else None
    return {"figure": name, "value": value, "target": target_text,
            "met": met(value, sense, target)}


def within(row, when):
    ratio = row["ratio_" + when]
    if row["stated_" + when] is None or ratio is None and not row["gap_problem"]:
        return None
    return ratio is not None and RATIO[0] <= ratio <= RATIO[1]


def intervals_held(rows):
    """One row for each parameter whose interval was stated, so that rate() counts parameters."""
    return [dict(row, held=one["held"]) for row in rows for one in row["intervals"]]


def name_figures(rows):
    hidden = [r for r in rows if r["kind"] in ("single", "pair", "foreign")]
    single = [r for r in rows if r["kind"] == "single" and r["could_be_told"]]
    untold = [r for r in rows if r["kind"] in ("single", "pair") and not r["could_be_told"]]
    foreign = [r for r in rows if r["kind"] == "foreign" and loud(r)]
    pairs = [r for r in rows if r["kind"] == "pair" and r["could_be_told"] and loud(r)]
    return [
        figure("nothing hidden, false alarms", rate([r for r in rows if r["kind"] == "nothing"], field("heard_of")), "<=", 0.01),
        figure("something hidden, wrong name", rate(hidden, field("wrong_name")), "<=", 0.02),
        figure("could be told, SNR 1, right", rate([r for r in single if r["snr"] == 1], field("right")), ">=", 0.9),
        figure("could be told, any size, right", rate(single, field("right"))),
        figure("could not be told, abstained for the right reason", rate(untold, field("right"))),
        figure("could not be told, named", rate(untold, field("wrong_name"))),
        figure("foreign to any library, SNR >= 1, `unknown`", rate(foreign, field("right")), ">=", 0.85),
        figure("foreign to any library, SNR >= 1, false name", rate(foreign, field("wrong_name")), "<=", 0.05),
        figure("foreign to any library, SNR >= 1, covariates right", rate(foreign, field("covariates"))),
        figure("pairs that could be told, SNR >= 1, both named", rate(pairs, field("right")), ">=", 0.8),
        figure("pairs that could be told, SNR >= 1, wrong partner", rate(pairs, field("wrong_name"))),
    ]


def set_figures(rows):
    named = [r for r in rows if r["kind"] in ("single", "pair")]
    stated = [r for r in rows if r["set_size"]]
    return [
        figure("truth in the credible set, where one is stated", rate(named, field("truth_in_set")), ">=", 0.95),
        figure("the same, with foreign effects and nothing hidden", rate(rows, field("truth_in_set"))),
        figure("mean size of a credible set", mean([r["set_size"] for r in stated]), "<=", 2),
        figure("false members of the sets, mean over all cases", mean([r["false_members"] for r in rows])),
    ]


def other_figures(rows):
    held = intervals_held(rows)
    coverage = figure("parameters in their stated intervals", rate(held, field("held")), ">=", 0.93)
    if coverage["value"]["rate"] is not None:
        coverage.update(target="93 to 97 %", met=0.93 <= coverage["value"]["rate"] <= 0.97)
    ten = [r for r in rows if r["kind"] != "nothing" and r["kpa"] == 10]
    places = [r["f1"]["mean"] for r in rows if r["f1"]]
    return [
        figure("gap before, stated / recomputed in 0.98 .. 1.02", rate(rows, lambda r: within(r, "before")), ">=", 1),
        figure("gap after, stated / recomputed in 0.98 .. 1.02", rate(rows, lambda r: within(r, "after")), ">=", 1),
        figure("gap recomputed: after is larger than before", rate(
            [r for r in rows if r["recomputed_after"]], lambda r: r["recomputed_after"] > r["recomputed_before"])),
        coverage,
        figure("place of a right single answer, mean F1", mean(places), ">=", 0.9),
        figure("effects of 10 kPa at the map, heard of", rate(ten, field("heard_of"))),
        figure("cases that the command refused", rate(rows, lambda r: r["outcome"] == "refused")),
        figure("time, longest [s]", max((r["seconds"] for r in rows if r["seconds"]), default=None), "<=", 60),
    ]


# --- tables -----------------------------------------------------------------------------------------


def grouped(rows, *fields):
    groups = collections.defaultdict(list)
    for row in rows:
        groups[tuple(row[f] for f in fields)].append(row)
    return dict(sorted(groups.items(), key=lambda item: [(v is None, str(type(v)), v) for v in item[0]]))


def right_by(rows, *fields):
    """{first field: {second field: rate of right answers}}"""
    table = collections.defaultdict(dict)
    for key, group in grouped(rows, *fields).items():
        table[key[0]][key[1]] = rate(group, field("right"))
    return dict(table)


def cells(rows):
    """Effect x form x protocol class x SNR x kPa at the map."""
    names = ("truth", "form", "protocol_class", "snr", "kpa")
    return [dict(zip(names, key), cases=len(group), **{what: sum(bool(r[what]) for r in group) for what in (
        "right", "wrong_name", "heard_of", "truth_in_set", "could_be_told")}) for key, group in grouped(rows, *names).items()]


def ratios(rows):
    """By verdict: the stated gap by the recomputed one."""
    table = {}
    for (verdict,), group in grouped(rows, "verdict").items():
        table[verdict] = {"cases": len(group)}
        for when in ("before", "after"):
            found = sorted(r["ratio_" + when] for r in group if r["ratio_" + when] is not None)
            table[verdict][when] = dict(recomputed=len(found), **(
                {"lowest": found[0], "median": statistics.median(found), "highest": found[-1]} if found else {}))
    return table


HEARD = ("heard_of", "right", "wrong_name")


def detection(rows, size):
    """By size of the hidden effects, "kpa" or "snr": heard of, right, named wrongly."""
    return {"%g" % value: {what: rate(group, field(what)) for what in HEARD}
            for (value,), group in grouped([r for r in rows if r[size] is not None], size).items()}


def outcomes_by(rows, name):
    return {str(value): dict(collections.Counter(r["outcome"] for r in group)) for (value,), group in grouped(rows, name).items()}


def confusion(rows):
    return {truth: dict(collections.Counter(r["answer"] for r in group)) for (truth,), group in grouped(rows, "truth").items()}


def refusals(rows):
    """Why the command refused cases: its sentences without program and file names, with N for every number."""
    said = [re.sub(r"^(?:\S+: )+", "", r["refused_because"] or "no reason") for r in rows if r["outcome"] == "refused"]
    return dict(collections.Counter(re.sub(r"\d+(?:\.\d+)?", "N", sentence) for sentence in said).most_common())


def summarise(rows, problems=()):
    """Everything that the published table says, as data. `problems` are {case, category, sentence}: of cases that are not
    scored, and of scored ones whose gap is missing."""
    scored = {r["case"] for r in rows}
    hidden = [r for r in rows if r["kind"] != "nothing"]
    nothing = [r for r in rows if r["kind"] == "nothing"]
    return {
        "cases": len(rows), "not_scored": dict(collections.Counter(p["category"] for p in problems if p["case"] not in scored)),
        "kinds": dict(collections.Counter(r["kind"] for r in rows)),
        "gap_not_recomputed": dict(collections.Counter(r["gap_problem"] for r in rows if r["gap_problem"])),
        "figures": name_figures(rows) + set_figures(rows) + other_figures(rows),
        "effect_by_snr": right_by([r for r in hidden if r["snr"] is not None], "truth", "snr"),
        "effect_by_kpa": right_by([r for r in hidden if r["kpa"] is not None], "truth", "kpa"),
        "effect_by_protocol": right_by(hidden, "truth", "protocol_class"),
        "effect_by_form": right_by(hidden, "truth", "form"),
        "false_alarms": {c: rate(g, field("heard_of")) for (c,), g in grouped(nothing, "protocol_class").items()},
        "credible_set": {str(n): rate(g, field("truth_in_set")) for (n,), g in grouped(
            [r for r in rows if r["set_size"]], "set_size").items()},
        "could_not_be_told": outcomes_by([r for r in hidden if not r["could_be_told"]], "reason"),
        "refused": refusals(rows),
        "outcomes": outcomes_by(rows, "kind"),
        "outcomes_by_effect": outcomes_by([r for r in rows if r["kind"] in ("single", "foreign")], "truth"),
        "detection": detection(hidden, "kpa"), "detection_by_snr": detection(hidden, "snr"),
        "gap": ratios(rows), "confusion": confusion(rows), "cells": cells(rows),
    }


# --- text -------------------------------------------------------------------------------------------


def percent(x):
    return format(100 * x, ".1f")


def interval(pair):
    return "%s to %s" % (percent(pair[0]), percent(pair[1]))


def value_text(value):
    if value is None or isinstance(value, dict) and value["n"] == 0:
        return "no case"
    if not isinstance(value, dict):
        return format(value, ".3g")
    text = "%s %% (%d of %d) | %s" % (percent(value["rate"]), value["k"], value["n"], interval(value["naive"]))
    return text + " | " + (interval(value["clustered"]) if value["clustered"] else "-")


def line(*words):
    return "| " + " | ".join(map(str, words)) + " |"


def table(columns, rows):
    return "\n".join([line(*columns), "|---" * len(columns) + "|"] + [line(*row) for row in rows])


def figure_rows(figures):
    said = {None: "-", True: "yes", False: "no"}
    for f in figures:
        value = value_text(f["value"])
        parts = value.split(" | ") if " | " in value else [value, "-", "-"]
        yield [f["figure"], *parts, f["target"] or "-", said[f["met"]]]


def share(value):
    return "%d of %d" % (value["k"], value["n"]) if value else ""


def grid(corner, data, columns=None):
    columns = columns or sorted({c for row in data.values() for c in row}, key=str)
    columns = [c for c in columns if any(c in row for row in data.values())]
    return table([corner, *columns], [[name, *(share(row.get(c)) for c in columns)] for name, row in data.items()])


def rate_rows(data):
    return [[name, *(value_text(value).split(" | ") + ["", ""])[:3]] for name, value in data.items()]


def detection_rows(data):
    return [[size, *(cell for what in HEARD for cell in value_text(row[what]).split(" | ")[::2])] for size, row in data.items()]


def ratio_rows(data):
    for verdict, row in data.items():
        for when in ("before", "after"):
            r = row[when]
            numbers = [format(r[x], ".3g") for x in ("lowest", "median", "highest")] if r["recomputed"] else ["-"] * 3
            yield [verdict, when, "%d of %d" % (r["recomputed"], row["cases"]), *numbers]


def count_rows(data):
    return [[name, ", ".join("%s %d" % item for item in sorted(row.items()))] for name, row in data.items()]


def section(title, text):
    return "## %s\n\n%s" % (title, text)


def head(summary):
    text = "%d cases scored (%s)." % (summary["cases"], ", ".join("%s %d" % kind for kind in sorted(summary["kinds"].items())))
    if summary["not_scored"]:
        missing = ", ".join("%s: %d" % item for item in sorted(summary["not_scored"].items()))
        text += " %d cases are not scored (%s)." % (sum(summary["not_scored"].values()), missing)
    if summary["gap_not_recomputed"]:
        text += " The gap of %d cases could not be recomputed." % sum(summary["gap_not_recomputed"].values())
    return text + " Rates in %; intervals of 95 %: exact, as if all cases were independent, and clustered by form and sheet."


def markdown(summary):
    rates = ["", "%", "exact", "clustered"]
    heard = ["heard of", "clustered", "right", "clustered", "wrong name", "clustered"]
    parts = [
        head(summary),
        section("Figures", table(["figure", "reached", "exact", "clustered", "target", "met"], figure_rows(summary["figures"]))),
        section("Outcomes by kind of case", table(["kind", "outcomes"], count_rows(summary["outcomes"]))),
        section("Outcomes by effect, one effect hidden", table(["hidden", "outcomes"], count_rows(summary["outcomes_by_effect"]))),
        section("Right by effect and SNR", grid("hidden", summary["effect_by_snr"], SNR[::-1])),
        section("Right by effect and kPa at the map", grid("hidden", summary["effect_by_kpa"], KPA)),
        section("Right by effect and protocol class", grid("hidden", summary["effect_by_protocol"])),
        section("Right by form", table(["hidden", "forms"], [
            [name, ", ".join("%s %s" % (form, share(value)) for form, value in row.items())]
            for name, row in summary["effect_by_form"].items()])),
        section("False alarms by protocol class", table(["class", *rates[1:]], rate_rows(summary["false_alarms"]))),
        section("Hidden effects by kPa at the map", table(["kPa", *heard], detection_rows(summary["detection"]))),
        section("Hidden effects by SNR", table(["SNR", *heard], detection_rows(summary["detection_by_snr"]))),
        section("Truth in the credible set, by its size", table(["size", *rates[1:]], rate_rows(summary["credible_set"]))),
        section("Effects that could not be told, by reason", table(
            ["reason", "outcomes"], count_rows(summary["could_not_be_told"]))),
        section("Stated gap by recomputed gap", table(
            ["verdict", "gap", "recomputed", "lowest", "median", "highest"], ratio_rows(summary["gap"]))),
        section("Refused by the command", table(["sentence", "cases"], summary["refused"].items())),
        section("First answers", table(["hidden", "answers"], count_rows(summary["confusion"]))),
    ]
    return "\n\n".join(parts) + "\n"


def csv_text(rows):
    """One line for each case; lists and mappings are written as JSON."""
    out = io.StringIO()
    if rows:
        writer = csv.DictWriter(out, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        for row in rows:
            writer.writerow({k: json.dumps(v) if isinstance(v, (dict, list)) else v for k, v in row.items()})
    return out.getvalue()
