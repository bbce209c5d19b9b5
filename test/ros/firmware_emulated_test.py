#!/usr/bin/python3
"""rig_emulator.launch board:=avr: the firmware's frames come through the driver; what is missing is said in a sentence."""
import pathlib
import subprocess
import tempfile
import unittest

import rospkg
import rospy
import rostest
from fsr_pressure_map.msg import MatrixFrame, MatrixInfo

SOURCE = pathlib.Path(rospkg.RosPack().get_path("fsr_pressure_map"))


def refused(*words, **environment):
    done = subprocess.run([SOURCE / "scripts/emulate_avr", "--link", "/nowhere/port", *words], capture_output=True, text=True,
                          env={"PATH": "/usr/bin:/bin", "HOME": tempfile.gettempdir(), **environment})
    return done.returncode, done.stderr


class FirmwareEmulatedTest(unittest.TestCase):
    def test_sends_frames_of_the_demo_rig(self):
        rospy.init_node("firmware_emulated_test")
        info = rospy.wait_for_message("/fsr/matrix_info", MatrixInfo, 100)
        self.assertEqual((info.rows, info.columns, info.full_scale), (7, 10, 1023))
        frame = rospy.wait_for_message("/fsr/raw", MatrixFrame, 60)
        self.assertEqual(len(frame.counts), 70)
        self.assertGreater(min(frame.counts), 20, "the bend presses the sheet, so no taxel reads 0")

    def test_says_what_is_wrong(self):
        status, said = refused("--surface", "cylinder_99cm")
        self.assertEqual(status, 1)
        self.assertIn("cylinder_99cm.yaml: there is no such surface file", said)
        status, said = refused("--simulation", str(SOURCE / "config/study/paper.yaml"))
        self.assertEqual(status, 1)
        self.assertIn("paper.yaml: has no matrix and effects; give a simulation", said)
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([SOURCE / "scripts/emulate_avr", "--link", f"{folder}/port", "--scan-rate", "500"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"emulate_avr: firmware: .* needs \d+ us for a scan of 7 x 10, but PERIOD is 2000 us: the shortest is")


if __name__ == "__main__":
    rostest.rosrun("fsr_pressure_map", "firmware_emulated", FirmwareEmulatedTest)
