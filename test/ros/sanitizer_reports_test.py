#!/usr/bin/python3
"""Tests sanitizer_reports.py: which reports of a sanitizer make a test fail."""
import unittest

from sanitizer_reports import counts

OURS = "    #0 fsr::Driver::onScan(int) /p/build/tsan/../../src/ros/driver/driver.cpp:90:22 (libfsr_pressure_map_ros.so+0x10ce5c) (BuildId: 13)"
HEADER = "    #0 ~shared_array /usr/include/boost/shared_array.hpp:45:25 (libfsr_pressure_map_ros.so+0xe5792)"
RUNTIME = "    #0 memcpy <null> (driver_node+0x63a8e) (BuildId: 48)"
ROS = "    #1 ros::Connection::writeTransport() <null> (libroscpp.so.4d+0xa8b71) (BuildId: 4e)"


def race(first, second):
    return ("WARNING: ThreadSanitizer: data race (pid=1)\n  Write of size 8 at 0x7b by thread T1:\n" + "\n".join(first) +
            "\n\n  Previous read of size 8 at 0x7b by main thread:\n" + "\n".join(second) + "\n\n  Thread T1 created at:\n" + OURS + "\n")


class SanitizerReports(unittest.TestCase):
    def test_a_race_of_our_code_with_our_code_counts(self):
        self.assertTrue(counts(race([OURS], [RUNTIME, HEADER, OURS, ROS])))

    def test_a_race_with_what_ros_does_by_itself_does_not(self):
        self.assertFalse(counts(race([OURS], [RUNTIME, ROS, OURS])))
        self.assertFalse(counts(race([HEADER, ROS], [OURS])))
        self.assertFalse(counts("ThreadSanitizer: reported 15 warnings\n"))

    def test_any_other_report_counts(self):
        self.assertTrue(counts("==1==ERROR: AddressSanitizer: heap-use-after-free\n" + ROS))
        self.assertTrue(counts("driver.cpp:3:1: runtime error: signed integer overflow\n"))


if __name__ == "__main__":
    unittest.main()
