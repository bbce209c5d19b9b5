#!/usr/bin/python3
"""simulated_bags.py SIMULATE: speed of `simulate` when it writes bags.

Simulates six conditions of 7,500 scans of 70 taxels at 10 Hz with every effect at its usual size. Prints the ratio of rig time
to CPU time of the whole tool, including its start and the closing of the files. Target: 1,000.
"""
import os
import resource
import subprocess
import sys
import tempfile

RIG = os.path.join(os.path.dirname(os.path.abspath(__file__)), "all_effects.yaml")
RIG_TIME = 6 * 10 * (2 * 620 / 17 + 2)  # six conditions of ten cycles [s]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([sys.argv[1], "--simulation", RIG, "--output", folder], check=True,
                       stdout=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        size = sum(entry.stat().st_size for entry in os.scandir(folder))
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(f"{RIG_TIME:.0f} s of rig time, {size / 1e6:.0f} MB of bags in {seconds:.2f} s of CPU time: "
          f"{RIG_TIME / seconds:.0f} times real time")


if __name__ == "__main__":
    main()
