#!/usr/bin/python3
"""docs/trial.md: its code in R and in Python makes the same table, that of the planted trials.

    trial_page_test.py PROGRAMS    # folder of the tools
"""
import csv
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import rosbag
from fsr_pressure_map.msg import Session

SOURCE = pathlib.Path(__file__).resolve().parent.parent.parent
PAGE = (SOURCE / "docs/trial.md").read_text()
HEADER = ("ROWS 2\nCOLS 3\nROW_SPACING 10.0 mm\nCOL_SPACING 10.0 mm\nSECONDS_PER_FRAME 0.02\n"
          "TIME 12/2/2019 6:21:52.34PM\nUNITS kPa\nASCII_DATA @@\n\n")
# Peaks of the steps [kPa] of each recording, by condition: its mean is that of the recordings' means.
TRIALS = {("liner_a", "walk_1"): [100, 110, 120], ("liner_a", "walk_2"): [130, 130, 130, 130, 130], ("liner_b", "walk_3"): [80, 90]}
MEANS = {"liner_a": (120, math.sqrt(200), 2), "liner_b": (85, None, 1)}  # of 110 and 130; of one recording


def code(language):
    return re.search(rf"```{language}\n(.*?)```", PAGE, re.DOTALL).group(1)


class TrialPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        bags = [cls.record(session, name, peaks) for (session, name), peaks in TRIALS.items()]
        (cls.folder / "regions.yaml").write_text("regions:\n  - {name: heel, rows: [1, 1], columns: [2, 2]}\n")
        subprocess.run([PROGRAMS / "export", *bags, "--to", "trial", "--regions", cls.folder / "regions.yaml", "--output",
                        cls.folder / "trial.csv"], check=True, stdout=subprocess.DEVNULL)

    @classmethod
    def record(cls, session, name, peaks):
        """Half sines of 0.6 s, one each second. The heel has half of the others' pressure."""
        frames = []
        for k in range(50 * (len(peaks) + 1)):
            step, phase = divmod(k / 50 - 0.4, 1)
            value = peaks[int(step)] * math.sin(math.pi * phase / 0.6) if 0 <= step < len(peaks) and phase < 0.6 else 0
            frames.append(f"Frame {k + 1}, {k / 50},,,,,,,\n" + f"{value:.4f},{value:.4f},{value:.4f}\n{value:.4f},{value:.4f},{value / 2:.4f}\n")
        (cls.folder / f"{name}.asf").write_text(HEADER + "\n".join(frames) + "\n@@\n")
        made = cls.folder / f"{name}.bag"
        subprocess.run([SOURCE / "scripts/import_maps", cls.folder / f"{name}.asf", "--output", made], check=True, stdout=subprocess.DEVNULL)
        with rosbag.Bag(made) as bag:
            first = next(bag.read_messages()).timestamp
        with rosbag.Bag(made, "a") as bag:
            bag.write("/fsr/session", Session(session_id=session), first)
        return made

    def check_table(self, table):
        with open(self.folder / table, newline="") as file:
            rows = [[self.number(cell) for cell in row] for row in csv.reader(file)]
        found = {(row[0], row[1]): row[2:] for row in rows if row[1:2] and row[1] in MEANS}
        self.assertEqual(len(found), 4, rows)
        for (region, session), values in found.items():
            for value, planted in zip(values[:3], MEANS[session]):
                share = 0.5 if region == "heel" and planted is not MEANS[session][2] else 1
                self.assertTrue(value is None if planted is None else abs(value - share * planted) < 0.02, (region, session, values))

    @staticmethod
    def number(cell):
        try:
            return float(cell)
        except ValueError:
            return None if cell in ("", "NA") else cell

    def test_the_code_in_r(self):
        subprocess.run(["Rscript", "-e", code("r")], cwd=self.folder, check=True, stdout=subprocess.DEVNULL)
        self.check_table("table.csv")

    def test_the_code_in_python(self):
        subprocess.run(["/usr/bin/python3", "-c", code("python")], cwd=self.folder, check=True)
        self.check_table("table.csv")


if __name__ == "__main__":
    PROGRAMS = pathlib.Path(sys.argv.pop(1))
    unittest.main()
