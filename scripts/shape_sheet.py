"""What measure_shape and measure_shape_limits share: one simulated sheet, the bags of its training, and what check_bag says of others."""

import copy
import math
import re

from simulated_rig import SimulatedRig

TRAINED = [0, 0.20, 0.13, 0.11, 0.09, 0.07, 0.05]  # radius [m]; 0 = flat
BETWEEN = [0.15, 0.12, 0.10, 0.08, 0.06, 0.055]
CYCLES = [{"cycles": {"peak": 300e3, "rate": 60e3, "dwell_peak": 1, "dwell_rest": 4, "cycles": 3}}]
REST = [{"cycles": {"peak": 60e3, "rate": 30e3, "dwell_peak": 1, "dwell_rest": 4, "cycles": 1}}]


def name_of(radius):
    return "flat" if radius == 0 else f"cylinder_{100 * radius:g}cm"


def curvature_of(radius):
    return 0.0 if radius == 0 else 1 / radius


def station(radius, program):
    surface = {"flat": True} if radius == 0 else {"cylinder": {"radius": radius, "axis": "y"}}
    return {"surface": name_of(radius), **surface, "program": copy.deepcopy(program)}


class Sheet(SimulatedRig):
    """One simulated sheet: the bags of its training and of its checks, and its calibration."""

    def rig(self):
        """The settings of the rig, whose mounts scatter."""
        rig = self.settings()
        rig["effects"].setdefault("repositioning", {})["offset"] = self.options.scatter
        if self.options.short:
            rig["matrix"].update(rows=3, columns=4)
        return rig

    def bags(self, checks, name="rig"):
        """The bags of training, and those of the stations `checks` behind them."""
        rig = self.rig()
        training = [station(radius, CYCLES) for _ in range(self.options.mounts) for radius in TRAINED]
        rig["session"] = training + checks
        bags = self.simulated(rig, name)
        return bags[:len(training)], bags[len(training):]

    def train(self, bags, *options):
        calibration = self.folder / "sheet.h5"
        self.run("train", *bags, "--history", "none", *options, "--output", calibration)
        return calibration

    def check(self, calibration, bags):
        """Rows of the tables that check_calibration prints: estimate, interval, verdict, surfaces that agree; changes along x and y."""
        text = self.run("check_calibration", calibration, *bags)
        table = text[text.index("How the sheet rests"):].splitlines()[2:]
        rows = {}
        for line in table[:len(bags)]:
            name, rest = line.split(", ", 1)
            words = rest.split(", mount ")[1].split()[1:]
            number = [math.nan if word in ("-", "varies") else float(word) for word in words[:4]]
            agree = " ".join(words[5:])
            rows[name] = {"declared": number[0], "estimate": number[1], "low": number[2], "high": number[3], "verdict": words[4],
                          "agree": [] if agree == "-" else agree.split(", "), "changes": False, "change": [None, None]}
        changes = text[text.index("Change of the bend"):].splitlines()[2:]
        for line in changes[:changes.index("") - 1]:
            name, rest = line.split(", ", 1)
            cells = re.split(r"\s{2,}", rest.split(", mount ")[1].strip())[1:]
            rows[name]["change"] = [None if cell == "-" else [float(word) for word in cell.split(" +- ")] for cell in cells[:2]]
            rows[name]["changes"] = cells[2] == "yes"
        return [rows[bag.name] for bag in bags]
