#!/usr/bin/python3
"""`rosbag fix` and the package's rules on a bag that was recorded before the PressureMap had FLAG_HISTORY_SHORT.

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
from fsr_pressure_map.msg import PressureMap

PACKAGE = pathlib.Path(__file__).resolve().parent.parent.parent
OLD_BAG = PACKAGE / "test/data/indenter_map.bag"
OLD_MD5 = "50c65025fc4b01118cf4b0ef3469834e"
MAPS = "/fsr/pressure_map"
RULE = "migration/pressure_map.bmr"

# rosbag asks rosdep which packages depend on rosbag, and reads the rules of those. Without an initialised rosdep it finds
# none; with one it fails on Debian, whose sensor_msgs lacks the rules that its package.xml names. So the test has a rosdep
# of its own, and shows rosbag this package alone.
ROSDEP = """def init_rospack_interface(): return True
def is_view_empty(view): return False
def is_ros_package(view, name): return True
def is_system_dependency(view, name): return False
"""


def definitions(bag):
    """The definitions of the maps in a bag: {MD5 sum: text}."""
    return {connection.md5sum: connection.msg_def for connection in bag._get_connections([MAPS])}


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
            self.assertEqual(messages(old), messages(new))
            maps = [map_ for _, map_, _ in new.read_messages([MAPS])]
            self.assertGreater(len(maps), 20)
            self.assertEqual(len(maps[0].pressure), 70)

    # rosbag makes a rule of its own where it finds none, so that a conversion alone would not show that one is missing.
    def test_rosbag_finds_and_uses_the_rule_of_the_package(self):
        with rosbag.Bag(str(OLD_BAG)) as old:
            text = definitions(old)[OLD_MD5]
        old_class = genpy.dynamic.generate_dynamic(PressureMap._type, text)[PressureMap._type]
        one_package = mock.patch.object(rospkg.RosPack, "list", lambda _: ["fsr_pressure_map"])
        with one_package, mock.patch.object(sys, "path", [str(self.folder), *sys.path]):
            path = rosbag.migration.MessageMigrator().find_path(old_class, PressureMap)
        own = [step.rule for step in path if step.rule.location.startswith(RULE + ":")]
        self.assertTrue(own, [step.rule.location for step in path])
        self.assertEqual(own[0].old_md5sum, OLD_MD5)
        self.assertEqual(own[-1].new_md5sum, PressureMap._md5sum)  # or a rule is missing


if __name__ == "__main__":
    unittest.main(verbosity=2)
