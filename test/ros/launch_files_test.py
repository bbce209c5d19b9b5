#!/usr/bin/python3
"""The shipped launch files as users start them: default parameters, relative paths, several terminals and one roscore."""
import csv
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

import rosbag
import rospy
import rosservice
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from fsr_pressure_map.msg import CalibrationInfo, MatrixInfo, PressureMap, PressureStatistics, PressureStatisticsArray, SurfaceCurvature
from terminal import PACKAGE, PATIENCE, PROGRAMS, Terminal, happens, pid_if_running, pid_of
from tf2_msgs.msg import TFMessage

BENCH = PACKAGE / "config" / "simulation" / "bench.yaml"  # 3 x 4 taxels


class LaunchFilesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.port = self.folder / "board"
        self.board = None

    def connect_board(self):
        """A board in a chamber at rest."""
        self.board = subprocess.Popen([str(PROGRAMS / "rig_emulator_node"), "__ns:=bench", f"_simulation:={BENCH}", f"_link:={self.port}",
                                       "_scan_rate:=100", "_autostart:=false"])
        self.addCleanup(self.board.wait)
        self.addCleanup(self.board.terminate)

    def start(self, name, *arguments):
        terminal = Terminal(self.folder, name, *arguments)
        self.addCleanup(terminal.end)
        return terminal

    def start_with_board(self, name, *arguments):
        return self.start(name, f"serial_port:={self.port}", "serial_baud:=0", *arguments)

    def wait_for(self, condition, terminal=None):
        if not happens(condition):
            self.fail(terminal.said() if terminal else "did not happen")

    def simulate(self):
        """Bags of the emulated board in its chamber, 1_flat.bag and 2_cylinder_5cm.bag."""
        subprocess.run([str(PROGRAMS / "simulate"), "--simulation", str(BENCH), "--output", "."], cwd=self.folder, check=True, stdout=subprocess.DEVNULL)

    def train(self):
        """A calibration of the emulated board, calibration.h5."""
        self.simulate()
        subprocess.run([str(PROGRAMS / "train"), "1_flat.bag", "2_cylinder_5cm.bag", "--output", "calibration.h5"], cwd=self.folder, check=True, stdout=subprocess.DEVNULL)

    def wait_for_maps(self, terminal, topic="/fsr/pressure_map"):
        maps = []
        subscriber = rospy.Subscriber(topic, PressureMap, maps.append)
        self.wait_for(lambda: any(one.state == PressureMap.STATE_OK for one in maps), terminal)
        subscriber.unregister()
        return [one for one in maps if one.state == PressureMap.STATE_OK]

    def press(self, service, *arguments):
        """What a button or `rosservice call` does; the service's sentence."""
        rospy.wait_for_service(service, PATIENCE)
        reply = rosservice.get_service_class_by_name(service)
        answer = rospy.ServiceProxy(service, reply)(*arguments)
        self.assertTrue(answer.success, f"{service}: {answer.message}")
        return answer.message

    def refused(self, name, *arguments):
        """The terminal's text of a launch that is refused."""
        terminal = Terminal(self.folder, name, *arguments)
        self.wait_for(terminal.ended, terminal)
        return terminal.said()

    def test_every_service_works_as_the_launch_files_start_it(self):
        self.train()
        self.connect_board()
        (self.folder / "regions.yaml").write_text("regions:\n  - {name: toe, rows: [0, 1], columns: [0, 1]}\n")
        (self.folder / "rig.yaml").write_text(f"serial_port: {self.port}\nserial_baud: 0\npitch_x: 0.02\npitch_y: 0.03\n"
                                              "sealing: pdms\ncalibration: calibration.h5\nregions: regions.yaml\n"
                                              "alarm_threshold: 500000\nprotocol: wire\nuse: bench\nsubject: S012\noperator: OP1\ntrial: 1\n")
        rig = self.start("calibrated", "rig:=rig.yaml", "surface:=flat", "unit:=mmHg", "pitch_x:=0.010")
        self.wait_for_maps(rig)
        self.assertEqual(rospy.get_param("/fsr/view/unit"), "mmHg")
        info = rospy.wait_for_message("/fsr/matrix_info", MatrixInfo, PATIENCE)
        self.assertEqual((round(info.pitch_x, 6), round(info.pitch_y, 6), info.sealing), (0.01, 0.03, "pdms"))
        self.assertIn("fsr_calibration_tare.yaml", self.press("/fsr/calibration/tare"))
        self.press("/fsr/calibration/clear_tare")
        self.assertIn("1 taxels are masked; stored in ", self.press("/fsr/calibration/set_mask", [1] + 11 * [0]))
        self.press("/fsr/calibration/reload")
        self.press("/fsr/calibration/load_calibration", str(self.folder / "calibration.h5"))
        self.press("/fsr/curvature/set_surface", "cylinder_5cm", 0)
        self.press("/fsr/view/set_alarm", "toe", 40e3, -1, -1)
        self.press("/fsr/view/set_alarm", "", 123e3, 2, 10e3)
        self.press("/fsr/driver/set_enabled", False)
        self.press("/fsr/driver/set_enabled", True)
        self.killed_and_started_again(rig)
        self.recorded_beside(rig)

    def killed_and_started_again(self, rig):
        """Mask, surface, mount and alarms are those that were set, and not those of the launch file."""
        for node in ("/fsr/calibration", "/fsr/curvature", "/fsr/view"):
            pid = pid_of(node)
            os.kill(pid, signal.SIGKILL)
            self.wait_for(lambda: pid_if_running(node) not in (0, pid), rig)
        surface = rospy.wait_for_message("/fsr/curvature", SurfaceCurvature, PATIENCE)
        self.assertEqual((surface.surface, surface.mount), ("cylinder_5cm", 2))
        maps = self.wait_for_maps(rig)
        self.assertTrue(maps[-1].flags[0] & PressureMap.FLAG_MASKED)
        self.assertFalse(maps[-1].flags[1] & PressureMap.FLAG_MASKED)
        self.assertIn("goes on with cylinder_5cm, mount 2", rig.said())
        self.wait_for(lambda: "the alarms that were set last: the whole matrix at 922.6 mmHg, region toe at 300 mmHg" in rig.said(), rig)
        arrays = []
        subscriber = rospy.Subscriber("/fsr/statistics", PressureStatisticsArray, arrays.append)
        self.wait_for(lambda: arrays and len(arrays[-1].regions) == 2, rig)  # the regions are known from the first map on
        subscriber.unregister()
        self.assertNotIn(3, [region.alarm for region in arrays[-1].regions], "3: no alarm set")
        toe = rospy.wait_for_message("/fsr/regions/toe", PressureStatistics, PATIENCE)
        self.assertEqual((toe.region, toe.total_area > 0), ("toe", True))

    def recorded_beside(self, rig):
        """A recording beside calibrated.launch, its button, its end, and its replay on the same roscore."""
        refusal = self.refused("record", "bag:=monday", "surface:=flat")
        self.assertIn("the node /fsr/curvature runs", refusal)
        self.assertIn("or leave out surface:=", refusal)
        record = self.start("record", "bag:=monday", "extra_topics:=/fsr/nobody", "rig:=rig.yaml", "trial:=2")
        self.assertIn("marked note", self.press("/fsr/session/mark", "note", "first"))
        written = self.folder / "monday.bag.active"
        self.wait_for(lambda: written.exists() and written.stat().st_size > 20_000, record)
        said = record.end()
        with rosbag.Bag(str(self.folder / "monday.bag")) as bag:
            scans = bag.get_message_count("/fsr/raw")
            session = next(message for _, message, _ in bag.read_messages(["/fsr/session"]))
        self.assertEqual((session.use, session.subject_code, session.operator_code, session.trial, session.protocol),
                         ("bench", "S012", "OP1", "2", ""))
        self.assertIn(f"recorded {scans} scans in ", said)
        self.assertIn(f"in {self.folder}/monday.bag; nothing came on /fsr/nobody\n", said)
        self.assertIn("while the node /fsr/driver runs", self.refused("replay", "bag:=monday.bag"))
        rig.end()
        self.replayed()

    def replayed(self):
        alarms = set()
        subscriber = rospy.Subscriber("/fsr/statistics", PressureStatisticsArray, lambda array: alarms.update(region.alarm for region in array.regions))
        arguments = ["bag:=monday.bag", "rate:=5", "calibration:=calibration.h5", "alarm_threshold:=400e3"]
        memory = self.folder / "ros_home" / "fsr_pressure_map"  # what the live rig remembers
        (memory / "fsr_calibration_tare.yaml").write_text(  # of another mount: its owner would drop it
            'format: fsr_pressure_map tare 1\ncalibration: "1"\nsurface: "flat"\nmount: 77\ncurvature: 0\ndate: "2024-05-17"\n'
            f"rows: 3\ncolumns: 4\noffset: {12 * [1000]}\n")
        remembered = {file.name: file.read_bytes() for file in memory.iterdir()}
        self.assertIn("fsr_calibration_mask.yaml", remembered)
        looped = self.start("replay", "loop:=true", *arguments)  # a short bag may end before this node hears the view
        self.wait_for(lambda: alarms, looped)
        self.assertFalse(self.wait_for_maps(looped)[-1].flags[0] & PressureMap.FLAG_MASKED, "the rig's mask is not used")
        self.assertIn("2 taxels are masked; it is forgotten", self.press("/fsr/calibration/set_mask", 2 * [1] + 10 * [0]))
        self.press("/fsr/calibration/clear_tare")
        looped.end()
        self.assertEqual({file.name: file.read_bytes() for file in memory.iterdir()}, remembered, looped.said())
        subscriber.unregister()
        replay = self.start("replay", *arguments)
        self.wait_for(lambda: replay.launch.poll() is not None, replay)
        self.assertNotIn(3, alarms, "3: no alarm set")
        self.assertIn("loaded ", replay.said())
        self.assertNotIn("has died", replay.said())
        self.assertFalse(rospy.get_param("/use_sim_time", False), replay.said())
        rospy.set_param("/use_sim_time", True)  # as a replay that was killed leaves it
        self.addCleanup(rospy.delete_param, "/use_sim_time")
        self.assertIn("rosparam set /use_sim_time false", self.refused("driver"))

    def test_two_sheets_of_default_parameters_lie_round_one_limb(self):
        launched, places, limb = self.start("sheets"), {}, []
        subscribers = [rospy.Subscriber("/tf_static", TFMessage, lambda message: places.update((t.child_frame_id, t) for t in message.transforms)),
                       rospy.Subscriber("/diagnostics", DiagnosticArray, lambda array: limb.extend(
                           (status.level, {pair.key: pair.value for pair in status.values}) for status in array.status if status.name == "limb/limb: sheets"))]
        self.wait_for(lambda: len(places) == 2 and (0, {"/sheet_1": "sheet_1", "/sheet_2": "sheet_2"}) in limb, launched)
        self.assertEqual({place.header.frame_id for place in places.values()}, {"limb"})
        for sheet, (x, y) in (("sheet_1", (0.07, 0)), ("sheet_2", (0, 0.07))):  # a quarter of the cylinder apart
            at = places[f"{sheet}_matrix"].transform.translation
            self.assertAlmostEqual(abs(at.x - x) + abs(at.y - y) + abs(at.z), 0, 9)
            self.assertEqual(rospy.wait_for_message(f"/{sheet}/pressure_map", PressureMap, PATIENCE).header.frame_id, f"{sheet}_matrix")
        rospy.wait_for_message("/limb/limb_statistics", PressureStatisticsArray, PATIENCE)
        for subscriber in subscribers:
            subscriber.unregister()
        self.assertNotIn("has died", launched.end())

    def test_sheets_with_rig_files_go_into_one_bag_and_one_table(self):
        for sheet in ("left", "right"):
            (self.folder / "simulation.yaml").write_text(BENCH.read_text().replace("board: {", f"board: {{serial: {sheet}, "))
            subprocess.run([str(PROGRAMS / "simulate"), "--simulation", "simulation.yaml", "--output", "."], cwd=self.folder, check=True, stdout=subprocess.DEVNULL)
            subprocess.run([str(PROGRAMS / "train"), "1_flat.bag", "2_cylinder_5cm.bag", "--output", f"{sheet}.h5"], cwd=self.folder, check=True, stdout=subprocess.DEVNULL)
            (self.folder / f"{sheet}.yaml").write_text(f"calibration: {sheet}.h5\nalong: 0.05\n")
        (self.folder / "board.yaml").write_text("serial_port: /dev/board\n")
        said = self.refused("sheets", "rig_1:=board.yaml", "rig_2:=board.yaml")
        self.assertIn("the rig files board.yaml and board.yaml have the same serial_port, /dev/board, but each sheet has a board of its own", said)
        sheets = self.start("sheets", "sheets:=left right", "rig_1:=left.yaml", "rig_2:=right.yaml", "emulated:=true", f"simulation:={BENCH}", "scan_rate:=100")
        for sheet in ("left", "right"):
            self.wait_for_maps(sheets, f"/{sheet}/pressure_map")
        record = self.start("record", "bag:=walk", "sheets:=left right", "session:=monday")
        self.press("/left/session/mark", "step", "1")
        written = self.folder / "walk.bag.active"
        self.wait_for(lambda: written.exists() and written.stat().st_size > 60_000, record)
        said = record.end()
        self.assertRegex(said, r"recorded \d+ scans in .* on /left/raw, \d+ scans in .* on /right/raw, ")
        sheets.end()
        subprocess.run([str(PROGRAMS / "export"), "walk.bag", "--to", "trial", "--calibration", "left.h5,right.h5", "--output", "trial.csv"], cwd=self.folder, check=True)
        with open(self.folder / "trial.csv", encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file) if row["step"] == "0"]
        self.assertEqual([(row["sheet"], row["session"]) for row in rows], [("left", "monday"), ("right", "monday")])
        self.assertNotIn("NA", [row["peak_kPa"] for row in rows])

    def test_launch_files_notice_each_other(self):
        self.connect_board()
        driver = self.start_with_board("driver")
        self.wait_for(lambda: pid_if_running("/fsr/driver"), driver)
        before = pid_if_running("/fsr/driver")
        refusal = self.refused("calibrated", f"serial_port:={self.port}")
        self.assertIn("the node /fsr/driver runs", refusal)
        self.assertIn("`roslaunch fsr_pressure_map driver.launch serial_port", refusal)
        self.assertIn(f"(process {driver.launch.pid})", refusal)
        self.assertEqual(pid_if_running("/fsr/driver"), before)
        self.assertIsNone(driver.launch.poll())
        refusal = self.refused("calibrated", "ns:=other", "pitchx:=0.02")
        self.assertIn("calibrated.launch has no argument pitchx (pitchx:=0.02); did you mean pitch_x?", refusal)

    def lab(self, **values):
        """A rig file in a folder whose name has an apostrophe."""
        rig = self.folder / "o'neil's lab" / "rig.yaml"
        rig.parent.mkdir(exist_ok=True)
        rig.write_text("".join(f"{name}: {value}\n" for name, value in values.items()))
        return f"rig:={rig.relative_to(self.folder)}"

    def test_a_refused_launch_ends_with_its_sentence(self):
        for name, arguments, sentence in [
                ("driver", ["pitchx:=0.02"], "driver.launch has no argument pitchx (pitchx:=0.02); did you mean pitch_x?"),
                ("calibrated", [self.lab(serial_prt="/dev/board")],
                 "the rig file o'neil's lab/rig.yaml says serial_prt, which is no argument of a rig; did you mean serial_port?"),
                ("session", ["plan:=one_hour", "rig:=none.yaml"],
                 f"the rig file none.yaml cannot be read: [Errno 2] No such file or directory: '{self.folder}/none.yaml'.")]:
            said = self.refused(name, *arguments)
            self.assertEqual(said.splitlines()[-1], sentence, said)

    def test_a_node_waits_for_a_right_setting(self):
        rig = self.start("calibrated", self.lab(serial_port=self.port, rows=900, unit="bar"), "surface:=no_such")
        self.wait_for(lambda: rig.said().count("tries again each second") == 3, rig)
        nodes = {node: pid_if_running(node) for node in ("/fsr/driver", "/fsr/view", "/fsr/curvature")}
        rospy.set_param("/fsr/curvature/surface", "flat")
        self.lab(serial_port=self.port)
        self.wait_for(lambda: all(pid_if_running(node) for node in nodes) and "there is no serial port" in rig.said(), rig)
        for service in ("/fsr/view/set_alarm", "/fsr/curvature/set_surface"):
            rospy.wait_for_service(service, PATIENCE)
        self.assertEqual({node: pid_if_running(node) for node in nodes}, nodes, rig.said())
        said = rig.end()
        self.assertEqual(said.count("tries again each second"), 3, said)
        self.assertNotIn("has died", said)

    def test_a_nodelet_waits_for_a_right_setting(self):
        rig = self.start("calibrated", self.lab(serial_port=self.port, rows=900), "nodelets:=true", "surface:=flat")
        self.wait_for(lambda: "(/fsr/driver tries again each second)" in rig.said(), rig)
        self.lab(serial_port=self.port)
        self.wait_for(lambda: "there is no serial port" in rig.said(), rig)
        said = rig.end()
        self.assertNotIn("has died", said)
        self.assertEqual(said.count("/fsr/driver tries again each second"), 1, said)

    def test_a_recording_that_would_be_useless_is_refused(self):
        for arguments, sentence in [
                (["wait:=1"], "no scan has come on /fsr/raw"),
                (["surface:=cylinder_6cm"], "surface cylinder_6cm: there is no file"),
                (["subject:=bob"], "must be a code of one to three capitals")]:
            said = self.refused("record", "bag:=useless", *arguments)
            self.assertIn(sentence, said)
            self.assertEqual(list(self.folder.glob("useless*")), [], said)

    def test_a_search_for_a_discrepancy_that_succeeds_ends_its_launch_without_an_error(self):
        self.simulate()
        search = self.start("discrepancy", f"bags:={self.folder}", f"output:={self.folder}/found", "least_gap:=0.7")
        self.wait_for(lambda: search.launch.poll() is not None, search)
        self.assertIn("the least gap is 0.7 kPa", search.said())
        self.assertTrue((self.folder / "found" / "verdict.yaml").exists())
        self.assertNotIn("has died", search.said())
        self.assertIn("has died", self.refused("discrepancy", f"bags:={self.folder}", f"output:={self.folder}/again", "least_gap:=-1"))

    def test_four_calibrations_are_compared_as_documented_and_a_fifth_if_given(self):
        self.train()
        self.connect_board()
        four = [f"{name}:=calibration.h5" for name in ("flat_only", "baseline", "per_curvature", "interpolated")]
        nodes = subprocess.check_output(["roslaunch", "--nodes", "fsr_pressure_map", "compare.launch", *four], text=True)
        self.assertNotIn("calibration_history", nodes)
        compare = self.start_with_board("compare", *four, "history:=calibration.h5", "surface:=cylinder_5cm")
        for topic in ("pressure_map", "flat_only/pressure_map", "baseline/pressure_map", "per_curvature/pressure_map", "history/pressure_map"):
            self.wait_for_maps(compare, f"/fsr/{topic}")
        rospy.wait_for_message("/fsr/history/calibration_info", CalibrationInfo, PATIENCE)


if __name__ == "__main__":
    rospy.init_node("launch_files_test")
    rostest.rosrun("fsr_pressure_map", "launch_files_test", LaunchFilesTest, sys.argv)
