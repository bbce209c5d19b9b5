#!/usr/bin/python3
"""The firmware of firmware/ on a simulated board behind a pseudo-terminal: real driver, recorder, training and map."""
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
from fsr_pressure_map.msg import MatrixFrame, PressureMap
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import FluidPressure

SOURCE = pathlib.Path(rospkg.RosPack().get_path("fsr_pressure_map"))
AMBIENT = 101325  # [Pa], which the driver adds
CYCLE = 6.0  # of the chamber [s]


def program(name):
    found = subprocess.run(["catkin_find", "--first-only", "--libexec", "fsr_pressure_map", name], capture_output=True, text=True)
    return found.stdout.strip()


class Board:
    """The simulated board. Its time is published as /clock, behind `since` [s]."""

    def __init__(self, firmware, port, surface, since, clock):
        self.since = since
        self.now = since
        self.clock = clock
        self.process = subprocess.Popen(
            [program("avr_board"), firmware, "--simulation", SOURCE / "test/firmware/rig.yaml", "--surface",
             SOURCE / f"config/surfaces/{surface}.yaml", "--serial", "FSR-0042", "--link", port, "--pace", "2", "--clock", "yes"],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.thread = threading.Thread(target=self.publish, daemon=True)
        self.thread.start()

    def publish(self):
        for line in self.process.stdout:
            try:
                self.now = self.since + float(line)
            except ValueError:
                continue  # the simulator says what it loads
            self.clock.publish(Clock(rospy.Time.from_sec(self.now)))

    def stop(self):
        self.process.terminate()
        self.process.wait()
        self.thread.join()


class FirmwareTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = pathlib.Path(cls.folder.name)
        subprocess.run(["make", "-C", SOURCE / "firmware", f"OUT={cls.path}"], check=True, stdout=subprocess.DEVNULL)
        cls.clock = rospy.Publisher("/clock", Clock, queue_size=1000)
        cls.port = rospy.get_param("~port")
        cls.board = None
        cls.since = 100.0

    @classmethod
    def tearDownClass(cls):
        cls.unplug()
        cls.folder.cleanup()

    @classmethod
    def plug_in(cls, surface):
        cls.unplug()
        cls.board = Board(cls.path / "firmware.elf", cls.port, surface, cls.since, cls.clock)

    @classmethod
    def unplug(cls):
        if cls.board:
            cls.board.stop()
            cls.since = cls.board.now + 1
            cls.board = None

    def wait(self, topic, kind, good=lambda message: True):
        """The first message for which `good` holds."""
        found = []
        seen = threading.Event()

        def look(message):
            if not seen.is_set() and good(message):
                found.append(message)
                seen.set()

        subscriber = rospy.Subscriber(topic, kind, look)
        self.assertTrue(seen.wait(60), f"nothing came on {topic}")
        subscriber.unregister()
        return found[0]

    def wait_for_time(self, seconds):
        end = self.board.now + seconds
        event = threading.Event()
        for _ in range(2400):
            if self.board.now >= end:
                return
            event.wait(0.05)
        self.fail(f"the simulated board has not run {seconds} s in two minutes")

    def record(self, surface):
        self.plug_in(surface)
        self.wait("/fsr/raw", MatrixFrame)
        bag = self.path / surface
        launch = subprocess.Popen(["roslaunch", "fsr_pressure_map", "record.launch", f"bag:={bag}", f"surface:={surface}"],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.wait("/fsr/session", rospy.AnyMsg)
        self.wait_for_time(3 * CYCLE)  # a loaded machine begins to record late
        launch.send_signal(signal.SIGINT)
        launch.wait(60)
        return bag.with_suffix(".bag")

    def test_driver_recorder_training_and_map(self):
        bags = [self.record("flat"), self.record("cylinder_5cm")]
        for bag in bags:
            with rosbag.Bag(str(bag)) as opened:
                scans = [message for _, message, _ in opened.read_messages("/fsr/raw")]
                info = next(message for _, message, _ in opened.read_messages("/fsr/matrix_info"))
            self.assertEqual((info.serial, info.firmware, info.rows, info.columns, info.full_scale),
                             ("FSR-0042", "1.1.0", 7, 10, 1023))
            self.assertGreater(len(scans), 2 * CYCLE * 50)
            steps = [(after.header.stamp - before.header.stamp).to_sec() for before, after in zip(scans, scans[1:])]
            self.assertAlmostEqual(sorted(steps)[len(steps) // 2], 0.020, delta=0.0005)

        calibration = self.path / "calibration.h5"
        trained = subprocess.run([program("train"), *bags, "--output", calibration], capture_output=True, text=True)
        self.assertEqual(trained.returncode, 0, trained.stdout + trained.stderr)

        launches = [subprocess.Popen(["roslaunch", "fsr_pressure_map", *words], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                    for words in (["calibration.launch", f"calibration:={calibration}"],
                                  ["curvature.launch", "surface:=cylinder_5cm"])]
        try:
            errors = self.errors_of_maps()
        finally:
            for launch in launches:
                launch.send_signal(signal.SIGINT)
            for launch in launches:
                launch.wait(60)
        print(f"largest error of the mean of a map: {max(errors):.0f} Pa")
        # The largest possible error would be 300 kPa; one count of the converter is 0.7 kPa, and bending moves a map by 34 kPa.
        self.assertLess(max(errors), 15e3)

    def errors_of_maps(self):
        """|mean of the map - chamber pressure| [Pa] of 100 maps under more than 250 kPa."""
        pressures = {}
        errors = []
        done = threading.Event()

        def keep(message):
            pressures[message.header.stamp.to_sec()] = message.fluid_pressure - AMBIENT

        def compare(message):
            values = [value for value in message.pressure if value == value]
            near = [time for time in list(pressures) if abs(time - message.header.stamp.to_sec()) < 0.03]
            if message.state != PressureMap.STATE_OK or not values or not near or done.is_set():
                return
            pressure = pressures[near[-1]]
            if pressure > 250e3:
                errors.append(abs(sum(values) / len(values) - pressure))
            if len(errors) >= 100:
                done.set()

        subscribers = [rospy.Subscriber("/fsr/chamber_pressure", FluidPressure, keep),
                       rospy.Subscriber("/fsr/pressure_map", PressureMap, compare)]
        self.assertTrue(done.wait(90), f"{len(errors)} maps of a loaded sheet came, {len(pressures)} readings")
        for subscriber in subscribers:
            subscriber.unregister()
        return errors


if __name__ == "__main__":
    rospy.init_node("firmware_test")
    rostest.rosrun("fsr_pressure_map", "firmware_test", FirmwareTest)
