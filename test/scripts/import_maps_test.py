#!/usr/bin/python3
"""scripts/import_maps: files as Tekscan's and novel's programs save them, and the numbers that our exports find in them.

    import_maps_test.py PROGRAMS    # folder of the tools
"""
import csv
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts/import_maps"
MAPS = SCRIPT.parent.parent / "test/data/indenter_map.bag"

# Header and frame lines as a public I-Scan file of version 6.10I has them.
TEKSCAN = """DATA_TYPE MOVIE
VERSION Tekscan Pressure Measurement System 6.10I
FILENAME C:\\trials\\socket.fsx
SENSOR_TYPE 9811
ROWS 2
COLS 3
ROW_SPACING 2.54 centimeters
COL_SPACING 1.27 centimeters
SENSEL_AREA 3.2258 cm2
SECONDS_PER_FRAME 0.1
TIME 12/2/2019 6:21:52.34PM
START_FRAME 1
END_FRAME 2
UNITS {unit}
ASCII_DATA @@

Frame 1, 0,, 12/2/2019 6:21:52.34PM,,,Raw Sum=,,310
B,0,10
B,20,0

Frame 2, 0.11,, 12/2/2019 6:21:52.45PM,,,Raw Sum=,,307
B,5,30
B,40,0

@@
"""
# As a public pliance file has them: a block of pressures, a second block, and the corners of the sensors [cm].
NOVEL = """file name: 2112170R_1.mat date/time 17.06.23 15.21
mat type s2160_001
total times [secs]: 0.083 time per frame [secs]: 0.04167 scanning rate [Hz]: 24
pressure values in kPa


electrical:
time[secs]       4       5       6
    5.79167   0.000  10.000  13.333
    5.83333   0.000  20.000  11.667

time[secs]    force        x        y
    5.79167    0.250        -        -


sensor        4        5        6
corner[cm]
x[0]   0.0000   0.0000   0.5000
y[0]   2.0000   1.0000   2.0000
x[1]   0.5000   0.5000   1.0000
y[1]   2.0000   1.0000   2.0000
x[2]   0.5000   0.5000   1.0000
y[2]   1.0000   0.0000   1.0000
x[3]   0.0000   0.0000   0.5000
y[3]   1.0000   0.0000   1.0000
"""


class ImportMaps(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_script(self, name, content, *more):
        (self.folder / name).write_bytes(content.replace("\n", "\r\n").encode())
        return subprocess.run([SCRIPT, self.folder / name, "--output", self.folder / "made.bag", *more], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def export(self, bag, kind, name, *more):
        subprocess.run([PROGRAMS / "export", bag, "--to", kind, "--output", self.folder / name, *more], check=True, stdout=subprocess.DEVNULL)
        with open(self.folder / name, newline="") as file:
            return list(csv.DictReader(file)) if name.endswith(".csv") else file.read()

    def test_a_trial_of_tekscan_has_its_peaks_and_forces(self):
        ran = self.run_script("trial.asf", TEKSCAN.format(unit="kPa"))
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertIn("2 maps of 2 x 3 over 0.110 s", ran.stdout)
        rows = self.export(self.folder / "made.bag", "statistics", "made.csv")
        self.assertEqual([(row["peak_kPa"], row["peak_row"], row["peak_column"]) for row in rows], [("20", "1", "1"), ("40", "1", "1")])
        self.assertAlmostEqual(float(rows[1]["force_N"]), 70e3 * 0.0254 * 0.0127, 3)  # from 10 kPa on
        self.assertAlmostEqual(float(rows[1]["stamp_s"]), 1575310912.45, 2)           # date -u -d '2019-12-02 18:21:52.45' +%s.%N
        self.assertEqual(rows[1]["without_reading"], "0", "cells without a sensor are masked")

    def test_pressures_of_other_units_and_raw_readings(self):
        self.run_script("trial.asf", TEKSCAN.format(unit="PSI"))
        self.assertAlmostEqual(float(self.export(self.folder / "made.bag", "statistics", "psi.csv")[1]["peak_kPa"]), 40 * 6.894757, 2)
        (self.folder / "made.bag").unlink()
        self.assertIn("2 scans of 2 x 3", self.run_script("trial.csv", TEKSCAN.format(unit="raw")).stdout)
        self.assertEqual([row["counts"] for row in self.export(self.folder / "made.bag", "csv", "raw.csv")][6:], ["0", "5", "30", "0", "40", "0"])

    def test_a_trial_of_novel_lies_on_its_grid(self):
        ran = self.run_script("trial.asc", NOVEL)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        rows = self.export(self.folder / "made.bag", "csv", "made.csv")[4:]
        self.assertEqual([row["pressure_Pa"] for row in rows], ["0", "11667", "20000", "NA"])
        self.assertEqual(rows[3]["taxel_flags"], "MASKED")
        self.assertAlmostEqual(float(rows[0]["time_s"]), 0.04166, 4)

    def test_what_we_export_comes_back(self):
        for kind, name in (("tekscan", "ours.asf"), ("pliance", "ours.asc")):
            text = self.export(MAPS, kind, name)
            (self.folder / name).unlink()
            ran = self.run_script(name, text.replace("\r\n", "\n"))
            self.assertEqual(ran.returncode, 0, ran.stderr)
            ours, made = (self.export(bag, "trial", name) for bag, name in ((MAPS, "a.csv"), (self.folder / "made.bag", "b.csv")))
            for column in ("peak_kPa", "mean_peak_kPa", "peak_integral_kPa_s", "contact_time_s", "force_N", "impulse_N_s"):
                value = float(ours[0][column])  # the sheet was bent: its areas are smaller by 1e-5
                self.assertAlmostEqual(value, float(made[0][column]), delta=2e-5 * value + 0.002, msg=column)
            self.assertEqual((ours[0]["peak_row"], ours[0]["peak_column"]), (made[0]["peak_row"], made[0]["peak_column"]))
            (self.folder / "made.bag").unlink()

    def test_wrong_files_are_refused_in_one_sentence(self):
        for name, content, why in (("a.asf", "time,force\n1,2\n", "no line ASCII_DATA @@"), ("a.asc", "time,force\n", "no file of novel's pliance"),
                                   ("a.asf", TEKSCAN.format(unit="bananas"), "UNITS bananas, but raw, kpa"),
                                   ("a.asf", TEKSCAN.format(unit="kPa").replace("B,5,30", "B,5"), "line 21: the frame has 5 cells, but 6"),
                                   ("a.asc", NOVEL.replace("y[0]   2.0000   1.0000   2.0000", "y[0]   2.0000   1.0000   2.6000"), "grid of equal distances")):
            ran = self.run_script(name, content)
            self.assertEqual(ran.returncode, 2, why)
            self.assertRegex(ran.stderr, r"^import_maps: .*a\.as[fc]: .*(" + why + r").*\n$")
            self.assertFalse((self.folder / "made.bag").exists())


if __name__ == "__main__":
    PROGRAMS = pathlib.Path(sys.argv.pop(1))
    unittest.main()
