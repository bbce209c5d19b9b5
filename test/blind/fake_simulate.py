#!/usr/bin/python3
"""Stands for `simulate --drive` in tests of the recomputed gap: adds the number of counts that the simulation file states to
every reading.

    fake_simulate.py --simulation FILE --output DIR --drive BAG...       FILE holds {add: COUNTS}
"""

import os
import pathlib
import sys

import rosbag
import yaml


def main(words):
    file, output = words[words.index("--simulation") + 1], pathlib.Path(words[words.index("--output") + 1])
    simulation = yaml.safe_load(pathlib.Path(file).read_text())
    if "white_noise" in (simulation.get("effects") or {}):
        print("fake_simulate: white_noise should have been removed", file=sys.stderr)
        return 2
    output.mkdir()
    with open(os.environ.get("FAKE_LOG", os.devnull), "a", encoding="ascii") as log:
        log.write("simulate " + " ".join(pathlib.Path(w).name for w in words if w.endswith(".bag")) + "\n")
    for path in words[words.index("--drive") + 1:]:
        with rosbag.Bag(path) as bag, rosbag.Bag(str(output / pathlib.Path(path).name), "w") as copy:
            for topic, message, stamp in bag.read_messages():
                if topic.endswith("/raw"):
                    message.counts = [count + simulation["add"] for count in message.counts]
                copy.write(topic, message, stamp)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
