#!/usr/bin/python3
"""The sheet says how it lies: calibrated.launch with a board on a cylinder of 5 cm that the launch file calls 9 cm, and without a file."""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xmlrpc.client

import rosgraph
import rospy
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from fsr_pressure_map.msg import PressureMap, SurfaceCurvature
from fsr_pressure_map.srv import Mark, SetSurface
from sensor_msgs.msg import FluidPressure
from std_srvs.srv import Trigger
from terminal import PACKAGE, PATIENCE, PROGRAMS, happens

RADII = [0, 0.13, 0.09, 0.07, 0.05]  # [m]; 0 = flat
CYCLES = [{"cycles": {"peak": 300e3, "rate": 60e3, "dwell_peak": 1, "dwell_rest": 4, "cycles": 2}}]


def station(radius):
    if radius == 0:
        return {"surface": "flat", "flat": True, "program": CYCLES}
    return {"surface": f"cylinder_{100 * radius:g}cm", "cylinder": {"radius": radius, "axis": "y"}, "program": CYCLES}


def write_rig(path, radii):
    rig = yaml.safe_load((PACKAGE / "config/simulation/demo.yaml").read_text())
    rig["matrix"].update(rows=5, columns=6)
    rig["session"] = [station(radius) for radius in radii]
    path.write_text(yaml.safe_dump(rig, sort_keys=False))


class ShapeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        write_rig(cls.folder / "training.yaml", RADII * 2)
        write_rig(cls.folder / "board.yaml", [0.05])
        cls.run_tool("simulate", "--simulation", cls.folder / "training.yaml", "--output", cls.folder / "bags")
        cls.run_tool("train", *sorted((cls.folder / "bags").glob("*.bag")), "--history", "none", "--no-scores",
                     "--output", cls.folder / "sheet.h5")
        cls.board = subprocess.Popen([str(PROGRAMS / "rig_emulator_node"), "__ns:=bench", f"_simulation:={cls.folder / 'board.yaml'}",
                                      f"_link:={cls.folder / 'board'}", "_scan_rate:=100", "_autostart:=false", "_surface:=cylinder_5cm", "_mount:=77"])

    @classmethod
    def tearDownClass(cls):
        cls.board.send_signal(signal.SIGINT)
        cls.board.wait(PATIENCE)
        cls.temporary.cleanup()

    @staticmethod
    def run_tool(name, *words):
        subprocess.run([str(PROGRAMS / name), *map(str, words)], check=True, stdout=subprocess.DEVNULL)

    def launch(self, *arguments):
        process = subprocess.Popen(["roslaunch", "fsr_pressure_map", "calibrated.launch", f"serial_port:={self.folder / 'board'}",
                                    f"calibration:={self.folder / 'sheet.h5'}", *arguments],
                                   env={**os.environ, "ROS_HOME": str(self.folder / "ros_home")})

        def end():
            process.send_signal(signal.SIGINT)
            process.wait(PATIENCE)
        self.addCleanup(end)
        rospy.wait_for_message("/fsr/pressure_map", PressureMap, PATIENCE)

    def call(self, service):
        rospy.wait_for_service(service, PATIENCE)
        return rospy.ServiceProxy(service, Trigger)()

    def await_status(self, right):
        """The first diagnostics of the calibration for which right(level, message, value) holds."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            for status in rospy.wait_for_message("/diagnostics", DiagnosticArray, PATIENCE).status:
                if "calibration: calibration" not in status.name:
                    continue
                last = (status.level, status.message, {pair.key: pair.value for pair in status.values}.get("sheet at rest"))
                if right(*last):
                    return
        self.fail(f"the last diagnostics are {last}")

    def await_mark(self, words):
        """Diagnostics in which the sentence on the last marked rest contains `words`."""
        end = time.monotonic() + PATIENCE
        last = None
        while time.monotonic() < end:
            for status in rospy.wait_for_message("/diagnostics", DiagnosticArray, PATIENCE).status:
                if "calibration: calibration" in status.name:
                    last = {pair.key: pair.value for pair in status.values}["marked rest"]
                    if words in last:
                        return last
        self.fail(f"the last mark says '{last}'")

    def start_session(self):
        session = subprocess.Popen([str(PROGRAMS / "session_node"), "__ns:=fsr", "__name:=session"])

        def stop():
            session.send_signal(signal.SIGINT)
            session.wait(PATIENCE)
        self.addCleanup(stop)
        rospy.wait_for_service("/fsr/session/mark", PATIENCE)
        node = xmlrpc.client.ServerProxy(rosgraph.Master("/shape_test").lookupNode("/fsr/session"))
        self.assertTrue(happens(lambda: any(link[1] == "/fsr/calibration" for link in node.getBusInfo("/shape_test")[2])),
                        "the calibration node does not listen to events")
        self.mark = lambda kind: self.assertTrue(rospy.ServiceProxy("/fsr/session/mark", Mark)(kind, "").success)

    def await_pressure(self, gauge):
        end = time.monotonic() + PATIENCE
        while rospy.wait_for_message("/fsr/chamber_pressure", FluidPressure, PATIENCE).fluid_pressure < 101325 + gauge:
            self.assertLess(time.monotonic(), end)

    def await_state(self, state):
        end = time.monotonic() + PATIENCE
        while rospy.wait_for_message("/fsr/pressure_map", PressureMap, PATIENCE).state != state:
            self.assertLess(time.monotonic(), end)

    def test_a_wrong_surface_is_found_without_being_asked_for_and_a_right_one_agrees(self):
        self.launch("surface:=cylinder_9cm")
        self.await_status(lambda level, message, _: level == DiagnosticStatus.WARN and "the surface file says cylinder_9cm" in message)
        rospy.wait_for_service("/fsr/curvature/set_surface", PATIENCE)
        self.assertTrue(rospy.ServiceProxy("/fsr/curvature/set_surface", SetSurface)("cylinder_5cm", 0).success)
        self.await_status(lambda level, _, value: level == DiagnosticStatus.OK and "agrees with cylinder_5cm" in value)
        reply = self.call("/fsr/calibration/check_surface")
        self.assertTrue(reply.success and "agrees with cylinder_5cm" in reply.message, reply.message)
        reply = self.call("/fsr/calibration/estimate_surface")
        self.assertTrue(reply.success and "curvature:=estimated" in reply.message, reply.message)
        self.start_session()
        self.mark("doff")
        self.assertIn("agrees with cylinder_5cm", self.await_mark("doff: the sheet rests as on "))

    def test_the_estimated_surface_is_used_with_its_deviation(self):
        self.launch("curvature:=estimated")
        self.await_state(PressureMap.STATE_CURVATURE_UNKNOWN)
        self.start_session()
        self.mark("doff")
        self.await_mark("it is used from now on, as mount 1")
        surface = rospy.wait_for_message("/fsr/curvature", SurfaceCurvature, PATIENCE)
        self.assertEqual(surface.surface, "estimated")
        self.assertAlmostEqual(surface.x[0], 20, delta=1)
        self.assertGreater(surface.deviation[0], 0)
        self.await_state(PressureMap.STATE_OK)
        self.mark("don")
        reply = self.call("/fsr/calibration/estimate_surface")
        self.assertTrue(not reply.success and "don was marked" in reply.message, reply.message)
        self.mark("doff")
        self.await_mark("the curvature in use stays")
        reply = self.call("/fsr/calibration/estimate_surface")
        self.assertTrue(reply.success and "it is used from now on, as mount 2" in reply.message, reply.message)
        self.assertTrue(self.call("/bench/rig_emulator/start").success)
        self.await_pressure(100e3)
        self.mark("doff")
        self.await_mark("doff: how the sheet lies cannot be told: the chamber is not at ambient pressure")


if __name__ == "__main__":
    rospy.init_node("shape_test")
    rostest.rosrun("fsr_pressure_map", "shape_test", ShapeTest, sys.argv)
