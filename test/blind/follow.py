"""Trials that go on after the verdict: confirmation by new recordings, and the recommended experiment."""

import collections
import pathlib
import shlex
import statistics
import tempfile

import yaml

import rates
import recompute

# Effects that a forward model describes, so that something can be predicted of them.
PREDICTED = ["hysteresis", "creep", "time_skew", "seal_leak", "drift", "break_in", "wear", "temperature"]
ANOTHER = ["hysteresis", "time_skew", "creep", "seal_leak"]
ONE_PACE = "paper"  # protocol under which loop, creep and delay look alike
OTHER_PROTOCOL = {"two_speeds": "minor_loops"}  # of the second recording; after any other one: two_speeds

Trial = collections.namedtuple("Trial", "name effect form seed snr first")


class Failed(Exception):
    """One sentence."""


class Tools:
    """Commands of the generator and of the program under test."""

    def __init__(self, generator, discrepancy):
        self.generator, self.discrepancy = shlex.split(generator), shlex.split(discrepancy)

    @staticmethod
    def run(words, allowed=(0,)):
        done = recompute.run_program([str(word) for word in words])
        if done.returncode not in allowed:
            said = (done.stderr.strip() or done.stdout.strip()).splitlines()[-1:] or ["it said nothing"]
            raise Failed("%s ended with status %d (%s)" % (words[0], done.returncode, said[0]))

    def make(self, trial, effect, folder):
        """A first recording; its key is folder/key.yaml."""
        self.run([*self.generator, "--seed", trial.seed, "--effect", effect, "--snr", trial.snr, "--protocol", trial.first,
                  "--size", "small", "--key", folder / "key.yaml", "--output", folder / "bags"])

    def follow(self, key, protocol, folder):
        """A later recording of the sheet of a key."""
        self.run([*self.generator, "--follow", key, "--protocol", protocol, "--key", folder / "key.yaml",
                  "--output", folder / "bags"])

    def investigate(self, folders, output):
        bags = [bag for folder in folders for bag in sorted((folder / "bags").glob("*.bag"))]
        self.run([*self.discrepancy, *bags, "--output", output, "--no-report", "--threads", "1"])
        return yaml.safe_load((output / "verdict.yaml").read_text())

    def confirm(self, verdict, folder, output):
        output.mkdir(parents=True)
        bags = sorted((folder / "bags").glob("*.bag"))
        self.run([*self.discrepancy, "--confirm", verdict, *bags, "--output", output])
        return yaml.safe_load((output / "confirmation.yaml").read_text())


def forms_of(generator, chosen_set, effects):
    """[(id, form)] that the generator lists."""
    wanted = PREDICTED if effects == "all" else effects.split(",")
    listed = recompute.run_program([*shlex.split(generator), "--list"]).stdout.split()
    return [(effect, form) for effect, form, of_set in (line.split(":") for line in listed)
            if of_set == chosen_set and effect in wanted]


def trials_of(forms, options):
    trials = []
    for seed in range(1, options.seeds + 1):
        for number, (effect, form) in enumerate(forms):
            first = options.first if (number + seed) % 2 else ONE_PACE
            name = "%s.%s.%s.%04d" % (effect, form, first, seed)
            trials.append(Trial(name, effect, form, seed, options.snr, first))
    return trials


def is_right(verdict, effect):
    """Whether the preferred explanation is the hidden effect."""
    found = verdict.get("credible_set") or []
    return bool(found) and found[0] == [effect]


def predicts(verdict):
    return bool(verdict.get("prediction"))


def confirmation_row(trial, kind, answer):
    low, high = answer["predicted"]
    return {"kind": kind, "cluster": "%s:%s" % (trial.effect, trial.form), "sheet": trial.seed, "passed": bool(answer["passed"]),
            "width": high - low}


def rows_of(trial, tools, keep):
    """What one trial says: a row for each prediction that was tested and each experiment that was followed."""
    with tempfile.TemporaryDirectory(prefix="follow_") as work:
        work = pathlib.Path(work)
        tools.make(trial, "%s:%s" % (trial.effect, trial.form), work / "first")
        verdict = tools.investigate([work / "first"], keep / "found")
        right = is_right(verdict, trial.effect)
        rows = []
        if predicts(verdict):
            tools.follow(work / "first" / "key.yaml", OTHER_PROTOCOL.get(trial.first, "two_speeds"), work / "second")
            answer = tools.confirm(keep / "found" / "verdict.yaml", work / "second", keep / "second")
            rows.append(confirmation_row(trial, "right" if right else "wrong name", answer))
        if right and predicts(verdict):
            rows.append(against_another(trial, tools, work, keep))
        if verdict["verdict"] == "ambiguous" and verdict.get("next_experiment"):
            rows.append(advised(trial, tools, verdict, work, keep))
        for row in rows:
            row.update(trial=trial.name, verdict=verdict["verdict"])
        return rows


def against_another(trial, tools, work, keep):
    """The prediction against the same sheet with another effect."""
    another = next(effect for effect in ANOTHER[trial.seed % len(ANOTHER):] + ANOTHER if effect != trial.effect)
    tools.make(trial, another, work / "another")
    tools.follow(work / "another" / "key.yaml", OTHER_PROTOCOL.get(trial.first, "two_speeds"), work / "another_second")
    answer = tools.confirm(keep / "found" / "verdict.yaml", work / "another_second", keep / "another")
    return confirmation_row(trial, "another effect", answer)


def advised(trial, tools, verdict, work, keep):
    protocol = verdict["next_experiment"]["protocol"]
    tools.follow(work / "first" / "key.yaml", protocol, work / "third")
    then = tools.investigate([work / "first", work / "third"], keep / "advised")
    return {"kind": "advised", "cluster": "%s:%s" % (trial.effect, trial.form), "sheet": trial.seed, "protocol": protocol,
            "right": is_right(then, trial.effect), "alone": then["verdict"] in ("named", "wrong_form"), "then": then["verdict"]}


def figures(rows):
    """[(figure, rate, target)]"""
    def share(kind, field, wanted=True):
        return rates.rate(rows, lambda row: (row[field] == wanted) if row["kind"] == kind else None)

    return [("right prediction, confirmed", share("right", "passed"), ">= 90 %"),
            ("prediction with a wrong name, failed", share("wrong name", "passed", False), ">= 95 %"),
            ("right prediction, against another effect, failed", share("another effect", "passed", False), ">= 95 %"),
            ("ambiguous, then the recommended experiment: right name first", share("advised", "right"), ">= 90 %"),
            ("the same: the only name", rates.rate(rows, lambda row: row["right"] and row["alone"] if row["kind"] == "advised"
                                                   else None), "-")]


def text_of(value):
    if value["n"] == 0:
        return "no trial"
    text = "%.1f %% (%d of %d)" % (100 * value["rate"], value["k"], value["n"])
    return text + (" [%.1f to %.1f]" % tuple(100 * end for end in value["clustered"]) if value["clustered"] else "")


def write_summary(rows, trials, folder):
    width = [row["width"] for row in rows if row["kind"] == "right"]
    summary = {"trials": trials, "figures": [{"figure": f, "value": v, "target": t} for f, v, t in figures(rows)],
               "median_width": statistics.median(width) if width else None, "rows": rows}
    lines = ["%d trials." % trials, "", "| figure | value | target |", "|---|---|---|"]
    lines += ["| %s | %s | %s |" % (f, text_of(v), t) for f, v, t in figures(rows)]
    lines.append("| median width of the interval of a right prediction, in sizes | %s | - |"
                 % ("no trial" if not width else "%.3f" % summary["median_width"]))
    folder.mkdir(parents=True, exist_ok=True)
    recompute.write_json(folder / "summary.json", summary)
    (folder / "summary.md").write_text("\n".join(lines) + "\n")
