#!/usr/bin/python3
"""grid_test.py GENERATOR COMMAND SIMULATE: a small campaign with the real programs.

Every case must be answered and scored, and every stated gap recomputed or the reason given. What the answers are is the business
of the campaigns themselves.
"""

import csv
import pathlib
import subprocess
import sys
import tempfile

TRIALS = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts" / "blind_trials"
EFFECTS = {"hysteresis", "time_skew", "dead_taxel", "none"}


def complaints(rows):
    if {row["truth"] for row in rows} != EFFECTS:
        yield "the campaign holds %s" % sorted(row["truth"] for row in rows)
    for row in rows:
        recomputed = all(float(row["recomputed_" + when] or 0) > 0 for when in ("before", "after"))
        if not recomputed and not row["gap_problem"]:
            yield "%s: gap neither recomputed nor a reason" % row["case"]
        if row["protocol_class"] == "not stated" or row["truth"] != "none" and not row["kpa"]:
            yield "%s: the key lacks protocol class or kPa at the map" % row["case"]
    if not any(row["ratio_before"] for row in rows):
        yield "no gap was recomputed"


def main(generator, command, simulate):
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([str(TRIALS), "--output", folder, "--generator", generator, "--simulate", simulate,
                               "--command", command + " {bags} --output {output} --no-report --threads 1", "--jobs", "1",
                               "--effects", "hysteresis:duhem,time_skew:two_clocks,dead_taxel:open", "--snr", "1", "--kpa", "",
                               "--nothing", "1"], capture_output=True, text=True)
        if done.returncode != 0:
            print(done.stderr)
            return 1
        rows = list(csv.DictReader(pathlib.Path(folder, "cases.csv").read_text().splitlines()))
    said = list(complaints(rows))
    print("\n".join(said) or "%d cases" % len(rows))
    return 1 if said else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:4]))
