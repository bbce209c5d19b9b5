#!/usr/bin/python3
"""A whole day at the emulated rig: the shipped launch files, an operator who makes mistakes, and the report of the day.

Nothing is called between rig, launch files and the report.
"""
import html.parser
import json
import signal
import subprocess
import threading

import rosnode
import rospy
import rostest
from conducted_session import ConductedSession
from fsr_pressure_map.msg import Instruction
from std_msgs.msg import String

PLAN = """
plan: day
order: listed
repeat_first: false
change: 60
conditioning: {cycles: 4, rate: 60000}
rest: {before: 10, after: 10}
surfaces: [{surface: flat}, {surface: cylinder_5cm}]
program:
  - cycles: {peak: 500000, rate: 80000, dwell_peak: 5, dwell_rest: 2, cycles: 5}
"""
# Steps: 1 mount, 2 to 5 conditioning, 6 rest, 7 to 11 cycles, 12 rest; 13 mount, 14 rest, 15 to 19 cycles, 20 rest.
STEPS = {"peak_too_low": 8, "leak": 9, "board_unplugged": 16, "terminal_closed": 18}
# An unplugged board sends neither scans nor pressure; what is missed first is said. A closed terminal cannot say anything.
REMARKS = ("planned are 500 kPa", "leak", "no reading of the chamber pressure|no scan came")
SECTIONS = ("What was recorded", "Whether the bags are fit", "How good the calibration is", "What the sheet does that the simulation lacks",
            "What to record next", "Every step", "How to compute it again")


class Page(html.parser.HTMLParser):
    """The headings, the text and whatever the page would load from elsewhere."""

    def __init__(self, text):
        super().__init__()
        self.headings, self.outside, self.pictures, self.text, self.in_heading = [], [], 0, "", False
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        if tag in ("script", "link", "iframe", "img", "object", "embed", "base"):
            self.outside.append(tag)
        self.outside += [f"{tag} {name}={value}" for name, value in attrs if name in ("src", "href", "xlink:href", "data", "action")]
        self.pictures += tag == "svg"
        if tag == "h2":
            self.headings.append("")
        self.in_heading = tag == "h2"

    def handle_data(self, data):
        self.text += data
        if self.in_heading:
            self.headings[-1] += data

    def handle_endtag(self, tag):
        self.in_heading = False


class DayTest(ConductedSession):
    def setUp(self):
        self.reported = threading.Event()
        super().setUp()
        rospy.Subscriber("/fsr/rig_emulator/acts", String, self.close_terminal)

    def hear(self, instruction):
        super().hear(instruction)
        said = instruction.remark
        if instruction.kind == Instruction.DONE and "The report of the day" in said and "being written" not in said:
            self.reported.set()

    def close_terminal(self, act):
        if act.data == "close the terminal of the conductor":
            rosnode.kill_nodes(["/fsr/conduct"])

    def tool(self, *words):
        done = subprocess.run(["rosrun", "fsr_pressure_map", *map(str, words)], cwd=self.home, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=120)
        return done.returncode, done.stdout.decode()

    def check_report(self, text):
        """The page holds each part, loads nothing, and has the figures of the tools."""
        page = Page(text)
        self.assertEqual(page.outside, [])
        self.assertEqual(page.pictures, 1)
        self.assertEqual(page.headings, list(SECTIONS))
        for part in ("no result", "incomplete"):
            self.assertNotIn(part, page.text)
        for reason in ("rejected (peak_missed): ", "rejected (leak): ", "4 of 4 cycles accepted", "marked by an event"):
            self.assertIn(reason, page.text)

        code, budget = self.tool("train", "--budget", "session/day_calibration.h5")
        self.assertEqual(code, 0, budget)
        for line in budget.splitlines()[1:]:
            self.assertIn(line, page.text)
        results = self.home / "session/day_report"
        for tool in ("check_bag", "train", "discrepancy"):
            self.assertIn((results / f"{tool}.txt").read_text(), page.text)
        training = json.loads((results / "training.json").read_text())
        rmse = training["scores"]["whole"]["errors_pa"]["whole"]["all"]["rmse"]
        self.assertIn(f"held-out error {rmse / 1e3:.1f} kPa", page.text)
        found = json.loads((results / "discrepancy/results.json").read_text())
        self.assertIn(found["sentence"], page.text)

    def test_from_plan_to_the_report(self):
        self.conduct(PLAN, ",".join(f"{name}@{step}" for name, step in STEPS.items()), REMARKS)
        for one in (self.running.pop(1), self.running.pop(0)):  # the driver and the rig, whose work is done
            one.send_signal(signal.SIGINT)
            one.wait(60)
        self.assertTrue(self.reported.wait(500), f"the report was not written; heard: {self.remarks}")
        report = self.home / "session/day_report.html"
        self.assertIn("The report of the day is being written.", self.remarks)
        self.assertIn(f"The report of the day is {report}", self.remarks)
        bags = sorted(path.name for path in (self.home / "session").glob("*.bag*"))
        self.assertEqual(bags, ["day_01_flat.bag", "day_02_cylinder_5cm.bag", "day_02_cylinder_5cm_part2.bag"])
        self.check_report(report.read_text())


if __name__ == "__main__":
    rospy.init_node("day_test")
    rostest.rosrun("fsr_pressure_map", "day_test", DayTest)
