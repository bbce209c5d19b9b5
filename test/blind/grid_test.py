#!/usr/bin/python3
"""grid_test.py GENERATOR COMMAND: a small part of the grid with the real command, on development seeds."""

import json
import pathlib
import subprocess
import sys
import tempfile

TRIALS = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts" / "blind_trials"


def main(generator, command):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([str(TRIALS), "--output", folder, "--generator", generator,
                        "--command", command + " {bags} --output {output} --no-report --threads 1", "--jobs", "1",
                        "--effects", "hysteresis:duhem,time_skew:two_clocks,dead_taxel:open", "--protocols", "two_speeds",
                        "--snr", "1", "--nothing", "1", "--pairs", "0"], check=True, capture_output=True)
        cases = json.loads(pathlib.Path(folder, "summary.json").read_text())["cases"]
    for case in cases:
        right = case["answer"] == ("none" if case["kind"] == "none" else case["truth"])
        print("%s: hidden %s, answer %s" % ("right" if right else "WRONG", case["truth"], case["answer"]))
        if not right:
            return 1
    return 0 if len(cases) == 4 else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
