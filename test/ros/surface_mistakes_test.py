#!/usr/bin/python3
"""The sheet slips off, and later lies on another surface than was asked for: the session notices both from the readings.

The emulated operator makes the mistakes.
"""
import signal

import rosbag
import rospy
import rostest
from conducted_session import SURFACES, ConductedSession

BENCH = SURFACES.parent / "simulation/bench.yaml"  # where a surface reads alike each time
PLAN = """
plan: rounds
order: listed
repeat_first: false
change: 60
conditioning: {cycles: 2, rate: 60000}
rest: {before: 5, after: 0}
surfaces: [{surface: flat, mounts: 3}, {surface: cylinder_5cm, mounts: 3}]
program:
  - cycles: {peak: 500000, rate: 80000, dwell_peak: 2, dwell_rest: 2, cycles: 2}
"""
# Steps: 1 mount, 2 and 3 conditioning, 4 rest, 5 and 6 cycles; mount n from the second on: 4 n - 1 mount, rest, two cycles.
MISTAKES = "sheet_off@10,repeat_surface@23"


class SurfaceMistakesTest(ConductedSession):
    def test_the_readings_tell(self):
        self.conduct(PLAN, MISTAKES, ("sheet", "mount 6 reads like flat"), rig=[f"_simulation:={BENCH}"], session=["report:=false"])
        conductor = self.running.pop()
        conductor.send_signal(signal.SIGINT)  # the last bag is closed at the latest then
        conductor.wait(60)
        # The mount on the wrong surface is set aside; the one that follows is complete and of the right surface.
        session = self.home / "session"
        self.assertEqual(len(list(session.glob("rounds_*.bag"))), 6)
        self.assertTrue(list((session / "set_aside").glob("rounds_06_cylinder_5cm*")))
        last = next(session.glob("rounds_06_cylinder_5cm*.bag"))
        with rosbag.Bag(str(last)) as bag:
            labels = [message.label for _, message, _ in bag.read_messages("/fsr/events")]
        self.assertEqual(sum("accepted" in label and "cycle" in label for label in labels), 2, labels)


if __name__ == "__main__":
    rospy.init_node("surface_mistakes_test")
    rostest.rosrun("fsr_pressure_map", "surface_mistakes_test", SurfaceMistakesTest)
