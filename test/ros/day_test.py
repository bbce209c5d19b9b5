#!/usr/bin/python3
"""A whole day at the emulated rig: the shipped launch files, an operator who makes mistakes, and the tools on what was recorded.

Nothing is called between the three launch files and the end of the plan. Rig time runs 20 times as fast as real time.
"""
import os
import pathlib
import signal
import subprocess
import tempfile
import threading
import unittest

import rospkg
import rospy
import rostest
from fsr_pressure_map.msg import Instruction
from rosgraph_msgs.msg import Clock
from std_msgs.msg import String

SURFACES = pathlib.Path(rospkg.RosPack().get_path("fsr_pressure_map")) / "config/surfaces"

PLAN = """
plan: day
order: listed
repeat_first: false
change: 60
conditioning: {cycles: 4, rate: 60000}
rest: {before: 10, after: 10}
surfaces: [{surface: flat}, {surface: cylinder_5cm}]
program:
  - cycles: {peak: 500000, rate: 40000, dwell_peak: 5, dwell_rest: 2, cycles: 5}
"""
# Steps: 1 mount, 2 to 5 conditioning, 6 rest, 7 to 11 cycles, 12 rest; 13 mount, 14 rest, 15 to 19 cycles, 20 rest.
STEPS = {"peak_too_low": 8, "leak": 9, "board_unplugged": 16, "terminal_closed": 18}
REMARKS = ("planned are 500 kPa", "leak", "no reading of the chamber pressure")  # a closed terminal cannot say anything
LINK = "day_port"


class DayTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.home = pathlib.Path(self.folder.name)
        (self.home / "day.yaml").write_text(PLAN)
        self.running, self.remarks, self.mistakes = [], [], ""
        self.over = threading.Event()
        rospy.Subscriber("/fsr/instruction", Instruction, self.hear)
        rospy.Subscriber("/fsr/rig_emulator/mistakes", String, self.count)

    def tearDown(self):
        for one in reversed(self.running):
            one.send_signal(signal.SIGINT)
        for one in self.running:
            one.wait(30)
        self.folder.cleanup()

    def hear(self, instruction):
        if instruction.remark and instruction.remark not in self.remarks:
            self.remarks.append(instruction.remark)
        if instruction.kind == Instruction.DONE:
            self.over.set()

    def count(self, mistakes):
        self.mistakes = mistakes.data

    def launch(self, name, *arguments):
        here = dict(os.environ, PWD=str(self.home))  # as a shell would say it
        self.running.append(subprocess.Popen(["roslaunch", "fsr_pressure_map", name, *arguments], cwd=self.home, env=here))

    def tool(self, *words):
        done = subprocess.run(["rosrun", "fsr_pressure_map", *map(str, words)], cwd=self.home, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=120)
        return done.returncode, done.stdout.decode()

    def test_from_plan_to_calibration(self):
        link = self.home / LINK
        self.launch("rig_emulator.launch", "operator:=true", "time_scale:=20", f"link:={link}", "change:=20",
                    "mistakes:=" + ",".join(f"{name}@{step}" for name, step in STEPS.items()))
        rospy.wait_for_message("/clock", Clock, 30)  # launch files refuse to wait for a clock that nobody publishes
        self.launch("driver.launch", f"serial_port:={link}")
        self.launch("session.launch", "plan:=day.yaml", f"surfaces:={SURFACES}")
        self.assertTrue(self.over.wait(200), f"the session did not end; heard: {self.remarks}")

        for name in STEPS:
            self.assertIn(name, self.mistakes)
        for remark in REMARKS:
            self.assertTrue(any(remark in heard for heard in self.remarks), f"{remark} was not said: {self.remarks}")
        session = self.running.pop()  # the last bag is closed when it ends
        session.send_signal(signal.SIGINT)
        session.wait(30)
        bags = sorted((self.home / "session").glob("*.bag"))
        self.assertEqual([bag.name for bag in bags], ["day_01_flat.bag", "day_02_cylinder_5cm.bag", "day_02_cylinder_5cm_part2.bag"])

        code, text = self.tool("check_bag", *bags)
        self.assertEqual(code, 0, text)
        self.assertIn("conditioning: said by the operator", text)
        code, text = self.tool("train", *bags, "--output", "day.h5")
        self.assertEqual(code, 0, text)
        self.assertTrue((self.home / "day.h5").exists())
        self.assertIn("cylinder_5cm", text)


if __name__ == "__main__":
    rospy.init_node("day_test")
    rostest.rosrun("fsr_pressure_map", "day_test", DayTest)
