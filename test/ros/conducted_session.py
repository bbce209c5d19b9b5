"""What the tests of whole sessions share: emulated rig and operator, the shipped launch files of driver and session, 20 times as fast
as real time."""
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import threading
import unittest

import rospkg
import rospy
from fsr_pressure_map.msg import Instruction
from rosgraph_msgs.msg import Clock

SURFACES = pathlib.Path(rospkg.RosPack().get_path("fsr_pressure_map")) / "config/surfaces"


class ConductedSession(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.home = pathlib.Path(self.folder.name)
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

    def start(self, *command):
        here = dict(os.environ, PWD=str(self.home))  # as a shell would say it
        self.running.append(subprocess.Popen([*map(str, command)], cwd=self.home, env=here))

    def conduct(self, plan, mistakes, remarks, rig=(), session=()):
        """From the first step to the last. `running` is rig, driver and session then. The remarks (patterns) must have been
        said."""
        (self.home / "plan.yaml").write_text(plan)
        rospy.set_param("/use_sim_time", True)
        link = self.home / "port"
        self.start("rosrun", "fsr_pressure_map", "clumsy_rig_node", "__ns:=fsr", "_operator:=true", "_change:=20", "_time_scale:=20",
                   f"_link:={link}", f"_mistakes:={mistakes}", *rig)
        rospy.wait_for_message("/clock", Clock, 30)  # launch files refuse to wait for a clock that nobody publishes
        self.start("roslaunch", "fsr_pressure_map", "driver.launch", f"serial_port:={link}")
        self.start("roslaunch", "fsr_pressure_map", "session.launch", "plan:=plan.yaml", f"surfaces:={SURFACES}", *session)
        self.assertTrue(self.over.wait(200), f"the session did not end; heard: {self.remarks}")
        for remark in remarks:
            self.assertTrue(any(re.search(remark, heard) for heard in self.remarks), f"{remark} was not said: {self.remarks}")
