#!/usr/bin/python3
"""Tests of the scripts that draw figures and write reports, without the tools: scripts/figures."""
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts" / "figures"))
import discrepancy  # noqa: E402
import figure_style as style  # noqa: E402
import study  # noqa: E402

CURVE = {"before [% FS]": [1, 2], "after [% FS]": [0, 1], "standard error [% FS]": [0.1, 0.1]}


class Discrepancy(unittest.TestCase):
    def test_every_plot_of_the_residual_has_a_title(self):
        for name, unit in (("pressure", " [Pa]"), ("direction", " [Pa, venting negative]"), ("time_since_reversal", " [s]")):
            _, axes = style.figure()
            discrepancy.draw_curve(axes, name, {name + unit: [-2e5, 3e5], **CURVE})
            self.assertEqual(axes.get_title(), "Residual by " + name.replace("_", " "))

    def test_what_is_largest_stands_first(self):
        results = {"verdict": "named", "sentence": "Best explanation: a lag.", "effects": [], "not_identifiable": [], "inputs": [],
                   "gap": {"before": None, "held_out_by": [], "foretold": []},
                   "first_screen": [{"title": "Scatter, more than what is missing", "answer": "The gain changes."},
                                    {"title": "Missing", "answer": "Best explanation: a lag."},
                                    {"title": "How sure", "answer": "Not excluded."}]}
        with tempfile.NamedTemporaryFile(suffix=".png") as picture:
            html = discrepancy.first_screen(results, picture.name)
        places = [html.index(part) for part in ("The gain changes.", "Best explanation: a lag.", "Not excluded.")]
        self.assertEqual(places, sorted(places))
        self.assertEqual(html.count("a lag."), 1)


class Study(unittest.TestCase):
    def test_draws_a_section_that_is_never_at_low_pressure(self):
        steps = list(range(20))
        surfaces = [(0.0, steps, [600.0 - 10 * s for s in steps], steps), (20.0, steps, [30.0 * s for s in steps], steps)]
        with tempfile.TemporaryDirectory() as folder:
            drawn = study.draw_response(folder + "/low", surfaces, 60)
            self.assertTrue(pathlib.Path(drawn).exists())
            study.draw_response(folder + "/none", surfaces[:1], 60)


if __name__ == "__main__":
    unittest.main()
