#!/usr/bin/python3
"""recheck.launch as users start it: beside calibrated.launch on a worn sheet, on recorded bags, and on what it has corrected."""
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

import rospy
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticArray
from fsr_pressure_map.msg import CalibrationInfo
from fsr_pressure_map.srv import LoadFile
from rosgraph_msgs.msg import Clock
from terminal import PACKAGE, PROGRAMS, Terminal, happens

PATIENCE = 90  # [s]
CYCLES = 4  # of each training bag


def write_rig(path, loss, offset):
    """The bench, whose sheet has lost a share of its conductance and whose board adds counts."""
    rig = yaml.safe_load((PACKAGE / "config/simulation/bench.yaml").read_text())
    rig["chamber"]["cycles"] = CYCLES
    if loss:
        rig["effects"]["wear"] = {"loss": loss, "age": 1e7}
        rig["effects"]["converter"]["offset"] = offset
    path.write_text(yaml.safe_dump(rig, sort_keys=False))


class RecheckTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        write_rig(cls.folder / "new.yaml", 0, 0)
        write_rig(cls.folder / "worn.yaml", 0.1, 20)
        cls.run_tool("simulate", "--simulation", "new.yaml", "--output", "new")
        cls.run_tool("simulate", "--simulation", "new.yaml", "--seed", "1", "--output", "again")
        cls.run_tool("train", "new/1_flat.bag", "new/2_cylinder_5cm.bag", "--history", "none", "--no-scores", "--output", "sheet.h5")

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @classmethod
    def run_tool(cls, name, *arguments):
        return subprocess.run([str(PROGRAMS / name), *arguments], cwd=cls.folder, check=True, stdout=subprocess.PIPE, text=True).stdout

    def start(self, name, *arguments):
        terminal = Terminal(self.folder, name, *arguments)
        self.addCleanup(terminal.end)
        return terminal

    def ended(self, terminal):
        """What the terminal shows when its launch has ended by itself."""
        if not happens(terminal.ended, patience=PATIENCE):
            self.fail(terminal.said())
        return terminal.said()

    def info(self, parent):
        """The description of the calibration in use, when it has this parent."""
        give_up = time.monotonic() + PATIENCE
        while time.monotonic() < give_up:
            info = rospy.wait_for_message("/fsr/calibration_info", CalibrationInfo, PATIENCE)
            if info.id and info.parent == parent:
                return info
        self.fail(f"no calibration with the parent {parent!r}; the last one was {info}")

    def diagnosed(self, value):
        """Waits until the diagnostics of the calibration node say so of the correction."""
        give_up = time.monotonic() + PATIENCE
        while time.monotonic() < give_up:
            for status in rospy.wait_for_message("/diagnostics", DiagnosticArray, PATIENCE).status:
                if value in [pair.value for pair in status.values if pair.key == "correction"]:
                    return
        self.fail(f"the diagnostics never said {value}")

    def test_a_worn_sheet_is_corrected_beside_the_running_calibration(self):
        port = self.folder / "board"
        self.start("rig_emulator", f"simulation:={self.folder}/worn.yaml", f"link:={port}", "time_scale:=10", "cycles:=0")
        rospy.wait_for_message("/clock", Clock, PATIENCE)  # or the next launch is refused
        self.start("calibrated", f"serial_port:={port}", "serial_baud:=0", "calibration:=sheet.h5", "surface:=flat")
        parent = self.info("")
        self.diagnosed("none")
        said = self.ended(self.start("recheck", "same_mount:=true", "report:=report.json"))
        self.assertIn("\nCorrected: on cycles that were left out", said)
        self.assertNotIn("has died", said)
        child = self.folder / "sheet_corrected.h5"
        self.assertIn(f"written to {child}", said)
        bag, = (self.folder / "ros_home").glob("recheck_*.bag")
        self.assertEqual(yaml.safe_load((self.folder / "report.json").read_text())["verdict"], "corrected")
        rospy.wait_for_service("/fsr/calibration/load_calibration", PATIENCE)
        answer = rospy.ServiceProxy("/fsr/calibration/load_calibration", LoadFile)(str(child))
        self.assertTrue(answer.success, answer.message)
        corrected = f"corrected on {self.info(parent.id).corrected[:10]} from {parent.id}"
        self.assertIn(corrected, answer.message)
        self.diagnosed(corrected)
        on_a_new_mount = self.ended(self.start("recheck", "calibration:=sheet.h5", f"bags:={bag}", "output:=none.h5"))
        self.assertIn("\nCannot tell: ", on_a_new_mount)
        self.assertIn(f'bags:="{bag} ..."', on_a_new_mount)
        self.assertFalse((self.folder / "none.h5").exists())
        refused = self.ended(self.start("recheck", "cycles:=3"))
        self.assertIn(f"is itself a correction of {parent.id}", refused)

    def test_recorded_bags_of_a_good_sheet_write_no_calibration(self):
        said = self.ended(self.start("recheck", "calibration:=sheet.h5", "bags:=again/1_flat.bag", "output:=none.h5"))
        self.assertIn("\nStill good: ", said)
        self.assertFalse((self.folder / "none.h5").exists())

    def test_without_a_calibration_it_says_what_to_give(self):
        said = self.ended(self.start("recheck", "ns:=nobody"))
        self.assertIn("must name a calibration file, because no calibration node runs", said)


if __name__ == "__main__":
    rospy.init_node("recheck_test", anonymous=True)
    rostest.rosrun("fsr_pressure_map", "recheck_test", RecheckTest, sys.argv)
