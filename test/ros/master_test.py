#!/usr/bin/python3
"""Existing connections do not need the master: a recorder loses nothing while roscore is gone and after it is back."""
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

import rosbag
import rostest
from terminal import PROGRAMS, happens


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class MasterTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.port = free_port()
        self.environment = dict(os.environ, ROS_MASTER_URI=f"http://127.0.0.1:{self.port}", ROS_IP="127.0.0.1")
        self.children = []

    def tearDown(self):
        for child in self.children:
            child.kill()
            child.wait()
        self.folder.cleanup()

    def start(self, *command):
        child = subprocess.Popen(command, env=self.environment, stdout=subprocess.DEVNULL)
        self.children.append(child)
        return child

    def start_master(self):
        master = self.start("rosmaster", "--core", "-p", str(self.port))
        self.wait_for(self.master_answers)
        return master

    def master_answers(self):
        with socket.socket() as probe:
            return probe.connect_ex(("127.0.0.1", self.port)) == 0

    def wait_for(self, condition):
        self.assertTrue(happens(condition, patience=30), "did not happen")

    def test_a_recording_goes_on_without_its_master(self):
        master = self.start_master()
        port = pathlib.Path(self.folder.name) / "board"
        self.start(str(PROGRAMS / "rig_emulator_node"), f"_link:={port}", "_scan_rate:=100")
        self.start(str(PROGRAMS / "driver_node"), f"_serial_port:={port}", "_serial_baud:=0")
        bag = pathlib.Path(self.folder.name) / "recorded.bag"
        recorder = self.start(str(PROGRAMS / "recorder_node"), f"_bag:={bag}", "_topics:=/raw")
        active = pathlib.Path(f"{bag}.active")
        self.wait_for(lambda: active.exists() and active.stat().st_size > 50_000)
        master.kill()
        master.wait()
        gone = time.time()
        size = active.stat().st_size
        self.wait_for(lambda: active.stat().st_size > size + 30_000)
        self.start_master()
        back = time.time()
        size = active.stat().st_size
        self.wait_for(lambda: active.stat().st_size > size + 30_000)
        recorder.send_signal(signal.SIGINT)
        recorder.wait(30)
        with rosbag.Bag(str(bag)) as recorded:
            scans = [(message.sequence, received.to_sec()) for _, message, received in recorded.read_messages("/raw")]
        numbers = [number for number, _ in scans]
        self.assertTrue(any(gone < received < back for _, received in scans), "nothing recorded while the master was gone")
        self.assertTrue(any(received > back for _, received in scans), "nothing recorded after the master came back")
        self.assertEqual(numbers, list(range(numbers[0], numbers[0] + len(numbers))), "a hole")


if __name__ == "__main__":
    rostest.rosrun("fsr_pressure_map", "master_test", MasterTest, sys.argv)
