#!/usr/bin/python3
"""`rosbag fix` and the package's rules on a bag that was recorded before the PressureMap had FLAG_HISTORY_SHORT and the
CalibrationInfo had its parent.

Needs the environment of a devel or install space, as a user who calls `rosbag fix` has it.
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import genpy.dynamic
import rosbag
import rosbag.migration
import rospkg
from fsr_pressure_map.msg import CalibrationInfo, PressureMap

PACKAGE = pathlib.Path(__file__).resolve().parent.parent.parent
OLD_BAG = PACKAGE / "test/data/indenter_map.bag"
OLD_MD5 = "50c65025fc4b01118cf4b0ef3469834e"
OLD_INFO_MD5 = "883c2521a8e1943b05728716309ddb06"
MAPS = "/fsr/pressure_map"
INFO = "/fsr/calibration_info"
RULE = "migration/pressure_map.bmr"

# rosbag asks rosdep which packages depend on rosbag, and reads the rules of those. Without an initialised rosdep it finds
# none; with one it fails on Debian, whose sensor_msgs lacks the rules that its package.xml names. So the test has a rosdep
# of its own, and shows rosbag this package alone.
ROSDEP = """def init_rospack_interface(): return True
def is_view_empty(view): return False
def is_ros_package(view, name): return True
def is_system_dependency(view, name): return False
"""


def definitions(bag, topic=MAPS):
    """The definitions of the messages of a topic in a bag: {MD5 sum: text}."""
    return {connection.md5sum: connection.msg_def for connection in bag._get_connections([topic])}


def messages(bag):
    """Topic, time and bytes of all messages."""
    return [(topic, time, raw[1]) for topic, raw, time in bag.read_messages(raw=True)]


class Migration(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "rosdep2").mkdir()
        (self.folder / "rosdep2" / "__init__.py").touch()
        (self.folder / "rosdep2" / "rospack.py").write_text(ROSDEP)

    def test_the_documented_command_converts_a_recorded_map(self):
        text = (PACKAGE / "docs/recording.md").read_text()
        words = re.search(r"^ {4,}rosbag fix (.*)$", text, re.MULTILINE).group(1).split("NEW.bag ")
        self.assertEqual(words, ["--noplugins OLD.bag ", "$(rospack find fsr_pressure_map)/" + RULE])
        fixed = self.folder / "fixed.bag"
        result = subprocess.run("rosbag fix --noplugins %s %s %s" % (OLD_BAG, fixed, words[1]), shell=True, text=True,
                                check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(result.returncode, 0, result.stdout)
        for complaint in ("WARNING", "ERROR", "Cannot"):
            self.assertNotIn(complaint, result.stdout)
        with rosbag.Bag(str(OLD_BAG)) as old, rosbag.Bag(str(fixed)) as new:
            self.assertEqual(list(definitions(old)), [OLD_MD5])
            self.assertEqual(list(definitions(new)), [PressureMap._md5sum])
            self.assertIn("FLAG_HISTORY_SHORT", definitions(new)[PressureMap._md5sum])
            empty = b"\0" * 8  # the lengths of parent and corrected
            self.assertEqual([(topic, time, data + empty if topic == INFO else data) for topic, time, data in messages(old)], messages(new))
            maps = [map_ for _, map_, _ in new.read_messages([MAPS])]
            self.assertGreater(len(maps), 20)
            self.assertEqual(len(maps[0].pressure), 70)

    def test_a_recorded_calibration_is_converted_to_one_without_a_parent(self):
        fixed = self.folder / "fixed.bag"
        result = subprocess.run(["rosbag", "fix", "--noplugins", OLD_BAG, fixed, PACKAGE / RULE], text=True, check=False,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(result.returncode, 0, result.stdout)
        with rosbag.Bag(str(OLD_BAG)) as old, rosbag.Bag(str(fixed)) as new:
            self.assertEqual(list(definitions(old, INFO)), [OLD_INFO_MD5])
            self.assertEqual(list(definitions(new, INFO)), [CalibrationInfo._md5sum])
            before = next(message for _, message, _ in old.read_messages([INFO]))
            after = next(message for _, message, _ in new.read_messages([INFO]))
            for field in before.__slots__:
                if field != "header":
                    self.assertEqual(getattr(after, field), getattr(before, field), field)
            self.assertEqual(after.header.stamp, before.header.stamp)
            self.assertEqual((after.parent, after.corrected), ("", ""))

    # rosbag makes a rule of its own where it finds none, so that a conversion alone would not show that one is missing.
    def test_rosbag_finds_and_uses_the_rule_of_the_package(self):
        for path, topic, md5, message in ((OLD_BAG, MAPS, OLD_MD5, PressureMap), (OLD_BAG, INFO, OLD_INFO_MD5, CalibrationInfo)):
            with rosbag.Bag(str(path)) as old:
                text = definitions(old, topic)[md5]
            old_class = genpy.dynamic.generate_dynamic(message._type, text)[message._type]
            one_package = mock.patch.object(rospkg.RosPack, "list", lambda _: ["fsr_pressure_map"])
            with one_package, mock.patch.object(sys, "path", [str(self.folder), *sys.path]):
                steps = rosbag.migration.MessageMigrator().find_path(old_class, message)
            own = [step.rule for step in steps if step.rule.location.startswith(RULE + ":")]
            self.assertTrue(own, [step.rule.location for step in steps])
            self.assertEqual(own[0].old_md5sum, md5)
            self.assertEqual(own[-1].new_md5sum, message._md5sum)  # or a rule is missing


if __name__ == "__main__":
    unittest.main(verbosity=2)
