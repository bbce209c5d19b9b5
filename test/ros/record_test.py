#!/usr/bin/python3
"""record.launch writes bags that can be understood without other files and lose at most the last second on kill -9."""
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

import rosbag
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from fsr_pressure_map.msg import MatrixFrame, MatrixInfo
from terminal import happens, pid_of

SLOW = 10.0   # [Hz], as in the paper: the slowest stream, whose chunk stays open longest
FAST = 200.0  # [Hz], where it does not matter
SCANS = 40
# Bytes that the sockets between publisher and recorder may hold.
SOCKET_BYTES = sum(int(pathlib.Path(f"/proc/sys/net/ipv4/{name}").read_text().split()[2]) for name in ("tcp_rmem", "tcp_wmem"))


class Recorder:
    """Runs `roslaunch record.launch` with its own bag."""

    def __init__(self, folder, *arguments):
        self.bag = pathlib.Path(folder) / "recorded"
        self.launch = subprocess.Popen(
            ["roslaunch", "fsr_pressure_map", "record.launch", f"bag:={self.bag}", "surface:=cylinder_7cm",
             "subject:=S012", "trial:=2", *arguments])



class RecordTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.scans = rospy.Publisher("/fsr/raw", MatrixFrame, queue_size=100)
        self.info = rospy.Publisher("/fsr/matrix_info", MatrixInfo, queue_size=10, latch=True)
        self.info.publish(MatrixInfo(serial="FSR-0001", rows=7, columns=10, full_scale=4095))
        self.recorder = None
        self.mounted = None

    def record(self, folder=None, *arguments):
        self.recorder = Recorder(folder or self.folder.name, *arguments)
        self.wait_for(lambda: self.scans.get_num_connections() > 0 and self.info.get_num_connections() > 0)

    def tearDown(self):
        if self.recorder and self.recorder.launch.poll() is None:
            self.recorder.launch.send_signal(signal.SIGINT)
        if self.recorder:
            self.recorder.launch.wait(30)
        if self.mounted:
            subprocess.run(["umount", "-l", str(self.mounted)], check=True)
        self.folder.cleanup()

    def wait_for(self, condition):
        self.assertTrue(happens(condition, ended=lambda: self.recorder.launch.poll() is not None, patience=30), "the recorder did not come up")

    def publish_scans(self, scan_rate=FAST):
        """Returns the stamps published [s]."""
        rate = rospy.Rate(scan_rate)
        stamps = []
        for i in range(SCANS):
            frame = MatrixFrame(sequence=i, rows=7, columns=10, full_scale=4095, counts=[i] * 70)
            frame.header.stamp = rospy.Time.now()
            self.scans.publish(frame)
            stamps.append(frame.header.stamp.to_sec())
            rate.sleep()
        return stamps

    def scans_on_disk(self):
        """The scans that would be left after a kill -9 now."""
        copy = pathlib.Path(self.folder.name) / "so_far.bag"
        shutil.copy(f"{self.recorder.bag}.bag.active", copy)
        with rosbag.Bag(str(copy), "a", allow_unindexed=True) as bag:
            for _ in bag.reindex():
                pass
        return [message for topic, message in self.recorded(copy) if topic == "/fsr/raw"]

    def wait_until_written(self, count):
        """Publishes until the first `count` scans are in the file."""
        for i in range(count, count + 600):
            if len(self.scans_on_disk()) >= count:
                return
            self.scans.publish(MatrixFrame(sequence=i, rows=7, columns=10, full_scale=4095, counts=[i] * 70))
            rospy.sleep(0.05)
        self.fail("the scans were not written within 30 s")

    def recorded(self, path):
        with rosbag.Bag(str(path)) as bag:
            return [(topic, message) for topic, message, _ in bag.read_messages()]

    def small_disk(self, size):
        """A folder on a file system of that size. The test is skipped with a message if the kernel forbids it."""
        folder = pathlib.Path(self.folder.name) / "small"
        folder.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none", str(folder)], stderr=subprocess.DEVNULL).returncode:
            print("SKIPPED: a small file system can be mounted by root alone", flush=True)
            self.skipTest("a small file system can be mounted by root alone")
        self.mounted = folder
        return folder

    def publish_until_the_launch_ends(self, scans):
        written = pathlib.Path(f"{self.recorder.bag}.bag.active")
        size = lambda: written.stat().st_size if written.exists() else 0  # closed at the end
        for i in range(scans):
            frame = MatrixFrame(sequence=i, rows=32, columns=32, full_scale=4095, counts=[i % 4096] * 1024)
            frame.header.stamp = rospy.Time.now()
            self.scans.publish(frame)
            # Fewer scans in transit than any queue holds, so that only the disk can lose a scan.
            for _ in range(600):
                if self.recorder.launch.poll() is not None or size() > 2048 * (i - 50):
                    break
                rospy.sleep(0.05)
        self.recorder.launch.wait(30)

    def check_without_hole(self, bag, least):
        kept = [m.sequence for topic, m in self.recorded(bag) if topic == "/fsr/raw"]
        self.assertGreater(len(kept), least)
        self.assertEqual(kept, list(range(kept[0], kept[0] + len(kept))), "a hole before the end")

    def test_one_bag_holds_two_sheets_and_says_where_they_are_one_board(self):
        other, info = (rospy.Publisher(f"/other/{name}", kind, queue_size=100, latch=True) for name, kind in (("raw", MatrixFrame), ("matrix_info", MatrixInfo)))
        info.publish(MatrixInfo(serial="FSR-0001", rows=7, columns=10, full_scale=4095))
        other.publish(MatrixFrame(rows=7, columns=10, full_scale=4095, counts=[1] * 70))
        complaints = []
        subscriber = rospy.Subscriber("/diagnostics", DiagnosticArray, lambda array: complaints.extend(
            status.message for status in array.status if status.level == DiagnosticStatus.ERROR))
        self.record(None, "sheets:=fsr other")
        self.publish_scans()
        self.wait_for(lambda: any("/fsr and /other have the same serial number, FSR-0001: give each sheet" in one for one in complaints))
        subscriber.unregister()
        self.recorder.launch.send_signal(signal.SIGINT)
        self.recorder.launch.wait(30)
        topics = {topic for topic, _ in self.recorded(f"{self.recorder.bag}.bag")}
        self.assertLessEqual({"/fsr/raw", "/other/raw", "/fsr/matrix_info", "/other/matrix_info", "/fsr/session"}, topics)

    def test_a_disk_that_fills_ends_the_launch_with_a_closed_bag(self):
        self.record(self.small_disk("2m"), "min_space:=1")
        self.publish_until_the_launch_ends(800)  # half of them are more than the disk may take
        self.assertFalse(pathlib.Path(f"{self.recorder.bag}.bag.active").exists())
        self.check_without_hole(f"{self.recorder.bag}.bag", 300)

    def test_a_full_disk_ends_the_launch_and_leaves_what_was_written(self):
        self.record(self.small_disk("400k"), "min_space:=0")
        self.publish_until_the_launch_ends(400)  # twice the capacity of the disk
        rescued = pathlib.Path(self.folder.name) / "rescued.bag"  # on a disk with enough space for the index
        shutil.copy(f"{self.recorder.bag}.bag.active", f"{rescued}.active")
        subprocess.run(["rosrun", "fsr_pressure_map", "close_bag", f"{rescued}.active"], check=True)
        self.check_without_hole(rescued, 100)

    def test_what_a_recorder_that_lags_behind_loses_shows_as_a_gap(self):
        self.record()
        self.publish_scans()
        pid = pid_of("/fsr/record")
        os.kill(pid, signal.SIGSTOP)  # stands for a disk that writes nothing for a while
        scan = MatrixFrame(rows=128, columns=128, full_scale=4095, counts=[1] * 128 ** 2)
        sent = list(range(SCANS, SCANS + 200 + SOCKET_BYTES // (2 * len(scan.counts))))  # 200: more than any queue
        for i in sent:
            scan.sequence = i
            self.scans.publish(scan)
            rospy.sleep(0.0005)
        size = os.path.getsize(f"{self.recorder.bag}.bag.active")
        os.kill(pid, signal.SIGCONT)
        self.wait_for(lambda: os.path.getsize(f"{self.recorder.bag}.bag.active") > size)
        self.recorder.launch.send_signal(signal.SIGINT)
        self.recorder.launch.wait(30)
        kept = [m.sequence for topic, m in self.recorded(f"{self.recorder.bag}.bag") if topic == "/fsr/raw"]
        self.assertEqual(kept, sorted(set(kept)), "no scan twice, none out of order")
        self.assertLess(len(kept), SCANS + len(sent), "the counter tells the loss")

    def test_kill_loses_at_most_the_last_second(self):
        self.record()
        stamps = self.publish_scans(SLOW)
        # The recorder catches up, however late it is; with larger chunks it would not.
        self.wait_for(lambda: stamps[-1] - self.scans_on_disk()[-1].header.stamp.to_sec() < 1.0)
        os.kill(pid_of("/fsr/record"), signal.SIGKILL)
        self.recorder.launch.wait(30)  # the launch ends with its recorder
        active = pathlib.Path(f"{self.recorder.bag}.bag.active")
        subprocess.run(["rosbag", "reindex", str(active)], check=True, stdout=subprocess.DEVNULL)
        kept = [m.header.stamp.to_sec() for topic, m in self.recorded(active) if topic == "/fsr/raw"]
        self.assertGreater(len(kept), 0)
        self.assertLess(stamps[-1] - kept[-1], 1.0)
        self.assertEqual(len(kept), sum(stamp <= kept[-1] + 1e-6 for stamp in stamps), "a hole before the kill")

    def end_node(self, bag, with_signal, full=False):
        """Records without a launch file, then ends the node. Returns its status and error output."""
        node = subprocess.Popen(["rosrun", "fsr_pressure_map", "recorder_node", "__name:=closing", f"_bag:={bag}",
                                 "_topics:=/fsr/raw", "_min_space:=0"], stderr=subprocess.PIPE, text=True,
                                preexec_fn=lambda: signal.signal(signal.SIGXFSZ, signal.SIG_IGN))
        self.addCleanup(node.stderr.close)
        active = pathlib.Path(f"{bag}.active")
        for i in range(600):  # until some scans are in the file
            self.scans.publish(MatrixFrame(sequence=i, rows=32, columns=32, full_scale=4095, counts=[i] * 1024))
            if active.exists() and active.stat().st_size > 20000:
                break
            rospy.sleep(0.05)
        pid = pid_of("/closing")
        if full:  # the file cannot grow from now on, as on a full disk
            resource.prlimit(pid, resource.RLIMIT_FSIZE, (active.stat().st_size,) * 2)
        os.kill(pid, with_signal)
        said = node.communicate(timeout=60)[1]
        return node.returncode, said

    def test_kill_and_a_closed_terminal_leave_a_closed_bag(self):
        for with_signal in (signal.SIGTERM, signal.SIGHUP):
            bag = pathlib.Path(self.folder.name) / f"{with_signal.name}.bag"
            status, said = self.end_node(bag, with_signal)
            self.assertEqual(status, 0, said)
            self.assertFalse(pathlib.Path(f"{bag}.active").exists())
            self.assertGreater(len(self.recorded(bag)), 5)

    def test_a_disk_that_is_full_when_the_bag_is_closed_ends_with_an_error(self):
        bag = pathlib.Path(self.folder.name) / "full.bag"
        status, said = self.end_node(bag, signal.SIGTERM, full=True)
        self.assertEqual(status, 1, said)
        self.assertIn("NOT CLOSED", said)
        self.assertFalse(bag.exists())
        self.assertIn("then run: ", said)
        command = said.split("then run: ")[1].splitlines()[0]
        subprocess.run(command.split(), check=True)  # as a person types it, once there is room
        self.check_without_hole(bag, 5)
        self.assertIn(f"its {len(self.recorded(bag))} messages are whole", said)

    def test_a_start_closes_what_a_killed_recorder_left(self):
        bag = pathlib.Path(self.folder.name) / "killed.bag"
        self.end_node(bag, signal.SIGKILL)
        self.assertTrue(pathlib.Path(f"{bag}.active").exists())
        again = subprocess.run(["rosrun", "fsr_pressure_map", "recorder_node", f"_bag:={bag}", "_topics:=/fsr/raw"],
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60)
        self.assertNotEqual(again.returncode, 0)
        self.assertIn(f"the recording that had not been closed was closed as {bag}", again.stdout)
        self.check_without_hole(bag, 5)

    def test_a_bag_can_be_understood_alone(self):
        self.record()
        self.publish_scans()
        self.wait_until_written(SCANS)
        self.recorder.launch.send_signal(signal.SIGINT)
        self.recorder.launch.wait(30)
        messages = self.recorded(f"{self.recorder.bag}.bag")
        last = dict(messages)
        self.assertEqual(last["/fsr/session"].subject_code, "S012")
        self.assertEqual(last["/fsr/session"].trial, "2")
        self.assertEqual(last["/fsr/curvature"].surface, "cylinder_7cm")
        self.assertEqual(last["/fsr/matrix_info"].serial, "FSR-0001")
        scans = [message.sequence for topic, message in messages if topic == "/fsr/raw"]
        self.assertEqual(scans[:SCANS], list(range(SCANS)))


if __name__ == "__main__":
    rospy.init_node("record_test")
    rostest.rosrun("fsr_pressure_map", "record_test", RecordTest, sys.argv)
