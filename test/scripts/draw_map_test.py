#!/usr/bin/python3
"""scripts/draw_map: what it prints and writes of a recording with known peaks.

    draw_map_test.py PROGRAMS    # folder of the tools
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts/draw_map"
ROOT = SCRIPT.parent.parent


class DrawMap(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        subprocess.run([PROGRAMS / "export", ROOT / "test/data/indenter_map.bag", "--to", "hdf5", "--output", self.folder / "scans.h5"],
                       check=True, stdout=subprocess.DEVNULL)

    def run_script(self, *words):
        return subprocess.run([SCRIPT, self.folder / "scans.h5", *words], text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def test_peaks_are_drawn_with_unit_scale_and_regions(self):
        import h5py
        with h5py.File(self.folder / "scans.h5") as file:
            pressure, flags = file["scans/pressure"][:], file["scans/flags"][:]
        highest = pressure.max()
        extrapolated = [flags[pressure[:, r, c].argmax(), r, c] == 8 for r in range(7) for c in range(10)]  # at the taxel's peak
        self.assertGreater(sum(extrapolated), 0)
        picture = self.folder / "peak.svg"
        ran = self.run_script("--output", picture, "--unit", "mmHg", "--regions", ROOT / "config/regions/example.yaml")
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertIn(f"highest {highest / 133.322387415:.4g} mmHg at row 4, column 6;", ran.stdout)
        for text in ("pressure [mmHg]", "along a row [mm]", "patellar tendon", "fibula head", "peak pressure in 2 s"):
            self.assertTrue(text in picture.read_text(), text)
        self.assertEqual(picture.read_text().count(">\u2265<"), sum(extrapolated))

    def test_one_moment_as_pdf_and_png(self):
        for name, magic in (("map.pdf", b"%PDF"), ("map.png", b"\x89PNG")):
            ran = self.run_script("--at", "1", "--output", self.folder / name)
            self.assertIn("pressure at 1.", ran.stdout, ran.stderr)
            self.assertEqual((self.folder / name).read_bytes()[:4], magic)

    def test_wrong_files_and_times_are_refused_in_one_sentence(self):
        for words, why in ((("--output", "a.jpg"), "must end with .pdf, .svg or .png"), (("--output", "a.pdf", "--at", "99"), "runs from 0 to"),
                           (("--output", "a.pdf", "--regions", "none.yaml"), "none.yaml: there is no such file")):
            ran = self.run_script(*words)
            self.assertEqual((ran.returncode, ran.stdout), (2, ""))
            self.assertRegex(ran.stderr, rf"^draw_map: .*{why}.*\n$")
        (self.folder / "scans.h5").write_text("no HDF5")
        self.assertRegex(self.run_script("--output", "a.pdf").stderr, r"^draw_map: .*scans.h5: is not written by export --to hdf5\n$")


if __name__ == "__main__":
    PROGRAMS = pathlib.Path(sys.argv.pop(1))
    unittest.main()
