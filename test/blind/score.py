#!/usr/bin/python3
"""Scores one verdict against the key of its case. docs/cases.md states the rules in words.

score_case() returns one row: plain values, None where a field does not apply.
"""

import math
import statistics

SCHEMA = 2  # of the key
NAMING = {"named", "wrong_form"}  # verdicts that give a name as the answer
VERDICTS = NAMING | {"none", "unknown", "ambiguous", "not_identifiable"}
REFUSED = {"verdict": "refused"}  # stands for a command that refuses a case with one sentence instead of answering
TRUTHS = {"named", "none", "unknown"}

# Levels at which sizes are drawn. Other sizes are counted at the nearest level on a logarithmic scale.
SNR = [0.125, 0.25, 0.5, 1, 2, 4]
KPA = [1, 3, 10, 30]

# Experiments that remove a reason why an effect could not be told. A reason that is not listed here accepts any experiment.
EXPERIMENTS = {
    "one_pace": {"two_speeds", "step_hold", "minor_loops", "rest", "random_order", "two_ramp_rates", "dwells", "step_and_hold"},
    "no_thermometer": {"two_ambients", "hours_apart"},
    "one_mount": {"random_order", "hours_apart", "remount", "flat_again"},
    "one_surface": {"random_order", "remount", "flat_again"},
}

# Other names that a verdict may use for the covariates of the key.
ALIASES = {"dP/dt": "pressure_rate", "rate": "pressure_rate", "direction x pressure": "direction", "P": "pressure",
           "previous extremes": "previous_extremes", "clock time": "clock_time", "time": "clock_time",
           "cycle number": "cycle", "accumulated abs(dP)": "accumulated_pressure",
           "accumulated_change": "accumulated_pressure",
           "time since reversal": "time_since_reversal", "total load": "total_load"}


# --- place ------------------------------------------------------------------------------------------


def overlap_f1(truth, told, whole):
    """F1 of two pressure ranges [low, high] in Pa; None = the end of the whole range."""
    ranges = [[end if end is not None else limit for end, limit in zip(r, whole)] for r in (truth, told)]
    common = max(0.0, min(r[1] for r in ranges) - max(r[0] for r in ranges))
    total = sum(r[1] - r[0] for r in ranges)
    return 2 * common / total if total > 0 else 0.0


def set_f1(truth, told):
    truth, told = set(truth), set(told)
    return 2 * len(truth & told) / (len(truth) + len(told)) if truth or told else 1.0


def localisation(key, verdict):
    """F1 of taxels, conditions and pressure range, and their mean; None where key or verdict states no place."""
    truth, told = key["effects"][0].get("where"), verdict.get("where")
    sheet, conditions = key.get("sheet") or {}, key.get("conditions")
    if not truth or not told or not sheet.get("rows") or not conditions:
        return None
    every = {"taxels": range(sheet["rows"] * sheet["columns"]), "conditions": conditions}
    f1 = {}
    for field, members in every.items():
        sets = [members if w.get(field, "all") in ("all", None) else w[field] for w in (truth, told)]
        f1[field] = set_f1(*sets)
    whole = (0.0, (key.get("protocol") or {}).get("peak_pa") or truth["pressure"][1])
    pressure = told.get("pressure", "all")
    f1["pressure"] = overlap_f1(truth["pressure"], [None, None] if pressure in ("all", None) else pressure, whole)
    f1["mean"] = statistics.mean(f1.values())
    return f1


# --- key and verdict --------------------------------------------------------------------------------


def explanations(verdict):
    """Sets of ids, best first."""
    named = [effect["id"] for effect in verdict.get("effects") or []]
    credible = [frozenset(ids) for ids in verdict.get("credible_set") or []]
    return credible or ([frozenset(named)] if named else [])


def identifiability(key):
    """{id: its entry in the key} of the hidden effects that could not be told under the protocol of the case. A key may
    say it of effects that are not hidden, too."""
    entries = (key.get("identifiable") or {}).get("effects") or []
    truth = {effect["id"] for effect in key["effects"]}
    return {entry["id"]: entry for entry in entries if entry["id"] in truth and not entry.get("could_be_told", True)}


def nearest(value, levels):
    return None if not value or value <= 0 else min(levels, key=lambda level: abs(math.log(value / level)))


def size_of(key, field, levels):
    """The level of the smallest hidden effect; None where the key does not state it."""
    sizes = [effect.get(field) for effect in key["effects"]]
    return nearest(min(sizes), levels) if sizes and all(sizes) else None


def kind_of(key):
    if key["truth"] == "none":
        return "nothing"
    if key["truth"] == "unknown":
        return "foreign"
    return "pair" if len(key["effects"]) > 1 else "single"


# --- abstention -------------------------------------------------------------------------------------


def removes(reason, experiment):
    """Whether an experiment is of use against the reason why an effect could not be told."""
    return experiment not in (None, "none") and experiment in EXPERIMENTS.get(reason, {experiment})


def listed(entry, reason, verdict):
    """Whether the verdict says of the effect that these bags cannot show it, and which experiment would."""
    return any(e["id"] == entry["id"] and removes(reason, e.get("experiment"))
               for e in verdict.get("not_identifiable") or [])


def abstains_rightly(entry, truth, verdict, sets):
    """Whether a verdict gives no name to an effect that could not be told, and for the reason in the key."""
    reason, _, partner = (entry.get("reason") or "").partition(":")
    kind = verdict["verdict"]
    if kind == "none":
        return reason == "too_small" or listed(entry, reason, verdict)
    if kind == "not_identifiable":
        return any(entry["id"] in ids for ids in sets)
    if kind != "ambiguous" or reason == "too_small":
        return False
    alike = set(entry.get("confused_with") or []) | ({partner} if partner else set())
    others = set().union(*sets) - truth
    experiment = (verdict.get("next_experiment") or {}).get("protocol")
    return truth in sets and (not alike or others <= alike) and removes(reason, experiment)


# --- one case ---------------------------------------------------------------------------------------


def outcome_of_nothing(verdict):
    return "right" if verdict["verdict"] == "none" else "false_alarm"


def outcome_of_foreign(verdict, first, hidden):
    if first:
        return "wrong_name"
    if verdict["verdict"] == "unknown":
        return "right"
    return "abstained" if hidden else "silent"


def outcome_untold(verdict, truth, sets, hidden):
    """No hidden effect could be told: only an abstention for the right reason is right."""
    if verdict["verdict"] in NAMING or verdict["verdict"] == "ambiguous" and truth not in sets:
        return "wrong_name"
    right = all(abstains_rightly(entry, truth, verdict, sets) for entry in hidden.values())
    return "abstained" if right else "wrong_reason"


def outcome_named(verdict, truth, first, hidden):
    """At least one hidden effect could be told; those that could not must not be named."""
    told = truth - set(hidden)
    if first - truth or verdict["verdict"] in NAMING and first - told:
        return "wrong_name"
    if first >= told:
        return "right"
    if first:
        return "incomplete"
    return "unknown" if verdict["verdict"] == "unknown" else "silent"


def outcome_of(kind, verdict, truth, sets, first, hidden):
    if verdict == REFUSED:
        return "refused"
    if kind == "nothing":
        return outcome_of_nothing(verdict)
    if kind == "foreign":
        return outcome_of_foreign(verdict, first, hidden)
    if truth <= set(hidden):
        return outcome_untold(verdict, truth, sets, hidden)
    return outcome_named(verdict, truth, first, hidden)


def covariates_right(key, verdict):
    """All covariates of the key, and at most one more; None where the verdict is not unknown."""
    if verdict["verdict"] != "unknown":
        return None
    told = {ALIASES.get(c, c) for c in verdict.get("depends_on") or []}
    wanted = set(key["effects"][0].get("depends_on") or [])
    return wanted <= told and len(told - wanted) <= 1


def parameter_intervals(key, verdict):
    """For each parameter that key and verdict share: whether its interval holds the true value."""
    told = {(effect["id"], p["name"]): p for effect in verdict.get("effects") or [] for p in effect.get("parameters") or []}
    held = []
    for effect in key["effects"]:
        for true in effect.get("parameters") or []:
            found = told.get((effect["id"], true.get("library_parameter")))
            if not found or not found.get("interval") or (found.get("unit") or "") != (true.get("unit") or ""):
                continue
            low, high = found["interval"]  # null = without end
            held.append({"id": effect["id"], "parameter": found["name"], "true": true["value"], "low": low, "high": high,
                         "held": (low is None or low <= true["value"]) and (high is None or true["value"] <= high)})
    return held


def names_of(ids):
    return " + ".join(sorted(ids))


def score_case(key, verdict, name=""):
    """One row. Raises ValueError, KeyError or TypeError where key or verdict are not as docs/cases.md says."""
    if verdict != REFUSED and verdict.get("verdict") not in VERDICTS:
        raise ValueError("verdict is %r, but must be one of %s" % (verdict.get("verdict"), ", ".join(sorted(VERDICTS))))
    if key["truth"] not in TRUTHS:
        raise ValueError("truth is %r, but must be one of %s" % (key["truth"], ", ".join(sorted(TRUTHS))))
    kind, hidden = kind_of(key), identifiability(key)
    truth = frozenset(effect["id"] for effect in key["effects"])
    answers = verdict["verdict"] in NAMING | {"ambiguous"}
    sets = explanations(verdict) if answers or verdict["verdict"] == "not_identifiable" else []
    first = sets[0] if sets and answers else frozenset()
    outcome = outcome_of(kind, verdict, truth, sets, first, hidden)
    stated = sets if answers else []
    form = "+".join(effect["form"] for effect in key["effects"])
    sheet = str((key.get("sheet") or {}).get("id", name))
    gap = verdict.get("gap") or {}
    return {
        "case": name, "set": key.get("set"), "kind": kind, "truth": names_of(truth) or "none", "form": form or "none",
        "protocol_class": key.get("protocol_class") or "not stated", "sheet": sheet,
        "cluster": names_of(truth) + ":" + form if truth else "sheet:" + sheet,
        "snr": size_of(key, "snr", SNR), "kpa": size_of(key, "kpa_at_map", KPA),
        "could_be_told": None if kind == "nothing" else not truth & set(hidden),
        "reason": "; ".join(sorted(str(e.get("reason")) for e in hidden.values())) or None,
        "verdict": verdict["verdict"], "answer": names_of(first) or verdict["verdict"],
        "credible_set": " | ".join(map(names_of, stated)) or None, "outcome": outcome,
        "right": outcome in ("right", "abstained"), "wrong_name": outcome == "wrong_name",
        "heard_of": verdict["verdict"] not in ("none", "refused"),
        "truth_in_set": truth in stated if stated else None, "set_size": len(stated) or None,
        "false_members": len(set().union(*stated) - truth),
        "covariates": covariates_right(key, verdict) if kind == "foreign" else None,
        "f1": localisation(key, verdict) if kind == "single" and first == truth else None,
        "intervals": parameter_intervals(key, verdict) if first == truth else [],
        "stated_before": gap.get("before"), "stated_after": gap.get("after"),
        "recomputed_before": None, "recomputed_after": None, "ratio_before": None, "ratio_after": None,
        "gap_problem": None, "seconds": None, "refused_because": None,
    }


def add_gap(row, recomputed):
    """Puts the recomputed gap beside the stated one. `recomputed` has before and after, or a problem."""
    row["gap_problem"] = recomputed.get("problem")
    for when in ("before", "after"):
        stated, found = row["stated_" + when], recomputed.get(when)
        row["recomputed_" + when] = found
        if stated is not None and found:
            row["ratio_" + when] = stated / found
