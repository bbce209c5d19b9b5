#!/usr/bin/python3
"""How fast `simulate` writes bags: simulated_bags.py SIMULATE

Six conditions of 7,500 scans of 70 taxels at 10 Hz with every effect at its usual size; prints rig time
over CPU time of the whole tool, start and closing of the files included. Target: 1,000.
"""
import os
import re
import resource
import subprocess
import sys
import tempfile

SURFACES = "".join(f"  - {{surface: bend_{cm}, cylinder: {{radius: {cm / 100}, axis: y}}}}\n" for cm in (5, 7, 9, 11, 13))


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    text = subprocess.run([sys.argv[1], "--list-effects"], check=True, capture_output=True, text=True).stdout
    effects = re.findall(r"^([a-z_]+): ", text.split("cannot show")[0], re.MULTILINE)
    rig = ("simulation: all\nprogram: [{cycles: {peak: 620000, rate: 17000, cycles: 10}}]\n"
           "session:\n  - {surface: flat, flat: true}\n" + SURFACES +
           "effects: {" + ", ".join(f"{effect}: {{}}" for effect in effects) + "}\n")
    with tempfile.TemporaryDirectory() as folder:
        settings = os.path.join(folder, "all.yaml")
        with open(settings, "w", encoding="utf-8") as out:
            out.write(rig)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([sys.argv[1], "--simulation", settings, "--output", folder], check=True,
                       stdout=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        size = sum(entry.stat().st_size for entry in os.scandir(folder))
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    cycles = 6 * 10 * (2 * 620 / 17 + 2)  # [s] of rig time
    print(f"{len(effects)} effects, {cycles:.0f} s of rig time, {size / 1e6:.0f} MB of bags in {seconds:.2f} s of CPU time: "
          f"{cycles / seconds:.0f} times real time")


if __name__ == "__main__":
    main()
