#!/usr/bin/python3
"""The demo's scores, its floor, its picture, its wrong surface and its verdict, on runs that are made up."""
import csv
import importlib.util
import pathlib
import sys
import tempfile
import unittest

import numpy
import yaml

PACKAGE = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(PACKAGE / "scripts"))
import demo_floor  # noqa: E402
import demo_history  # noqa: E402
import demo_score  # noqa: E402
import demo_shape  # noqa: E402
import demo_tools  # noqa: E402

START = 1704099600 * 10**9  # [ns]
TAXELS = 3


def course(time):
    """Rest of 10 s, then two cycles to 600 kPa: 20 s up, 8 s held, 20 s down, 8 s at rest [Pa]."""
    return numpy.interp((time - 10) % 56, [0, 20, 28, 48, 56], [0, 600e3, 600e3, 0, 0]) * (time > 10)


def made_up_run():
    """The static map reads 20 kPa high, history 5 kPa from 40 s on and as the static one before; its maps of the first 30 s are
    missing."""
    time = numpy.arange(0, 130, 0.1)
    stamps = START + numpy.round(time * 1e9).astype(numpy.int64)
    truth = numpy.repeat(course(time)[:, None], TAXELS, axis=1)
    series = {name: (stamps, truth + 20e3) for name in ("flat_only", "baseline", "per_curvature", "interpolated")}
    series["history"] = stamps[300:], truth[300:] + 5e3
    series["floor"] = stamps, truth
    settled = numpy.repeat((time[300:] > 40)[:, None], TAXELS, axis=1)
    series["history"][1][~settled] += 15e3
    return demo_score.Run(numpy.column_stack([stamps, course(time)]), series, settled)


def scores_of(**rmse):
    names = dict.fromkeys(demo_score.COLUMNS, 4.0)
    names.update({"flat_only": 9.0, "baseline": 6.0}, **rmse)
    return {name: {"rmse_percent": value, "rmse_kpa": 6 * value, "settled_kpa": 5 * value, "scans": 100, "unsettled": 0.031}
            for name, value in names.items()}


class Score(unittest.TestCase):
    def test_counts_the_cycles_of_scans_that_every_map_has(self):
        score = demo_score.score(made_up_run())
        self.assertEqual([round(score[name]["settled_kpa"], 2) for name in ("interpolated", "history", "floor")], [20, 5, 0])
        self.assertEqual([round(score[name]["rmse_kpa"], 2) for name in ("interpolated", "floor")], [20, 0])
        unsettled = score["history"]["unsettled"]  # 10 s of those from 30 s on
        self.assertAlmostEqual(unsettled, 10 / 100, 2)
        self.assertAlmostEqual(score["history"]["rmse_kpa"], (400 * unsettled + 25 * (1 - unsettled))**0.5, 3)
        self.assertEqual({cell["scans"] for cell in score.values()}, {score["history"]["scans"]})
        self.assertAlmostEqual(score["interpolated"]["rmse_percent"], 100 * 20 / 600, 3)

    def test_the_table_shows_static_history_and_floor(self):
        scores = {"flat": scores_of(), "cylinder_8cm": scores_of(history=1.5, floor=1.25)}
        lines = demo_score.table(scores, ["flat"], "cylinder_8cm").splitlines()
        heading = next(line for line in lines if line.startswith("surface"))
        self.assertLess(heading.index("interpolated"), heading.index("history"))
        self.assertLess(heading.index("history"), heading.index("floor"))
        self.assertIn("interpolated 20.0 kPa, history 20.0 kPa, floor 20.0 kPa", lines[-1])
        self.assertEqual(lines[-3].split()[-8:], ["24.0", "1.50", "9.0", "1.25", "7.5", "3.1", "%", "100"])


class Verdict(unittest.TestCase):
    def test_history_may_be_worse_than_the_static_answer_by_one_per_cent(self):
        self.assertEqual(demo_score.complaints({"flat": scores_of(flat_only=4.0, history=4.03), "bent": scores_of()}, ["flat", "bent"]), [])
        for surface in ("flat", "bent"):
            said = demo_score.complaints({surface: scores_of(flat_only=4.0 if surface == "flat" else 9.0, history=4.05)}, [surface])
            self.assertEqual(said, [f"{surface}: history (4.05 %) is worse than the static answer (4.00 %)"])

    def test_a_map_without_a_reading_is_told(self):
        self.assertEqual(demo_score.complaints({"bent": scores_of(floor=float("nan"))}, ["bent"]), ["bent: a scheme gave no reading"])

    def test_knowing_the_curvature_must_help(self):
        self.assertIn("per-curvature (6.50 %)", demo_score.complaints({"bent": scores_of(per_curvature=6.5)}, ["bent"])[0])


class Floor(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_is_the_demo_s_rig_without_loop_and_creep(self):
        shipped = PACKAGE / "config/simulation/demo.yaml"
        rig, floor = yaml.safe_load(shipped.read_text()), demo_floor.without_memory(shipped)
        self.assertEqual(set(rig["effects"]) - set(floor["effects"]), {"hysteresis", "creep"})
        for effect in ("hysteresis", "creep"):
            rig["effects"].pop(effect)
        self.assertEqual(floor, rig)

    def test_a_rig_without_loop_and_creep_has_none(self):
        file = self.folder / "rig.yaml"
        file.write_text("simulation: dull\neffects: {static_curve: {}}\n")
        with self.assertRaisesRegex(demo_tools.Failure, "neither of the effects"):
            demo_floor.without_memory(file)

    def test_reads_an_exported_table(self):
        table = self.folder / "maps.csv"
        with open(table, "w", newline="") as file:
            rows = csv.writer(file)
            rows.writerow(["bag", "pressure_Pa", "stamp_s"])
            rows.writerows([["a.bag", "1.5", "1704099600.941176471"], ["a.bag", "NA", "1704099600.941176471"],
                            ["a.bag", "2", "1704099601.000000001"], ["a.bag", "3", "1704099601.000000001"],
                            ["b.bag", "4", "1704099601.000000001"], ["b.bag", "5", "1704099601.000000001"]])
        maps = demo_floor.read_maps(table)
        self.assertEqual(maps["a.bag"][0].tolist(), [START + 941176471, START + 10**9 + 1])
        numpy.testing.assert_array_equal(maps["a.bag"][1], [[1.5, float("nan")], [2, 3]])
        numpy.testing.assert_array_equal(maps["b.bag"][1], [[4, 5]])


class Picture(unittest.TestCase):
    def test_finds_the_reversals_and_how_long_ago_they_were(self):
        run = made_up_run()
        direction, since, moves = demo_history.since_reversal(run.reference)
        for time, way, ago, moving in [(5, 0, None, False), (20, 1, 10, True), (34, 1, 24, False), (50, -1, 12, True), (64, -1, 26, False),
                                       (70, 1, 4, True), (110, -1, 16, True)]:
            i = round(time * 10)
            self.assertEqual((direction[i], moves[i]), (way, moving), f"at {time} s")
            if ago is not None:
                self.assertAlmostEqual(since[i], ago, delta=0.6)
        for way in (1, -1):
            self.assertAlmostEqual(demo_history.length_of_ramp(run, way), 20, delta=1)

    def test_shows_the_error_of_each_map(self):
        run = made_up_run()
        for name, error in [("interpolated", 20), ("history", 5), ("floor", 0)]:
            for way in (1, -1):
                times, errors = demo_history.error_by_time([run], name, way, settled_only=True)
                numpy.testing.assert_allclose(errors, error, atol=1e-6)
                self.assertAlmostEqual(times[-1], 27.5, delta=1.1)

    def test_is_drawn_with_its_numbers(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        picture = pathlib.Path(demo_history.draw([made_up_run()], pathlib.Path(folder.name) / "history"))
        self.assertEqual((picture.name, picture.read_bytes()[1:4]), ("history.png", b"PNG"))
        with open(picture.with_suffix(".csv"), newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({row["direction"] for row in rows}, {"loading", "unloading"})
        self.assertEqual({round(float(row["RMSE [kPa]"])) for row in rows if row["map"] == "history, once settled"}, {5})
        unloading = [float(row["RMSE [kPa]"]) for row in rows if (row["map"], row["direction"]) == ("history", "unloading")]
        self.assertGreater(unloading[1], 10)
        self.assertAlmostEqual(unloading[-3], 5)


def answers_of(check="the sheet rests as on 5.0 cm (4.8 cm to 5.1 cm), but the surface file says cylinder_9cm (9.0 cm)", given=True):
    said = demo_shape.Answer(True, "something")
    return {"check": demo_shape.Answer(given, check), "check_true": said, "estimate": said}


def rows_of(**rmse):
    return {use: demo_shape.Row(20.0, 0.2 if use == "estimated" else float("nan"),
                                {"rmse_percent": kpa / 6, "rmse_kpa": kpa, "bias_kpa": -kpa / 2, "scans": 492})
            for use, kpa in rmse.items()}


class WrongSurface(unittest.TestCase):
    def test_the_table_shows_the_error_with_each_surface_and_how_to_compute_it_again(self):
        lines = demo_shape.table(rows_of(wrong=75, estimated=21, true=20), 21.04, "folder").splitlines()
        rows = [line.split() for line in lines[6:9]]
        self.assertEqual([row[0] for row in rows], ["wrong:", "estimated", "true:"])
        self.assertEqual(rows[0][-5:], ["20.00", "12.50", "75.0", "-37.5", "3.75"])
        self.assertEqual(rows[1][1:], ["20.00", "+-", "0.20", "3.50", "21.0", "-10.5", "1.05"])
        self.assertIn("492 scans", lines[2])
        self.assertIn("an error of 21.0 kPa", lines[-3])
        self.assertIn("scripts/demo_shape.py folder", lines[-1])

    def test_an_estimate_that_was_not_given_has_no_error(self):
        text = demo_shape.table(rows_of(wrong=75, true=20), float("nan"), "folder")
        self.assertEqual(text.splitlines()[7].split(), ["estimated", "none"])
        self.assertNotIn("nan", text)

    def test_prints_what_the_sheet_said(self):
        said = demo_shape.sentences(answers_of(check="how the sheet lies cannot be told: why", given=False)).splitlines()
        self.assertEqual(said[0], "~check_surface, cylinder_9cm: how the sheet lies cannot be told: why")
        self.assertEqual(len(said), 3)

    def test_a_wrong_file_must_be_found(self):
        rows = rows_of(wrong=75, estimated=21, true=20)
        self.assertEqual(demo_shape.complaints(answers_of(), rows), [])
        for given, said in [(False, "how the sheet lies cannot be told: why"), (True, "the sheet rests as on 5.0 cm, which agrees with it")]:
            self.assertEqual(demo_shape.complaints(answers_of(said, given), rows), [f"the wrong surface file was not found: {said}"])

    def test_the_estimated_surface_must_help(self):
        said = "the map does not have a smaller error with the estimated surface than with the wrong one"
        for error in (75, float("nan")):
            self.assertEqual(demo_shape.complaints(answers_of(), rows_of(wrong=75, estimated=error, true=20)), [said])

    @unittest.skipUnless(importlib.util.find_spec("rosbag") and importlib.util.find_spec("fsr_pressure_map"), "needs ROS")
    def test_the_readings_get_another_surface(self):
        import rosbag
        import rospy
        from fsr_pressure_map.msg import MatrixFrame, PressureMap, SurfaceCurvature
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        load, wrong = (pathlib.Path(folder.name) / name for name in ("load.bag", "wrong.bag"))
        with rosbag.Bag(str(load), "w") as bag:
            for second in (10, 11, 12):
                for topic, message in [("curvature", SurfaceCurvature(surface="estimated", x=[20], deviation=[0.2])), ("raw", MatrixFrame()),
                                       ("pressure_map", PressureMap())]:
                    message.header.stamp = rospy.Time(second)
                    bag.write(f"/fsr/{topic}", message, rospy.Time(second + 0.5))
        demo_shape.exchange(load, SurfaceCurvature(surface="cylinder_9cm", x=[11]), wrong)
        with rosbag.Bag(str(wrong)) as bag:
            messages = list(bag.read_messages())
        self.assertEqual([topic for topic, _, _ in messages], ["/fsr/curvature"] + 3 * ["/fsr/raw"])
        self.assertEqual((messages[0][1].surface, messages[0][1].header.stamp), ("cylinder_9cm", rospy.Time(10)))
        self.assertEqual([message.header.stamp.secs for _, message, _ in messages[1:]], [10, 11, 12])
        self.assertEqual(demo_shape.curvature_of(load)[0], 20)
        self.assertNotEqual(demo_shape.curvature_of(wrong)[1], demo_shape.curvature_of(wrong)[1])


if __name__ == "__main__":
    sys.exit(unittest.main())
