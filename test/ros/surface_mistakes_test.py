#!/usr/bin/python3
"""The sheet slips off, and later lies on another surface than was asked for: the session notices both from the readings.

The shipped launch files of driver and session; the emulated operator makes the mistakes. Rig time runs 20 times as fast
as real time.
"""
import os
import pathlib
import signal
import subprocess
import tempfile
import threading
import unittest

import rosbag
import rospkg
import rospy
import rostest
from fsr_pressure_map.msg import Instruction
from rosgraph_msgs.msg import Clock

SURFACES = pathlib.Path(rospkg.RosPack().get_path("fsr_pressure_map")) / "config/surfaces"
BENCH = SURFACES.parent / "simulation/bench.yaml"  # where a surface reads alike each time
PLAN = """
plan: rounds
order: listed
repeat_first: false
change: 60
conditioning: {cycles: 2, rate: 60000}
rest: {before: 5, after: 0}
surfaces: [{surface: flat, mounts: 3}, {surface: cylinder_5cm, mounts: 3}]
program:
  - cycles: {peak: 500000, rate: 80000, dwell_peak: 2, dwell_rest: 2, cycles: 2}
"""
# Steps: 1 mount, 2 and 3 conditioning, 4 rest, 5 and 6 cycles; mount n from the second on: 4 n - 1 mount, rest, two cycles.
MISTAKES = "sheet_off@10,repeat_surface@23"


class SurfaceMistakesTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.home = pathlib.Path(self.folder.name)
        (self.home / "rounds.yaml").write_text(PLAN)
        self.running, self.remarks, self.over = [], [], threading.Event()
        rospy.Subscriber("/fsr/instruction", Instruction, self.hear)

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

    def launch(self, name, *arguments):
        here = dict(os.environ, PWD=str(self.home))  # as a shell would say it
        self.running.append(subprocess.Popen(["roslaunch", "fsr_pressure_map", name, *arguments], cwd=self.home, env=here))

    def start_rig(self, link, mistakes, *parameters):
        rospy.set_param("/use_sim_time", True)
        self.running.append(subprocess.Popen(["rosrun", "fsr_pressure_map", "clumsy_rig_node", "__ns:=fsr", "_operator:=true", "_change:=20",
                                              "_time_scale:=20", f"_link:={link}", f"_mistakes:={mistakes}", *parameters]))

    def test_the_readings_tell(self):
        port = self.home / "port"
        self.start_rig(port, MISTAKES, f"_simulation:={BENCH}")
        rospy.wait_for_message("/clock", Clock, 30)  # launch files refuse to wait for a clock that nobody publishes
        self.launch("driver.launch", f"serial_port:={port}")
        self.launch("session.launch", "plan:=rounds.yaml", f"surfaces:={SURFACES}", "report:=false")
        self.assertTrue(self.over.wait(200), f"the session did not end; heard: {self.remarks}")
        for remark in ("sheet", "mount 6 reads like flat"):
            self.assertTrue(any(remark in heard for heard in self.remarks), f"{remark} was not said: {self.remarks}")

        conductor = self.running.pop()
        conductor.send_signal(signal.SIGINT)  # the last bag is closed at the latest then
        conductor.wait(60)
        # The mount on the wrong surface is set aside; the one that follows is complete and of the right surface.
        session = self.home / "session"
        self.assertEqual(len(list(session.glob("rounds_*.bag"))), 6)
        self.assertTrue(list((session / "set_aside").glob("rounds_06_cylinder_5cm*")))
        last = next(session.glob("rounds_06_cylinder_5cm*.bag"))
        with rosbag.Bag(str(last)) as bag:
            labels = [message.label for _, message, _ in bag.read_messages("/fsr/events")]
        self.assertEqual(sum("accepted" in label and "cycle" in label for label in labels), 2, labels)


if __name__ == "__main__":
    rospy.init_node("surface_mistakes_test")
    rostest.rosrun("fsr_pressure_map", "surface_mistakes_test", SurfaceMistakesTest)
