#!/usr/bin/python3
"""Driver on one machine, calibration on another: two network namespaces with a cable that is cut and connected again."""
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

import rostest
from terminal import PROGRAMS, happens

RIG, STATION = "10.77.13.1", "10.77.13.2"

LISTENER = """
import sys, rospy
from fsr_pressure_map.msg import PressureMap
def keep(map):
    print(map.header.seq, map.state, len(map.pressure), flush=True)
rospy.init_node("listener", anonymous=True)
rospy.Subscriber("/pressure_map", PressureMap, keep)
rospy.spin()
"""


def run(*command):
    subprocess.run(command, check=True, stderr=subprocess.DEVNULL)


class TwoMachinesTest(unittest.TestCase):
    def setUp(self):
        self.children = []
        self.folder = tempfile.TemporaryDirectory()
        tag = str(os.getpid())
        self.rig, self.station = f"fsr_rig_{tag}", f"fsr_station_{tag}"
        self.cable = f"fsrc{tag}"[:14]
        self.made = []
        try:
            for space, address, end in ((self.rig, RIG, "a"), (self.station, STATION, "b")):
                run("ip", "netns", "add", space)
                self.made.append(space)
            run("ip", "link", "add", self.cable + "a", "netns", self.rig, "type", "veth", "peer", "name", self.cable + "b", "netns", self.station)
            for space, address, end in ((self.rig, RIG, "a"), (self.station, STATION, "b")):
                run("ip", "-n", space, "addr", "add", f"{address}/24", "dev", self.cable + end)
                for device in ("lo", self.cable + end):
                    run("ip", "-n", space, "link", "set", device, "up")
        except (subprocess.CalledProcessError, FileNotFoundError):
            self.tearDown()
            why = "network namespaces need root, ip (iproute2) and a kernel that permits them"
            print(f"SKIPPED: {why}", flush=True)
            self.skipTest(why)

    def tearDown(self):
        for child in self.children:
            child.kill()
            child.wait()
        for space in self.made:
            subprocess.run(["ip", "netns", "del", space], stderr=subprocess.DEVNULL, check=False)
        self.made = []
        self.folder.cleanup()

    def start(self, space, address, *command, **options):
        environment = dict(os.environ, ROS_MASTER_URI=f"http://{RIG}:11311", ROS_IP=address)
        child = subprocess.Popen(["ip", "netns", "exec", space, *command], env=environment, **options)
        self.children.append(child)
        return child

    def wait_for(self, condition):
        self.assertTrue(happens(condition), "did not happen")

    def master_answers(self):
        return subprocess.run(["ip", "netns", "exec", self.station, "bash", "-c", f"exec 3<>/dev/tcp/{RIG}/11311"],
                              stderr=subprocess.DEVNULL, check=False).returncode == 0

    def wait_for_silence(self, count):
        """Waits until the count stays the same for a second, in which ten maps would come; returns the count."""
        last, since = count(), time.monotonic()
        def silent():
            nonlocal last, since
            if count() != last:
                last, since = count(), time.monotonic()
            return time.monotonic() - since > 1
        self.wait_for(silent)
        return last

    def test_maps_come_back_after_the_cable(self):
        port = pathlib.Path(self.folder.name) / "board"
        heard = pathlib.Path(self.folder.name) / "heard"
        self.start(self.rig, RIG, "rosmaster", "--core", "-p", "11311")
        self.wait_for(self.master_answers)
        self.start(self.rig, RIG, str(PROGRAMS / "rig_emulator_node"), f"_link:={port}")
        self.start(self.rig, RIG, str(PROGRAMS / "driver_node"), f"_serial_port:={port}", "_serial_baud:=0")
        self.start(self.station, STATION, str(PROGRAMS / "calibration_node"))
        with open(heard, "w", encoding="ascii") as file:
            self.start(self.station, STATION, "/usr/bin/python3", "-c", LISTENER, stdout=file)
        lines = lambda: heard.read_text(encoding="ascii").splitlines()
        self.wait_for(lambda: len(lines()) > 10)
        self.assertTrue(all(line.split()[1] == "1" for line in lines()), "no calibration was given: each map says so")
        run("ip", "-n", self.rig, "link", "set", self.cable + "a", "down")
        during = self.wait_for_silence(lambda: len(lines()))
        run("ip", "-n", self.rig, "link", "set", self.cable + "a", "up")
        self.wait_for(lambda: len(lines()) > during + 20)


if __name__ == "__main__":
    rostest.rosrun("fsr_pressure_map", "two_machines_test", TwoMachinesTest, sys.argv)
