#!/usr/bin/python3
"""Follows docs/first_hour.md and docs/first_week.md: their own commands, in their order, on the emulated board.

The person at the rig is played here: puts the sheet on the surface that a recording names, runs chamber cycles, ends a
recording with Ctrl-C. Only what depends on the place is changed in a command: the port, and rviz.
"""
import contextlib
import os
import pathlib
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import unittest

import rosgraph
import rospy
import rostest
from fsr_pressure_map.msg import PressureMap
from fsr_pressure_map.srv import SetSurface
from std_msgs.msg import String
from std_srvs.srv import Trigger
from terminal import happens

DOCS = pathlib.Path(__file__).resolve().parent.parent.parent / "docs"
STAYS = ("driver.launch", "calibrated.launch", "replay.launch")  # runs until the next of them
CYCLES = 4
RIG = """simulation: week
seed: 4
matrix: {rows: 4, columns: 5, pitch_x: 0.010, pitch_y: 0.010}
chamber: {peak: 500000, rate: 100000, dwell_peak: 2, dwell_rest: 4, cycles: 4}
effects:
  static_curve: {conductance: 3.0e-4, reference_pressure: 620000, exponent: 0.9, saturation_pressure: 1.2e6}
  bending_preload: {amplitude: 34000, curvature_constant: 3.0}
  hysteresis: {loop_width: 0.05, span: 500000, reach: 120000}
  white_noise: {absolute: 4}
  converter: {full_scale: 4095, feedback_resistance: 3600}
"""


def commands_of(document, heading):
    """The commands of the code blocks below a heading, with continued lines joined."""
    text = (DOCS / document).read_text()
    text = text[text.index(heading):].replace("\\\n", " ")
    found = re.findall(r"^ {4,}((?:roslaunch|rosrun|rostopic|mkdir) .*)$", text, re.MULTILINE)
    return [line.strip() for line in found]


class Documents(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "rig.yaml").write_text(RIG)
        self.environment = dict(os.environ, ROS_HOME=str(self.folder / "ros_home"), PWD=str(self.folder))
        self.stays = None
        self.addCleanup(self.end_what_stays)
        self.status = ""
        self.emulator = self.start(["roslaunch", "fsr_pressure_map", "rig_emulator.launch", "link:=%s" % self.port(),
                                    "simulation:=%s" % (self.folder / "rig.yaml"), "time_scale:=25", "autostart:=false"])
        self.addCleanup(self.end, self.emulator)
        rospy.Subscriber("/fsr/rig_emulator/status", String, self.on_status)
        rospy.wait_for_service("/fsr/rig_emulator/set_surface", 60)
        self.put_on = rospy.ServiceProxy("/fsr/rig_emulator/set_surface", SetSurface)
        self.start_cycles = rospy.ServiceProxy("/fsr/rig_emulator/start", Trigger)

    def port(self):
        return self.folder / "board"

    def on_status(self, message):
        self.status = message.data

    def start(self, words):
        log = open(self.folder / ("%d.log" % len(list(self.folder.glob("*.log")))), "w")
        self.addCleanup(log.close)
        return subprocess.Popen(words, env=self.environment, cwd=self.folder, stdout=log, stderr=subprocess.STDOUT)

    def end(self, child):
        if child.poll() is None:
            child.send_signal(signal.SIGINT)
        with contextlib.suppress(subprocess.TimeoutExpired):
            child.wait(30)
            return
        child.kill()
        self.fail("%s did not end on Ctrl-C" % child.args)

    def end_what_stays(self):
        if self.stays:
            self.end(self.stays)
        self.stays = None

    def wait_for(self, condition, what, child=None):
        if happens(condition, ended=lambda: child and child.poll() is not None):
            return
        logs = "\n".join(path.read_text()[-1500:] for path in sorted(self.folder.glob("*.log")))
        self.fail("%s did not happen\n%s" % (what, logs))

    def listens(self, node, topic):
        return node in dict(rosgraph.Master("/documents").getSystemState()[1]).get(topic, [])

    def follow(self, command):
        words = shlex.split(command.replace("/dev/serial/by-id/usb-...", str(self.port())).replace(" viz:=true", ""))
        if "*" in command:
            words = [word for pattern in words for word in (self.matching(pattern) if "*" in pattern else [pattern])]
        if words[:1] == ["roslaunch"]:
            self.launch(words)
        else:
            self.run_to_its_end(words + (["-n", "1"] if words[0] == "rostopic" else []))

    def matching(self, pattern):
        found = sorted(str(path.relative_to(self.folder)) for path in self.folder.glob(pattern))
        self.assertTrue(found, "%s matches nothing" % pattern)
        return found

    def launch(self, words):
        if words[2] == "record.launch":
            return self.record(words)
        self.assertIn(words[2], STAYS)
        self.end_what_stays()
        if words[2] != "replay.launch" and not any(word.startswith("serial_port") for word in words):
            words.append("serial_port:=%s" % self.port())
        self.stays = self.start(words)
        if words[2] != "driver.launch":
            rospy.wait_for_message("/fsr/pressure_map", PressureMap, 60)

    def record(self, words):
        arguments = dict(word.split(":=", 1) for word in words if ":=" in word)
        surface = arguments.get("surface")
        if surface:
            self.assertTrue(self.put_on(surface, int(arguments["mount"])).success)
        recorder = self.start(words)
        self.wait_for(lambda: self.listens("/fsr/record", "/fsr/raw") and self.listens("/fsr/record", "/fsr/chamber_pressure"),
                      "recording", recorder)
        self.status = ""
        self.assertTrue(self.start_cycles().success)
        self.wait_for(lambda: self.status.startswith("done"), "the end of the cycles", recorder)
        self.end(recorder)
        self.assertEqual(recorder.returncode, 0)
        self.assertTrue((self.folder / (arguments["bag"] + ".bag")).exists(), arguments["bag"])

    def run_to_its_end(self, words):
        done = subprocess.run(words, env=self.environment, cwd=self.folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.said = done.stdout
        self.assertEqual(done.returncode, 0, "%s\n%s" % (shlex.join(words), done.stdout[-2000:]))

    def test_first_hour(self):
        commands = commands_of("first_hour.md", "## Your own rig")
        self.assertGreaterEqual(len(commands), 8)
        for command in commands:
            if "new_cycles.bag" in command:  # the page says to record them, with the command of step 2
                self.follow("roslaunch fsr_pressure_map driver.launch serial_port:=/dev/serial/by-id/usb-...")
                self.follow("roslaunch fsr_pressure_map record.launch bag:=new_cycles surface:=cylinder_7cm mount:=3")
            self.follow(command)
        self.assertRegex(self.said, "Still good|Recalibrate")

    def test_first_week(self):
        commands = commands_of("first_week.md", "# First week")
        self.assertGreaterEqual(len(commands), 11)
        self.follow("roslaunch fsr_pressure_map driver.launch serial_port:=/dev/serial/by-id/usb-...")
        said = {}
        for command in commands:
            self.follow(command)
            if command.startswith("rosrun"):
                said[command.split()[2] + (" --confirm" if "--confirm" in command else "")] = self.said
        self.assertRegex(said["discrepancy"], "hysteresis")
        self.assertRegex(said["discrepancy --confirm"], "confirmed")
        self.assertIn("no reference: accuracy not assessed", said["check_bag"])


if __name__ == "__main__":
    rospy.init_node("documents_test", disable_signals=True)
    rostest.rosrun("fsr_pressure_map", "documents_test", Documents, sys.argv)
