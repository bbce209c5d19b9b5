#!/usr/bin/python3
"""session.launch leads an operator through a plan: instructions, rejections, one bag for each mount; it goes on after kill -9.

The operator publishes what a board would, with stamps that run ahead of the clock: the conductor judges by stamps alone.
"""
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import threading
import unittest

import rosbag
import rospy
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticArray
from fsr_pressure_map.msg import Instruction, MatrixFrame, MatrixInfo
from sensor_msgs.msg import FluidPressure, Image
from std_srvs.srv import Trigger
from terminal import PACKAGE, happens, pid_of

AMBIENT = 100e3  # [Pa]
PERIOD = 0.1     # of scans and readings [s]
PLAN = """
plan: test day
order: listed
repeat_first: false
conditioning: {cycles: 1, rate: 100000, dwell_peak: 1, dwell_rest: 1}
rest: {before: 3, after: 3}
change: 10
tolerance: {peak: 0.05, rate: 0.25, dwell: 2}
surfaces: [{surface: flat}, {surface: bowl, two_planes: {x: 5, y: 5}}]
program:
  - cycles: {peak: 300000, fill_rate: 50000, vent_rate: 50000, dwell_peak: 1, dwell_rest: 1, cycles: 2}
"""


class SessionTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.plan = pathlib.Path(self.folder.name) / "day.yaml"
        self.plan.write_text(PLAN)
        self.bags = pathlib.Path(self.folder.name) / "bags"
        self.scans = rospy.Publisher("/fsr/raw", MatrixFrame, queue_size=1000)
        self.pressures = rospy.Publisher("/fsr/chamber_pressure", FluidPressure, queue_size=1000)
        self.info = rospy.Publisher("/fsr/matrix_info", MatrixInfo, queue_size=1, latch=True)
        self.info.publish(MatrixInfo(serial="FSR-0001", rows=3, columns=4, full_scale=4095, ambient_pressure=AMBIENT))
        self.changed = threading.Condition()
        self.instruction = None
        self.instructions = rospy.Subscriber("/fsr/instruction", Instruction, self.hear)
        self.now, self.sequence, self.pressure = rospy.Time.now().to_sec(), 0, 0.0
        self.launch, self.commanded, self.commands = None, [], None

    def tearDown(self):
        if self.launch:
            self.launch.send_signal(signal.SIGINT)
            self.launch.wait(30)
        for one in (self.scans, self.pressures, self.info, self.instructions):
            one.unregister()
        if self.commands:
            self.commands.unregister()
        self.folder.cleanup()

    def hear(self, message):
        with self.changed:
            self.instruction = message
            self.changed.notify_all()

    def start(self):
        self.instruction = None
        self.launch = subprocess.Popen(["roslaunch", "fsr_pressure_map", "session.launch", f"plan:={self.plan}", f"folder:={self.bags}",
                                        f"surfaces:={PACKAGE}/config/surfaces", "wait:=60", "silence:=5", "command:=true", "report:=false"])
        self.commands = rospy.Subscriber("/fsr/chamber_command", FluidPressure, lambda message: self.commanded.append(message.fluid_pressure))
        self.until(lambda now: now is not None)
        self.wait_for(lambda: self.scans.get_num_connections() > 0 and self.pressures.get_num_connections() > 0)

    def until(self, condition):
        with self.changed:
            self.assertTrue(self.changed.wait_for(lambda: condition(self.instruction), 30), f"still: {self.instruction}")
        return self.instruction

    def wait_for(self, condition):
        self.assertTrue(happens(condition, patience=30), "did not happen")

    def call(self, name):
        rospy.wait_for_service(f"/fsr/conduct/{name}", 10)
        return rospy.ServiceProxy(f"/fsr/conduct/{name}", Trigger)()

    def confirm(self):
        self.until(lambda now: now.confirm)
        step = self.instruction.step
        self.assertTrue(self.call("confirm").success)
        return self.until(lambda now: not now.confirm and now.step >= step)

    def recording(self, bag):
        """Waits until the recorder listens: it has subscribed before it publishes diagnostics."""
        self.wait_for((self.bags / f"{bag}.bag.active").exists)
        rospy.wait_for_message("/diagnostics", DiagnosticArray, 10)

    def step(self, pressure):
        self.pressure = pressure
        self.now += PERIOD
        self.sequence += 1
        stamp = rospy.Time.from_sec(self.now)
        frame = MatrixFrame(sequence=self.sequence, rows=3, columns=4, full_scale=4095, counts=[int(pressure / 200)] * 12)
        frame.header.stamp = stamp
        reading = FluidPressure(fluid_pressure=AMBIENT + pressure)
        reading.header.stamp = stamp
        self.scans.publish(frame)
        self.pressures.publish(reading)
        rospy.sleep(0.002)  # the queues of the publishers are not endless

    def stay(self, duration):
        for _ in range(round(duration / PERIOD)):
            self.step(self.pressure)

    def ramp(self, to, rate):
        begin, count = self.pressure, max(1, round(abs(to - self.pressure) / rate / PERIOD))
        for i in range(1, count + 1):
            self.step(begin + (to - begin) * i / count)

    def cycle(self, peak, rate, dwell=1):
        self.stay(1.5)
        self.ramp(peak, rate)
        self.stay(dwell)
        self.ramp(0, rate)
        self.stay(1)

    def follow(self):
        """Does what the instruction says, and waits for the next one."""
        now = self.instruction
        if now.kind == Instruction.REST:
            self.stay(now.dwell_rest + 0.5)
        else:
            self.cycle(now.peak, now.rate, now.dwell_peak)
        return self.until(lambda later: later.step > now.step or later.kind == Instruction.DONE)

    def test_a_session_with_a_mistake_and_a_crash(self):
        self.start()
        self.assertEqual(self.instruction.kind, Instruction.MOUNT)
        self.assertEqual((self.instruction.plan, self.instruction.surface, self.instruction.steps), ("test day", "flat", 11))
        self.stay(2)
        self.wait_for(lambda: AMBIENT in self.commanded)  # until matrix_info has come, the standard's ambient pressure is commanded
        self.commanded.clear()
        self.stay(2)
        self.wait_for(lambda: self.commanded)
        self.assertEqual(set(self.commanded), {AMBIENT})
        self.assertEqual(self.confirm().kind, Instruction.CONDITION)
        self.follow()
        self.assertEqual(self.instruction.kind, Instruction.REST)
        self.assertAlmostEqual(max(self.commanded), AMBIENT + 330e3, delta=1)
        self.recording("test_day_01_flat")
        self.follow()

        step = self.instruction.step
        self.cycle(200e3, 50e3)
        self.until(lambda now: "turned at 200 kPa, planned are 300 kPa" in now.remark)
        self.assertEqual(self.instruction.step, step)
        self.assertEqual(self.follow().remark, "")

        rejected = self.call("accept")
        self.assertFalse(rejected.success)
        picture = rospy.wait_for_message("/fsr/session_coverage", Image, 10)
        self.assertEqual(picture.encoding, "rgb8")

        os.kill(pid_of("/fsr/conduct"), signal.SIGKILL)
        self.until(lambda now: now.kind == Instruction.MOUNT)  # started again
        self.assertEqual((self.instruction.step, self.instruction.surface), (step + 1, "flat"))
        self.wait_for(lambda: self.scans.get_num_connections() == 1 and self.pressures.get_num_connections() == 1)
        self.stay(2)
        self.confirm()
        self.recording("test_day_01_flat_part2")
        while self.instruction.kind != Instruction.MOUNT:
            self.follow()

        self.assertEqual(self.instruction.surface, "bowl")
        self.wait_for((self.bags / "test_day_01_flat_part2.bag").exists)
        self.confirm()
        self.recording("test_day_02_bowl")
        self.stay(1)
        self.assertTrue(self.call("reject").success)  # the rest that runs
        self.until(lambda now: "by a person" in now.remark)
        self.assertTrue(self.call("reject").success)  # the mount
        self.until(lambda now: now.confirm)
        self.wait_for((self.bags / "set_aside/test_day_02_bowl.bag").exists)
        self.confirm()
        self.recording("test_day_02_bowl")
        while self.instruction.kind != Instruction.DONE:
            self.follow()
        self.assertFalse(self.call("reject").success)
        self.wait_for(lambda: (self.bags / "test_day_02_bowl.bag").exists())

        self.assertEqual(sorted(path.name for path in self.bags.glob("*.bag*")),
                         ["test_day_01_flat.bag", "test_day_01_flat_part2.bag", "test_day_02_bowl.bag"])
        with rosbag.Bag(str(self.bags / "test_day_01_flat.bag")) as bag:  # what the kill -9 left
            events = [message.label for _, message, _ in bag.read_messages("/fsr/events")]
        self.assertTrue(any("cycle 1 of 2" in label and "accepted" in label for label in events), events)
        with rosbag.Bag(str(self.bags / "test_day_01_flat_part2.bag")) as bag:
            events = [message for _, message, _ in bag.read_messages("/fsr/events")]
        self.assertIn(("note", "1 cycle before this recording, too few to condition a sheet"), [(event.kind, event.label) for event in events])
        with rosbag.Bag(str(self.bags / "test_day_02_bowl.bag")) as bag:
            found = {}
            for topic, message, _ in bag.read_messages():
                found.setdefault(topic, []).append(message)
        self.assertEqual([event.kind for event in found["/fsr/events"]], ["step"] * 4)
        self.assertIn("cycle 2 of 2 on bowl, mount 2 accepted: peak 300 kPa, filled at 50 kPa/s", found["/fsr/events"][2].label)
        self.assertEqual({(surface.surface, surface.mount) for surface in found["/fsr/curvature"]}, {("bowl", 2)})
        self.assertEqual(found["/fsr/session"][0].protocol, "day")
        self.assertEqual(len(found["/fsr/raw"]), len(found["/fsr/chamber_pressure"]))
        state = yaml.safe_load((self.bags / "test_day_session.yaml").read_text())
        self.assertEqual((state["steps"], state["rejected"]), ("a" * 11, 3))

    def test_a_plan_that_is_missing_or_wrong_is_named_until_it_is_right(self):
        self.plan.unlink()
        self.launch = subprocess.Popen(["rosrun", "fsr_pressure_map", "conduct_node", "__ns:=fsr", f"_plan:={self.plan}",
                                        f"_folder:={self.bags}", f"_surfaces:={PACKAGE}/config/surfaces"])
        self.until(lambda now: now is not None and str(self.plan) in now.remark)
        self.assertIn("cannot begin", self.instruction.text)
        self.plan.write_text(PLAN.replace("surface: flat", "surface: flatt"))
        self.until(lambda now: "day.yaml: surfaces[0].surface is flatt, but" in now.remark)
        self.assertIsNone(self.launch.poll())
        self.plan.write_text(PLAN)
        now = self.until(lambda now: now.kind == Instruction.MOUNT)
        self.assertEqual((now.remark, now.surface), ("", "flat"))
        self.assertIsNone(self.launch.poll())


    def start_node(self, *more, namespace="fsr", name="conduct"):
        """conduct_node alone, so that its exit status can be seen. It records without a limit for the space on the disk."""
        values = [("plan", self.plan), ("folder", self.bags), ("surfaces", PACKAGE / "config/surfaces"), ("report", "false"), ("silence", 5),
                  ("recorder/topics", "/fsr/raw /fsr/chamber_pressure /fsr/events"), ("recorder/min_space", 0)]
        return subprocess.Popen(["rosrun", "fsr_pressure_map", "conduct_node", f"__ns:={namespace}", f"__name:={name}"] +
                                [f"_{key}:={value}" for key, value in values] + list(more))

    def begin(self):
        """Waits for the node, and goes to the first step that is recorded."""
        self.until(lambda now: now is not None)
        self.wait_for(lambda: self.scans.get_num_connections() > 0 and self.pressures.get_num_connections() > 0)
        self.stay(2)
        self.confirm()
        self.follow()
        self.assertEqual(self.instruction.kind, Instruction.REST)

    def hears_within(self, words, limit):
        with self.changed:
            heard = self.changed.wait_for(lambda: self.instruction is not None and words in self.instruction.remark, limit)
        self.assertTrue(heard, f"\"{words}\" was not said within {limit} s, but {self.instruction}")

    def test_a_folder_that_is_removed_is_said_at_once_and_by_the_status(self):
        self.launch = self.start_node()
        self.begin()
        self.recording("test_day_01_flat")
        self.stay(1)
        shutil.rmtree(str(self.bags))
        self.hears_within("was removed while it was written: what was in it is lost; nothing is recorded: the folder", 5)
        self.hears_within("after a crash the session would not go on from here", 5)
        self.bags.mkdir()
        self.recording("test_day_01_flat")
        self.assertEqual(self.instruction.kind, Instruction.REST)  # asked for again
        self.follow()
        self.assertEqual(self.instruction.remark, "")
        self.assertTrue((self.bags / "test_day_session.yaml").exists())
        self.launch.send_signal(signal.SIGINT)
        self.assertEqual(self.launch.wait(30), 1)

    def test_a_full_disk_is_said_at_once_and_makes_no_empty_bags(self):
        self.launch = self.start_node("_recorder/min_space:=1000000000")
        self.begin()
        self.hears_within("nothing is recorded: only", 5)
        self.assertEqual(list(self.bags.glob("*.bag*")), [])
        self.launch.send_signal(signal.SIGINT)
        self.assertEqual(self.launch.wait(30), 0)

    def test_a_second_conductor_on_a_folder_is_refused_until_the_first_ends(self):
        first = self.start_node(namespace="first")
        self.wait_for((self.bags / "test_day_plan.yaml").exists)
        self.launch = self.start_node()
        self.hears_within("another conductor leads a session in this folder", 15)
        self.assertEqual(self.instruction.kind, Instruction.BREAK)
        first.kill()
        first.wait(30)
        self.until(lambda now: now.kind == Instruction.MOUNT)
        self.launch.send_signal(signal.SIGINT)
        self.assertEqual(self.launch.wait(30), 0)


if __name__ == "__main__":
    rospy.init_node("session_test")
    rostest.rosrun("fsr_pressure_map", "session_test", SessionTest)
