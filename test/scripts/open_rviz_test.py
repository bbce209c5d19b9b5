#!/usr/bin/python3
"""The copy of the shipped configuration that open_rviz makes for the names of the sheets."""
import os
import pathlib
import sys
import unittest

import yaml

PACKAGE = pathlib.Path(__file__).resolve().parent.parent.parent
SHIPPED = str(PACKAGE / "config" / "rviz" / "sheets.rviz")

sys.dont_write_bytecode = True
from bare_shell import module  # noqa: E402

open_rviz = module("open_rviz")


class OpenRviz(unittest.TestCase):
    def test_displays_and_panel_have_the_names_of_the_sheets(self):
        words = open_rviz.with_names(["-d", SHIPPED, "--sheets=left,right", "__name:=rviz"])
        self.addCleanup(os.unlink, words[1])
        self.assertEqual((words[0], words[2:]), ("-d", ["__name:=rviz"]))
        with open(words[1], encoding="utf-8") as file:
            config = yaml.safe_load(file)
        displays = config["Visualization Manager"]["Displays"]
        self.assertEqual([display["Topic"] for display in displays if "Topic" in display], ["/left/pressure_map", "/right/pressure_map"])
        self.assertEqual([panel["Sensor"] for panel in config["Panels"] if "Sensor" in panel], ["/left"])

    def test_other_words_and_files_stay_as_they_are(self):
        for words in (["-d", SHIPPED], ["-d", "/no/such.rviz", "--sheets=a"], ["--help"]):
            self.assertEqual(open_rviz.with_names(list(words)), [word for word in words if not word.startswith("--sheets")])


if __name__ == "__main__":
    sys.exit(unittest.main())
