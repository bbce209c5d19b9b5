#!/usr/bin/python3
"""Scores verdicts against sealed keys. This is the third program, beside the generator and the one under test.

    score.py RESULTS [--json FILE]

RESULTS is a folder of scripts/blind_trials: RESULTS/cases/*/{key.yaml, verdict.yaml, run.json}. Prints
the confusion matrix, rates with their 95 % intervals (Clopper-Pearson, pooled over the cells of the grid), rates
by SNR, localisation, gap closed, and every target with the value reached.
"""

import argparse
import json
import math
import pathlib
import statistics
import sys

import yaml

FAULTS = {"stuck_taxel", "dead_taxel", "row_fault", "column_fault"}
QUICK = {"hysteresis", "creep", "time_skew", "seal_leak", "mains_pickup", "repositioning"} | FAULTS
SLOW = {"temperature", "wear"}
NAMING = {"named", "wrong_form"}  # verdicts that give a name as the answer
VERDICTS = NAMING | {"none", "unknown", "ambiguous", "not_identifiable"}
TWO_SPEEDS = {"two_speeds", "random_order"}
PAPER = {"paper", "paper_remounted"}

# Other names that a verdict may use for the covariates of the key.
ALIASES = {"dP/dt": "pressure_rate", "rate": "pressure_rate", "direction x pressure": "direction", "P": "pressure",
           "previous extremes": "previous_extremes", "clock time": "clock_time", "time": "clock_time",
           "cycle number": "cycle", "accumulated abs(dP)": "accumulated_pressure",
           "accumulated_change": "accumulated_pressure",
           "time since reversal": "time_since_reversal", "total load": "total_load"}


# --- one case ---------------------------------------------------------------------------------------


def overlap_f1(truth, told, whole=(0.0, 620e3)):
    """F1 of two pressure ranges [low, high] in Pa; None = the end of the whole range."""
    ranges = [[end if end is not None else limit for end, limit in zip(r, whole)] for r in (truth, told)]
    common = max(0.0, min(r[1] for r in ranges) - max(r[0] for r in ranges))
    total = sum(r[1] - r[0] for r in ranges)
    return 2 * common / total if total > 0 else 0.0


def set_f1(truth, told):
    truth, told = set(truth), set(told)
    return 2 * len(truth & told) / (len(truth) + len(told)) if truth or told else 1.0


def localisation(key, verdict):
    """F1 of taxels, conditions and pressure range, and their mean; None where the verdict states no place."""
    truth, told = key["effects"][0]["where"], verdict.get("where")
    if not told:
        return None
    every = {"taxels": range(key["taxels"]), "conditions": key["conditions"]}
    f1 = {}
    for field, members in every.items():
        sets = [members if w.get(field, "all") in ("all", None) else w[field] for w in (truth, told)]
        f1[field] = set_f1(*sets)
    pressure = told.get("pressure", "all")
    f1["pressure"] = overlap_f1(truth["pressure"], [None, None] if pressure in ("all", None) else pressure)
    f1["mean"] = statistics.mean(f1.values())
    return f1


def explanations(verdict):
    """Sets of ids, best first."""
    named = [effect["id"] for effect in verdict.get("effects") or []]
    credible = [frozenset(ids) for ids in verdict.get("credible_set") or []]
    return credible or ([frozenset(named)] if named else [])


def score_case(key, verdict, run):
    """Score of one verdict; fields that do not apply are None."""
    if verdict.get("verdict") not in VERDICTS:
        raise ValueError("verdict is %r, but must be one of %s" % (verdict.get("verdict"), ", ".join(sorted(VERDICTS))))
    truth = frozenset(effect["id"] for effect in key["effects"])
    sets = explanations(verdict)
    naming, kind = verdict["verdict"] in NAMING, key["truth"]
    first = sets[0] if sets and verdict["verdict"] in NAMING | {"ambiguous"} else frozenset()
    if run.get("left_out"):
        kind = "left_out"
    case = {
        "truth": " + ".join(sorted(truth)) or "none", "kind": "pair" if kind == "named" and len(truth) > 1 else kind,
        "form": "+".join(effect["form"] for effect in key["effects"]), "snr": key["spec"]["snr"],
        "protocol": key["spec"]["protocol"], "thermometer": key["spec"]["thermometer"], "verdict": verdict["verdict"],
        "answer": " + ".join(sorted(first)) or verdict["verdict"], "set_size": len(sets) or None,
        "right_first": None, "in_set": None, "wrong_name": naming, "covariates": None, "extra": None, "f1": None,
        "gap_closed": (verdict.get("gap") or {}).get("closed"), "seconds": run.get("seconds"),
    }
    if kind == "named":
        case["right_first"] = first == truth
        case["in_set"] = any(truth <= s for s in sets)
        case["wrong_name"] = naming and not truth & first
        case["extra"] = len(first - truth) if naming else 0
        if len(truth) == 1 and first == truth:
            case["f1"] = localisation(key, verdict)
    elif kind == "unknown":
        case["right_first"] = verdict["verdict"] == "unknown"
        told = {ALIASES.get(c, c) for c in verdict.get("depends_on") or []}
        wanted = set(key["effects"][0]["depends_on"])
        case["covariates"] = wanted <= told and len(told - wanted) <= 1 if case["right_first"] else None
    elif kind == "left_out":
        case["right_first"] = left_out_right(verdict, run)
    follow = run.get("follow_up")
    confirmed = run.get("confirmed")
    case["wrong_fails"] = None if confirmed is None or first == truth else not confirmed
    case["right_passes"] = None if confirmed is None or first != truth else confirmed
    one_right = lambda: follow["verdict"] in NAMING and follow["effects"] == sorted(truth)
    case["resolved"] = None if not follow or run.get("left_out") else one_right()
    return case


def left_out_right(verdict, run):
    """True effect left out: `unknown` is right; where another effect closes 90 % as much, `ambiguous` with a next step."""
    shares = dict(run.get("shares_with_it") or {})
    true = shares.pop(run["left_out"], None)
    substitute = true is not None and max(shares.values(), default=0) >= 0.9 * true
    if not substitute:
        return verdict["verdict"] == "unknown"
    return verdict["verdict"] == "ambiguous" and bool(verdict.get("next_experiment"))


# --- many cases -------------------------------------------------------------------------------------


def binomial_tail(k, n, p):
    """P(X >= k), X binomial."""
    if k <= 0:
        return 1.0
    if p <= 0 or p >= 1:
        return float(p >= 1)
    logs = [math.lgamma(n + 1) - math.lgamma(i + 1) - math.lgamma(n - i + 1) + i * math.log(p) + (n - i) * math.log1p(-p)
            for i in range(k, n + 1)]
    return min(1.0, math.fsum(math.exp(x) for x in logs))


def solve(rising, target):
    """The argument in 0 .. 1 at which an increasing function reaches `target`."""
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if rising(middle) < target else (low, middle)
    return (low + high) / 2


def clopper_pearson(k, n, level=0.95):
    """Exact interval of a rate: k of n."""
    if n == 0:
        return (0.0, 1.0)
    alpha = (1 - level) / 2
    low = 0.0 if k == 0 else solve(lambda p: binomial_tail(k, n, p), alpha)
    high = 1.0 if k == n else solve(lambda p: binomial_tail(k + 1, n, p), 1 - alpha)
    return (low, high)


def rate(cases, what):
    """[k, n, rate, low, high] of what(case) over the cases where it is not None."""
    values = [v for v in map(what, cases) if v is not None]
    k, n = sum(map(bool, values)), len(values)
    return [k, n, k / n if n else None, *clopper_pearson(k, n)]


def field(name):
    return lambda case: case[name]


def confusion(cases):
    table = {}
    for case in cases:
        row = table.setdefault(case["truth"], {})
        row[case["answer"]] = row.get(case["answer"], 0) + 1
    return table


def by_snr(cases):
    rows = {}
    for case in cases:
        if case["kind"] == "named":
            rows.setdefault(case["truth"], {}).setdefault(case["snr"], []).append(case)
    return {truth: {snr: rate(group, field("right_first")) for snr, group in sorted(groups.items(), reverse=True)}
            for truth, groups in sorted(rows.items())}


def median(values):
    return statistics.median(values) if values else None


def summarise(cases):
    """All figures of the published table, as data."""
    named = [c for c in cases if c["kind"] == "named"]
    loud = [c for c in named if c["snr"] >= 1]
    gaps = {}
    for case in loud:
        if case["right_first"] and case["gap_closed"] is not None:
            gaps.setdefault(case["truth"], []).append(case["gap_closed"])

    def chosen(ids, protocols, snr):
        return [c for c in named if c["truth"] in ids and c["protocol"] in protocols and c["snr"] == snr]

    slow = [c for c in loud if c["truth"] in SLOW and c["thermometer"]]
    paper = [c for c in loud if c["truth"] in QUICK | SLOW and c["protocol"] in PAPER and c["snr"] == 1]
    unknown = [c for c in cases if c["kind"] == "unknown" and c["snr"] >= 1]
    pairs = [c for c in cases if c["kind"] == "pair" and c["protocol"] in TWO_SPEEDS]
    sizes = [c["set_size"] for c in paper if c["set_size"]]
    places = [c["f1"] for c in loud if c["f1"]]
    without_drift = [c for c in pairs if "drift" not in c["truth"].split(" + ")]

    def place(what):
        return statistics.mean(f1[what] for f1 in places) if places else None

    figures = [
        ("false alarms with nothing hidden", rate([c for c in cases if c["kind"] == "none"],
                                                  lambda c: c["verdict"] != "none"), "<=", 0.01),
        ("right name first, two speeds, SNR 1", rate(chosen(QUICK, TWO_SPEEDS, 1), field("right_first")), ">=", 0.95),
        ("right name first, two speeds, SNR 0.5", rate(chosen(QUICK, TWO_SPEEDS, 0.5), field("right_first")),
         ">=", 0.9),
        ("temperature and wear with a thermometer, right first", rate(slow, field("right_first")), ">=", 0.7),
        ("temperature and wear with a thermometer, truth in the set", rate(slow, field("in_set")), ">=", 0.97),
        ("the paper's cycles, SNR 1, right first", rate(paper, field("right_first")), ">=", 0.85),
        ("the paper's cycles, SNR 1, truth in the set", rate(paper, field("in_set")), ">=", 0.97),
        ("the paper's cycles, SNR 1, mean set size", statistics.mean(sizes) if sizes else None, "<=", 2),
        ("wrong single name, any SNR", rate(named, field("wrong_name")), "<=", 0.02),
        ("unknown recognised, SNR >= 1", rate(unknown, field("right_first")), ">=", 0.9),
        ("unknown, covariates right", rate(unknown, field("covariates")), ">=", 0.85),
        ("unknown, false name", rate(unknown, field("wrong_name")), "<=", 0.05),
        ("true effect left out, answered right", rate([c for c in cases if c["kind"] == "left_out"],
                                                      field("right_first")), ">=", 0.9),
        ("where, mean F1, SNR >= 1", place("mean"), ">=", 0.9),
        ("where, F1 of the taxels", place("taxels"), ">=", 0.9),
        ("where, F1 of the surfaces", place("conditions"), ">=", 0.9),
        ("where, F1 of the pressures", place("pressure"), ">=", 0.9),
        ("two effects, both named", rate(pairs, field("right_first")), ">=", 0.85),
        ("two effects, neither a drift, both named", rate(without_drift, field("right_first")), ">=", 0.85),
        ("two effects, false terms a case", statistics.mean(c["extra"] for c in pairs) if pairs else None, "<=", 0.1),
        ("gap closed, median, SNR >= 1", median([g for group in gaps.values() for g in group]), ">=", 0.8),
        ("gap closed, median of the worst effect", min(map(median, gaps.values()), default=None), ">=", 0.6),
        ("ambiguous, then the recommended experiment: one right name", rate(cases, field("resolved")), ">=", 0.9),
        ("a frozen wrong prediction fails to confirm", rate(cases, field("wrong_fails")), ">=", 0.95),
        ("a frozen right prediction is confirmed", rate(cases, field("right_passes")), ">=", 0.9),
        ("time, longest [s]", max((c["seconds"] for c in cases if c["seconds"]), default=None), "<=", 60),
    ]
    single = [c for c in cases if c["kind"] != "pair"]
    return {"cases": len(cases), "confusion": confusion(single), "by_snr": by_snr(cases),
            "pairs": confusion([c for c in cases if c["kind"] == "pair"]), "figures": [figure(*f) for f in figures]}


def figure(name, value, sense, target):
    """One line of the table of targets."""
    number = value[2] if isinstance(value, list) else value
    met = None if number is None else number <= target if sense == "<=" else number >= target
    return {"figure": name, "value": value, "target": sense + " " + format(target, "g"), "met": met}


# --- text -------------------------------------------------------------------------------------------


def percent(x):
    return format(100 * x, ".1f") + " %"


def value_text(value):
    if value is None or isinstance(value, list) and value[1] == 0:
        return "no case"
    if isinstance(value, list):
        k, n, share, low, high = value
        return "%s (%d of %d; %s to %s)" % (percent(share), k, n, percent(low), percent(high))
    return format(value, ".3g")


def grid_text(rows, columns, cell, corner):
    lines = ["| " + corner + " | " + " | ".join(map(str, columns)) + " |", "|---" * (len(columns) + 1) + "|"]
    lines += ["| " + row + " | " + " | ".join(cell(row, column) for column in columns) + " |" for row in rows]
    return "\n".join(lines)


def markdown(summary):
    table, snr = summary["confusion"], summary["by_snr"]
    answers = sorted({a for row in table.values() for a in row}, key=lambda a: (a not in table, a))
    levels = sorted({s for row in snr.values() for s in row}, reverse=True)
    met = {None: "-", True: "yes", False: "no"}
    parts = [
        "%d cases. Rates with 95 %% Clopper-Pearson intervals, pooled over the cells of the grid." % summary["cases"],
        "## Targets\n\n| figure | reached | target | met |\n|---|---|---|---|\n" + "\n".join(
            "| %s | %s | %s | %s |" % (f["figure"], value_text(f["value"]), f["target"], met[f["met"]])
            for f in summary["figures"]),
        "## Right name first against SNR\n\n" + grid_text(
            snr, levels, lambda t, s: value_text(snr[t][s]) if s in snr[t] else "", "hidden"),
        "## Confusion: hidden (row), first answer (column)\n\n" + grid_text(
            sorted(table), answers, lambda t, a: str(table[t].get(a, "")), "hidden"),
        "## Pairs\n\n| hidden | first answer |\n|---|---|\n" + "\n".join(
            "| %s | %s |" % (truth, ", ".join(a + (" (%d times)" % k if k > 1 else "") for a, k in sorted(row.items())))
            for truth, row in sorted(summary["pairs"].items())),
    ]
    return "\n\n".join(parts) + "\n"


def read_results(folder):
    """Scores of all finished cases below the folder; refused and failed cases are counted separately."""
    cases, failed = [], []
    for run_file in sorted(pathlib.Path(folder, "cases").glob("*/run.json")):
        run = json.loads(run_file.read_text())
        if run["status"] == "failed":
            failed.append(run_file.parent.name)
        if run["status"] == "done":
            key, verdict = (yaml.safe_load((run_file.parent / f).read_text()) for f in ("key.yaml", "verdict.yaml"))
            try:
                cases.append(dict(score_case(key, verdict, run), name=run_file.parent.name))
            except (KeyError, TypeError, ValueError) as error:
                raise SystemExit("%s: %s" % (run_file.parent / "verdict.yaml", error))
    return cases, failed


def main():
    parser = argparse.ArgumentParser(description="Scores verdicts against sealed keys.")
    parser.add_argument("results", help="folder of scripts/blind_trials")
    parser.add_argument("--json", help="write the figures and every case's score there too")
    options = parser.parse_args()
    cases, failed = read_results(options.results)
    summary = summarise(cases)
    print(markdown(summary))
    if failed:
        print("%d cases failed: %s" % (len(failed), ", ".join(failed[:10])), file=sys.stderr)
    if options.json:
        pathlib.Path(options.json).write_text(json.dumps({"summary": summary, "cases": cases}, indent=1) + "\n")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
