#!/usr/bin/python3
"""What scripts/launch_check knows of the launch files, of a command line and of a rig file."""
import pathlib
import sys
import tempfile
import unittest

PACKAGE = pathlib.Path(__file__).resolve().parent.parent.parent

sys.dont_write_bytecode = True
from bare_shell import module  # noqa: E402

launch_check = module("launch_check")


def arguments(name):
    return launch_check.arguments_of(PACKAGE / "launch" / f"{name}.launch")


class LaunchCheck(unittest.TestCase):
    def refusal(self, function, *arguments):
        with self.assertRaises(launch_check.Refused) as raised:
            function(*arguments)
        return str(raised.exception)

    def test_calibrated_takes_the_arguments_of_what_it_includes(self):
        self.assertLessEqual({"regions", "pitch_x", "transducer_offset", "unit", "mask_file", "mount", "rig"}, arguments("calibrated"))
        self.assertFalse({"name", "manager"} & arguments("calibrated"))
        self.assertIn("transducer_offset", arguments("compare"))

    def test_every_launch_file_has_arguments(self):
        for launch in (PACKAGE / "launch").glob("*.launch"):
            self.assertTrue(arguments(launch.stem), launch)

    def test_every_launch_file_is_checked(self):
        checked = {launch.stem for launch in (PACKAGE / "launch").glob("*.launch") if "scripts/launch_check" in launch.read_text()}
        for launch in (PACKAGE / "launch").glob("*.launch"):
            included = {pathlib.PurePath(include.get("file")).stem for include in launch_check.ElementTree.parse(launch).getroot().iter("include")
                        if include.get("if") is None}
            self.assertTrue({launch.stem, *included} & checked, launch)

    def test_an_unknown_argument_is_refused_by_name(self):
        call = launch_check.Call(["-p", "11411", "fsr_pressure_map", "driver.launch", "__log:=x", "sealling:=pdms"])
        self.assertEqual(call.master(), "http://localhost:11411")
        self.assertIn("driver.launch has no argument sealling (sealling:=pdms); did you mean sealing?", self.refusal(launch_check.check_arguments, call))

    def test_a_value_that_is_no_choice_is_refused(self):
        call = launch_check.Call(["fsr_pressure_map", "rig_emulator.launch", "board:=uno"])
        self.assertEqual(self.refusal(launch_check.check_arguments, call), "rig_emulator.launch: board:=uno must be emulated or avr")
        launch_check.check_arguments(launch_check.Call(["fsr_pressure_map", "rig_emulator.launch", "board:=avr"]))

    def test_a_launch_file_of_somebody_else_is_let_alone(self):
        launch_check.check_arguments(launch_check.Call(["my_rig", "driver.launch", "anything:=1"]))

    def test_the_example_of_a_rig_file_is_right(self):
        launch_check.check_rig(str(PACKAGE / "config" / "rig" / "example.yaml"))

    def test_sheets_of_one_serial_port_are_refused(self):
        call = launch_check.Call(["fsr_pressure_map", "sheets.launch"])
        launch_check.check_ports(call, [("a.yaml", "/dev/a"), ("b.yaml", "/dev/b")])
        self.assertIn("the rig files a.yaml and c.yaml have the same serial_port, /dev/a, but",
                      self.refusal(launch_check.check_ports, call, [("a.yaml", "/dev/a"), ("b.yaml", "/dev/b"), ("c.yaml", "/dev/../dev/a")]))
        launch_check.check_ports(launch_check.Call(["fsr_pressure_map", "sheets.launch", "emulated:=true"]), 2 * [("a.yaml", "/dev/a")])
        call = launch_check.Call(["fsr_pressure_map", "sheets.launch", "serial_port:=/dev/a"])
        self.assertIn("would be the port of every sheet", self.refusal(launch_check.check_ports, call, [("a.yaml", "/dev/a"), ("b.yaml", "/dev/b")]))

    def test_a_rig_file_may_describe_the_session_of_a_recording(self):
        self.assertLessEqual(launch_check.OF_A_SESSION, arguments("record"))

    def test_a_wrong_rig_file_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            rig = pathlib.Path(folder) / "rig.yaml"
            self.assertIn("cannot be read", self.refusal(launch_check.check_rig, str(rig)))
            for text, sentence in [("serial_prot: /dev/board\n", "says serial_prot, which is no argument of a rig"), ("xyz: 1\n", "no argument of a rig; it may be one of alarm_dwell, "), ("- 1\n", "must have one line"),
                                   ("a: [", "cannot be read")]:
                rig.write_text(text)
                self.assertIn(sentence, self.refusal(launch_check.check_rig, str(rig)))


if __name__ == "__main__":
    sys.exit(unittest.main())
