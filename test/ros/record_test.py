#!/usr/bin/python3
"""record.launch makes bags that can be understood alone and lose at most the last second on kill -9."""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest
import xmlrpc.client

import rosbag
import rosgraph
import rospy
import rostest
from fsr_pressure_map.msg import MatrixFrame, MatrixInfo

SCAN_RATE = 10.0  # [Hz], the paper's: the slowest stream, so the one whose chunk stays open longest
SCANS = 40


class Recorder:
    """`roslaunch record.launch` with a bag of its own."""

    def __init__(self, folder):
        self.bag = pathlib.Path(folder) / "recorded"
        self.launch = subprocess.Popen(
            ["roslaunch", "fsr_pressure_map", "record.launch", f"bag:={self.bag}", "surface:=cylinder_7cm",
             "subject:=S012", "trial:=2"])

    def pid(self):
        uri = rosgraph.Master("/record_test").lookupNode("/fsr/record")
        return xmlrpc.client.ServerProxy(uri).getPid("/record_test")[2]


class RecordTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.scans = rospy.Publisher("/fsr/raw", MatrixFrame, queue_size=100)
        self.info = rospy.Publisher("/fsr/matrix_info", MatrixInfo, queue_size=10, latch=True)
        self.info.publish(MatrixInfo(serial="FSR-0001", rows=7, columns=10, full_scale=4095))
        self.recorder = Recorder(self.folder.name)
        self.wait_for(lambda: self.scans.get_num_connections() > 0 and self.info.get_num_connections() > 0)

    def tearDown(self):
        if self.recorder.launch.poll() is None:
            self.recorder.launch.send_signal(signal.SIGINT)
        self.recorder.launch.wait(30)
        self.folder.cleanup()

    def wait_for(self, condition):
        for _ in range(600):
            if condition():
                return
            self.assertIsNone(self.recorder.launch.poll(), "record.launch ended by itself")
            rospy.sleep(0.05)
        self.fail("the recorder did not come up within 30 s")

    def publish_scans(self):
        """Returns the stamps published [s]."""
        rate = rospy.Rate(SCAN_RATE)
        stamps = []
        for i in range(SCANS):
            frame = MatrixFrame(sequence=i, rows=7, columns=10, full_scale=4095, counts=[i] * 70)
            frame.header.stamp = rospy.Time.now()
            self.scans.publish(frame)
            stamps.append(frame.header.stamp.to_sec())
            rate.sleep()
        return stamps

    def recorded(self, path):
        with rosbag.Bag(str(path)) as bag:
            return [(topic, message) for topic, message, _ in bag.read_messages()]

    def test_kill_loses_at_most_the_last_second(self):
        stamps = self.publish_scans()
        os.kill(self.recorder.pid(), signal.SIGKILL)
        self.recorder.launch.wait(30)  # the launch ends with its recorder
        active = pathlib.Path(f"{self.recorder.bag}.bag.active")
        subprocess.run(["rosbag", "reindex", str(active)], check=True, stdout=subprocess.DEVNULL)
        kept = [m.header.stamp.to_sec() for topic, m in self.recorded(active) if topic == "/fsr/raw"]
        self.assertGreater(len(kept), 0)
        self.assertLess(stamps[-1] - kept[-1], 1.0)
        self.assertEqual(len(kept), sum(stamp <= kept[-1] + 1e-6 for stamp in stamps), "a hole before the kill")

    def test_a_bag_can_be_understood_alone(self):
        self.publish_scans()
        self.recorder.launch.send_signal(signal.SIGINT)
        self.recorder.launch.wait(30)
        messages = self.recorded(f"{self.recorder.bag}.bag")
        last = dict(messages)
        self.assertEqual(last["/fsr/session"].subject_code, "S012")
        self.assertEqual(last["/fsr/session"].trial, "2")
        self.assertEqual(last["/fsr/curvature"].surface, "cylinder_7cm")
        self.assertEqual(last["/fsr/matrix_info"].serial, "FSR-0001")
        self.assertEqual(sum(topic == "/fsr/raw" for topic, _ in messages), SCANS)


if __name__ == "__main__":
    rospy.init_node("record_test")
    rostest.rosrun("fsr_pressure_map", "record_test", RecordTest, sys.argv)
