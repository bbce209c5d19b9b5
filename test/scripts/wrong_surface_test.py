#!/usr/bin/python3
"""The demo's part with the wrong surface file, with its nodes and launch files, on a small sheet. Needs the environment of the devel space."""
import argparse
import os
import pathlib
import sys
import tempfile
import unittest

import rosbag
import yaml

sys.dont_write_bytecode = True
PACKAGE = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(PACKAGE / "scripts"))
import demo_run  # noqa: E402
import demo_shape  # noqa: E402
from demo_tools import process, run_tool, wait_until  # noqa: E402

RADII = {"flat": 0, "cylinder_13cm": 0.13, "cylinder_9cm": 0.09, "cylinder_7cm": 0.07, "cylinder_5cm": 0.05}  # [m]; 0 = flat
CYCLES = [{"cycles": {"peak": 620e3, "rate": 120e3, "dwell_peak": 1, "dwell_rest": 1, "cycles": 3}}]
UNDER_LOAD = 20e3  # the chamber at which a bag of training begins [Pa]
LIMIT = 120  # for the cycles [s]


def station(name, radius):
    bend = {"cylinder": {"radius": radius, "axis": "y"}} if radius else {"flat": True}
    return {"surface": name, **bend, "program": CYCLES}


def without_rest(bag, target):
    """The mounts at rest are recorded before the first load, as in the demo; the sheet rests otherwise after one."""
    with rosbag.Bag(str(bag)) as source, rosbag.Bag(str(target), "w") as copy:
        begin = next(time for _, message, time in source.read_messages(topics=["/fsr/chamber_pressure"])
                     if message.fluid_pressure > 101325 + UNDER_LOAD)
        for topic, message, time in source.read_messages():
            if time >= begin or topic not in ("/fsr/raw", "/fsr/chamber_pressure"):
                copy.write(topic, message, time)
    return target


class WrongSurface(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.output = pathlib.Path(temporary.name)
        cls.logs = cls.output / "logs"
        cls.logs.mkdir()
        port = demo_run.free_port()
        os.environ.update(ROS_MASTER_URI=f"http://127.0.0.1:{port}", ROS_IP="127.0.0.1", ROS_HOME=str(cls.output / "ros_home"),
                          ROS_LOG_DIR=str(cls.logs / "ros"))
        demo_run.SIMULATION = cls.output / "small.yaml"
        rig = yaml.safe_load((PACKAGE / "config/simulation/demo.yaml").read_text())
        rig["matrix"].update(rows=5, columns=6)
        rig["session"] = [station(*surface) for surface in RADII.items()]
        demo_run.SIMULATION.write_text(yaml.safe_dump(rig, sort_keys=False))
        cls.run_demo(port)

    @classmethod
    def run_demo(cls, port):
        run_tool(cls.logs / "simulate.log", "simulate", "--simulation", demo_run.SIMULATION, "--seed", "1", "--output", cls.output / "simulated")
        bags = [without_rest(bag, cls.output / bag.name) for bag in sorted((cls.output / "simulated").glob("*.bag"))]
        board = cls.output / "board"
        arguments = argparse.Namespace(time_scale=30.0, seed=1, live_cycles=1)
        with process(["roscore", "-p", str(port)], cls.logs / "roscore.log") as core:
            import rosgraph
            wait_until(rosgraph.is_master_online, core, "roscore", cls.logs / "roscore.log")
            with process(["roslaunch", "fsr_pressure_map", "demo.launch", f"link:={board}", "time_scale:=30", "seed:=1",
                          f"simulation:={demo_run.SIMULATION}", "autostart:=false"], cls.logs / "rig.log"):
                rig = demo_run.Rig(cls.logs)
                mounts = demo_shape.record_mounts(rig, list(RADII), cls.output / "mounts")
            cls.answers, cls.rows, cls.live = demo_run.run_mistake(rig, arguments, board, mounts, bags, cls.output, cls.logs, LIMIT)

    def test_the_check_finds_the_wrong_file_and_agrees_with_the_true_one(self):
        self.assertEqual(demo_shape.complaints(self.answers, self.rows), [])
        self.assertIn("the sheet rests as on 5.", self.answers["check"].sentence)
        self.assertIn("but the surface file says cylinder_9cm", self.answers["check"].sentence)
        self.assertIn("agrees with cylinder_5cm", self.answers["check_true"].sentence)

    def test_the_estimate_is_nearly_as_good_as_the_truth(self):
        self.assertIn("it is used from now on", self.answers["estimate"].sentence)
        self.assertAlmostEqual(self.rows["estimated"].curvature, 20, delta=1)
        self.assertGreater(self.rows["estimated"].deviation, 0)
        wrong, estimated, true = (self.rows[use].score["rmse_kpa"] for use in ("wrong", "estimated", "true"))
        self.assertGreater(wrong, 1.5 * true)
        self.assertLess(estimated, 1.1 * true)

    def test_the_rows_have_the_same_readings_and_the_estimated_one_is_the_live_map(self):
        self.assertEqual(len({row.score["scans"] for row in self.rows.values()}), 1)
        self.assertEqual({row.score["missing"] for row in self.rows.values()}, {0})
        self.assertAlmostEqual(self.rows["estimated"].score["rmse_kpa"], self.live, delta=0.01 * self.live)

    def test_the_table_can_be_computed_again(self):
        rows, live = demo_shape.errors(self.output / "shape", self.output / "shape.h5", self.logs)
        self.assertEqual(demo_shape.table(rows, live, self.output), demo_shape.table(self.rows, self.live, self.output))


if __name__ == "__main__":
    sys.exit(unittest.main(warnings="ignore"))  # rospy leaves sockets open
